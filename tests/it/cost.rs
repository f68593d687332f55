//! `glisten cost`: operations of paths, loops, lines; and budgets of `glisten.toml`, which fail `lint`.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// The stages of a program's cost.
fn stages(files: &[(&str, &str)], arguments: &[&str]) -> Vec<Value> {
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
    let folder = Folder::new(&files);
    let names = files.iter().map(|(name, _)| *name).filter(|name| !name.ends_with(".toml"));
    let arguments: Vec<&str> =
        ["cost", "--format", "json"].into_iter().chain(names).chain(arguments.iter().copied()).collect();
    let output = folder.run(&arguments);
    let json: Value = serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output)));
    assert_eq!(code(&output), 0, "{}", err(&output));
    json["programs"][0]["stages"].as_array().expect("a list").clone()
}

/// The stage of a fragment shader with this body and these declarations.
fn fragment(declarations: &str, body: &str, arguments: &[&str]) -> Value {
    let text = format!("#version 150\n{declarations}\nout vec4 c;\nvoid main()\n{{\n{body}\n}}\n");
    stages(&[("a.frag", &text)], arguments).remove(0)
}

/// Arithmetic, special, lookups and branches of a path.
fn path(stage: &Value, name: &str) -> [u64; 4] {
    ["arithmetic", "special", "lookups", "branches"].map(|class| stage[name][class].as_u64().expect("a count"))
}

#[test]
fn operations_count_once_a_component_by_class() {
    let stage = fragment("in vec3 n; in float x;", "c = vec4(dot(n, n) + sqrt(x) / x);", &[]);
    assert_eq!(path(&stage, "longest"), [6, 2, 0, 0]);
    assert_eq!(path(&stage, "shortest"), [6, 2, 0, 0]);
    assert_eq!(stage["longest"]["weight"], 14);
    let folded = fragment("in float x;", "const float k = sqrt(2.0) * 3.0; c = vec4(x * (k / 7.0));", &[]);
    assert_eq!(path(&folded, "longest"), [1, 0, 0, 0]);
}

#[test]
fn paths_part_at_branches_and_end_where_they_are_left() {
    let body = "float y = x;\nif (x > 0.0)\n    y = sqrt(x);\nelse if (x < -1.0)\n    discard;\nc = vec4(y * 2.0);";
    let stage = fragment("in float x;", body, &[]);
    assert_eq!(path(&stage, "longest"), [2, 1, 0, 1], "a root and a product");
    assert_eq!(path(&stage, "shortest"), [2, 0, 0, 2], "the fragment that is discarded");
    let late = &stage["early_z"][0];
    assert_eq!((late["what"].as_str(), late["line"].as_u64()), (Some("discard"), Some(10)));
    let body = "float y = x;\nfor (int i = 0; i < 8; i++)\n{\n    y += sqrt(y);\n    if (y > 9.0)\n        break;\n}\nc = vec4(y);";
    let stage = fragment("in float x;", body, &[]);
    assert_eq!((path(&stage, "shortest")[1], path(&stage, "longest")[1]), (1, 8));
}

#[test]
fn the_rounds_of_loops_are_known_from_where_they_can_be() {
    let rounds = |declarations: &str, body: &str, arguments: &[&str]| {
        let stage = fragment(declarations, body, arguments);
        let one = &stage["loops"][0];
        (one["least"].as_u64(), one["most"].as_u64(), one["known"].as_str().map(str::to_owned))
    };
    let told = |least, most, known: &str| (Some(least), Some(most), Some(known.to_owned()));
    let sum = "float s = 0.0;";
    let uses = "c = vec4(s);";
    let x = "in float x; uniform int n; uniform vec4 light[6];";
    for (head, expected) in [
        ("for (int i = 0; i < 5; i++) s += x;", told(5, 5, "counted")),
        ("for (int i = 10; i > 0; i -= 3) s += x;", told(4, 4, "counted")),
        ("for (float f = 0.0; f < 1.0; f += 0.25) s += x;", told(4, 4, "counted")),
        ("for (int i = 1; i <= 64; i *= 2) s += x;", told(7, 7, "counted")),
        ("int i = 0; while (i < 3) { s += x; i++; }", told(3, 3, "counted")),
        ("int i = 0; do { s += x; i++; } while (i < 4);", told(4, 4, "counted")),
        ("int i = 9; do { s += x; i++; } while (i < 4);", told(1, 1, "counted")),
        ("for (int i = 0; i < n; i++) s += light[i].x;", told(0, 6, "array")),
        ("for (int i = 0; i < min(n, 3); i++) s += x;", told(0, 3, "range")),
        ("for (int i = 0; i < n; i++) s += x;", told(0, 8, "assumed")),
        ("while (s < x) s += 1.0;", told(0, 8, "assumed")),
    ] {
        let found = rounds(x, &format!("{sum}\n{head}\n{uses}"), &[]);
        assert_eq!(found, expected, "{head}");
    }
    let head = format!("{sum}\nfor (int i = 0; i < n; i++) s += x;\n{uses}");
    assert_eq!(rounds(x, &head, &["--range", "n=2..4"]), told(2, 4, "range"));
    assert_eq!(rounds(x, &head, &["--iterations", "3"]), told(0, 3, "assumed"));
}

