//! `glisten lint --baseline`: what an old tree may keep; and the reports of GitLab and JUnit.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

const OLD: &str = "#version 150\nuniform float t;\nout vec4 c;\nvoid main() {\n    float unused;\n    if (t * 0.1 == t + t) discard;\n    \
                   if (t * 0.1 == t + t) discard;\n    c = vec4(t);\n}\n";
const BROKEN: &str = "#version 150\nout vec4 c;\nvoid main() {\n    c = vec4(missing);\n}\n";
const RULES: [&str; 4] = ["--warn", "correctness", "--warn", "numerics"];

fn folder() -> Folder {
    Folder::new(&[("old.frag", OLD.as_bytes()), ("sub/broken.frag", BROKEN.as_bytes())])
}

fn lint(folder: &Folder, more: &[&str]) -> (i32, Vec<Value>) {
    let arguments = [&["lint", ".", "--format", "json"], &RULES[..], more].concat();
    let output = folder.run(&arguments);
    let mut found: Vec<Value> =
        serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output)));
    found.pop();
    (code(&output), found)
}

fn update(folder: &Folder, more: &[&str]) -> String {
    let output = folder.run(&[&["lint", "--baseline", "known.json", "--update-baseline"], &RULES[..], more].concat());
    assert_eq!((code(&output), out(&output).as_str()), (0, ""), "{}", err(&output));
    err(&output)
}

/// A file without text is a finding like others; one that cannot be read is none, and is told.
#[test]
fn files_without_text_are_known_and_unreadable_ones_are_told() {
    let folder = Folder::new(&[("empty.frag", b""), ("binary.frag", b"\x00\x01\x02")]);
    let (exit, all) = lint(&folder, &[]);
    assert_eq!((exit, all.len()), (1, 2), "{all:#?}");
    update(&folder, &["."]);
    assert_eq!(lint(&folder, &["--baseline", "known.json"]), (0, Vec::new()));
    let output = folder.run(&["lint", "empty.frag", "no.frag", "--baseline", "known.json", "--update-baseline"]);
    assert!(code(&output) == 2 && out(&output).contains("there is no file `no.frag`"), "{}", out(&output));
    assert!(!fs::read_to_string(folder.path("known.json")).expect("written").contains("no.frag"));
}

#[test]
fn known_findings_are_left_out_and_new_ones_are_told() {
    let folder = folder();
    let (exit, all) = lint(&folder, &[]);
    assert!(exit == 1 && all.len() >= 4, "{all:#?}");
    let told = update(&folder, &["."]);
    assert!(told.contains(&format!("wrote {} findings to known.json", all.len())), "{told}");
    assert_eq!(lint(&folder, &["--baseline", "known.json"]), (0, Vec::new()));
    // From another folder, by other names.
    let mut inner = folder.command(&["lint", "broken.frag", "--baseline", "../known.json"]);
    let inner = inner.current_dir(folder.path("sub")).output().expect("it runs");
    assert_eq!(code(&inner), 0, "{}", out(&inner));

    // Lines above come; a third equal line and an error are new.
    let more =
        OLD.replace("uniform", "// one\n\nuniform").replace("    c =", "    if (t * 0.1 == t + t) discard;\n    c =");
    fs::write(folder.path("old.frag"), more).expect("written");
    let (exit, fresh) = lint(&folder, &["--baseline", "known.json"]);
    assert_eq!((exit, fresh.len()), (0, 1), "{fresh:#?}");
    assert_eq!(fresh[0]["line"], 10, "{fresh:#?}");
    fs::write(folder.path("sub/broken.frag"), BROKEN.replace("missing", "other")).expect("written");
    let (exit, fresh) = lint(&folder, &["--baseline", "known.json"]);
    assert_eq!((exit, fresh.len()), (1, 2), "{fresh:#?}");
    let told = folder.run(&[&["lint", ".", "--baseline", "known.json"], &RULES[..]].concat());
    assert!(err(&told).contains("of the baseline left out"), "{}", err(&told));
    assert!(err(&told).contains("1 finding of the baseline gone: --update-baseline removes them"), "{}", err(&told));
}

#[test]
fn an_update_keeps_what_it_did_not_check() {
    let folder = folder();
    update(&folder, &["."]);
    fs::write(folder.path("old.frag"), OLD.replace("    float unused;\n", "")).expect("written");
    update(&folder, &["old.frag"]);
    let text = fs::read_to_string(folder.path("known.json")).expect("it is there");
    assert!(text.contains("sub/broken.frag") && !text.contains("unused"), "{text}");
    fs::remove_file(folder.path("sub/broken.frag")).expect("it was there");
    update(&folder, &["old.frag"]);
    let text = fs::read_to_string(folder.path("known.json")).expect("it is there");
    assert!(!text.contains("broken"), "{text}");
}

