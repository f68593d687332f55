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
fn matrices_cost_their_cofactors_and_a_division_and_transposing_nothing() {
    let weight = |declaration: &str, value: &str| {
        let stage = fragment(declaration, &format!("c = vec4({value});"), &[]);
        let [arithmetic, special, ..] = path(&stage, "longest");
        [arithmetic, special]
    };
    assert_eq!(weight("in vec4 q; uniform mat4 m;", "m * q"), [28, 0]);
    assert_eq!(weight("in vec4 q; uniform mat4 m;", "inverse(m) * q"), [28 + 139, 1]);
    assert_eq!(weight("in vec3 q; uniform mat3 m;", "(inverse(m) * q).x"), [15 + 62, 1]);
    assert_eq!(weight("in vec2 q; uniform mat2 m;", "(inverse(m) * q).x"), [6 + 7, 1]);
    assert_eq!(weight("in float q; uniform mat4 m;", "q * determinant(m)"), [1 + 51, 0]);
    assert_eq!(weight("in float q; uniform mat2 m;", "q * determinant(m)"), [1 + 3, 0]);
    assert_eq!(weight("in vec4 q; uniform mat4 m;", "transpose(m) * q"), [28, 0]);
    assert_eq!(weight("in vec3 q; in vec3 n;", "refract(q, n, 1.5).x"), [21, 1]);
    assert_eq!(weight("in vec3 q; in vec3 n;", "faceforward(q, n, n).x"), [9, 0]);
}

/// The fewest and the most rounds of the first loop, and from where they are known.
fn rounds(declarations: &str, body: &str, arguments: &[&str]) -> (u64, u64, String) {
    let stage = fragment(declarations, body, arguments);
    let one = &stage["loops"][0];
    let count = |name: &str| one[name].as_u64().expect("a count");
    (count("least"), count("most"), one["known"].as_str().expect("a word").to_owned())
}

/// Loops over `s`, with a varying `x`, a uniform `n` and an array of six.
const LOOPS: &str = "in float x; uniform int n; uniform uint u; uniform vec4 light[6];";

fn check(cases: &[(&str, (u64, u64, &str))], arguments: &[&str]) {
    for (head, (least, most, known)) in cases {
        let found = rounds(LOOPS, &format!("float s = 0.0;\n{head}\nc = vec4(s);"), arguments);
        assert_eq!(found, (*least, *most, (*known).to_owned()), "{head}");
    }
}

#[test]
fn the_rounds_of_loops_are_known_from_where_they_can_be() {
    check(
        &[
            ("for (int i = 0; i < 5; i++) s += x;", (5, 5, "counted")),
            ("for (int i = 10; i > 0; i -= 3) s += x;", (4, 4, "counted")),
            ("for (float f = 0.0; f < 1.0; f += 0.25) s += x;", (4, 4, "counted")),
            ("for (int i = 1; i <= 64; i *= 2) s += x;", (7, 7, "counted")),
            ("for (int i = 98; i > 0; i /= 49) s += x;", (2, 2, "counted")),
            ("for (int i = 64; i != 0; i >>= 1) s += x;", (7, 7, "counted")),
            ("int m = 5; for (int i = 0; i < m; i++) s += x;", (5, 5, "counted")),
            ("int m = 5; for (int i = 0; m > i; i++) s += x;", (5, 5, "counted")),
            ("int i = 0; while (i < 3) { s += x; i++; }", (3, 3, "counted")),
            ("int i = 3; while (i-- > 0) s += x;", (3, 3, "counted")),
            ("int i = 3; while (--i > 0) s += x;", (2, 2, "counted")),
            ("int i = 0; do { s += x; i++; } while (i < 4);", (4, 4, "counted")),
            ("int i = 9; do { s += x; i++; } while (i < 4);", (1, 1, "counted")),
            ("int i = 3; do s += x; while (i-- > 0);", (4, 4, "counted")),
            ("int i = 3; do s += x; while (--i > 0);", (3, 3, "counted")),
            ("for (int i = 0; i < n; i++) s += light[i].x;", (0, 6, "array")),
            ("for (int i = n - 1; i >= 0; i--) s += light[i].x;", (0, 6, "array")),
            ("for (int i = 0; i < min(n, 3); i++) s += x;", (0, 3, "range")),
            ("for (int i = 0; i < n; i++) s += x;", (0, 8, "assumed")),
            ("for (int i = n; i > 0; i--) s += x;", (0, 8, "assumed")),
            ("while (s < x) s += 1.0;", (0, 8, "assumed")),
        ],
        &[],
    );
    let head = "float s = 0.0;\nfor (int i = 0; i < n; i++) s += x;\nc = vec4(s);";
    assert_eq!(rounds(LOOPS, head, &["--iterations", "3"]), (0, 3, "assumed".to_owned()));
}

