//! `glisten lint --configurations`: what is behind conditions is checked, and findings say under which macros they come.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn lint(folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(folder).args(["lint", "--configurations"]).args(arguments).output().expect("the program runs")
}

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        fs::write(folder.path().join(name), text).expect("it can be written");
    }
    folder
}

/// `line code notes` of each finding.
fn found(folder: &Path, arguments: &[&str]) -> Vec<String> {
    let arguments: Vec<&str> = arguments.iter().copied().chain(["--format", "json"]).collect();
    let output = lint(folder, &arguments);
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).expect("it is JSON");
    let findings = rows.iter().filter(|row| row.get("code").is_some());
    let notes = |row: &Value| {
        let notes = row["notes"].as_array().cloned().unwrap_or_default();
        notes.iter().filter_map(Value::as_str).map(|note| format!(" {note}")).collect::<String>()
    };
    let mut told: Vec<String> = findings
        .map(|row| format!("{}:{} {}{}", row["file"], row["line"], row["code"], notes(row)).replace('"', ""))
        .collect();
    told.sort();
    told
}

const SHADOWS: &str = "#version 150
uniform vec4 base;
out vec4 color;
void main()
{
    color = base;
#ifdef SHADOWS
#ifndef PCF
    color *= shadow_of(1);
#else
    color *= 0.5;
#endif
#if QUALITY > 2
    color *= hard;
#endif
#endif
}
";

#[test]
fn findings_say_under_which_macros_they_come() {
    let folder = folder(&[("a.frag", SHADOWS)]);
    let plain = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .current_dir(folder.path())
        .args(["lint", "a.frag"])
        .output()
        .expect("the program runs");
    assert_eq!(plain.status.code(), Some(0), "a plain run sees nothing of it");
    let expected = [
        "a.frag:9 E0304 only with `SHADOWS=1` and without `PCF`",
        "a.frag:14 E0301 only with `QUALITY=3` and `SHADOWS=1`",
    ];
    let told: Vec<String> =
        found(folder.path(), &["a.frag"]).into_iter().filter(|one| !one.contains("W0102")).collect();
    let mut expected: Vec<String> = expected.map(str::to_owned).to_vec();
    expected.sort();
    assert_eq!(told, expected);
    assert_eq!(lint(folder.path(), &["a.frag"]).status.code(), Some(1));
    let given = found(folder.path(), &["a.frag", "-D", "SHADOWS=1", "-D", "PCF=1", "-D", "QUALITY=1"]);
    assert_eq!(given, [""; 0], "macros of the command line stay as they are");
}

#[test]
fn what_some_configurations_do_not_have_is_told_so_and_not_fixed() {
    let text = "#version 150\nout vec4 color;\nvoid main()\n{\n    color = vec4(1.0);\n#ifndef FADE\n    colour *= 0.5;\n#endif\n}\n";
    let folder = folder(&[("a.frag", text)]);
    assert_eq!(found(folder.path(), &["a.frag"]), ["a.frag:7 E0301 only without `FADE`"]);
    let is_fixable = |output: &Output| String::from_utf8_lossy(&output.stdout).contains("\"applicability\"");
    assert!(!is_fixable(&lint(folder.path(), &["a.frag", "--format", "json"])), "another configuration may need it");
    assert_eq!(lint(folder.path(), &["a.frag", "--fix"]).status.code(), Some(2));
}

#[test]
fn branches_that_no_configuration_reaches_are_named() {
    let text = "#version 150\nout vec4 color;\nvoid main()\n{\n    color = vec4(1.0);\n#ifdef A\n#ifndef A\n    color *= 2.0;\n#endif\n\
        #elif defined(B)\n    color *= 3.0;\n#endif\n}\n";
    let folder = folder(&[("a.frag", text)]);
    assert_eq!(found(folder.path(), &["a.frag"]), ["a.frag:7 W0115"]);
    let output = lint(folder.path(), &["a.frag"]);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("2 of 3 branches reached"), "{said}");
}

#[test]
fn an_error_directive_excludes_a_configuration() {
    let text = "#version 150\n#if defined(A) && defined(B)\n#error A and B exclude each other\n#endif\nout vec4 color;\nvoid main()\n{\n\
        #if defined(A) && defined(B)\n    color = wrong;\n#else\n    color = vec4(1.0);\n#endif\n}\n";
    let folder = folder(&[("a.frag", text)]);
    let told = found(folder.path(), &["a.frag"]);
    assert!(!told.iter().any(|one| one.contains("E0118") || one.contains("E0301")), "{told:?}");
}

#[test]
fn macros_of_included_texts_and_defaults_count() {
    let header = "#ifndef HEADER\n#define HEADER\n#ifndef LIGHTS\n#define LIGHTS 2\n#endif\n#ifdef GLOSS\nfloat gloss() { return missing; }\n#endif\n#endif\n";
    let text = "#version 150\n#extension GL_GOOGLE_include_directive : enable\n#ifdef LIT\n#include \"header.glsl\"\n#endif\nout vec4 color;\n\
        void main()\n{\n    color = vec4(1.0);\n#ifdef LIT\n#if LIGHTS == 3\n    color *= three;\n#endif\n#endif\n}\n";
    let folder = folder(&[("a.frag", text), ("header.glsl", header)]);
    let told = found(folder.path(), &["a.frag"]);
    assert!(told.contains(&"header.glsl:7 E0301 only with `GLOSS=1` and `LIT=1`".to_owned()), "{told:?}");
    assert!(told.contains(&"a.frag:12 E0301 only with `LIGHTS=3` and `LIT=1`".to_owned()), "{told:?}");
}
