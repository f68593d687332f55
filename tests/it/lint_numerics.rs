//! Tests of the rules on the domains of functions: what is told, and what is proven or unknown and therefore not.

use crate::support::compile_text;
use glisten_front::diagnostic::Group;
use glisten_front::hir::Stage;
use glisten_front::lint;

/// The names of the rules of numerics that find something in an expression.
fn told(body: &str) -> Vec<&'static str> {
    let text = format!(
        "#version 150\nin vec3 n; in vec3 l; in vec3 v; in float x; uniform float k; uniform sampler2D t; out vec4 c;\n\
         void main() {{ vec3 N = normalize(n), L = normalize(l), V = normalize(v); float r = 0.0; {body} c = vec4(r); }}\n"
    );
    let done = compile_text("a.frag", &text, Stage::Fragment);
    let messages: Vec<&str> = done.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let program = done.program.unwrap_or_else(|| panic!("{body}: {messages:?}"));
    let found = lint::check(&program, &done.sources);
    found
        .iter()
        .map(|found| found.code)
        .filter(|code| code.group() == Some(Group::Numerics))
        .map(|code| code.name)
        .collect()
}

#[test]
fn a_domain_that_is_left_is_told() {
    for (body, rule) in [
        ("r = pow(dot(N, L), k);", "pow-maybe-negative"),
        ("r = pow(N.y, 128.0);", "pow-maybe-negative"),
        ("r = pow(sin(x) * 0.5, 2.0);", "pow-maybe-negative"),
        ("r = pow(1.0 - dot(N, V), 5.0);", "pow-maybe-negative"),
        ("r = pow(fract(x) * 2.0 - 1.0, 3.0);", "pow-maybe-negative"),
        ("float d = dot(N, reflect(-L, N)); r = pow(d, k);", "pow-maybe-negative"),
        ("r = sqrt(1.0 - dot(N, L) * dot(N, L));", "sqrt-maybe-negative"),
        ("float d = dot(N, L); r = sqrt(1.0 - d * d);", "sqrt-maybe-negative"),
        ("r = inversesqrt(cos(x));", "sqrt-maybe-negative"),
        ("r = acos(dot(N, L));", "acos-beyond-one"),
        ("r = asin(-dot(N, L));", "acos-beyond-one"),
        ("r = acos(sin(x) * 2.0);", "acos-beyond-one"),
        ("r = log(clamp(sin(x), 0.0, 1.0));", "log-of-zero"),
        ("r = log2(fract(x));", "log-of-zero"),
        ("r = x / max(dot(N, L), 0.0);", "division-by-clamped-zero"),
        ("r = x / (4.0 * max(dot(N, L), 0.0));", "division-by-clamped-zero"),
        ("r = x / clamp(dot(N, L), 0.0, 1.0);", "division-by-clamped-zero"),
        ("r = normalize(n - n).x;", "normalize-of-zero"),
    ] {
        assert_eq!(told(body), [rule], "{body}");
    }
}

#[test]
fn what_is_proven_guarded_or_unknown_is_not() {
    for body in [
        "r = pow(max(dot(N, L), 0.0), k);",
        "r = pow(abs(N.y), 128.0);",
        "r = pow(clamp(1.0 - dot(N, V), 0.0, 1.0), 5.0);",
        "r = pow(sin(x) * 0.5 + 0.5, 2.0);",
        "r = pow(x, 2.0) + pow(texture(t, n.xy).x, 2.2);",
        "r = pow(dot(texture(t, n.xy).rgb, vec3(0.3, 0.6, 0.1)), 2.2);",
        "r = pow(dot(n, l), 2.0);",
        "float d = dot(N, L); if (d > 0.0) r = pow(d, k);",
        "float d = dot(N, L); r = d > 0.0 ? pow(d, k) : 0.0;",
        "float d = dot(N, L); d = max(d, 0.0); r = pow(d, k);",
        "r = sqrt(max(1.0 - dot(N, L) * dot(N, L), 0.0));",
        "r = sqrt(dot(n, n)) + sqrt(x * x) + sqrt(x) + sqrt(k);",
        "r = sqrt(1.0 - fract(x));",
        "r = acos(clamp(dot(N, L), -1.0, 1.0)) + acos(x) + asin(sin(x));",
        "r = acos(min(dot(N, L), 1.0) * 0.5);",
        "r = log(x) + log(length(n)) + log(max(x, 1e-6)) + log(fract(x) + 1.0);",
        "r = x / max(dot(N, L), 1e-3) + x / k + x / dot(n, l);",
        "r = x / (max(dot(N, L), 0.0) + 0.001);",
        "r = normalize(n - l).x;",
    ] {
        assert_eq!(told(body), [] as [&str; 0], "{body}");
    }
}

#[test]
fn a_float_counter_is_told_where_rounding_decides() {
    for (body, is_told) in [
        ("for (float i = 0.0; i < 1.0; i += 0.1) r += i;", true),
        ("for (float i = 1.0; i > 0.0; i -= 0.2) r += i;", true),
        ("for (float i = 0.0; i < k; i += 0.15) r += i;", true),
        ("for (float i = 0.0; i < 100000.0; i += 0.15) r += i;", true),
        ("for (float i = 0.0; i < 1.0; i += 0.15) r += i;", false),
        ("for (float i = 1.54; 0.0 < i; i -= 0.2) r += i;", false),
    ] {
        assert_eq!(told(body).contains(&"float-loop-counter"), is_told, "{body}");
    }
}

/// The value of a global that nothing assigns to is that of its declaration.
#[test]
fn a_global_that_nothing_assigns_to_is_constant() {
    let found = |assignment: &str| {
        let text = format!(
            "#version 150\nint kind = 5; out vec4 c; in vec2 p;\nvoid main() {{ {assignment} float k = cos(3.14159 / float(kind)); \
             c = vec4(sqrt(0.75 - k * k), p, 1.0); }}\n"
        );
        let done = compile_text("a.frag", &text, Stage::Fragment);
        let program = done.program.expect("it compiles");
        lint::check(&program, &done.sources).iter().any(|found| found.code.name == "sqrt-maybe-negative")
    };
    assert!(!found(""));
    assert!(found("kind = int(p.x);"));
}
