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

#[test]
fn a_file_that_is_named_twice_is_run_once() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let text = std::fs::read(fixtures().join("uniforms_and_blocks.shader_test")).expect("the fixture");
    std::fs::write(folder.path().join("a.shader_test"), text).expect("written");
    let run = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["test", "--format", "json", "--backend", "cpu", "a.shader_test", ".", "./a.shader_test"])
        .current_dir(folder.path())
        .output()
        .expect("the program runs");
    let results: Vec<Value> = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!((results.len(), results[0]["file"].as_str()), (1, Some("a.shader_test")), "{results:?}");
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
    let tolerance = ("[test]\n", "[test]\ntolerance -1 0 0 0\n", "is no tolerance");
    for (from, to, expected) in MISTAKES.iter().copied().chain([tolerance]) {
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

/// A test of one shader with these requirements, this fragment stage and these commands.
fn written(requirements: &str, fragment: &str, commands: &str) -> (Vec<Value>, Option<i32>) {
    let text = format!(
        "[require]\n{requirements}\nSIZE 16 16\n[vertex shader passthrough]\n[fragment shader]\n{fragment}[test]\n{commands}"
    );
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("a.shader_test");
    std::fs::write(&path, text).expect("written");
    test(&path)
}

/// Asserts one result of both backends.
fn assert_both(found: &(Vec<Value>, Option<i32>), result: &str, reason: &str, what: &str) {
    assert_eq!(found.0.len(), 2, "{what}");
    for row in &found.0 {
        assert_eq!(row["result"], result, "{what}: {row}");
        assert!(row["reason"].as_str().unwrap_or_default().contains(reason), "{what}: {row}");
    }
    assert_eq!(found.1, Some(i32::from(result == "fail")), "{what}");
}

#[test]
fn a_version_of_es_is_the_first_line_of_its_shader() {
    let shader =
        "#version 300 es\nprecision mediump float;\nout vec4 c;\nvoid main() { c = vec4(0.0, 1.0, 0.0, 1.0); }\n";
    let commands = "draw rect -1 -1 2 2\nprobe all rgba 0 1 0 1\n";
    assert_both(&written("GLSL ES >= 3.00", shader, commands), "pass", "", "first");
    let second = format!("//\n{shader}");
    assert_both(
        &written("GLSL ES >= 3.00", &second, commands),
        "fail",
        "line 7: `#version` is not in the first line",
        "second",
    );
}

#[test]
fn a_name_that_no_uniform_has_fails() {
    let shader = "#version 150\nstruct S { vec3 a; float b[2]; };\nuniform S s[2];\nuniform vec2 v;\nuniform vec4 unused[3];\n\
        uniform sampler2D tex, texs[2];\nconst float K = 1.0;\nout vec4 color;\nvoid main() { color = vec4(s[1].a + K + v.xyx, s[0].b[1]) \
        + texture(tex, v) + texture(texs[0], v) + texture(texs[1], v); }\n";
    for (line, reason) in [
        ("uniform vec3 s[1].aa 1 1 1", "`s[1].aa` is not a uniform; did you mean `s[1].a`?"),
        ("uniform vec3 s[2].a 1 1 1", "`s[2].a` is not a uniform"),
        ("uniform vec2 v[0] 1 1", "`v[0]` is not a uniform"),
        ("uniform float v.x 1", "`v.x` is not a uniform"),
        ("uniform vec4 unused[3] 1 1 1 1", "`unused[3]` is not a uniform"),
        ("uniform vec4 color 1 1 1 1", "`color` is not a uniform"),
        ("uniform float K 1", "`K` is not a uniform"),
        ("uniform vec4 piglit_vertex 1 1 1 1", "`piglit_vertex` is not a uniform"),
        ("uniform int texs[2] 0", "`texs[2]` is not a uniform"),
        ("uniform float tex 0", "`tex` is a `sampler2D`, whose unit is an `int`, not a `float`"),
        ("uniform int tex", "a word is missing at the end"),
        ("uniform int tex 0 0", "`0` is too much at the end"),
        ("uniform int texs[1] 0 0", "`0` is too much at the end"),
    ] {
        assert_both(&written("GLSL >= 1.50", shader, &format!("{line}\n")), "fail", reason, line);
    }
    let right = "uniform int tex 0\nuniform int texs 0 1\nuniform int texs[1] 2\nuniform vec4 unused[2] 1 1 1 1\nuniform float s[1].b[1] 1\n";
    assert_both(&written("GLSL >= 1.50", shader, right), "pass", "", "right");
}

#[test]
fn a_shader_that_does_not_compile_is_no_link_error() {
    for (shader, result, reason) in [
        ("#version 150\nin vec3 x;\nout vec4 c;\nvoid main() { c = vec4(x, 1); }\n", "pass", ""),
        ("#version 150\nout vec4 c;\nvoid main() { c = vec4(1) \n}\n", "fail", "the test expects a link error"),
        ("#version 400\nout vec4 c;\nvoid main() { double d = 1.0; c = vec4(d); }\n", "skip", "not supported yet"),
        (
            "#version 150\nfloat f(float x) { return f(x); }\nout vec4 c;\nvoid main() { c = vec4(f(1.0)); }\n",
            "pass",
            "",
        ),
    ] {
        assert_both(&written("GLSL >= 1.50", shader, "link error\n"), result, reason, shader);
    }
}

#[test]
fn textures_have_the_parameters_that_are_set() {
    let shader =
        "#version 150\nuniform sampler2D tex;\nout vec4 c;\nvoid main() { c = texture(tex, vec2(1.1, 0.1)); }\n";
    let drawn = |commands: &str, color: &str| {
        written("GLSL >= 1.50", shader, &format!("{commands}draw rect -1 -1 2 2\nprobe all rgba {color}\n"))
    };
    assert_both(&drawn("", "0 0 0 1"), "pass", "", "a unit without a texture is opaque");
    let texture = "texture rgbw 0 (4, 4)\n";
    for (parameters, color, result, reason) in [
        ("texparameter 2D wrap_s repeat\ntexparameter 2D wrap_t repeat\n", "1 0 0 1", "pass", ""),
        ("texparameter 2D wrap_r repeat\n", "0 1 0 1", "pass", ""),
        ("texparameter 2D wrap_s repeat\n", "1 0 0 1", "skip", "a texture with a wrap mode for each direction"),
        ("texparameter 3D wrap_s repeat\n", "1 0 0 1", "skip", "the last texture is not a `3D`"),
        (
            "texparameter 2DD wrap_s repeat\n",
            "1 0 0 1",
            "fail",
            "`2DD` is not a target of textures; did you mean `2D`?",
        ),
    ] {
        assert_both(&drawn(&format!("{texture}{parameters}"), color), result, reason, parameters);
    }
}

#[test]
fn vertex_data_is_of_attributes() {
    for (header, reason) in [
        ("piglit_vertex/float/vec2 b/float/float", "line 9: `b` is not an attribute of the program"),
        ("piglit_vertex/float/vec2/1 0/float/float", "line 9: `piglit_vertex` has no column 1"),
        ("piglit_vertex[1]/float/vec2 0/float/float", "line 9: `piglit_vertex` has no element 1"),
        ("0/float/vec2 piglit_vertex/float/float", ""),
    ] {
        let shader = format!(
            "#version 150\nout vec4 c;\n[vertex data]\n{header}\n-1 -1 1\n3 -1 1\n-1 3 1\n[fragment shader]\n\
            void main() {{ }}\n"
        );
        let found = written("GLSL >= 1.50", &shader, "draw arrays GL_TRIANGLES 0 3\n");
        assert_both(&found, if reason.is_empty() { "pass" } else { "fail" }, reason, header);
    }
}
