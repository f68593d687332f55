//! The crates that Cargo compiles after an edit of a shader, counted by the runs of rustc: the layouts of docs/build.md.
//!
//! The build script and the generator get the glisten that this test is built with, so that it is not compiled again.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// Notes the crate of each run. `GLISTEN` and `DEPENDENCIES` are for those that compile shaders.
const WRAPPER: &str = r#"#!/bin/sh
rustc="$1"; shift
name=; before=
for word in "$@"; do
    [ "$before" = --crate-name ] && name="$word"
    before="$word"
done
case "$name" in
    ""|___) ;;
    build_script_build|generate) echo "$name" >> "$RUNS"
        exec "$rustc" "$@" --extern "glisten=$GLISTEN" -L "dependency=$DEPENDENCIES" ;;
    *) echo "$name" >> "$RUNS" ;;
esac
exec "$rustc" "$@"
"#;

const VERTEX: &str = "#version 330\nin vec4 p;\nvoid main() { gl_Position = p; }\n";
const FRAGMENT: &str = "#version 330\n#include \"tint.glsl\"\nout vec4 c;\nvoid main() { c = tint(vec4(1.0)); }\n";
const INCLUDE: &str = "vec4 tint(vec4 c) { return c * 0.5; }\n";

/// A workspace.
struct Workspace(TempDir);

impl Workspace {
    fn new(files: &[(&str, &str)]) -> Self {
        let workspace = Self(tempfile::tempdir().expect("a folder"));
        let shaders = [("a.vert", VERTEX), ("a.frag", FRAGMENT), ("include/tint.glsl", INCLUDE), ("notes.txt", "x")];
        for (name, text) in shaders {
            workspace.write(&format!("shaders/shaders/{name}"), text);
        }
        files.iter().for_each(|(name, text)| workspace.write(name, text));
        workspace.write("wrapper", WRAPPER);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            let path = workspace.path("wrapper");
            fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("the permissions are set");
        }
        workspace
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, newer than everything that was built.
    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        fs::write(&path, text).expect("written");
        let file = fs::File::options().append(true).open(&path).expect("the file");
        file.set_modified(SystemTime::now() + Duration::from_millis(5)).expect("the time is set");
        std::thread::sleep(Duration::from_millis(10));
    }

    /// The crates that were compiled by a command of Cargo, and what it printed.
    fn cargo(&self, words: &[&str]) -> (Vec<String>, String, bool) {
        let test = std::env::current_exe().expect("a test has a file");
        let dependencies = test.parent().expect("a folder");
        let runs = self.path("runs");
        let _ = fs::remove_file(&runs);
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()));
        command.args(words).arg("--offline").current_dir(self.0.path());
        command.env("RUSTC_WRAPPER", self.path("wrapper")).env("CARGO_TARGET_DIR", self.path("target"));
        command.env("RUNS", &runs).env("GLISTEN", crate::build::newest(dependencies, "glisten"));
        command.env("DEPENDENCIES", dependencies).env_remove("CARGO_ENCODED_RUSTFLAGS").env_remove("OUT_DIR");
        let run = command.output().expect("cargo is there, since it runs this");
        let text = String::from_utf8_lossy(&run.stderr).into_owned();
        let mut crates: Vec<String> =
            fs::read_to_string(&runs).unwrap_or_default().lines().map(str::to_owned).collect();
        crates.sort();
        (crates, text, run.status.success())
    }

    fn built(&self) -> Vec<String> {
        let (crates, text, is_built) = self.cargo(&["build"]);
        assert!(is_built, "{text}");
        crates
    }
}

fn manifest(name: &str, more: &str) -> String {
    format!("[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n{more}")
}

/// The workspace with a crate for shaders, on which the program depends and the engine does not.
fn with_build_script(build: &str) -> Workspace {
    let app = "[dependencies]\nengine = { path = \"../engine\" }\nshaders = { path = \"../shaders\" }\n";
    Workspace::new(&[
        ("Cargo.toml", "[workspace]\nmembers = [\"shaders\", \"engine\", \"app\"]\nresolver = \"3\"\n"),
        ("shaders/Cargo.toml", &manifest("shaders", "")),
        ("shaders/build.rs", &format!("fn main() {{ {build}.run(); }}\n")),
        ("shaders/src/lib.rs", "include!(concat!(env!(\"OUT_DIR\"), \"/shaders.rs\"));\n"),
        ("engine/Cargo.toml", &manifest("engine", "")),
        ("engine/src/lib.rs", "pub fn draw(code: &str) -> usize { code.len() }\n"),
        ("app/Cargo.toml", &manifest("app", app)),
        (
            "app/src/main.rs",
            "#![deny(warnings)]\nfn main() { assert!(engine::draw(shaders::a::FRAGMENT_WGSL) > 0); }\n",
        ),
    ])
}

