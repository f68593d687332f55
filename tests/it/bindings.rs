//! The C library and the Python package: their examples are built and run, the header is current.
//!
//! If a compiler of C or C++, or the environment of Python is missing, the test says so; if `CI` is set, it fails.

use super::emit::missing;
use super::support::root;
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// Runs a command. Its output is shown if it fails.
fn run(command: &mut Command) -> String {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let text = String::from_utf8_lossy(&stdout).into_owned();
    assert!(status.success(), "{command:?}\n{text}{}", String::from_utf8_lossy(&stderr));
    text
}

/// Whether a command is there.
fn is_there(command: &str) -> bool {
    Command::new(command).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// The folder of what this test was built to: `target/debug`.
fn built() -> PathBuf {
    let own = env::current_exe().expect("a test has a file");
    own.ancestors().nth(2).expect("`it` is in `deps`").to_owned()
}

/// Runs Cargo on the C library together with all that this test was built with, so that little is compiled again.
fn cargo(verb: &str, what: &[&str]) -> String {
    let folder = built();
    let profile = folder.file_name().expect("a folder has a name").to_string_lossy().replace("debug", "dev");
    let target = folder.parent().expect("a profile's folder is in the target folder");
    let crates = fs::read_dir(root().join("crates")).expect("the folder is there");
    let mut command = Command::new(env::var_os("CARGO").unwrap_or("cargo".into()));
    command.current_dir(root()).args([verb, "--profile", &profile, "--package", "glisten"]);
    for entry in crates {
        let name = entry.expect("an entry").file_name().into_string().expect("a name");
        command.args(["--package", &format!("glisten-{name}")]);
    }
    command.args(["--package", "glisten-binding", "--package", "glisten-c"]).args(what);
    if cfg!(feature = "gl") {
        command.arg("--all-features");
    }
    run(command.env("CARGO_TARGET_DIR", target))
}

/// The folder with the C library.
fn library() -> &'static Path {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| {
        cargo("build", &["--lib", "--test", "it"]);
        built()
    })
}

fn source(name: &str) -> PathBuf {
    root().join("integrations/c").join(name)
}

/// A program of an example, made by this compiler.
fn program(folder: &Path, compiler: &str, standard: &str, example: &str, rest: &[OsString]) -> PathBuf {
    let output = folder.join("program");
    let mut command = Command::new(compiler);
    command.args([standard, "-Wall", "-Wextra", "-Werror", "-pedantic", "-I"]).arg(source(""));
    run(command.arg(source(example)).args(rest).arg("-o").arg(&output));
    output
}

#[test]
fn the_example_in_c_runs_with_the_shared_library() {
    if !is_there("cc") {
        return missing("a compiler of C", "Debian has it in the package gcc");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let library = library();
    let rest = ["-L".into(), library.into(), "-l:libglisten.so".into()];
    let program = program(folder.path(), "cc", "-std=c11", "examples/shader.c", &rest);
    let output = run(Command::new(program).env("LD_LIBRARY_PATH", library));
    assert!(output.contains("@fragment") && output.trim_end().ends_with("all is well"), "{output}");
    assert!(output.contains("wrong.frag:2:15: `colour` is not declared"), "{output}");
}

#[test]
fn the_example_in_cpp_runs_with_the_static_library() {
    if !is_there("c++") {
        return missing("a compiler of C++", "Debian has it in the package g++");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let rest = [library().join("libglisten.a").into(), "-lpthread".into(), "-ldl".into(), "-lm".into()];
    let program = program(folder.path(), "c++", "-std=c++17", "examples/variants.cpp", &rest);
    let output = run(Command::new(program).arg(root().join("fixtures/scenes/triangle.toml")));
    assert!(output.contains("256 x 256 pixels") && output.trim_end().ends_with("all is well"), "{output}");
}

#[test]
fn the_header_is_what_the_sources_make() {
    cargo("test", &["--test", "header"]);
}

/// `integrations/python/wheel` builds the wheel and its environment; `.ci/run` runs it before the tests.
#[test]
fn the_python_package_does_what_its_tests_say() {
    let own = root().join("target/venv/bin/python");
    let python = env::var_os("GLISTEN_PYTHON").map_or(own, PathBuf::from);
    let has_all = Command::new(&python).args(["-c", "import glisten, numpy, pytest"]).output();
    if !has_all.is_ok_and(|output| output.status.success()) {
        return missing("the Python package", "run `integrations/python/wheel`");
    }
    let folder = root().join("integrations/python");
    let output = run(Command::new(&python).args(["-m", "pytest", "-q", "-p", "no:cacheprovider"]).current_dir(&folder));
    assert!(output.contains(" passed") && !output.contains("skipped"), "{output}");
    let example = run(Command::new(&python).arg("examples/explore.py").current_dir(&folder));
    assert!(example.contains("stability: stable"), "{example}");
}
