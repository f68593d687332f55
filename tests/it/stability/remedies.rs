//! Remedies are told as they are: measured against the exact picture of the program that was asked about, with the kind that fits.

use crate::cli::{Folder, err, out};
use serde_json::Value;

const VERTEX: &str = "#version 150\nin vec2 p;\nout vec2 uv;\nvoid main() {\n    uv = p;\n    gl_Position = vec4(2.0 * p - 1.0, 0.0, 1.0);\n}\n";
const SCENE: &str = "[framebuffer]\nwidth = 12\nheight = 12\nformat = \"rgba32float\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \
    \"a.frag\"\nprimitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [0, 0, 1, 0, 0, 1, 1, 1] }\n";

/// The findings about a fragment shader with this body, a varying `uv` from 0 to 1 and a uniform `big`.
fn found(body: &str) -> Value {
    let fragment = format!("#version 150\nin vec2 uv;\nuniform float big;\nout vec4 c;\nvoid main() {{\n{body}\n}}\n");
    let uniforms = if body.contains("big") { "[draw.uniforms]\nbig = 16777216\n" } else { "" };
    let scene = format!("{SCENE}{uniforms}");
    let folder =
        Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", scene.as_bytes())]);
    let output = folder.run(&["stability", "a.toml", "--format", "json"]);
    serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {body}: {}", err(&output)))
}

fn helps(found: &Value) -> Vec<&str> {
    found["causes"].as_array().into_iter().flatten().filter_map(|cause| cause["help"].as_str()).collect()
}

fn kinds(found: &Value) -> Vec<&str> {
    found["causes"].as_array().into_iter().flatten().filter_map(|cause| cause["kind"].as_str()).collect()
}

/// The rewriting in a help text, and its error.
fn tried(help: &str) -> Option<(&str, f64)> {
    let (_, rest) = help.split_once("Tried: with `")?;
    let (text, rest) = rest.split_once('`')?;
    let (_, error) = rest.split_once("the error of the picture is ")?;
    Some((text, error.split_whitespace().next()?.parse().ok()?))
}

#[test]
fn exponentials_have_stable_forms_whose_errors_are_those_of_the_picture() {
    for (body, form) in [
        ("float x = uv.x * 200.0;\nc = vec4(log(1.0 + exp(x)) * 0.005);", "(max(x, 0.0) + log(1.0 + exp(-abs(x))))"),
        ("float x = uv.x * 200.0;\nc = vec4(log(exp(x) + 1.0) * 0.005);", "(max(x, 0.0) + log(1.0 + exp(-abs(x))))"),
        (
            "float x = uv.x * 200.0;\nfloat e = exp(x);\nfloat s = 1.0 + e;\nc = vec4(log(s) * 0.005);",
            "(max(x, 0.0) + log(1.0 + exp(-abs(x))))",
        ),
        (
            "float a = uv.x * 200.0, b = uv.y * 150.0;\nc = vec4(log(exp(a) + exp(b)) * 0.005);",
            "(max(a, b) + log(1.0 + exp(-abs(a - b))))",
        ),
        ("vec2 x = uv * 200.0;\nc = log2(1.0 + exp2(x)).xyxy * 0.005;", "(max(x, 0.0) + log2(1.0 + exp2(-abs(x))))"),
        ("float x = uv.x * 200.0;\nc = vec4(exp(x) / exp(x + 1.0));", "exp(x - (x + 1.0))"),
        (
            "float a = exp(uv.x * 200.0);\nfloat b = exp(uv.x * 200.0 + 1.0);\nc = vec4(a / b);",
            "exp((uv.x * 200.0) - (uv.x * 200.0 + 1.0))",
        ),
        ("float x = uv.x * 200.0;\nc = vec4(exp(x) / (1.0 + exp(x)));", "(1.0 / (1.0 + exp(-x)))"),
        ("float x = uv.x * 200.0;\nfloat e = exp(x);\nc = vec4(e / (e + 1.0));", "(1.0 / (1.0 + exp(-x)))"),
    ] {
        let found = found(body);
        let told: Vec<(&str, f64)> = helps(&found).into_iter().filter_map(tried).collect();
        assert!(told.iter().any(|(text, error)| *text == form && *error < 1e-4), "{body}: {told:?} {found}");
    }
}

#[test]
fn a_rewriting_that_draws_another_picture_does_not_help() {
    // 1 / exp(x) by a product, so that no stable form fits.
    for body in [
        "float x = uv.x * 200.0;\nc = vec4(log(2.0 + exp(x)) * 0.005);",
        "float x = uv.x * 200.0;\nc = vec4(sqrt(exp(x)) * exp(-0.5 * x));",
    ] {
        let found = found(body);
        let helps = helps(&found);
        assert!(helps.iter().any(|help| help.contains("does not help, because it draws another picture")), "{found}");
        assert!(helps.iter().all(|help| tried(help).is_none()), "{found}");
    }
    // A local that changes in between is no part of a form.
    let found = found("float x = uv.x * 200.0;\nfloat e = exp(x);\nx = 1.0;\nc = vec4(e / exp(x + 199.0));");
    assert!(helps(&found).iter().all(|help| !help.contains("exp(x - ")), "{found}");
}