#[test]
fn a_stated_range_limits_where_a_loop_starts_and_where_it_ends() {
    check(
        &[
            ("for (int i = 0; i < n; i++) s += x;", (2, 12, "range")),
            ("for (int i = n; i > 0; i--) s += x;", (2, 12, "range")),
            ("for (int i = n - 1; i >= 0; i--) s += x;", (2, 12, "range")),
            ("for (int i = n; i-- > 0;) s += x;", (2, 12, "range")),
            ("int i = n; while (i > 0) { s += x; i--; }", (2, 12, "range")),
            ("int i = n; while (i-- > 0) s += x;", (2, 12, "range")),
            ("int i; i = n; do { s += x; i--; } while (i > 0);", (2, 12, "range")),
            ("for (int i = n; i < 20; i++) s += x;", (8, 18, "range")),
            ("for (int i = n; i != 0; --i) s += x;", (2, 12, "range")),
            ("for (int i = n * 2; i > n; i -= 2) s += x;", (0, 11, "range")),
            ("for (int i = n; i > 0; i /= 2) s += x;", (2, 4, "range")),
            ("for (int i = n; i > 0; i >>= 1) s += x;", (2, 4, "range")),
            ("for (int i = 0; i < n / 2; i++) s += x;", (1, 6, "range")),
            ("for (int i = n - 1; i >= 0; i--) s += light[i].x;", (2, 6, "range")),
            ("for (float f = float(n); f > 0.0; f -= 1.0) s += x;", (2, 12, "range")),
            ("int m = n; for (int i = m; i > 0; i--) s += x;", (2, 12, "range")),
            // Steps of two pass a limit of the other parity, and the counter goes all the way around.
            ("for (int i = 0; i != n; i += 2) s += x;", (0, 8, "assumed")),
        ],
        &["--range", "n=2..12"],
    );
    check(&[("for (int i = n; i > 0; i--) s += x;", (0, 4, "range"))], &["--range", "n=-3..4"]);
}

#[test]
fn the_first_of_two_conditions_that_fails_ends_a_loop() {
    check(
        &[
            ("for (int i = 0; i < 16 && i < n; i++) s += x;", (0, 12, "range")),
            ("for (int i = 0; i < n && i < 16; i++) s += x;", (0, 12, "range")),
            ("for (int i = 0; i < 5 && i < n; i++) s += x;", (0, 5, "range")),
            ("for (int i = 0; i < 16 && i < 7; i++) s += x;", (7, 7, "counted")),
            ("for (int i = 0; i < 16 && s < x; i++) s += x;", (0, 16, "counted")),
            ("for (int i = 0; s < x && i < n; i++) s += x;", (0, 12, "range")),
            ("for (int i = 0; i < 16 && n < 20; i++) s += x;", (16, 16, "range")),
        ],
        &["--range", "n=0..12"],
    );
}

/// The counter of a loop has bounds in its body, where another one may start or end.
#[test]
fn a_loop_in_another_knows_its_counter() {
    let inner = |head: &str| {
        let stage = fragment(LOOPS, &format!("float s = 0.0;\n{head}\nc = vec4(s);"), &[]);
        let loops = stage["loops"].as_array().expect("a list").clone();
        let found = loops.iter().map(|one| (one["least"].as_u64(), one["most"].as_u64(), one["known"].as_str()));
        found.map(|(least, most, known)| format!("{least:?} {most:?} {known:?}")).collect::<Vec<_>>().join(", ")
    };
    for (head, rounds) in [
        ("for (int i = 0; i < 3; i++)\nfor (int j = i; j < 3; j++) s += x;", "Some(1) Some(3) Some(\"range\")"),
        ("for (int i = 0; i < 4; i++)\nfor (int j = 0; j < i; j++) s += x;", "Some(0) Some(3) Some(\"range\")"),
        ("for (int i = 8; i > 0; i -= 2)\nfor (int j = 0; j < i; j++) s += x;", "Some(2) Some(8) Some(\"range\")"),
        // What the body changes has no bounds.
        ("for (int i = 0; i < 4;) { for (int j = 0; j < i; j++) s += x; i++; }", "Some(0) Some(8) Some(\"assumed\")"),
    ] {
        assert!(inner(head).contains(rounds), "{head}: {}", inner(head));
    }
}

