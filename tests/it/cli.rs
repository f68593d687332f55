//! The `glisten` program end to end: exit codes, standard output and error, files.

use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const VERTEX: &str = "#version 150 core\nin vec4 pv;\nin vec4 cv;\nuniform mat4 mc;\nout vec4 vc;\nvoid main(void)\n\
    {\n    vc = cv;\n    gl_Position = mc * pv;\n}\n";
const FRAGMENT: &str = "#version 150 core\nin vec4 vc;\nout vec4 fc;\nvoid main(void)\n{\n    fc = vc;\n}\n";

/// A temporary folder with files in it, and the program run there.
struct Place(TempDir);

impl Place {
    fn new(files: &[(&str, &[u8])]) -> Self {
        let place = Self(tempfile::tempdir().expect("a temporary folder"));
        for (name, bytes) in files {
            let path = place.path(name);
            fs::create_dir_all(path.parent().expect("it is in the folder")).expect("a folder");
            fs::write(path, bytes).expect("written");
        }
        place
    }

    fn triangle() -> Self {
        Self::new(&[("tri.vert", VERTEX.as_bytes()), ("tri.frag", FRAGMENT.as_bytes())])
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.args(arguments).current_dir(self.0.path()).env("NO_COLOR", "1");
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).stdin(Stdio::null()).output().expect("the program runs")
    }

    fn run_with_input(&self, arguments: &[&str], input: &str) -> Output {
        let mut child = self
            .command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        child.stdin.take().expect("it is piped").write_all(input.as_bytes()).expect("it reads its input");
        child.wait_with_output().expect("it ends")
    }

    /// The findings of `lint --format json` and the exit code.
    fn lint(&self, arguments: &[&str]) -> (Vec<Value>, i32) {
        let output = self.run(&[&["lint", "--format", "json"], arguments].concat());
        let text = out(&output);
        let findings: Vec<Value> = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
        (findings, code(&output))
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(self.path(folder))
            .map(|entries| {
                entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
            })
            .unwrap_or_default();
        names.sort();
        names
    }
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("it ended by a signal: {output:?}"))
}

fn codes(findings: &[Value]) -> Vec<&str> {
    findings.iter().filter_map(|finding| finding["code"].as_str()).collect()
}