#[test]
fn a_baseline_that_is_none_is_refused() {
    let folder = folder();
    let output = folder.run(&["lint", ".", "--baseline", "no.json"]);
    assert_eq!(code(&output), 2);
    assert!(err(&output).contains("--update-baseline"), "{}", err(&output));
    for text in ["", "[]", "{\"version\": 1}", "{\"version\": 7, \"findings\": []}", "\u{0}"] {
        fs::write(folder.path("no.json"), text).expect("written");
        let output = folder.run(&["lint", ".", "--baseline", "no.json"]);
        assert_eq!(code(&output), 1, "{text}");
        assert!(err(&output).contains("is no baseline"), "{}", err(&output));
    }
    let output = folder.run(&["lint", ".", "--update-baseline"]);
    assert_eq!(code(&output), 2);
}

/// A fix is for what is told.
#[test]
fn known_findings_are_not_fixed() {
    let folder = folder();
    update(&folder, &["."]);
    let output =
        folder.run(&[&["lint", "old.frag", "--unsafe-fixes", "--baseline", "known.json"], &RULES[..]].concat());
    assert_eq!(code(&output), 0, "{}", out(&output));
    assert_eq!(fs::read_to_string(folder.path("old.frag")).expect("it is there"), OLD);
}

/// GitLab requires these keys, and fingerprints that differ.
#[test]
fn gitlab_gets_its_keys() {
    let folder = folder();
    let (_, all) = lint(&folder, &[]);
    let output = folder.run(&[&["lint", ".", "--format", "gitlab"], &RULES[..]].concat());
    let report: Vec<Value> = serde_json::from_str(&out(&output)).expect("JSON");
    assert_eq!(report.len(), all.len());
    let prints: BTreeSet<&str> = report.iter().filter_map(|entry| entry["fingerprint"].as_str()).collect();
    assert_eq!(prints.len(), report.len(), "{report:#?}");
    for entry in &report {
        assert!(entry["description"].is_string() && entry["check_name"].is_string(), "{entry}");
        assert!(["info", "minor", "major"].contains(&entry["severity"].as_str().unwrap_or_default()), "{entry}");
        assert!(entry["location"]["path"].is_string(), "{entry}");
        assert!(entry["location"]["positions"]["begin"]["line"].is_u64(), "{entry}");
    }
}

#[test]
fn junit_counts_its_cases() {
    let folder = folder();
    fs::write(folder.path("a&b.frag"), BROKEN.replace("missing", "a < b")).expect("written");
    let (_, all) = lint(&folder, &[]);
    let output = folder.run(&[&["lint", ".", "--format", "junit"], &RULES[..]].concat());
    let xml = out(&output);
    assert_eq!(xml.matches("<testcase ").count(), all.len(), "{xml}");
    let wrong = all.iter().filter(|finding| finding["severity"] != "note").count();
    assert_eq!(xml.matches("<failure ").count(), wrong, "{xml}");
    assert!(xml.contains(&format!("tests=\"{}\" failures=\"{wrong}\"", all.len())), "{xml}");
    assert!(xml.contains("a&amp;b.frag") && !xml.contains("a&b.frag"), "{xml}");
    fs::write(folder.path("clean.frag"), "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n")
        .expect("written");
    let xml = out(&folder.run(&["lint", "clean.frag", "--format", "junit"]));
    assert!(xml.contains("tests=\"1\" failures=\"0\"") && xml.contains("nothing found"), "{xml}");
}