#[test]
fn what_is_the_same_in_a_draw_is_counted_apart() {
    let body = "float a = sqrt(u) * 2.0;\nfloat b = x * a;\nc = vec4(b);";
    let stage = fragment("in float x; uniform float u;", body, &[]);
    assert_eq!(path(&stage, "uniform"), [1, 1, 0, 0]);
    let line = stage["lines"].as_array().expect("a list").iter().find(|line| line["line"] == 6).expect("its line");
    assert_eq!((line["uniform"]["special"].as_u64(), line["longest"]["special"].as_u64()), (Some(1), Some(1)));
    // A value that varies by the condition around its assignment.
    let body = "float a = u;\nif (x > 0.5)\n    a = 2.0;\nc = vec4(sqrt(a));";
    let stage = fragment("in float x; uniform float u;", body, &[]);
    assert_eq!(path(&stage, "uniform")[1], 0);
}

#[test]
fn a_known_uniform_decides_a_branch() {
    let body = "c = vec4(x);\nif (kind == 2)\n    c = vec4(sqrt(x));\nelse\n    c *= 2.0;";
    let stage = fragment("in float x; uniform int kind;", body, &["--range", "kind=2"]);
    assert_eq!((path(&stage, "shortest")[1], path(&stage, "longest")[1]), (1, 1));
    let stage = fragment("in float x; uniform int kind;", body, &["--range", "kind=3..9"]);
    assert_eq!(path(&stage, "longest")[1], 0);
}

#[test]
fn calls_cost_what_their_functions_do_and_many_of_them_do_no_harm() {
    // Thirty functions, each of which calls the one before it twice: a billion operations, and a short text.
    let mut declarations = "in float x;\nfloat f0(float a) { return sqrt(a); }\n".to_owned();
    for number in 1..31 {
        let before = number - 1;
        declarations += &format!("float f{number}(float a) {{ return f{before}(a) + f{before}(a + 1.0); }}\n");
    }
    let stage = fragment(&declarations, "c = vec4(f30(x));", &[]);
    assert_eq!(path(&stage, "longest")[1], 1 << 30);
}

#[test]
fn tables_name_the_stages_and_the_dearest_lines() {
    let folder = Folder::triangle();
    let output = folder.run(&["cost", "tri.vert", "tri.frag"]);
    let text = out(&output);
    assert_eq!(code(&output), 0);
    for part in ["shortest path", "longest path", "vertex: tri.vert", "fragment: tri.frag", "register"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(code(&folder.run(&["cost", "none.frag"])), 2);
    let wrong = Folder::new(&[("a.frag", b"#version 150\nvoid main() { x = 1; }\n")]);
    assert_eq!(code(&wrong.run(&["cost", "a.frag"])), 1);
}

#[test]
fn budgets_fail_lint() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/cost");
    let lint = |files: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        let output = command.current_dir(&folder).args(["lint", "--format", "json"]).args(files).output();
        let output = output.expect("the program runs");
        let rows: Vec<Value> = serde_json::from_slice(&output.stdout).expect("it is JSON");
        let over = rows.into_iter().filter(|row| row["code"] == "E0017");
        (over.collect::<Vec<Value>>(), output.status.code())
    };
    let (over, exit) = lint(&["over.vert", "over.frag"]);
    let messages: Vec<&str> = over.iter().filter_map(|row| row["message"].as_str()).collect();
    assert_eq!(exit, Some(1));
    assert!(messages.iter().any(|message| message.contains("3 texture lookups, over the budget of 2")), "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("3 registers of varyings")), "{messages:?}");
    let labels = over[0]["labels"].as_array().expect("a list");
    assert_eq!((labels[0]["line"].as_u64(), over[0]["severity"].as_str()), (Some(9), Some("error")));
    assert_eq!(lint(&["within.vert", "within.frag"]), (Vec::new(), Some(0)));
    let (over, exit) = lint(&["loop.frag"]);
    assert_eq!(exit, Some(1), "nine rounds of one lookup: {over:?}");
    assert!(over[0]["notes"][0].as_str().is_some_and(|note| note.contains("counts 9 rounds")), "{}", over[0]);
}

#[test]
fn a_budget_that_means_nothing_is_told_at_its_place() {
    let config = "[lint.budgets]\n\"*.frag\" = { weigth = 3 }\n\"*.vert\" = { lookups = -1 }\n";
    let shader = "#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    let folder = Folder::new(&[("glisten.toml", config.as_bytes()), ("a.frag", shader.as_bytes())]);
    let (findings, exit) = folder.lint(&["a.frag"]);
    let told: Vec<(&str, u64)> =
        findings.iter().filter_map(|one| Some((one["code"].as_str()?, one["line"].as_u64()?))).collect();
    assert_eq!((told.as_slice(), exit), (&[("E0015", 2), ("E0015", 3)][..], 1));
}