#[test]
fn wrong_usage_is_2_and_help_is_0() {
    let place = Place::new(&[]);
    for arguments in [&["frobnicate"][..], &[], &["lint"], &["compile", "a.vert"], &["lint", "--deny"], &["explain"]] {
        let output = place.run(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(out(&output).is_empty() && !err(&output).is_empty(), "{arguments:?}");
    }
    for arguments in [&["--help"][..], &["--version"], &["lint", "--help"]] {
        let output = place.run(arguments);
        assert_eq!(code(&output), 0, "{arguments:?}");
        assert!(out(&output).contains("glisten"), "{arguments:?}");
    }
}

#[test]
fn each_kind_of_bad_file_has_its_own_word_and_code() {
    let place = Place::new(&[("empty.vert", b""), ("binary.vert", b"\x03\x02\x23\x07\0\0\0\0"), ("folder/x", b"")]);
    for (file, id, exit, word) in [
        ("missing.vert", "E0010", 2, "there is no file"),
        ("empty.vert", "E0013", 1, "is empty"),
        ("binary.vert", "E0014", 1, "binary"),
    ] {
        let (findings, exit_code) = place.lint(&[file]);
        assert_eq!((codes(&findings), exit_code), (vec![id], exit), "{file}");
        assert!(findings[0]["message"].as_str().is_some_and(|message| message.contains(word)), "{findings:?}");
        assert_eq!(findings[0]["file"], file);
    }
    for file in ["missing.vert", "folder"] {
        let output = place.run(&["compile", file, "-o", "out"]);
        assert_eq!(code(&output), 2, "{file}");
        assert!(err(&output).contains(file), "{}", err(&output));
    }
    assert!(place.names("out").is_empty());
}

#[test]
fn the_worst_exit_code_wins_and_all_files_are_told_of() {
    let place = Place::new(&[("empty.vert", b"")]);
    let (findings, exit) = place.lint(&["empty.vert", "missing.frag"]);
    assert_eq!(codes(&findings), ["E0013", "E0010"]);
    assert_eq!(exit, 2);
}

#[cfg(unix)]
#[test]
fn an_unreadable_file_is_told() {
    use std::os::unix::fs::PermissionsExt;
    let place = Place::triangle();
    fs::set_permissions(place.path("tri.vert"), fs::Permissions::from_mode(0o000)).expect("permissions");
    if fs::read(place.path("tri.vert")).is_ok() {
        // The superuser reads everything; what cannot be read then is a file that is a socket.
        fs::remove_file(place.path("tri.vert")).expect("removed");
        let _socket = std::os::unix::net::UnixListener::bind(place.path("tri.vert")).expect("a socket");
        let (findings, exit) = place.lint(&["tri.vert"]);
        assert_eq!((codes(&findings), exit), (vec!["E0011"], 2));
        return;
    }
    let (findings, exit) = place.lint(&["tri.vert"]);
    assert_eq!((codes(&findings), exit), (vec!["E0011"], 2));
}

#[test]
fn a_stage_that_no_name_tells_is_asked_for() {
    let place = Place::new(&[("a.txt", FRAGMENT.as_bytes())]);
    let output = place.run(&["lint", "a.txt"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("--stage"), "{}", err(&output));
    let output = place.run_with_input(&["lint", "-"], FRAGMENT);
    assert_eq!(code(&output), 2);
}

#[test]
fn explain_shows_pages_and_the_nearest_of_unknown_codes() {
    let place = Place::new(&[]);
    let page = place.run(&["explain", "e0003"]);
    assert_eq!(code(&page), 0);
    assert!(out(&page).starts_with("E0003 nesting-too-deep (error)"), "{}", out(&page));
    assert_eq!(out(&place.run(&["explain", "nesting-too-deep"])), out(&page));
    let unknown = place.run(&["explain", "E003"]);
    assert_eq!(code(&unknown), 2);
    assert!(err(&unknown).contains("`E0003`"), "{}", err(&unknown));
    let list = place.run(&["explain", "--list"]);
    assert_eq!(out(&list).lines().count(), glisten::diagnostic::codes::all().count());
}

#[test]
fn levels_with_unknown_codes_are_refused() {
    let place = Place::triangle();
    for (arguments, word) in [
        (["--allow", "W9999"], "there is no code"),
        (["--deny", "lone-stag"], "lone-stage"),
        (["--allow", "E0001"], "no level"),
        (["--warn", "warnings"], "only be denied"),
    ] {
        let output = place.run(&[&["lint", "tri.vert"][..], &arguments].concat());
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(err(&output).contains(word), "{}", err(&output));
    }
}

#[test]
fn a_broken_configuration_is_an_error_at_its_place() {
    let place = Place::triangle();
    fs::write(place.path("glisten.toml"), "[lint]\nallow = [\"lone-stag\"]\n").expect("written");
    let (findings, exit) = place.lint(&["tri.vert", "tri.frag"]);
    assert_eq!(exit, 1);
    let finding = findings.iter().find(|finding| finding["code"] == "E0015").expect("it is told");
    assert_eq!((finding["line"].as_u64(), finding["column"].as_u64()), (Some(2), Some(10)));
    assert!(finding["help"].as_str().is_some_and(|help| help.contains("lone-stage")), "{finding}");
}

#[test]
fn a_reader_that_goes_away_ends_the_program_in_silence() {
    let place = Place::new(&[]);
    let mut child = place
        .command(&["explain", "--list"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert!(err(&output).is_empty(), "{}", err(&output));
}

/// Whether a path is a file with something in it.
fn is_written(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|metadata| metadata.is_file() && metadata.len() > 0)
}
