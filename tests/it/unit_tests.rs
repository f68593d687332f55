//! Tests of functions in GLSL: `glisten test` on sources with `//! test`.

use crate::cli::{Folder, code, out};
use crate::support::root;
use serde_json::Value;
use std::process::Command;

/// The rows of `glisten test --format json` over a source, and the exit code.
fn rows(name: &str, text: &str, arguments: &[&str]) -> (Vec<Value>, i32) {
    let folder = Folder::new(&[(name, text.as_bytes())]);
    let output = folder.run(&[&["test", "--format", "json", name], arguments].concat());
    let rows = serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", out(&output)));
    (rows, code(&output))
}

/// The reason of the only test of a text on the reference.
fn reason(text: &str) -> Option<String> {
    let (rows, exit) = rows("a.glsl", text, &["--backend", "cpu"]);
    assert_eq!(rows.len(), 1, "{rows:?}");
    assert_eq!(exit, i32::from(rows[0]["result"] != "pass"));
    rows[0]["reason"].as_str().map(str::to_owned)
}

#[test]
fn the_tests_of_the_library_pass() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    let output = command.current_dir(root()).args(["test", "shader_lib/tests", "--format", "json"]).output();
    let output = output.expect("the program runs");
    let rows: Vec<Value> = serde_json::from_slice(&output.stdout).expect("it is JSON");
    assert!(rows.len() >= 60, "{}", rows.len());
    for row in &rows {
        assert_eq!(row["result"], "pass", "{row}");
        assert!(row["test"].is_string() && row["line"].is_u64() && row["cases"].as_u64() > Some(0), "{row}");
    }
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn what_is_expected_is_compared_on_both_backends() {
    let text = "//! test\n//! 1.0, 2.0 => 3.0\n//! 1.5, 2.0 => 3.75\nfloat sum(float a, float b) { return a + b; }\n";
    let (rows, exit) = rows("a.glsl", text, &[]);
    assert_eq!((rows.len(), exit), (2, 1));
    for (row, backend) in rows.iter().zip(["gpu", "cpu"]) {
        assert_eq!((row["backend"].as_str(), row["result"].as_str()), (Some(backend), Some("fail")));
        let told = "line 3: `sum(a = 1.5, b = 2.0)` is 3.5, not 3.75 (1 of 2 cases fail)";
        assert_eq!(row["reason"].as_str(), Some(told));
    }
}

#[test]
fn each_kind_of_test_fails_where_it_should() {
    for (text, told) in [
        (
            "//! test x = 0..1\nbool f(float x) { return x < 1.0; }",
            "line 1: `f(x = 1.0)` is false (1 of 256 cases fail)",
        ),
        ("//! test x = 0..1\nfloat f(float x) { return 1.0 / x; }", "`f(x = 0.0)` is inf, which is not finite"),
        (
            "//! test n = unit\nvoid f(vec3 n, out vec3 got, out vec3 expected) { got = n; expected = -n; }",
            "`got` of `f(n = (1.0, 0.0, 0.0))` is (1.0, 0.0, 0.0), not (-1.0, 0.0, 0.0)",
        ),
        ("//! test i in 1 2 3\nbool f(int i) { return i != 2; }", "`f(i = 2)` is false (1 of 3 cases fail)"),
        ("//! test\nbool f(bool b) { return b; }", "`f(b = false)` is false (1 of 2 cases fail)"),
        ("//! test y = 1\nbool f(float x) { return true; }", "line 1: the function has no parameter `y`"),
        ("//! test\nbool f(float x) { return true; }", "line 1: the parameter `x` has no values"),
        ("//! test\n//! 1.0\nbool f(float x) { return true; }", "line 2: `1.0` is no `name = values`"),
        ("//! test\n//! 1.0, 2.0 => 1.0\nfloat f(float x) { return x; }", "line 2: the arguments are 2 numbers"),
        ("//! test\n//! 1.0 => 1.0, 2.0\nfloat f(float x) { return x; }", "line 2: 2 numbers are expected of 1"),
        ("//! test\nint nothing;", "no function follows"),
        (
            "#ifdef A\n//! test x = 1\nfloat f(float x) { return 2.0; }\n#endif\nbool g(float x) { return true; }",
            "no function follows under the condition",
        ),
        ("float g() { return y; }\n//! test\nbool f() { return true; }", "line 1: `y` is not declared (E0301)"),
        ("//! test\nbool f(sampler2D s) { return true; }", "which no number fills"),
        ("//! test x = 1\nvoid f(float x, out float y) { y = x; }", "is not passed in alone"),
    ] {
        let reason = reason(text).unwrap_or_else(|| panic!("{text} passes"));
        assert!(reason.contains(told), "{text}: {reason}");
    }
}

#[test]
fn the_envelope_is_the_tolerance_and_a_wrong_formula_is_outside_of_it() {
    let right = "//! test x = 0.1..10\nvoid f(float x, out float got, out float expected)\n{ got = exp(log(x)); expected = x; }";
    assert_eq!(reason(right), None);
    let wrong = right.replace("expected = x", "expected = x * 1.001");
    assert!(reason(&wrong).is_some());
    let tolerated = wrong.replace("0.1..10", "0.1..10\n//! tolerance 0.02");
    assert_eq!(reason(&tolerated), None);
}

#[test]
fn functions_of_whole_shaders_are_tested_in_their_versions() {
    let tested = "//! test\n//! 3.0 => 1.5\nfloat halves(float x) { return x / 2.0; }\n";
    for (name, head, main) in [
        (
            "a.vert",
            "#version 330 core\nlayout(location = 0) in vec4 p;\nuniform mat4 m;\nflat out ivec2 q;\n",
            "void main() { q = ivec2(1); gl_Position = m * p; }",
        ),
        (
            "a.frag",
            "#version 120\nvarying vec3 n;\nuniform sampler2D t;\n",
            "void main() { gl_FragColor = texture2D(t, n.xy); }",
        ),
        ("b.vert", "#version 110\nattribute vec4 p;\nvarying vec3 n;\n", "void main() { n = p.xyz; gl_Position = p; }"),
        (
            "b.frag",
            "#version 300 es\nprecision mediump float;\nin vec3 n;\nout vec4 c;\n",
            "void main() { c = vec4(n, 1.0); }",
        ),
        ("c.glsl", "", ""),
    ] {
        let text = format!("{head}{tested}{main}\n");
        let (rows, exit) = rows(name, &text, &["--backend", "cpu"]);
        assert_eq!((rows.len(), exit), (1, 0), "{name}: {rows:?}");
        assert_eq!(rows[0]["line"].as_u64(), Some(head.lines().count() as u64 + 1));
    }
}

#[test]
fn folders_are_searched_and_includes_and_macros_are_those_of_the_command_line() {
    let folder = Folder::new(&[
        ("lib/double.glsl", b"float twice(float x) { return FACTOR * x; }\n"),
        (
            "tests/a.glsl",
            b"#include \"double.glsl\"\n//! test\n//! 2.0 => 4.0\nfloat f(float x) { return twice(x); }\n",
        ),
        ("tests/none.glsl", b"float g(float x) { return x; }\n"),
    ]);
    let output = folder.run(&["test", "tests", "-I", "lib", "-D", "FACTOR=2.0", "--backend", "cpu"]);
    assert_eq!((out(&output).as_str(), code(&output)), ("1 passed, 0 failed, 0 skipped\n", 0));
    assert_eq!(code(&folder.run(&["test", "tests", "-I", "lib", "-D", "FACTOR=3.0", "--backend", "cpu"])), 1);
    assert_eq!(code(&folder.run(&["test", "lib"])), 2, "there is no test");
}