/// `baseline` in `[lint]` stands for the flag, below the folder of `glisten.toml`.
#[test]
fn configurations_name_baselines() {
    let old = "#version 150\nout vec4 color;\nvoid main() { float a = 1.0; color = vec4(1.0); }\n";
    let folder = Folder::new(&[
        ("glisten.toml", b"[lint]\nbaseline = \"known/lint.json\"\n"),
        ("sub/glisten.toml", b"[lint]\nbaseline = \"own.json\"\n"),
        ("known/.gitignore", b""),
        ("old.frag", old.as_bytes()),
        ("sub/old.frag", old.as_bytes()),
        ("sub/deep/new.frag", old.replace("vec4(1.0)", "vec4(0.5)").as_bytes()),
    ]);
    let missing = folder.run(&["lint", "old.frag"]);
    assert_eq!(code(&missing), 2, "{}", err(&missing));
    assert!(err(&missing).contains("--update-baseline"), "{}", err(&missing));
    let output = folder.run(&["lint", ".", "--update-baseline"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = |name: &str| fs::read_to_string(folder.path(name)).expect(name);
    assert!(text("known/lint.json").contains("\"../old.frag\""));
    assert!(!text("known/lint.json").contains("new.frag"), "each file has the baseline of its own configuration");
    assert!(text("sub/own.json").contains("deep/new.frag"));
    assert_eq!(lint(&folder, &[]), (0, Vec::new()));
    let more = old.replace("void main()", "float f() { float b = 2.0; return 1.0; }\nvoid main()");
    fs::write(folder.path("sub/old.frag"), more).expect("written");
    let (_, fresh) = lint(&folder, &[]);
    assert!(!fresh.is_empty() && fresh.iter().all(|one| one["line"] == 3), "{fresh:?}");
    // The flag takes precedence.
    let output = folder.run(&["lint", ".", "--baseline", "all.json", "--update-baseline"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(text("all.json").contains("sub/old.frag"));
}

/// The folder of the baseline need not be above the shaders, and the current folder does not matter.
#[test]
fn names_are_from_the_folder_of_the_baseline() {
    let folder = Folder::new(&[
        ("out/deep/.gitignore", b""),
        ("old.frag", OLD.as_bytes()),
        ("sub/broken.frag", BROKEN.as_bytes()),
    ]);
    let known = ["--baseline", "out/deep/known.json"];
    let write = |at: &str, arguments: &[&str]| {
        let mut command = folder.command(&[&["lint", "--update-baseline"], arguments, &RULES[..]].concat());
        let output = command.current_dir(folder.path(at)).output().expect("it runs");
        assert_eq!(code(&output), 0, "{}", err(&output));
        fs::read_to_string(folder.path("out/deep/known.json")).expect("it is there")
    };
    let text = write(".", &[".", known[0], known[1]]);
    assert!(text.contains("\"../../old.frag\"") && text.contains("\"../../sub/broken.frag\""), "{text}");
    let path = |name: &str| folder.path(name).to_string_lossy().into_owned();
    let all = path(".");
    let json = path("out/deep/known.json");
    for (at, arguments) in [
        ("sub", ["..", "--baseline", "../out/deep/known.json"]),
        ("out", ["../", "--baseline", "deep/known.json"]),
        ("out/deep", ["../..", "--baseline", "known.json"]),
        ("sub", [all.as_str(), "--baseline", json.as_str()]),
    ] {
        let mut command = folder.command(&[&["lint"], &arguments[..], &RULES[..]].concat());
        let output = command.current_dir(folder.path(at)).output().expect("it runs");
        assert_eq!((code(&output), out(&output)), (0, String::new()), "{at}: {arguments:?}");
        assert_eq!(write(at, &arguments), text, "{at}: {arguments:?}");
    }
}

/// Files of before named what was not below their folder as the command line had it.
#[test]
fn old_baselines_are_read_and_written_anew() {
    let folder =
        Folder::new(&[("out/.gitignore", b""), ("old.frag", OLD.as_bytes()), ("out/old.frag", OLD.as_bytes())]);
    let lint =
        |more: &[&str]| folder.run(&[&["lint", "old.frag", "--baseline", "out/known.json"], &RULES[..], more].concat());
    assert_eq!(code(&lint(&["--update-baseline"])), 0);
    let read = || fs::read_to_string(folder.path("out/known.json")).expect("it is there");
    let text = read();
    assert!(text.contains("\"../old.frag\""), "{text}");
    for old in ["other.frag".to_owned(), folder.path("other.frag").to_string_lossy().into_owned()] {
        fs::copy(folder.path("old.frag"), folder.path("other.frag")).expect("copied");
        fs::write(folder.path("out/known.json"), text.replace("../old.frag", &old)).expect("written");
        let arguments = ["lint", "other.frag", "--baseline", "out/known.json"];
        let output = folder.run(&[&arguments, &RULES[..]].concat());
        assert_eq!((code(&output), out(&output)), (0, String::new()), "{old}");
        // What lies below the folder was always named from there.
        let output = folder.run(&[&["lint", "out/old.frag", "--baseline", "out/known.json"], &RULES[..]].concat());
        assert!(!out(&output).is_empty());
        assert_eq!(code(&lint(&["--update-baseline"])), 0);
        assert!(read().contains("\"../other.frag\"") && read().contains("\"../old.frag\""), "{}", read());
    }
}
