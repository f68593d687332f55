//! The Bazel rules: they give the bytes of the command line, compile nothing twice, and see only what is declared. On a cluster of
//! BuildGrid a worker is killed in the middle of a build.
//!
//! If Bazel or BuildGrid is missing, the test says so; if `CI` is set, it fails.

use super::emit::missing;
use super::support::{files_under, root};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Debian's rules, which Bazel would download otherwise.
const RULES_JAVA: &str = "/usr/share/bazel/rules/java";
const PLATFORMS: &str = "/usr/share/bazel/platforms";

/// A copy of the rules and their example, with a Bazel of its own.
struct Workspace {
    folder: tempfile::TempDir,
}

impl Workspace {
    fn new() -> Option<Self> {
        let is_there = Path::new(RULES_JAVA).is_dir() && Command::new("bazel").arg("help").output().is_ok();
        if !is_there {
            missing("Bazel", "Debian has it in the packages bazel-bootstrap and bazel-rules-java");
            return None;
        }
        let folder = tempfile::tempdir().expect("a folder");
        let from = root().join("integrations/bazel");
        for path in files_under(&from) {
            let to = folder.path().join(path.strip_prefix(&from).expect("below the folder"));
            fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
            fs::copy(&path, to).expect("copied");
        }
        Some(Self { folder })
    }

    fn example(&self, name: &str) -> PathBuf {
        self.folder.path().join("example").join(name)
    }

    fn bazel(&self, verb: &str, arguments: &[&str]) -> (bool, String) {
        let mut command = Command::new("bazel");
        command.current_dir(self.example("")).env("GLISTEN", env!("CARGO_BIN_EXE_glisten"));
        command.arg(format!("--output_user_root={}", self.folder.path().join("bazel").display())).arg(verb);
        if verb == "build" {
            let stub = self.folder.path().join("offline/rules_cc");
            for (name, path) in [("rules_java", RULES_JAVA.into()), ("platforms", PLATFORMS.into()), ("rules_cc", stub)]
            {
                command.arg(format!("--override_repository={name}={}", path.display()));
            }
        }
        let output = command.args(arguments).output().expect("it starts");
        let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
        (output.status.success(), text.concat())
    }

    fn build(&self, targets: &[&str]) -> String {
        let (is_well, text) = self.bazel("build", targets);
        assert!(is_well, "{text}");
        text
    }

    fn output(&self) -> PathBuf {
        let (_, text) = self.bazel("info", &["bazel-bin"]);
        text.lines().find(|line| line.ends_with("/bin")).expect("a folder").into()
    }
}

impl Drop for Workspace {
    fn drop(&mut self) {
        self.bazel("shutdown", &[]);
        // What Bazel lays out is read-only.
        let _ = Command::new("chmod").args(["-R", "u+w"]).arg(self.folder.path()).status();
    }
}

/// Writes with the command line the outputs of the example's program.
fn by_hand(workspace: &Workspace, output: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(workspace.example("")).args(["compile", "shaders/lit.vert", "shaders/lit.frag"]);
    command.args(["-I", "shaders", "-D", "LIGHTS=2", "--bind-attrib", "position=0", "--clip-z=minus-one-to-one"]);
    command.args(["--target", "wgsl", "--target", "spirv", "--target", "hlsl", "-o"]).arg(output);
    let run = command.output().expect("it starts");
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

#[test]
fn bazel_gives_the_bytes_of_the_command_line_and_compiles_nothing_twice() {
    let Some(workspace) = Workspace::new() else { return };
    workspace.build(&["//..."]);
    let bin = workspace.output();
    let expected = tempfile::tempdir().expect("a folder");
    by_hand(&workspace, expected.path());
    let files = files_under(expected.path());
    assert_eq!(files.len(), 7);
    for file in files {
        let name = file.file_name().expect("a name");
        let made = fs::read(bin.join("lit").join(name)).expect("Bazel made it");
        assert_eq!(made, fs::read(&file).expect("readable"), "{}", name.display());
    }
    let index = fs::read_to_string(bin.join("variants/index.json")).expect("an index");
    let index: serde_json::Value = serde_json::from_str(&index).expect("JSON");
    let variants = index["variants"].as_array().expect("a list");
    assert_eq!(variants.len(), 32);
    assert_eq!(variants[3]["defines"]["LIGHTS"], "2");
    let code = variants[3]["outputs"]["wgsl"][1].as_str().expect("a path");
    assert!(fs::read_to_string(bin.join("variants").join(code)).expect("code").contains("fog"));
    // The same in one action.
    let index = fs::read_to_string(bin.join("listed/index.json")).expect("an index");
    let index: serde_json::Value = serde_json::from_str(&index).expect("JSON");
    assert_eq!(index["programs"][0]["variants"].as_array().map(Vec::len), Some(6), "{index}");
    let codes: Vec<String> = files_under(&bin.join("listed"))
        .iter()
        .filter(|path| path.extension().is_some_and(|extension| extension == "wgsl"))
        .map(|path| fs::read_to_string(path).expect("code"))
        .collect();
    assert!(codes.iter().any(|code| code.contains("@location(3)")), "{codes:?}");

    assert!(workspace.build(&["//..."]).contains("1 process: 1 internal"), "nothing changed");
    let fragment = workspace.example("shaders/lit.frag");
    let text = fs::read_to_string(&fragment).expect("readable");
    fs::write(&fragment, text.replace("light.glsl", "undeclared.glsl")).expect("written");
    fs::write(workspace.example("shaders/undeclared.glsl"), "#define lit_by_all(x) (x)\n").expect("written");
    let (is_well, output) = workspace.bazel("build", &["//:lit"]);
    assert!(!is_well && output.contains("E0107") || output.contains("undeclared.glsl"), "{output}");
    assert!(!is_well, "a file that is not declared was read");
}

#[test]
fn a_cluster_builds_the_same_bytes_although_a_worker_is_killed() {
    let own = root().join("target/buildgrid/bin/python");
    let python = env::var_os("GLISTEN_BUILDGRID").map_or(own, PathBuf::from);
    if !python.is_file() {
        return missing("BuildGrid", "make the environment target/buildgrid with `pip install buildgrid==0.0.86`");
    }
    let Some(workspace) = Workspace::new() else { return };
    let mut command = Command::new("python3");
    command.arg(workspace.folder.path().join("cluster/measure")).args(["--workers", "2", "--kill", "--buildgrid"]);
    let output = command.arg(python).arg(env!("CARGO_BIN_EXE_glisten")).output().expect("it starts");
    let text = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).concat();
    assert!(output.status.success(), "{text}");
    assert!(text.contains("one killed") && text.contains("168 files, the bytes of the local build"), "{text}");
    assert!(text.contains("33 remote") && text.contains("33 remote cache hit"), "{text}");
}