#[test]
fn a_counter_without_a_sign_wraps() {
    check(
        &[
            ("for (uint i = 5u; i >= 0u; i--) { s += x; if (x > 0.1) break; }", (0, 8, "assumed")),
            ("for (uint i = 5u; i < 10u; i--) s += x;", (6, 6, "counted")),
            ("for (uint i = 5u; i > 0u; i--) s += x;", (5, 5, "counted")),
            ("for (uint i = u; i > 0u; i--) s += x;", (0, 7, "range")),
            ("for (uint i = 0u; i < u; i++) s += x;", (0, 7, "range")),
            // 0 - 1 is the largest number.
            ("for (uint i = u - 1u; i > 0u; i--) s += x;", (0, 8, "assumed")),
            ("for (uint i = 0u; i < u - 1u; i++) s += x;", (0, 8, "assumed")),
        ],
        &["--range", "u=0..7"],
    );
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
fn a_known_uniform_decides_a_switch_and_a_selection() {
    let longest = |declarations: &str, body: &str, range: &str| {
        let stage = fragment(&format!("in vec4 q; {declarations}"), body, &["--range", range]);
        ["shortest", "longest"].map(|name| stage[name]["weight"].as_u64().expect("a weight"))
    };
    let switch =
        "c = vec4(0.0); switch (kind) { case 0: c = q; break; case 1: c = q + q; break; case 2: c = sqrt(q); break; }";
    for (range, expected) in [
        ("kind=0", [1, 1]),
        ("kind=1", [5, 5]),
        ("kind=2", [17, 17]),
        ("kind=1..2", [5, 17]),
        ("kind=0..1", [1, 5]),
        ("kind=3..9", [1, 1]),
        ("kind=-5..1", [1, 5]),
    ] {
        assert_eq!(longest("uniform int kind;", switch, range), expected, "{range}");
    }
    // A case goes on into the next, and the default is where no label fits.
    let falls = "switch (kind) { case 0: c = sqrt(q); break; default: c = q + q + q; break; case 4: c = q * q; case 5: c = q + q; }";
    for (range, expected) in
        [("kind=4", [9, 9]), ("kind=5", [5, 5]), ("kind=4..5", [5, 9]), ("kind=4..6", [5, 9]), ("kind=7", [9, 9])]
    {
        assert_eq!(longest("uniform int kind;", falls, range), expected, "{range}");
    }
    let select = "c = kind == 1u ? q + q : sqrt(q);";
    let [one, other] = ["kind=1", "kind=2..3"].map(|range| longest("uniform uint kind;", select, range));
    assert_eq!((one[0], one[1]), (one[0], one[0]));
    assert_eq!((other[0], other[1]), (one[0] + 12, one[0] + 12));
    assert_eq!(longest("uniform uint kind;", select, "kind=0..3"), [one[0], other[0]]);
    let both = "c = q * float(kind > 1 && q.x * q.y + q.z > 0.5);";
    let [skipped, taken] = ["kind=0", "kind=2"].map(|range| longest("uniform int kind;", both, range));
    assert_eq!((skipped[1], taken[1]), (skipped[0], skipped[0] + 3));
    let bound = "float s = 0.0; int most = kind == 1 ? 3 : 9; for (int i = 0; i < most; i++) s += q.x; c = vec4(s);";
    assert_eq!(rounds("in vec4 q; uniform int kind;", bound, &["--range", "kind=1"]).1, 3);
    assert_eq!(rounds("in vec4 q; uniform int kind;", bound, &["--range", "kind=0..1"]).1, 9);
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
fn budgets_count_loops_and_choices_by_stated_ranges() {
    let config = "[lint.ranges]\nlights = [0, 64]\nkind = 1\n[lint.budgets]\n\"*.frag\" = { weight = 100 }\n";
    let over = |body: &str| {
        let shader = format!(
            "#version 150\nuniform int lights;\nuniform int kind;\nuniform mat4 m;\nin vec4 q;\nout vec4 c;\nvoid main() {{ c = q; {body} }}\n"
        );
        let folder = Folder::new(&[("glisten.toml", config.as_bytes()), ("a.frag", shader.as_bytes())]);
        let (findings, _) = folder.lint(&["a.frag"]);
        findings.iter().any(|one| one["code"] == "E0017")
    };
    assert!(over("for (int i = 0; i < lights; i++) c += q;"));
    assert!(over("for (int i = lights; i > 0; i--) c += q;"));
    assert!(over("int i = lights; while (i-- > 0) c += q;"));
    assert!(!over("for (int i = 0; i < 8 && i < lights; i++) c += q;"));
    assert!(over("c = inverse(m) * q;"));
    let dear = "c = sqrt(sqrt(sqrt(sqrt(sqrt(sqrt(sqrt(q)))))));";
    assert!(over(&format!("switch (kind) {{ case 1: {dear} break; }}")));
    assert!(!over(&format!("switch (kind) {{ case 2: {dear} break; }}")));
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
