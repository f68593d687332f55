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
            "#ifndef A\n//! test x = 1\n#endif\nbool g(float x) { return true; }",
            "no function follows under the condition",
        ),
        ("//! test\n//! vec2(1) => 1.0\nfloat f(float x) { return x; }", "line 2: the arguments are 2 numbers"),
        (
            "//! test\n//! 1.0 => float(1)\nint f(float x) { return int(x); }",
            "line 2: `float(1)` is a `float`, not a `int`",
        ),
        ("//! test\n//! 1.5 => 2\nint f(int x) { return x + 1; }", "line 2: `1.5` is not of type `int`"),
        ("//! test\n//! -1 => 4294967295u\nuint f(uint x) { return x; }", "line 2: `-1` does not fit in a `uint`"),
        ("//! test\n//! 0 => 1.0\nfloat f(bool x) { return 1.0; }", "`0` is not a `bool`: write `true` or `false`"),
        (
            "//! test x = 0..1, k in 1 2\nbool f(float x, int k) { return !(x == 1.0 && k == 1); }",
            "line 1: `f(x = 1.0, k = 1)` is false (1 of 256 cases fail)",
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
fn integers_have_all_of_their_bits_on_both_backends() {
    let wrong = "//! test\n//! 8388608 => 8388609\n//! 2147483647 => 2147483646\nint f(int x) { return x; }\n\
        //! test\n//! 4294967295u => 4294967294u\nuint g(uint x) { return x; }\n";
    let (wrongs, exit) = rows("a.glsl", wrong, &[]);
    assert_eq!((wrongs.len(), exit), (4, 1));
    for row in &wrongs {
        assert_eq!(row["result"], "fail", "{row}");
    }
    assert_eq!(wrongs[0]["reason"], "line 2: `f(x = 8388608)` is 8388608, not 8388609 (2 of 2 cases fail)");
    let right = "//! test\n//! -2147483648, 4294967295u => ivec2(-2147483648, -1)\nivec2 f(int x, uint y) { return ivec2(x, int(y)); }\n\
        //! test x in 16777217 2147483647 -16777217\nbool g(int x) { return x == 16777217 || x == 2147483647 || x == -16777217; }\n\
        //! test x in 0xffffffffu 65536u\nvoid h(uint x, out uvec3 got, out uvec3 expected) { got = uvec3(x); expected = uvec3(x, x, x); }\n";
    let (rights, exit) = rows("a.glsl", right, &[]);
    assert_eq!((rights.len(), exit), (6, 0), "{rights:?}");
}

#[test]
fn what_is_left_out_is_skipped_and_what_is_commented_out_is_none() {
    let text = "/*\n//! test\nbool f() { return false; }\n*/\n#ifdef A\n//! test\nbool g() { return false; }\n#else\n//! test\nbool h() { return true; }\n#endif\n";
    let (found, exit) = rows("a.glsl", text, &["--backend", "cpu"]);
    let results: Vec<_> = found.iter().map(|row| (row["line"].as_u64(), row["result"].as_str())).collect();
    assert_eq!((results, exit), (vec![(Some(6), Some("skip")), (Some(9), Some("pass"))], 0));
    assert_eq!(found[0]["reason"], "line 6: the condition (`#if`) that the comment is under does not hold");
    let (found, exit) = rows("a.glsl", text, &["--backend", "cpu", "-D", "A"]);
    assert_eq!((found[0]["result"].as_str(), found[1]["result"].as_str(), exit), (Some("fail"), Some("skip"), 1));
}

#[test]
fn standard_input_and_diagnostics_are_those_of_every_command() {
    let folder = Folder::new(&[]);
    let cpu = ["--backend", "cpu"];
    let tested =
        |arguments: &[&str], text: &str| folder.run_with_input(&[&["test", "-"], &cpu[..], arguments].concat(), text);
    // A stray semicolon.
    let warned = "//! test\nbool f() { return true; }\n;\n";
    let output = tested(&[], warned);
    assert_eq!((out(&output).as_str(), code(&output)), ("1 passed, 0 failed, 0 skipped\n", 0));
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains("warning[") && told.contains(":3:"), "{told}");
    assert_eq!(code(&tested(&["--deny", "warnings"], warned)), 1);
    let output = tested(&["--diagnostics", "json"], warned);
    let found: Vec<Value> = serde_json::from_slice(&output.stderr).expect("it is JSON");
    assert_eq!((found[0]["line"].as_u64(), found[0]["severity"].as_str()), (Some(3), Some("warning")));
    let shader = "[require]\nGLSL >= 1.50\n[vertex shader passthrough]\n[fragment shader]\nout vec4 c;\nvoid main() { c = vec4(0.0); }\n[test]\nclear\n";
    assert_eq!(out(&tested(&[], shader)), "1 passed, 0 failed, 0 skipped\n");
    assert_eq!(code(&tested(&[], "float f();\n")), 2, "there is no test");
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
