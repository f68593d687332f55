//! Calls of the program with hostile files: what takes too long ends, no input is overwritten, and no text is a megabyte.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const VERTEX: &str = "#version 150\nin vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n";
const FRAGMENT: &str =
    "#version 150\nuniform float u;\nout vec4 c;\nvoid main() { c = vec4(sin(u * gl_FragCoord.x)); }\n";
const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nINSTANCES\
    [draw.attributes]\np = { size = 3, values = [-1, -1, 0, 3, -1, 0, -1, 3, 0] }\n[draw.uniforms]\nu = 0.5\n";

/// A folder with a scene of one draw, one whose picture is large, and one whose draw has four million instances.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = [
        ("a.vert", VERTEX.to_owned()),
        ("a.frag", FRAGMENT.to_owned()),
        ("a.toml", SCENE.replace("INSTANCES", "")),
        ("large.toml", SCENE.replace("INSTANCES", "").replace("= 8\n", "= 256\n")),
        ("long.toml", SCENE.replace("INSTANCES", "instances = 4194304\n")),
    ];
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("written");
    }
    folder
}

fn glisten(folder: &Path, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(folder).args(arguments.split_whitespace());
    command
}

fn run(folder: &Path, arguments: &str) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } = glisten(folder, arguments).output().expect("the program runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (status.code(), text(&stdout), text(&stderr))
}

/// A pipe without a reader is no reason to wait for ever.
#[cfg(unix)]
#[test]
fn a_pipe_that_nobody_reads_is_told() {
    let folder = folder();
    let made = Command::new("mkfifo").arg(folder.path().join("pipe")).status().expect("mkfifo runs");
    assert!(made.success());
    let (code, _, said) = run(folder.path(), "compile a.vert a.frag -o out --depfile pipe");
    assert!(
        code == Some(2) && said.contains("cannot write `pipe`: it is a pipe that nobody reads"),
        "{code:?}: {said}"
    );
    let mut reader =
        Command::new("cat").arg(folder.path().join("pipe")).stdout(Stdio::piped()).spawn().expect("it runs");
    let (code, _, said) = run(folder.path(), "compile a.vert a.frag -o out --depfile pipe");
    assert_eq!(code, Some(0), "{said}");
    let read = std::io::read_to_string(reader.stdout.take().expect("it is piped")).expect("it is read");
    assert!(reader.wait().is_ok() && read.contains("a.vert.wgsl"), "{read}");
}

/// The time of a model counts that is read before anything is drawn.
#[test]
fn timeout_ends_the_reading_of_a_model() {
    let rows: String = (0..400_000).map(|k| format!("v {k} 0 0\n")).collect();
    let faces: String = (1..399_999).map(|k| format!("f {k} {} {}\n", k + 1, k + 2)).collect();
    let folder = folder();
    fs::write(folder.path().join("a.obj"), rows + &faces).expect("written");
    let (code, _, said) = run(folder.path(), "render a.obj -o a.png --backend cpu --timeout 0.05");
    assert!(code == Some(1) && said.contains("gave up after 0.05 s"), "{code:?}: {said}");
}

#[test]
fn timeout_ends_each_command() {
    let folder = folder();
    for command in ["stability", "stability --exact", "stability --stiff", "specialize -o out", "report -o out"] {
        let start = Instant::now();
        let (code, _, said) = run(folder.path(), &format!("{command} long.toml --timeout 1"));
        assert_eq!(code, Some(1), "{command}: {said}");
        assert!(
            said.contains("gave up after 1 s") && said.contains("`--timeout` gives more time"),
            "{command}: {said}"
        );
        assert!(start.elapsed() < Duration::from_secs(30), "{command}: {:?}", start.elapsed());
    }
    let start = Instant::now();
    let (_, _, said) = run(folder.path(), "stability large.toml --sweep u=0..1e6:4000 --timeout 1");
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}: {said}", start.elapsed());
    assert!(said.contains("`--timeout` gives more time"), "{said}");
}

#[test]
fn inputs_are_not_overwritten() {
    let folder = folder();
    let inputs = ["a.vert", "a.frag", "a.toml"];
    let texts = || inputs.map(|name| fs::read(folder.path().join(name)).expect("it is there"));
    let before = texts();
    for command in [
        "compile a.vert a.frag -o out --depfile a.frag",
        "compile a.vert a.frag -o out --manifest ./a.vert",
        "play --export a.toml a.toml",
        "play --export a.frag a.toml",
        "specialize a.toml -o .",
        "stability a.toml --worst a.toml --stiff",
        "upgrade a.frag -o . --to 330",
    ] {
        let (code, _, said) = run(folder.path(), command);
        assert_eq!(code, Some(2), "{command}: {said}");
        assert!(said.contains("is one of the inputs"), "{command}: {said}");
        assert!(texts() == before, "{command}");
    }
    let (code, _, said) = run(folder.path(), "upgrade a.frag --in-place --to 330");
    assert_eq!(code, Some(0), "{said}");
    assert!(texts() != before);
}

#[test]
fn a_long_name_is_cut_in_failures() {
    let folder = folder();
    let name = "a".repeat(1 << 20);
    fs::write(folder.path().join("name.toml"), SCENE.replace("INSTANCES", "").replace("a.vert", &name))
        .expect("written");
    fs::write(folder.path().join("name.frag"), format!("#version 150\nvoid main() {{ {name} = 1; }}\n"))
        .expect("written");
    for command in ["render name.toml -o a.png --backend cpu", "lint name.frag", "compile name.frag -o out"] {
        let (code, told, said) = run(folder.path(), command);
        assert!(code.is_some_and(|code| code > 0), "{command}");
        assert!((told + &said).len() < 8192, "{command}");
    }
}

#[test]
fn a_control_character_is_an_error_at_its_place() {
    let folder = folder();
    let text = FRAGMENT.replace("c = vec4", "c = /* \u{1b}[31m \u{1} */ \u{7} vec4");
    fs::write(folder.path().join("bell.frag"), &text).expect("written");
    let (code, told, said) = run(folder.path(), "lint bell.frag --format github");
    assert_eq!(code, Some(1), "{said}");
    assert!(told.contains("line=4") && told.contains("E0103"), "{told}");
    assert!(!told.contains(['\u{1b}', '\u{7}', '\u{1}']), "{told:?}");
    fs::write(folder.path().join("bell.frag"), text.replace('\u{7}', "")).expect("written");
    let (code, told, said) = run(folder.path(), "lint bell.frag");
    assert_eq!(code, Some(0), "{told}{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told() {
    let folder = folder();
    for command in ["--help", "--version", "lint --help", "help", "explain E0103", "reflect a.frag", "completions bash"]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("Linux has it");
        let output = glisten(folder.path(), command).stdout(Stdio::from(full)).output().expect("the program runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{command}: {said}");
        assert!(said.contains("cannot write to standard output"), "{command}: {said}");
    }
}
