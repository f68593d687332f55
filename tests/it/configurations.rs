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

#[test]
fn a_header_of_one_branch_is_looked_at_too() {
    let header = "#ifdef LIT\nconst float lit = 1.0;\n#else\nconst float lit = 0.0;\n#endif\n";
    let text = "#version 150\n#extension GL_GOOGLE_include_directive : enable\n#ifdef GLOSS\n#include \"header.glsl\"\n#else\nconst float lit = 2.0;\n\
        #endif\nout vec4 color;\nvoid main()\n{\n    color = vec4(lit);\n#ifdef LIT\n    color *= 2.0;\n#endif\n}\n";
    let folder = folder(&[("a.frag", text), ("header.glsl", header)]);
    assert_eq!(found(folder.path(), &["a.frag"]), [""; 0], "all branches of the header are reached");
}

#[test]
fn the_project_states_values_and_conditions() {
    let text = "#version 150\nout vec4 color;\nvoid main()\n{\n    color = vec4(1.0);\n#if LIGHTS == 7\n    color *= seven;\n#endif\n\
        #if LIGHTS > 7\n    color *= many;\n#endif\n#if defined(PCF) && !defined(SHADOWS)\n    color *= pcf;\n#endif\n#ifdef LEGACY\n    color *= legacy;\n\
        #endif\n}\n";
    let folder = folder(&[("a.frag", text)]);
    let codes = |state: &str| {
        fs::write(folder.path().join("glisten.toml"), state).expect("it can be written");
        let told = found(folder.path(), &["a.frag"]);
        let told = told.iter().filter(|one| !one.contains("W0102"));
        told.map(|one| one.split(" with").next().unwrap_or_default().to_owned()).collect::<Vec<_>>()
    };
    let all = ["a.frag:10 E0301 only", "a.frag:13 E0301 only", "a.frag:16 E0301 only", "a.frag:7 E0301 only"];
    assert_eq!(codes(""), all);
    let stated = "[lint.configurations]\nvalues = { LIGHTS = [0, 9], LEGACY = [false] }\nskip = [\"PCF !SHADOWS\"]\n";
    let expected = ["a.frag:10 E0301 only", "a.frag:12 W0115", "a.frag:15 W0115", "a.frag:6 W0115"];
    assert_eq!(codes(stated), expected);
    let expected = ["a.frag:13 E0301 only", "a.frag:16 E0301", "a.frag:7 E0301", "a.frag:9 W0115"];
    assert_eq!(codes("[lint.configurations]\nonly = [\"LEGACY LIGHTS=7\"]\n"), expected);
    let output = {
        codes("[lint.configurations]\nvalue = {}\nskip = [\"\"]\nvalues = { LIGHTS = 1 }\n");
        lint(folder.path(), &["a.frag"])
    };
    let said = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    for mistake in ["did you mean `values`", "a condition is empty", "is not a list of values"] {
        assert!(said.contains(mistake), "{mistake}: {said}");
    }
}

#[test]
fn a_file_of_permutations_lists_the_configurations() {
    let list = "[[program]]\nfiles = [\"a.frag\"]\ndefines = { GRAY = 1 }\nskip = [\"PCF !SHADOWS\"]\n\
        [program.values]\nSHADOWS = [false, true]\nPCF = [false, true]\n";
    let text = "#version 150\nout vec4 color;\nvoid main()\n{\n    color = vec4(1.0);\n#if defined(PCF) && !defined(SHADOWS)\n    color *= never;\n\
        #elif defined(PCF)\n    color *= pcf;\n#endif\n#ifdef OTHER\n    color *= other;\n#endif\n#ifndef GRAY\n    color *= gray;\n#endif\n}\n";
    let folder = folder(&[("a.frag", text), ("list.toml", list)]);
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        let arguments = ["lint", "--permutations", "list.toml"].iter().chain(arguments);
        command.current_dir(folder.path()).args(arguments).output().expect("the program runs")
    };
    let output = run(&["--format", "json"]);
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).expect("it is JSON");
    let mut told: Vec<String> = rows
        .iter()
        .filter(|row| row.get("code").is_some())
        .map(|row| format!("{} {} {}", row["line"], row["code"], row["notes"]).replace('"', ""))
        .collect();
    told.sort();
    assert_eq!(told.len(), 4, "{told:#?}");
    assert!(told.iter().any(|one| one.starts_with("9 E0301 [only with `PCF=1`")), "{told:#?}");
    assert_eq!(told.iter().filter(|one| one.contains("W0115")).count(), 3, "{told:#?}");
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8_lossy(&run(&[]).stderr).into_owned();
    assert!(said.contains("3 configurations of 1 program, 3 of them different; 1 of 4 branches reached"), "{said}");
    assert_eq!(run(&["a.frag"]).status.code(), Some(2), "the file names the programs");
    fs::write(folder.path().join("list.toml"), "[[program]]\n").expect("it can be written");
    assert_eq!(run(&[]).status.code(), Some(1));
}