#[test]
fn an_engine_is_not_compiled_again_for_a_shader() {
    let build = "glisten::build::Build::new().folder(\"shaders\").include(\"shaders/include\")";
    let workspace = with_build_script(&format!("{build}.watch_files()"));
    assert_eq!(workspace.built(), ["app", "build_script_build", "engine", "shaders"]);
    assert_eq!(workspace.built(), [""; 0]);
    workspace.write("shaders/shaders/notes.txt", "y");
    workspace.write("shaders/shaders/include/other.glsl", "\n");
    assert_eq!(workspace.built(), [""; 0], "nobody reads them");
    // Cargo compiles a crate whose script ran, and what depends on it, whatever the script has written.
    workspace.write("shaders/shaders/include/tint.glsl", &format!("// The same.\n{INCLUDE}"));
    assert_eq!(workspace.built(), ["app", "shaders"]);
    assert_eq!(workspace.built(), [""; 0]);

    workspace.write("shaders/shaders/a.frag", "#version 330\nout vec4 c;\nvoid main() { c = missing; }\n");
    let (_, text, is_built) = workspace.cargo(&["build"]);
    assert!(!is_built && text.contains("`missing` is not declared"), "{text}");
    assert!(text.contains("error: shaders@0.1.0: ") && !text.contains("panicked"), "{text}");
    workspace.write("shaders/shaders/a.frag", FRAGMENT);
    assert_eq!(workspace.built(), ["app", "shaders"]);
}

#[test]
fn folders_are_watched_for_new_programs() {
    let workspace = with_build_script("glisten::build::Build::new().folder(\"shaders\").include(\"shaders/include\")");
    assert_eq!(workspace.built().len(), 4);
    assert_eq!(workspace.built(), [""; 0]);
    workspace.write("shaders/shaders/deep/b.vert", VERTEX);
    workspace.write("shaders/shaders/deep/b.frag", "#version 330\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n");
    workspace.write("app/src/main.rs", "fn main() { println!(\"{}\", shaders::b::FRAGMENT_WGSL); }\n");
    assert_eq!(workspace.built(), ["app", "shaders"]);
    assert_eq!(workspace.built(), [""; 0]);
}

#[test]
fn a_generator_compiles_nothing_while_the_module_is_the_same() {
    let generate = "fn main() {\n    let build = glisten::build::Build::new().folder(\"shaders/shaders\")\
        .include(\"shaders/shaders/include\").output_folder(\"app/src\");\n    \
        if let Err(error) = build.build() {\n        eprintln!(\"{error}\");\n        std::process::exit(1);\n    }\n}\n";
    let workspace = Workspace::new(&[
        ("Cargo.toml", "[workspace]\nmembers = [\"shaders\", \"app\"]\nresolver = \"3\"\n"),
        ("shaders/Cargo.toml", &manifest("generate", "")),
        ("shaders/src/main.rs", generate),
        ("app/Cargo.toml", &manifest("app", "")),
        ("app/src/main.rs", "mod shaders;\nfn main() { assert!(!shaders::a::FRAGMENT_WGSL.is_empty()); }\n"),
    ]);
    let both = || {
        let (mut crates, text, is_generated) = workspace.cargo(&["run", "--package", "generate"]);
        assert!(is_generated, "{text}");
        let (own, text, is_built) = workspace.cargo(&["build", "--package", "app"]);
        assert!(is_built, "{text}");
        crates.extend(own);
        crates
    };
    assert_eq!(both(), ["generate", "app"]);
    assert_eq!(both(), [""; 0]);
    workspace.write("shaders/shaders/include/tint.glsl", &format!("// The same.\n{INCLUDE}"));
    assert_eq!(both(), [""; 0], "the module is the same");
    workspace.write("shaders/shaders/include/tint.glsl", &INCLUDE.replace("0.5", "0.25"));
    assert_eq!(both(), ["app"]);
}
