//! The contracts that may change rounding: fast math, and moves to the vertex stage.

use glisten_front::hir::{ScalarValue, Stage};
use glisten_front::{Compiler, Options, Source};
use glisten_specialize::{Known, Math, Options as How, Residual, specialize_with};

const VERTEX: &str = "#version 150\nin vec4 p;\nin vec4 q;\nout vec4 v;\nvoid main() { v = q; gl_Position = p; }\n";

fn compiled(vertex: &str, fragment: &str) -> glisten_front::Compilation {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", vertex, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    Compiler::new(Options::default()).compile(&sources)
}

fn residual(vertex: &str, fragment: &str, known: &[(&str, &[f32])], math: Math, move_to_vertex: bool) -> Residual {
    let compiled = compiled(vertex, fragment);
    let messages: Vec<_> = compiled.diagnostics.iter().map(|found| found.message.clone()).collect();
    let program = compiled.program.unwrap_or_else(|| panic!("{messages:?}\n{fragment}"));
    let mut values = Known::default();
    for (name, numbers) in known {
        values.uniforms.insert((*name).into(), numbers.iter().map(|value| ScalarValue::Float(*value)).collect());
    }
    let how = How { sources: Some(&compiled.sources), math, move_to_vertex, ..How::default() };
    let residual = specialize_with(&program, &values, &how);
    assert!(residual.fault.is_none(), "{:?}", residual.fault);
    residual
}

/// What is assigned to `color` under fast math, where `u` and `w` are known and `d` is not.
fn fast(expression: &str, u: f32, w: f32) -> String {
    let fragment = format!(
        "#version 150\nin vec4 v;\nuniform float u;\nuniform float w;\nuniform float d;\nuniform mat4 m;\nout vec4 color;\n\
         void main() {{ color = vec4({expression}); }}\n"
    );
    let residual = residual(VERTEX, &fragment, &[("u", &[u]), ("w", &[w])], Math::Fast, false);
    let text = residual.text(Stage::Fragment).expect("a stage").to_owned();
    let line = text.lines().find(|line| line.trim_start().starts_with("color = ")).unwrap_or_default();
    line.trim().trim_start_matches("color = ").trim_end_matches(';').to_owned()
}

#[test]
fn fast_math_drops_assignments_that_change_nothing() {
    let text = |statements: &str| {
        let fragment = format!(
            "#version 150\nin vec4 v;\nuniform float u;\nuniform float w;\nout vec4 color;\n\
             void main() {{ vec3 c = v.xyz; {statements} color = vec4(c, 1.0); }}\n"
        );
        let residual = residual(VERTEX, &fragment, &[("u", &[0.0]), ("w", &[1.0])], Math::Fast, false);
        residual.text(Stage::Fragment).expect("a stage").to_owned()
    };
    assert_eq!(text("c += u; c *= w; c -= vec3(u); c /= w;"), text(""));
}