#[test]
fn what_an_engine_adds_or_replaces_is_left_alone() {
    let text = "#if @normalMap\nuniform sampler2D normals;\n#endif\n#ifdef NEW\nin vec3 at;\nout vec4 color;\n#endif\nvoid main()\n{\n\
        #ifdef NEW\n    color = vec4(at, 1.0);\n#else\n    gl_FragColor = vec4(1.0);\n#endif\n#ifdef FADE\n    gl_FragColor *= fade;\n#endif\n}\n";
    let folder = folder(&[("a.frag", text)]);
    let codes = |arguments: &[&str]| {
        let told = found(folder.path(), arguments)
            .into_iter()
            .map(|one| one.split(" without").next().unwrap_or("").to_owned());
        told.filter(|one| one.contains(" E") || one.contains("W0115")).collect::<Vec<_>>()
    };
    let of_search = codes(&["."]);
    assert!(of_search.iter().any(|one| one.contains(":16 E0301")), "{of_search:?}");
    assert!(!of_search.iter().any(|one| one.contains("E0120") || one.contains("W0115")), "{of_search:?}");
    assert!(codes(&["a.frag"]).iter().any(|one| one.contains("E0120")), "whoever names the file wants to know");
}

const NEEDS: &str = "#version 150
out vec4 c;
#if defined(PCF) && !defined(SHADOWS)
#error PCF needs SHADOWS
#endif
#if defined(PCF) && defined(SOFT)
vec3 abc = vec2(1.0);
#endif
void main() { c = vec4(1.0); }
";

/// Nothing is hidden by what an `#error` forbids: the macros that it asks for are defined, too.
#[test]
fn configurations_that_an_error_forbids_are_completed() {
    let folder = folder(&[("a.frag", NEEDS)]);
    let expected = ["a.frag:7 E0401 only with `PCF=1` and `SHADOWS=1` and `SOFT=1`"];
    assert_eq!(found(folder.path(), &["a.frag"]), expected);
    let output = lint(folder.path(), &["a.frag"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout);
    assert!(told.contains("all of 2 branches reached"), "{told}");
}

/// Three macros of a chain of demands, in every order.
#[test]
fn chains_of_demands_are_followed() {
    let demand = |a: &str, b: &str| format!("#if defined({a}) && !defined({b})\n#error {a} needs {b}\n#endif\n");
    let [ab, bc, cd] = [("A", "B"), ("B", "C"), ("C", "D")].map(|(a, b)| demand(a, b));
    for chain in [[&ab, &bc, &cd], [&cd, &ab, &bc], [&bc, &cd, &ab]] {
        let chain: String = chain.into_iter().map(String::as_str).collect();
        let text = format!(
            "#version 150\nout vec4 c;\n{chain}#if defined(A) && defined(X)\nvec3 v = vec2(1.0);\n#endif\nvoid main() {{ c = vec4(1.0); }}\n"
        );
        let folder = folder(&[("a.frag", &text)]);
        let told = found(folder.path(), &["a.frag"]);
        assert!(told.len() == 1 && told[0].contains("E0401"), "{told:?}");
    }
}

/// A pair that a condition of the project drops is completed, and lines that it reaches are not dead.
#[test]
fn configurations_that_the_project_forbids_are_completed() {
    let live = NEEDS.replace("#error PCF needs SHADOWS\n", "").replace("vec3 abc = vec2(1.0)", "float live = 1.0");
    let settings = ("glisten.toml", "[lint.configurations]\nskip = [\"PCF !SHADOWS\"]\n");
    let wrong = folder(&[settings, ("a.frag", NEEDS)]);
    let told = found(wrong.path(), &["a.frag"]);
    assert!(told.iter().any(|one| one.starts_with("a.frag:7 E0401")), "{told:?}");
    let right = folder(&[settings, ("a.frag", &live)]);
    let told = found(right.path(), &["a.frag"]);
    assert!(!told.iter().any(|one| one.contains("W0115")), "{told:?}");
}

/// A listed variant is no guess: its `#error` is told.
#[test]
fn listed_variants_tell_their_errors() {
    let list = "[[program]]\nfiles = [\"a.frag\"]\n[program.values]\nPCF = [false, true]\nSHADOWS = [false, true]\nSOFT = [false, true]\n";
    let folder = folder(&[("a.frag", NEEDS), ("p.toml", list)]);
    let output = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .current_dir(folder.path())
        .args(["lint", "--permutations", "p.toml"])
        .output()
        .expect("the program runs");
    let told = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && told.contains("E0118") && told.contains("E0401"), "{told}");
}

#[test]
fn standard_input_has_configurations() {
    use std::io::Write;
    let mut child = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["lint", "--configurations", "-", "--stage", "fragment"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("the program runs");
    child.stdin.take().expect("a pipe").write_all(NEEDS.as_bytes()).expect("it reads");
    let output = child.wait_with_output().expect("it ends");
    let told = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && told.contains("E0401"), "{told}");
}