#[test]
fn a_picture_without_an_exact_one_is_the_rewritten_one() {
    let found = found("float x = uv.x - 0.5;\nc = vec4(pow(x, 2.0), 0.0, 0.0, 1.0);");
    let helps = helps(&found);
    let told = helps.iter().find(|help| help.contains("Tried: with `(x * x)`")).unwrap_or_else(|| panic!("{found}"));
    assert!(told.contains("where the exact picture is finite; elsewhere it draws its own"), "{told}");
}

#[test]
fn what_vanishes_under_a_root_is_an_underflow() {
    for body in [
        "float a = uv.x * 1e-25, b = uv.y * 1e-25;\nc = vec4(sqrt(a * a + b * b) * 1e25);",
        "vec2 v = uv * 1e-25;\nc = vec4(sqrt(dot(v, v)) * 1e25);",
        "float a = uv.x * 1e-25;\nc = vec4(sqrt(a * a) * 1e25);",
        "float a = (uv.x + 0.5) * 1e-25;\nc = vec4(inversesqrt(a * a) * 1e-25);",
        "float a = (uv.x + 0.5) * 1e-25;\nc = vec4(pow(a * a, 0.5) * 1e25);",
        "float a = (uv.x + 0.5) * 1e-25;\nc = vec4(log(a * a) * 0.01);",
    ] {
        let found = found(body);
        assert_eq!(kinds(&found).first(), Some(&"underflow"), "{body}: {found}");
        let help = helps(&found).join(" ");
        assert!(help.contains("safeLength") && help.contains("power of two"), "{help}");
        assert!(!help.contains("negative") && !help.contains("Tried"), "{help}");
    }
    // A difference that cancels is no underflow.
    let found = found("float a = 1.0 + uv.x * 1e-4;\nc = vec4(sqrt(a * a - a * a * (1.0 - 1e-7)) * 1e3);");
    assert!(!kinds(&found).contains(&"underflow"), "{found}");
}

#[test]
fn exact_operations_on_integers_are_no_cause() {
    for body in [
        "int i = int(big + uv.x * 4.0);\nc = vec4(float(i - 16777216));",
        "int i = int(big + uv.x * 4.0);\nint j = i - 16777216;\nfloat f = float(j);\nc = vec4(f);",
        "uint i = uint(big + uv.x * 4.0);\nc = vec4(float(i - 16777216u) * 0.25);",
    ] {
        let found = found(body);
        let causes = found["causes"].as_array().map(Vec::as_slice).unwrap_or_default();
        assert!(!causes.is_empty(), "{found}");
        assert!(causes.iter().all(|cause| cause["line"].as_u64() == Some(6)), "{body}: {found}");
    }
    // An integer of more than 24 bits is rounded where it is converted.
    let found = found("int i = 16777217 + 2 * int(uv.x * 4.0);\nc = vec4(float(i) - big);");
    assert!(kinds(&found).contains(&"rounding") || kinds(&found).contains(&"cancellation"), "{found}");
}

/// The starts and the kinds of the causes.
fn places(found: &Value) -> Vec<(u64, u64, &str)> {
    let causes = found["causes"].as_array().into_iter().flatten();
    let number = |cause: &Value, key: &str| cause[key].as_u64().unwrap_or(0);
    causes.map(|cause| (number(cause, "line"), number(cause, "column"), cause["kind"].as_str().unwrap_or(""))).collect()
}

/// The shader's text begins on line 6.
#[test]
fn what_passes_an_infinity_or_a_nan_on_is_no_cause() {
    for (body, first) in [
        (
            "vec3 p = vec3(floor(uv * 12.0) - 6.0, 0.0);\nvec3 n = normalize(p);\nc = vec4(n * 0.5 + 0.5, 1.0);",
            (7, 10, "division"),
        ),
        (
            "vec3 p = vec3(floor(uv * 12.0) - 6.0, 0.0);\nvec3 n = normalize(p);\nc = vec4(dot(n, vec3(0.3, 0.4, 0.5)));",
            (7, 10, "division"),
        ),
        ("float x = floor(uv.x * 12.0) - 6.0;\nfloat y = 1.0 / x;\nc = vec4(y - 0.2);", (7, 11, "division")),
        (
            "vec3 p = vec3(uv - 0.5, 0.3);\nif (uv.x > 0.9) p *= 0.0;\nvec3 n = normalize(p);\nc = vec4(max(dot(n, normalize(vec3(1.0, \
             -1.0, 0.5))), 0.0));",
            (8, 10, "division"),
        ),
    ] {
        let found = found(body);
        assert_eq!(places(&found), [first], "{body}: {found}");
    }
}

