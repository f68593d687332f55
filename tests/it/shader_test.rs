//! `glisten test`, end to end, on both backends.

use crate::support::root;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn fixtures() -> PathBuf {
    root().join("fixtures/shader_tests")
}

/// The results and the exit code.
fn test(path: &Path) -> (Vec<Value>, Option<i32>) {
    let run = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["test", "--format", "json"])
        .arg(path)
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&run.stdout).into_owned();
    let results = serde_json::from_str(&text)
        .unwrap_or_else(|error| panic!("{error}: {text}{}", String::from_utf8_lossy(&run.stderr)));
    (results, run.status.code())
}

#[test]
fn the_tests_of_the_fixtures_pass() {
    let (results, code) = test(&fixtures());
    assert!(results.len() >= 4);
    for result in &results {
        assert_eq!(result["result"], "pass", "{result}");
        assert_eq!(result["reason"], Value::Null);
    }
    assert_eq!(code, Some(0));
}

/// The results for the fixture with a text in it replaced.
fn changed(from: &str, to: &str) -> (Vec<Value>, Option<i32>) {
    let text = std::fs::read_to_string(fixtures().join("uniforms_and_blocks.shader_test")).expect("the fixture");
    assert!(text.contains(from));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("changed.shader_test");
    std::fs::write(&path, text.replace(from, to)).expect("written");
    test(&path)
}

#[test]
fn a_wrong_expectation_fails_and_says_where() {
    let (results, code) = changed("(0.375, 1.0, 0.5, 1.0)", "(0.375, 0.9, 0.5, 1.0)");
    assert_eq!((results.len(), code), (2, Some(1)));
    for result in results {
        assert_eq!(result["result"], "fail", "{result}");
        let reason = result["reason"].as_str().expect("a reason");
        assert!(reason.starts_with("line 31: pixel (62, 125) is (0.37"), "{reason}");
    }
}

#[test]
fn a_mistake_in_a_shader_fails_with_its_line() {
    let (results, code) = changed("result = vec4(inverted", "result = vec3(inverted");
    assert_eq!(code, Some(1));
    let reason = results[0]["reason"].as_str().expect("a reason");
    assert!(reason.starts_with("line 18:"), "{reason}");
}

/// A change of the fixture, and the reason for which it fails.
const MISTAKES: &[(&str, &str, &str)] = &[
    ("[test]", "[tests]", "`tests` is not a section; did you mean `test`?"),
    ("[fragment shader]", "[fragment shader", "`]` is missing after `[fragment shader`"),
    ("GLSL >= 1.50", "GLLS >= 1.50", "`GLLS` is not a requirement; did you mean `GLSL`?"),
    ("draw rect", "drw rect", "`drw rect` is not a command; did you mean `draw rect`?"),
    ("\nprobe", "\nprob", "is not a command; did you mean `probe"),
    (
        "\nuniform float weights 0.5",
        "\nuniform flaot weights 0.5",
        "`flaot` is not a type of a uniform; did you mean `float`?",
    ),
];

#[test]
fn a_mistyped_word_fails_and_is_no_skip() {
    for (from, to, expected) in MISTAKES {
        let (results, code) = changed(from, to);
        assert_eq!(code, Some(1), "{to}");
        for result in results {
            assert_eq!(result["result"], "fail", "{to}");
            assert!(result["reason"].as_str().is_some_and(|reason| reason.contains(expected)), "{result}");
        }
    }
}

#[test]
fn what_is_not_supported_is_skipped_with_its_reason() {
    let (results, code) = changed("GLSL >= 1.50", "GLSL >= 4.70");
    assert_eq!(code, Some(0));
    for result in results {
        assert_eq!(result["result"], "skip");
        assert!(result["reason"].as_str().expect("a reason").contains("requires"), "{result}");
    }
}