#[test]
fn fast_math_uses_algebra() {
    let cases: &[(&str, f32, f32, &str)] = &[
        ("v.x * u", 0.0, 0.0, "vec4(0.0)"),
        ("v.x + u", 0.0, 0.0, "vec4(v.x)"),
        ("u / v.x", 0.0, 0.0, "vec4(0.0)"),
        ("mix(v.x, v.y, u)", 1.0, 0.0, "vec4(v.y)"),
        ("mix(v.x, v.y, u)", 0.0, 0.0, "vec4(v.x)"),
        ("dot(v.xy, vec2(u, w))", 0.0, 0.0, "vec4(0.0)"),
        ("v.x / u", 4.0, 0.0, "vec4(v.x * 0.25)"),
        ("(v.x * u) * w", 0.5, 0.5, "vec4(v.x * 0.25)"),
        ("u * (w * v.x)", 0.5, 0.5, "vec4(v.x * 0.25)"),
        ("(v.x + u) + w", 3.0, -2.0, "vec4(v.x + 1.0)"),
        ("u - (v.x - w)", 3.0, 2.0, "vec4(5.0 - v.x)"),
        ("(v.x + u) - w", 1.0, 3.0, "vec4(v.x - 2.0)"),
        ("v.x * u", -1.0, 0.0, "vec4(-v.x)"),
        ("v.x + sqrt(u)", 4.0, 0.0, "vec4(v.x + 2.0)"),
        ("v.x * pow(u, w)", 3.0, 2.0, "vec4(v.x * 9.0)"),
        ("v.x + u / w", 1.0, 4.0, "vec4(v.x + 0.25)"),
        ("pow(v.x, u)", 1.0, 0.0, "vec4(v.x)"),
        ("pow(v.x, u)", 0.0, 0.0, "vec4(1.0)"),
        ("pow(v.x, u)", 0.5, 0.0, "vec4(sqrt(v.x))"),
        ("1.0 / sqrt(v.x)", 0.5, 0.0, "vec4(inversesqrt(v.x))"),
        ("normalize(normalize(v.xyz)), u", 1.0, 0.0, "vec4(normalize(v.xyz), 1.0)"),
        ("max(clamp(v.x, 0.0, 1.0), u)", 0.0, 0.0, "vec4(clamp(v.x, 0.0, 1.0))"),
        ("(m * m) * v", 0.0, 0.0, "vec4(m * (m * v))"),
        ("mat4(u) * v", 1.0, 0.0, "vec4(v)"),
        ("mat4(u) * (m * v)", 1.0, 0.0, "vec4(m * v)"),
        ("v * mat4(u)", 2.0, 0.0, "vec4(v * 2.0)"),
        ("mat2(u, 0.0, 0.0, w) * v.xy, 0.0, 0.0", 2.0, 3.0, "vec4(v.xy * vec2(2.0, 3.0), 0.0, 0.0)"),
    ];
    let mut wrong = Vec::new();
    for (expression, u, w, wanted) in cases {
        let found = fast(expression, *u, *w);
        if found != *wanted {
            wrong.push(format!("`{expression}` by {u}, {w} is `{found}`, not `{wanted}`"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_whole_power_becomes_products() {
    let power = |n: f32| {
        let fragment = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\nvoid main() {\n    float x = max(v.x, v.y);\n    \
             color = vec4(pow(x * v.z, u));\n}\n";
        residual(VERTEX, fragment, &[("u", &[n])], Math::Fast, false).text(Stage::Fragment).expect("a stage").to_owned()
    };
    let five = power(5.0);
    assert!(five.contains("float pow5(float x)") && five.contains("x * x") && !five.contains("pow("), "{five}");
    // Too long as products, and no whole number.
    for n in [511.0, 2.5, 1e10] {
        assert!(power(n).contains("pow("), "{n}");
    }
    let inverse = power(-2.0);
    assert!(inverse.contains("1.0 / ") && !inverse.contains("pow("), "{inverse}");
}

#[test]
fn without_fast_math_nothing_of_it_happens() {
    let fragment = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n\
        void main() { color = vec4((v.x / u) + pow(v.y, u)) * 3.0; }\n";
    let text = residual(VERTEX, fragment, &[("u", &[3.0])], Math::Exact, false);
    let text = text.text(Stage::Fragment).expect("a stage");
    assert!(text.contains("/ 3.0") && text.contains("pow("), "{text}");
}

/// The residual's fragment stage under finite math, of a program that computes `color` so.
fn finite(expression: &str, u: f32) -> String {
    let fragment = format!(
        "#version 150\nin vec4 v;\nuniform float u;\nuniform float d;\nuniform sampler2D t;\nout vec4 color;\n\
         float half_of(float x) {{ return x / d; }}\nvoid main() {{ color = vec4({expression}); }}\n"
    );
    let text = |math| {
        residual(VERTEX, &fragment, &[("u", &[u])], math, false).text(Stage::Fragment).expect("a stage").to_owned()
    };
    assert_ne!(text(Math::Exact), text(Math::Finite), "{expression}");
    text(Math::Finite)
}

#[test]
fn finite_math_takes_numbers_from_outside_to_be_finite() {
    // Of each, what is left of the part that `u` decides; a sum with 1 hides the sign of a zero.
    let zeros = [
        "1.0 + v.x * u",
        "1.0 + d * u",
        "1.0 + texture(t, v.xy).x * u",
        "1.0 + half_of(v.x) * u",
        "1.0 + u * pow(v.x, d)",
        "1.0 + dot(v, vec4(u))",
        "mix(v.x + 1.0, 1.0, 1.0 - u)",
        "1.0 + u * (v.x / v.y)",
    ];
    for expression in zeros {
        let text = finite(expression, 0.0);
        assert!(text.contains("color = vec4(1.0);") && !text.contains("uniform"), "{expression}\n{text}");
    }
    assert!(finite("isnan(v.x) || isinf(half_of(v.x)) ? 2.0 : 1.0", 0.0).contains("color = vec4(1.0);"));
}

#[test]
fn finite_math_rounds_as_before_and_keeps_signs_of_zeros() {
    let exact = |expression: &str, u: f32| {
        let fragment = format!(
            "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\nvoid main() {{ color = vec4({expression}); }}\n"
        );
        let text = |math| {
            residual(VERTEX, &fragment, &[("u", &[u])], math, false).text(Stage::Fragment).expect("a stage").to_owned()
        };
        assert_eq!(text(Math::Exact), text(Math::Finite), "{expression}");
    };
    // A color of floats shows the sign of a zero.
    for (expression, u) in
        [("v.x / u", 3.0), ("(v.x * u) * 0.5", 0.25), ("(v.x + u) + 1.0", 2.0), ("pow(v.x, u)", 2.0), ("v.x + u", 0.0)]
    {
        exact(expression, u);
    }
}

#[test]
fn fast_math_keeps_effects_discards_and_derivatives() {
    let fragment = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\nfloat count = 0.0;\n\
        float more() { count += v.x; return v.y; }\n\
        void main() { float a = more() * u; if (v.z > 0.5) discard; color = vec4(a, count, dFdx(v.x), 1.0); }\n";
    let text = residual(VERTEX, fragment, &[("u", &[0.0])], Math::Fast, false);
    let text = text.text(Stage::Fragment).expect("a stage");
    assert!(text.contains("count") && text.contains("more()") && text.contains("discard"), "{text}");
    assert!(text.contains("dFdx(v.x)"), "{text}");
}

const LIT: &str = "#version 150\nin vec4 p;\nin vec3 n;\nuniform mat4 mvp;\nout vec3 at;\nout vec3 normal;\n\
    flat out vec3 tint;\nnoperspective out vec2 screen;\ncentroid out vec3 middle;\n\
    void main() { at = p.xyz; normal = n; tint = n; screen = p.xy; middle = n; gl_Position = mvp * p; }\n";

fn moved(body: &str) -> Residual {
    let fragment = format!(
        "#version 150\nin vec3 at;\nin vec3 normal;\nflat in vec3 tint;\nnoperspective in vec2 screen;\n\
         centroid in vec3 middle;\nuniform vec3 light;\nuniform mat3 turn;\nuniform sampler2D tex;\nout vec4 color;\n\
         float half_of(float x) {{ return x * 0.5; }}\n\
         float tilted(vec3 x) {{ if (x.x > 2.0) return 1.0; return length(turn * x); }}\nvoid main() {{\n{body}\n}}\n"
    );
    residual(LIT, &fragment, &[], Math::Exact, true)
}

#[test]
fn what_is_affine_moves_to_the_vertex_stage() {
    // What the fragment stage does, the varyings that carry it, and what is gone from there.
    let cases: &[(&str, &[&str], &str)] = &[
        ("vec3 l = light - at; color = vec4(normalize(l), 1.0);", &["l"], "light"),
        ("color = vec4(normalize(turn * normal), 1.0);", &["normal_affine"], "turn *"),
        ("color = vec4(max(dot(light, at) + 2.0, 0.0));", &["at_affine"], "light"),
        ("vec3 l = light - at; color = vec4(sqrt(dot(l, light)));", &["at_affine"], "light"),
        ("color = vec4(normalize(mix(light, at, 0.25)), 1.0);", &["at_affine"], "light"),
        ("color = vec4(fract(dot(tint, light)));", &["tint_affine"], "light"),
        // A parameter of a function that is called from one place stands for its argument.
        ("color = vec4(tilted(at), at.y * at.y, 0.0, 1.0);", &["at_affine"], "turn *"),
        ("if (at.x > 0.0) discard; color = vec4(turn * at, 1.0) * half_of(at.y);", &["at_affine"], "turn *"),
    ];
    for (body, names, gone) in cases {
        let residual = moved(body);
        let (vertex, fragment) = (residual.text(Stage::Vertex), residual.text(Stage::Fragment));
        let texts = format!("{body}\n{}\n{}", vertex.unwrap_or(""), fragment.unwrap_or(""));
        let found: Vec<&str> = residual.moved.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(found, *names, "{texts}");
        assert!(
            !fragment.is_some_and(|text| text.contains(gone)) && vertex.is_some_and(|text| text.contains(gone)),
            "{texts}"
        );
    }
}

#[test]
fn what_is_not_affine_or_does_not_pay_stays() {
    for body in [
        // Products of varyings, and functions of them.
        "color = vec4(dot(normal, at));",
        "color = vec4(normalize(at), 1.0);",
        "color = vec4(light / at, 1.0);",
        // Varyings of different interpolation.
        "color = vec4(turn * (at + tint), 1.0) + vec4(at * at, 1.0) + vec4(tint * tint, 1.0);",
        "color = vec4(turn * (at + middle), 1.0) + vec4(at * at, 1.0) + vec4(middle * middle, 1.0);",
        "color = vec4(dot(at.xy, screen));",
        // What changes from fragment to fragment otherwise.
        "color = vec4(at.x * gl_FragCoord.x);",
        "color = texture(tex, vec2(0.5)) * at.x;",
        "float k = 0.0; for (int i = 0; i < 9; ++i) { k += at.x * float(i); if (k > light.x) break; } color = vec4(k);",
        // A varying more than is saved.
        "color = vec4(at * 2.0, 1.0) + vec4(sin(at), 1.0);",
        "color = vec4(at, normal.x);",
    ] {
        let residual = moved(body);
        assert!(residual.moved.is_empty(), "{body}\n{:?}\n{:?}", residual.moved, residual.text(Stage::Fragment));
    }
}

#[test]
fn nothing_moves_into_a_stage_that_returns_early() {
    let vertex = "#version 150\nin vec4 p;\nuniform bool early;\nout vec3 at;\n\
        void main() { at = p.xyz; gl_Position = p; if (early) return; gl_Position = p * 2.0; }\n";
    let fragment = "#version 150\nin vec3 at;\nuniform vec3 light;\nout vec4 color;\n\
        void main() { color = vec4(normalize(light - at), 1.0); }\n";
    assert!(residual(vertex, fragment, &[], Math::Exact, true).moved.is_empty());
}

/// The fragment stage of a body, where `u` is known to be 3.
fn written(body: &str) -> String {
    let fragment = format!(
        "#version 150\nin vec4 v;\nuniform float u;\nuniform vec4 list[16];\nout vec4 color;\nvoid main() {{\n{body}\n}}\n"
    );
    residual(VERTEX, &fragment, &[("u", &[3.0])], Math::Exact, false).text(Stage::Fragment).expect("a stage").to_owned()
}

#[test]
fn a_short_loop_with_an_open_jump_is_written_out() {
    let broken = written(
        "float s = 0.0; for (int i = 0; i < 3; ++i) { if (s > v.x) break; s += v.y * float(i); } color = vec4(s);",
    );
    assert!(!broken.contains("for (") && !broken.contains("break") && broken.contains("v.y * 2.0"), "{broken}");
    let skipped = written(
        "float s = 0.0; for (int i = 0; i < 3; ++i) { if (v.x > float(i)) continue; s += v.y; } color = vec4(s);",
    );
    assert!(!skipped.contains("for (") && !skipped.contains("continue") && skipped.contains("v.x > 2.0"), "{skipped}");
    // Jumps from within other branches stay jumps.
    let deep = written(
        "float s = 0.0; for (int i = 0; i < 3; ++i) { if (v.z > 0.5) { s += 1.0; if (s > v.x) break; s *= v.w; } s += v.y; } \
         color = vec4(s);",
    );
    assert!(deep.contains("do {") && deep.contains("} while (false);") && deep.contains("break;"), "{deep}");
    // What is known after an iteration is what holds on all ways out of it.
    let known = written(
        "float s = 0.0; for (int i = 0; i < 2; ++i) { s = u; if (v.x > float(i)) break; s = 1.0; } color = vec4(s, u, s, s);",
    );
    assert!(known.contains("vec4(s, 3.0, s, s)"), "{known}");
}

#[test]
fn loops_that_jump_both_ways_or_run_long_stay() {
    for body in [
        "float s = 0.0; for (int i = 0; i < 3; ++i) { if (v.x > s) continue; if (v.y > s) break; s += v.z; } color = vec4(s);",
        // The `break` is sure only where the `continue` was not taken.
        "float s = 0.0; for (int i = 0; i < 3; ++i) { if (v.x > s) continue; s += v.z; break; } color = vec4(s);",
        "float s = 0.0; for (int i = 0; i < 60; ++i) { if (s > v.x) break; s += sin(v.y + s) * cos(v.z + s); } color = vec4(s);",
    ] {
        let text = written(body);
        assert!(text.contains("for (") && !text.contains("do {"), "{text}");
    }
}

#[test]
fn a_uniform_array_ends_where_no_index_reaches() {
    let size = |body: &str| {
        let text = written(body);
        let line = text.lines().find(|line| line.starts_with("uniform vec4")).unwrap_or_default().to_owned();
        line.chars().filter(char::is_ascii_digit).collect::<String>().trim_start_matches('4').to_owned()
    };
    assert_eq!(
        size("color = vec4(0.0); for (int i = 0; i < 5; ++i) { for (int j = 0; j < 60; ++j) color += list[i] * v; }"),
        "5"
    );
    assert_eq!(size("color = list[clamp(int(v.x), 0, 2)];"), "3");
    assert_eq!(size("color = list[int(gl_FragCoord.x) & 7];"), "8");
    // Nothing is known of these, or they may be negative, which is limited to the first element.
    assert_eq!(size("color = list[int(v.x)];"), "16");
    assert_eq!(size("color = list[int(clamp(v.x, 0.0, 3.0))];"), "16");
}
