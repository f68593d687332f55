//! SARIF is valid by the schema of OASIS, and the GitHub action's script writes it.
//!
//! `npm install --prefix target/sarif @microsoft/jest-sarif` brings the schema and a validator.

use crate::cli::{Folder, code};
use crate::emit::missing;
use crate::support::root;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Validates files; what is wrong with each.
fn validated(files: &[&Path]) -> Option<Vec<(bool, String)>> {
    let modules = root().join("target/sarif/node_modules");
    let script = root().join("tests/it/sarif.mjs");
    let output = modules.is_dir().then(|| Command::new("node").arg(&script).arg(&modules).args(files).output());
    let Some(Ok(output)) = output else {
        missing("the schema of SARIF", "npm install --prefix target/sarif @microsoft/jest-sarif (and node) brings it");
        return None;
    };
    let lines = String::from_utf8_lossy(&output.stdout);
    let read = |line: &str| {
        let row: Value = serde_json::from_str(line).expect("a line of JSON");
        (row["valid"] == true, row["errors"].to_string())
    };
    let found: Vec<(bool, String)> = lines.lines().map(read).collect();
    assert_eq!(found.len(), files.len(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(found)
}

#[test]
fn sarif_is_valid_by_its_schema() {
    let folder = Folder::new(&[("wrong.sarif", br#"{"version":"2.1.0","runs":[{"tool":{}}]}"#)]);
    let mut paths = vec![folder.path("wrong.sarif")];
    let sources = ["fixtures/lint", "fixtures/invalid", "fixtures/valid", "fixtures/link", "fixtures/cost"];
    for (index, source) in sources.iter().enumerate() {
        let path = folder.path(&format!("{index}.sarif"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        let output =
            command.current_dir(root()).args(["lint", "--warn", "style", "--format", "sarif", source]).output();
        fs::write(&path, output.expect("the program runs").stdout).expect("written");
        paths.push(path);
    }
    let files: Vec<&Path> = paths.iter().map(std::path::PathBuf::as_path).collect();
    let Some(found) = validated(&files) else { return };
    assert!(!found[0].0, "a tool without a driver is not valid");
    for ((valid, errors), source) in found.iter().skip(1).zip(sources) {
        assert!(valid, "{source}: {errors}");
    }
}

/// Runs the script of the action on a folder with these arguments; the exit code, what it prints, and its outputs.
fn action(folder: &Folder, arguments: &str) -> (i32, String, String) {
    let outputs = folder.path("outputs");
    let _ = fs::remove_file(&outputs);
    let mut command = Command::new(root().join("integrations/github/lint"));
    command.current_dir(folder.path(".")).env("GLISTEN", env!("CARGO_BIN_EXE_glisten"));
    command.env("GLISTEN_PATHS", "shaders\na b.frag").env("GLISTEN_ARGS", arguments);
    command.env("GLISTEN_SARIF", "found.sarif").env("GITHUB_OUTPUT", &outputs);
    let output = command.output().expect("bash runs");
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    (code(&output), printed, fs::read_to_string(outputs).unwrap_or_default())
}

#[test]
fn the_action_annotates_and_writes_sarif() {
    let noisy = b"#version 150\nout vec4 c;\nvoid main() { float unused = 1.0; c = vec4(1.0); }\n";
    let folder = Folder::new(&[("shaders/a.frag", noisy), ("a b.frag", noisy)]);
    let (exit, printed, outputs) = action(&folder, "");
    assert_eq!((exit, outputs.as_str()), (0, "sarif=found.sarif\n"));
    assert!(printed.contains("::notice") && printed.contains("a b.frag"), "{printed}");
    let sarif: Value =
        serde_json::from_slice(&fs::read(folder.path("found.sarif")).expect("it is there")).expect("JSON");
    assert_eq!(sarif["runs"][0]["results"].as_array().map(Vec::len), Some(2));
    let (exit, printed, _) = action(&folder, "--deny unused-variable\n-D A=1");
    assert_eq!(exit, 1);
    assert!(printed.contains("::error"), "{printed}");
    let (exit, _, outputs) = action(&folder, "--no-such-flag");
    assert_eq!((exit, outputs.as_str()), (2, ""));
}

#[test]
fn the_action_names_files_that_are_there() {
    let action = fs::read_to_string(root().join("integrations/github/action.yml")).expect("readable");
    for input in ["paths", "args", "sarif", "upload", "glisten"] {
        assert!(action.contains(&format!("  {input}:\n")), "{input}");
        assert!(action.contains(&format!("inputs.{input}")), "{input} is not used");
    }
    assert!(action.contains("\"$GITHUB_ACTION_PATH/lint\"") && root().join("integrations/github/lint").is_file());
    assert!(root().join("integrations/github/../../Cargo.toml").is_file());
}

/// The URI of a file has the bytes of its name (RFC 3986 §2.1), of UTF-8 or not.
#[cfg(target_os = "linux")]
#[test]
fn uris_have_the_bytes_of_names() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let text = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0f) }\n";
    let folder = Folder::new(&[]);
    let name = |bytes: &[u8]| OsStr::from_bytes(bytes).to_owned();
    fs::create_dir(folder.path(".").join(name(b"n\xff"))).expect("a folder");
    for file in [&b"n\xff/x\xfe.frag"[..], b"n\xff/\xc3\xa9 y.frag", b"n\xff/z.frag", "\u{fffd}.frag".as_bytes()] {
        fs::write(folder.path(".").join(name(file)), text).expect("written");
    }
    let output = folder.run(&["lint", ".", "--format", "sarif"]);
    let log: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let results = log["runs"][0]["results"].as_array().expect("results");
    let of =
        |value: &Value| value["artifactLocation"]["uri"].as_str().map(|uri| uri.trim_start_matches("./").to_owned());
    let mut uris: Vec<String> =
        results.iter().filter_map(|result| of(&result["locations"][0]["physicalLocation"])).collect();
    uris.sort();
    uris.dedup();
    assert_eq!(uris, ["%EF%BF%BD.frag", "n%FF/%C3%A9%20y.frag", "n%FF/x%FE.frag", "n%FF/z.frag"]);
    let changes = results.iter().flat_map(|result| result["fixes"].as_array().cloned().unwrap_or_default());
    let mut fixed: Vec<String> = changes.filter_map(|fix| of(&fix["artifactChanges"][0])).collect();
    fixed.sort();
    fixed.dedup();
    assert_eq!(fixed, uris);
}
