//! The examples for CMake, Meson, Ninja and Make: they build, build nothing twice, and build again after a change of a file
//! that a shader includes. Where a tool is missing, the test says so; if `CI` is set, it fails.

use crate::support::root;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, SystemTime};
use tempfile::TempDir;

/// A copy of `integrations`, with the program on the path.
struct Copy(TempDir);

impl Copy {
    fn new() -> Self {
        let copy = Self(tempfile::tempdir().expect("a folder"));
        copy_all(&root().join("integrations"), &copy.path("integrations"));
        copy
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The output of a command in a folder.
    fn run(&self, folder: &str, words: &[&str]) -> String {
        let (program, arguments) = words.split_first().expect("a command");
        let bin = Path::new(env!("CARGO_BIN_EXE_glisten")).parent().expect("a folder");
        let path = std::env::var_os("PATH").unwrap_or_default();
        let paths = [bin.to_owned()].into_iter().chain(std::env::split_paths(&path));
        let run = Command::new(program)
            .args(arguments)
            .current_dir(self.path(folder))
            .env("PATH", std::env::join_paths(paths).expect("paths"))
            .output()
            .expect("the tool was found");
        let text = String::from_utf8_lossy(&run.stdout).into_owned() + &String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success(), "{words:?}: {text}");
        text
    }

    /// Changes the file that a shader includes, and makes it newer than everything.
    fn change_the_include(&self) {
        let path = self.path("integrations/cmake/example/shaders/include/height.glsl");
        let text = fs::read_to_string(&path).expect("the include").replace("cos(place.y", "cos(2.0 * place.y");
        fs::write(&path, text).expect("written");
        let file = fs::File::options().append(true).open(&path).expect("the include");
        file.set_modified(SystemTime::now() + Duration::from_secs(2)).expect("the time is set");
    }
}

fn copy_all(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("a folder").filter_map(Result::ok) {
        let (from, to) = (entry.path(), to.join(entry.file_name()));
        if from.is_dir() {
            copy_all(&from, &to);
        } else {
            fs::copy(&from, &to).expect("copied");
        }
    }
}

/// Whether tools are there.
fn are_there(tools: &[&str]) -> bool {
    let is_missing = |tool: &&&str| Command::new(tool).arg("--version").output().is_err();
    let missing: Vec<&str> = tools.iter().filter(is_missing).copied().collect();
    for tool in &missing {
        crate::emit::missing(tool, "Debian has it in a package of this name, Ninja in ninja-build");
    }
    missing.is_empty()
}

/// Builds, again without need, and again after a change. `did` says whether a build compiled the shaders.
fn builds(copy: &Copy, folder: &str, words: &[&str], output: &str, did: impl Fn(&str) -> bool) {
    let first = copy.run(folder, words);
    assert!(did(&first), "{words:?}: {first}");
    let read = || fs::read_to_string(copy.path(output)).unwrap_or_else(|error| panic!("{output}: {error}"));
    let before = read();
    let second = copy.run(folder, words);
    assert!(!did(&second), "{words:?} again: {second}");
    copy.change_the_include();
    let third = copy.run(folder, words);
    assert!(did(&third), "{words:?} after a change: {third}");
    assert_ne!(before, read(), "the include is another one");
}

#[test]
fn ninja_builds_what_changed() {
    if are_there(&["ninja"]) {
        let copy = Copy::new();
        let did = |text: &str| text.contains("shaders of wave");
        builds(&copy, "integrations/ninja", &["ninja"], "integrations/ninja/out/wave.vert.wgsl", did);
    }
}

#[test]
fn make_builds_what_changed() {
    if are_there(&["make"]) {
        let copy = Copy::new();
        let did = |text: &str| text.contains("--depfile");
        builds(&copy, "integrations/make", &["make"], "integrations/make/out/wave.vert.wgsl", did);
    }
}

#[test]
fn cmake_builds_what_changed() {
    for (generator, tool) in [("Ninja", "ninja"), ("Unix Makefiles", "make")] {
        if are_there(&["cmake", tool]) {
            let copy = Copy::new();
            let shown = copy.run("integrations", &["cmake", "-S", "cmake/example", "-B", "built", "-G", generator]);
            assert!(shown.contains("wave.shaders/wave.frag.spv;"), "{shown}");
            let words = ["cmake", "--build", "built"];
            let did = |text: &str| text.contains("Compiling the shaders of wave\n");
            builds(&copy, "integrations", &words, "integrations/built/wave.shaders/wave.vert.wgsl", did);
            let index = fs::read_to_string(copy.path("integrations/built/waves.shaders/index.json")).expect("an index");
            assert!(index.contains("\"BANDS\": \"1\""), "{index}");
            copy.run("integrations", &["cmake", "--build", "built", "--target", "clean"]);
            assert!(!copy.path("integrations/built/waves.shaders").exists(), "`clean` leaves outputs of variants");
        }
    }
}

/// An output that has another name than the build expects would be made each time.
#[test]
fn cmake_names_the_reflection_as_glisten_does() {
    let names = [
        "d.vert",
        "d.vert.glsl",
        "G.VERT",
        "lit_vs.glsl",
        "a-frag.GLSL",
        "bVertex.glsl",
        "vertex.glsl",
        "vs_x.glsl",
        "x.vertexshader",
        "deferred-f.sdr",
        "a.b.fs",
        "a.vertexFrag.glsl",
    ];
    if are_there(&["cmake"]) {
        let folder = tempfile::tempdir().expect("a folder");
        let module = root().join("integrations/cmake/Glisten.cmake");
        let script = format!(
            "include(\"{}\")\nforeach(name {})\n  _glisten_stem(stem ${{name}})\n  message(STATUS \"${{name}} ${{stem}}\")\nendforeach()\n",
            module.display(),
            names.join(" ")
        );
        let path = folder.path().join("names.cmake");
        fs::write(&path, script).expect("written");
        let output = Command::new("cmake").arg("-P").arg(&path).output().expect("it runs");
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        for name in names {
            let (_, stem) = glisten::stage_of_name(name).expect("a stage");
            assert!(said.contains(&format!("-- {name} {stem}\n")), "{name} {stem}: {said}");
        }
    }
}

#[test]
fn meson_builds_what_changed() {
    if are_there(&["meson", "ninja"]) {
        let copy = Copy::new();
        copy.run("integrations", &["meson", "setup", "built", "meson"]);
        let words = ["meson", "compile", "-C", "built"];
        let did = |text: &str| text.contains("Generating wave ");
        builds(&copy, "integrations", &words, "integrations/built/wave.vert.wgsl", did);
    }
}