#[test]
fn a_sum_that_bears_the_error_of_a_sine_is_no_cause() {
    let found = found("float t = 86400.0 * 30.0;\nc = vec4(0.5 + 0.5 * sin(t * 3.0 + uv.x * 6.0));");
    assert!(kinds(&found).contains(&"argument") && !kinds(&found).contains(&"cancellation"), "{found}");
}

#[test]
fn further_causes_of_a_line_have_their_places() {
    let found = found("float a = uv.x * 1e20 + 1e19;\nfloat b = uv.y * 1e20;\nc = vec4(sqrt(a * a + b * b) * 1e-20);");
    let overflow = &found["causes"][0];
    let starts = [&overflow["column"], &overflow["also"][0]["column"]].map(|column| column.as_u64().unwrap_or(0));
    assert!(starts == [15, 23] || starts == [23, 15], "{found}");
    assert_eq!(found["causes"].as_array().map(Vec::len), Some(1), "{found}");
}

#[test]
fn a_rewriting_is_judged_at_its_place() {
    let found = found(
        "float a = uv.x * 1e-3;\nfloat b = uv.y * 1e-3;\nfloat p = (1.0 - cos(a)) * 1e6;\nfloat q = (1.0 - cos(b)) * 1e6;\nc = vec4(p, \
         q, 0.0, 1.0);",
    );
    let helps = helps(&found);
    assert_eq!(helps.len(), 2, "{found}");
    for help in helps {
        assert!(help.contains("the rest has other causes") && !help.contains("lost digits"), "{help}");
    }
}

/// Bodies, and words that their first help has and has not.
#[test]
fn a_remedy_fits_the_expression() {
    for (body, has, has_not) in [
        (
            "vec3 q = vec3(2e6, 1e6, 3e6);\nvec3 p = q + vec3(uv, 0.3);\nc = vec4(distance(p, q));",
            "relative to the camera",
            "safeLength",
        ),
        ("c = vec4(mix(1e8, 1.0 + uv.y, 1.0 - uv.x * 1e-9 - 1e-9));", "where `t` is near 1", "subtracts"),
        ("float x = 1.0 + uv.x * 1e-6;\nc = vec4(pow(x, 1e6));", "bases from 0 to 1", "of a base near 1 and"),
        ("c = vec4((pow(1.0 + uv.x * 1e-4, 1.0 / 3.0) - 1.0) * 3e4);", "n * x * (1.0", "x / 6.0"),
        ("float x = uv.x * 1e-5 + 1e-6;\nc = vec4(log2(x + 1.0) / x);", "2.885390", "is `2.0 * y"),
        (
            "float r = 9e6;\nfloat d = 2999.99 + uv.x * 0.01;\nc = vec4(sqrt(max(r - d * d, 0.0)) * 0.1);",
            "`(x - y) * (x + y)`",
            "squared mean",
        ),
        (
            "vec2 n = vec2(0.8, 0.6) * (1.0 - uv.x * 1e-6);\nc = vec4((1.0 - dot(n, n)) * 1e5);",
            "third component",
            "1.0 - c",
        ),
        (
            "vec3 p = vec3(uv.x * 1e-3, 0.0, 3000.0 + uv.y);\nfloat r = 3000.0;\nc = vec4((dot(p, p) - r * r) * 1e-2);",
            "`dot(x - y, x + y)`",
            "write `(x - y)",
        ),
        ("float x = 1.0 - uv.x * 1e-3;\nc = vec4((1.0 - x * (2.0 - x)) * 1e6);", "rearrange", "depth"),
        ("float x = 1.0 + uv.x * 1e-5;\nc = vec4((x * x - 1.0) * 1e5);", "`(c - 1.0) * (c + 1.0)`", "quadratic"),
        ("vec3 v = vec3(uv + 0.1, 0.3) * 1e-20;\nc = vec4(dot(v, v) * 1e38);", "safeNormalize", "cancel"),
    ] {
        let found = found(body);
        let helps = helps(&found);
        let help = helps.iter().find(|help| help.contains(has)).unwrap_or_else(|| panic!("{body}: {found}"));
        assert!(!help.contains(has_not), "{body}: {help}");
    }
}

#[test]
fn the_square_of_a_tiny_vector_is_an_underflow() {
    let found = found("vec3 v = vec3(uv + 0.1, 0.3) * 1e-20;\nfloat d = dot(v, v);\nc = vec4(v / sqrt(d), 1.0);");
    assert!(!kinds(&found).contains(&"cancellation") && kinds(&found).contains(&"underflow"), "{found}");
}
