//! What stays and what goes, by small programs: NaN, infinities, signed zeros, derivatives, effects.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{Binary, Class, Numbers, Ternary};
use glisten_front::hir::{ScalarValue, Stage};
use glisten_front::{Compiler, Options, Source};
use glisten_specialize::{Input, Known, Residual, specialize, specialize_with};
use std::time::{Duration, Instant};

const VERTEX: &str = "#version 150\nin vec4 p;\nin vec4 q;\nout vec4 v;\nvoid main() { v = q; gl_Position = p; }\n";

fn residual(fragment: &str, known: &[(&str, &[f32])]) -> Residual {
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let messages: Vec<_> = compiled.diagnostics.iter().map(|found| found.message.clone()).collect();
    let program = compiled.program.unwrap_or_else(|| panic!("{messages:?}\n{fragment}"));
    let mut values = Known::default();
    for (name, numbers) in known {
        values.uniforms.insert((*name).into(), numbers.iter().map(|value| ScalarValue::Float(*value)).collect());
    }
    let residual = specialize(&program, &values);
    assert!(residual.fault.is_none(), "{:?}", residual.fault);
    residual
}

/// Comments stay where their code stays, of both kinds, next to it and around bodies.
#[test]
fn comments_stay_with_their_code() {
    let fragment = "#version 150\nin vec4 v; // from the vertices\nuniform float u; /* stays */\nuniform float w; // goes\n\
        out vec4 color;\n\n// twice\nfloat twice(float a) /* of a */\n{\n    // the sum\n    return a + a; /* tail */\n    // last\n\
        } // twice, done\n\nvoid main() {\n    if (w > 0.5) color = vec4(0.0); // never\n    \
        else color = vec4(twice(u * v.x)); /* both */ // kinds\n}\n// the end\n/* of\n   it */\n";
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let program = compiled.program.expect("it compiles");
    let mut known = Known::default();
    known.uniforms.insert("w".into(), vec![ScalarValue::Float(0.0)]);
    let options =
        glisten_specialize::Options { sources: Some(&compiled.sources), ..glisten_specialize::Options::default() };
    let residual = specialize_with(&program, &known, &options);
    let text = residual.text(Stage::Fragment).expect("a stage");
    for kept in [
        "// from the vertices",
        "/* stays */",
        "/* of a */",
        "/* tail */",
        "    // last\n}  // twice, done",
        "/* both */ // kinds",
        "}\n// the end\n/* of\n   it */\n",
    ] {
        assert!(text.contains(kept), "{kept}: {text}");
    }
    assert!(!text.contains("goes") && !text.contains("never"), "{text}");
}

/// The fragment stage of `color = EXPRESSION` with uniforms `u` and `w`, and the unknown `v`.
fn of(expression: &str, u: f32, w: f32) -> String {
    let fragment = format!(
        "#version 400\nin vec4 v;\nuniform float u;\nuniform float w;\nout vec4 color;\n\
         void main() {{ color = vec4({expression}); }}\n"
    );
    residual(&fragment, &[("u", &[u]), ("w", &[w])]).text(Stage::Fragment).expect("a stage").to_owned()
}

/// What is left of `c` after some statements, where `u` is 0 and `w` is 1.
fn left_of(statements: &str) -> String {
    let fragment = format!(
        "#version 150\nin vec4 v;\nuniform float u;\nuniform float w;\nout vec4 color;\n\
         void main() {{ vec3 c = v.xyz; {statements} color = vec4(c, 1.0); }}\n"
    );
    residual(&fragment, &[("u", &[0.0]), ("w", &[1.0])]).text(Stage::Fragment).expect("a stage").to_owned()
}

/// A driver makes 0 of `x * 0.0`, whatever the sign of `x` is.
#[test]
fn a_zero_whose_sign_an_operation_sees_stays_in_its_uniform() {
    for seen in [
        "float(floatBitsToUint(x.x * u) >> 31)",
        "atan(x.x * u, -1.0)",
        "1.0 / (x.x * u) > 0.0 ? 1.0 : 0.25",
        "float(floatBitsToUint(dot(x, vec2(u))) >> 31)",
        "uintBitsToFloat((floatBitsToUint(x.x * u) & 0x80000000u) | 0x3f800000u)",
    ] {
        let text = of_bits(seen);
        assert!(text.contains("uniform float u"), "{seen}: {text}");
    }
    // Of a color nobody sees it, or the product is 0 with a known sign.
    for unseen in ["x.x * x.x * u", "1.0 / (2.0 + x.x * u)", "atan(abs(x.x) * u, -1.0)"] {
        let text = of_bits(unseen);
        assert!(!text.contains("uniform float u"), "{unseen}: {text}");
    }
}

/// 0 to a power above 0 is 0, and no small number that vanished.
#[test]
fn a_power_of_zero_is_folded() {
    let text = of_bits("max(pow(u, 4.0), 0.25) * x.x");
    assert!(!text.contains("pow") && text.contains("0.25"), "{text}");
}

/// The fragment stage of `color = EXPRESSION` in GLSL 3.30, with `u` = 0 and an `x` that is finite and else unknown.
fn of_bits(expression: &str) -> String {
    let fragment = format!(
        "#version 330\nin vec4 v;\nuniform float u;\nout vec4 color;\n\
         void main() {{ vec2 x = vec2(ivec2(v.xy)); color = vec4({expression}); }}\n"
    );
    residual(&fragment, &[("u", &[0.0])]).text(Stage::Fragment).expect("a stage").to_owned()
}

#[test]
fn what_leaves_a_variable_as_it_is_goes() {
    let nothing = left_of("");
    for statements in
        ["c *= w;", "c /= w;", "c -= u;", "c -= vec3(u);", "c = c;", "c.xy = c.xy;", "c.x *= w;", "c = c * w;"]
    {
        assert_eq!(left_of(statements), nothing, "{statements}");
    }
    // -0 + 0 is 0, and places that differ are no identity.
    for statements in ["c += u;", "c.xy = c.yx;", "c *= v.w;", "c -= w;"] {
        assert_ne!(left_of(statements), nothing, "{statements}");
    }
    // One pass of a loop that is written out does nothing: what it declares goes, too.
    let written_out = left_of("for (int i = 0; i < 2; ++i) { vec3 k = i == 0 ? v.yzw : vec3(u); c -= k * w; }");
    assert_eq!(written_out.matches("vec3 k").count(), 1, "{written_out}");
    let twice = left_of("c = clamp(clamp(c, 0.25, 0.5), 0.25, 0.5);");
    assert_eq!(twice, left_of("c = clamp(c, 0.25, 0.5);"));
    assert_ne!(twice, left_of("c = clamp(clamp(c, 0.25, 0.5), 0.5, 0.5);"));
}

#[test]
fn a_factor_of_one_goes_next_to_a_scalar() {
    for (statements, wanted) in [
        ("c = vec3(w) * v.w;", "vec3 c = vec3(v.w);"),
        ("c = v.w / vec3(w);", "vec3 c = vec3(v.w);"),
        ("c *= vec3(w) * v.w;", "c *= v.w;"),
        ("c = (vec3(w) * v.x) * (vec3(w) * v.y);", "vec3 c = v.x * vec3(v.y);"),
        ("vec3 d = vec3(w); d *= v.w; c = d;", "vec3 d = vec3(v.w);"),
    ] {
        let left = left_of(statements);
        assert!(left.contains(wanted), "{statements}: {left}");
    }
    // 0 + -0 is 0.
    let kept = left_of("c = vec3(u) + v.w;");
    assert!(!kept.contains("vec3(v.w)"), "{kept}");
}

/// `c`, of which each component is one of two numbers.
fn between(low: &str, high: &str) -> String {
    format!("c = vec3(v.x > 0.1 ? {low} : {high}, v.y > 0.1 ? {low} : {high}, v.z > 0.1 ? {low} : {high}); ")
}

/// Functions that give their argument back, or one number, where its range says so.
#[test]
fn functions_of_a_narrow_range_go() {
    let bounded = between("0.25", "0.75");
    for (statement, wanted) in [
        ("c = abs(c);", ""),
        ("c = fract(c);", ""),
        ("c = mod(c, 4.0);", ""),
        ("c *= sign(c);", ""),
        ("c *= sign(-c);", "c *= vec3(-1.0);"),
        ("c += floor(c + 3.0);", "c += vec3(3.0);"),
        ("c += ceil(c);", "c += vec3(1.0);"),
        ("c += trunc(c - 2.0);", "c += vec3(-1.0);"),
        ("float s = (v.w > 0.1 ? -1.0 : 1.0) * u; c += s;", ""),
        ("float s = (v.w > 0.1 ? -1.0 : 1.0) * u; c -= s;", ""),
    ] {
        assert_eq!(left_of(&format!("{bounded}{statement}")), left_of(&format!("{bounded}{wanted}")), "{statement}");
    }
    // -0 and NaN, numbers at the end of a range, and a sum that may be 0.
    for (low, high, statement) in [
        ("-0.0", "1.0", "c = abs(c);"),
        ("0.25", "1.0", "c = fract(c);"),
        ("0.25", "0.75", "c = mod(c, 0.75);"),
        ("-0.25", "0.75", "c = mod(c, 4.0);"),
        ("0.0", "0.75", "c *= sign(c);"),
        ("0.25", "1.0", "c += floor(c);"),
        ("0.25", "v.w", "c = abs(c);"),
        ("-0.0", "0.75", "float s = (v.w > 0.1 ? -1.0 : 1.0) * u; c += s;"),
    ] {
        let bounded = between(low, high);
        assert_ne!(left_of(&format!("{bounded}{statement}")), left_of(&bounded), "{low} to {high}: {statement}");
    }
}

/// The length of a vector limits its products, as long as it is one vector: `u` is 0, and what is finite times 0 adds nothing.
#[test]
fn a_unit_vector_is_no_longer_than_one() {
    let bounded = between("0.25", "1.0");
    let before = format!("{bounded}vec3 n = normalize(c), m = normalize(c.yzx * c);");
    let nothing = left_of(&bounded);
    for product in [
        "dot(n, m)",
        "dot(-n, m.xyz)",
        "dot(n, reflect(-m, n))",
        "dot(reflect(m, -n), reflect(n, m))",
        "length(cross(n, m))",
        "dot(n, faceforward(n, m, n))",
    ] {
        let text = left_of(&format!("{before} c += u * pow(max({product}, 0.0), 300.0);"));
        assert_eq!(text, nothing, "{product}");
    }
    for product in [
        "dot(vec3(n.x, m.y, n.z), m)",
        "dot(n.xxx, m)",
        "dot(n.zyx, vec3(m.xy, n.z))",
        "dot(mat3(n, m, n)[1] + n, m)",
        "dot(transpose(mat3(n, m, n))[1], m)",
        "dot(n + m, m)",
    ] {
        let text = left_of(&format!("{before} c += u * pow(max({product}, 0.0), 300.0);"));
        assert!(text.contains("pow"), "{product}: {text}");
    }
    for statements in ["n.x = m.x;", "n[1] = m.y;", "n.yz = m.xy;", "if (c.x > 0.5) n.z = m.z;"] {
        let text = left_of(&format!("{before} {statements} c += u * pow(max(dot(n, m), 0.0), 300.0);"));
        assert!(text.contains("pow"), "{statements}: {text}");
    }
}

#[test]
fn a_product_with_the_identity_goes() {
    let bounded = between("0.25", "1.0");
    let nothing = left_of(&bounded);
    for factor in ["mat3(w)", "transpose(inverse(mat3(w)))", "mat3(mat4(w))", "(mat3(w) * mat3(w))"] {
        assert_eq!(left_of(&format!("{bounded}c = {factor} * c;")), nothing, "{factor}");
        assert_eq!(left_of(&format!("{bounded}c = c * {factor};")), nothing, "{factor}");
    }
    assert_eq!(left_of(&format!("{bounded}c.x = dot(c, vec3(u, w, u));")), left_of(&format!("{bounded}c.x = c.y;")));
    assert_eq!(
        left_of(&format!("{bounded}c = mat3(c, c.zxy, c) * vec3(u, w, u);")),
        left_of(&format!("{bounded}c = c.zxy;"))
    );
    // A matrix with a single 1 is no axis.
    let matrix = "c = (mat4x3(c, c, c, c) * mat2x4(w, u, u, u, u, u, u, u))[0];";
    assert!(left_of(&format!("{bounded}{matrix}")).contains("mat2x4"));
    // An infinity times 0 is NaN.
    assert!(left_of("c = mat3(w) * c;").contains("mat3"));
}

/// Where nobody sees the sign of a zero, adding one does nothing; `v` may be -0.
#[test]
fn signs_of_zeros_that_nobody_sees_do_not_count() {
    let texture = |coordinate: &str| {
        let fragment = format!(
            "#version 150\nin vec4 v;\nuniform float u;\nuniform sampler2D s;\nout vec4 color;\n\
             void main() {{ vec2 c = v.xy; {coordinate} }}\n"
        );
        residual(&fragment, &[("u", &[0.0])]).text(Stage::Fragment).expect("a stage").to_owned()
    };
    for (with, without) in [
        ("color = texture(s, c + u);", "color = texture(s, c);"),
        ("c += u; color = texture(s, c.yx);", "color = texture(s, c.yx);"),
        ("color = vec4(c.x + u > c.y + u);", "color = vec4(c.x > c.y);"),
        ("color = vec4(abs(c.x + u) + 1.0);", "color = vec4(abs(c.x) + 1.0);"),
        ("color = vec4((c.x + u) * 2.0 + 1.0);", "color = vec4(c.x * 2.0 + 1.0);"),
        ("color = vec4(length(c + u));", "color = vec4(length(c));"),
        ("color = vec4(pow(c.x + u, 64.0));", "color = vec4(pow(c.x, 64.0));"),
        ("color = vec4(pow(c.x + u, 2.5));", "color = vec4(pow(c.x, 2.5));"),
    ] {
        assert_eq!(texture(with), texture(without), "{with}");
    }
    for seen in [
        "color = vec4(c + u, 0.0, 1.0);",
        "color = vec4(1.0 / (c.x + u));",
        "color = textureProj(s, vec3(c, c.x + u));",
        "c += u; color = texture(s, c) + c.x;",
        "color = vec4(atan(c.x + u, c.y));",
        "color = vec4(inversesqrt(c.x + u));",
        "color = vec4(1.0 / sqrt(c.x + u));",
        "color = vec4(pow(c.x + u, 3.0));",
        "color = vec4(pow(c.x + u, c.y));",
    ] {
        let text = texture(seen);
        // A driver that finds a literal 0 may lose the sign. Between colors, 0 and -0 are equal.
        let is_color = ["vec4(c + u", "c += u", "u, 3.0)"].iter().any(|color| seen.contains(color));
        let literal = ["+ 0.0", "+= 0.0", "vec2(0.0)"].iter().any(|zero| text.contains(zero));
        assert_eq!(literal, is_color, "{seen}: {text}");
        assert_eq!(text.contains("uniform float u;"), !is_color, "{seen}: {text}");
    }
}

/// The larger of 0 and -0 is the first of them, and a remainder of an infinite divisor is NaN.
#[test]
fn what_comes_back_is_the_same_number() {
    for (low, high, statement) in [("-1.0", "-0.0", "c = max(c, 0.0);"), ("0.0", "1.0", "c = max(vec3(-0.0), c);")] {
        let bounded = between(low, high);
        assert!(left_of(&format!("{bounded}{statement}")).contains("max("), "{statement}");
    }
    let infinite = "c = vec3(v.x > 0.1 ? 0.25 : 0.5); float far = max(1.0 / v.y, 2.0); c = mod(c, far);";
    assert!(left_of(infinite).contains("mod("));
}

/// Iterations that were written out have variables of their own: one of them reads what the others do not.
#[test]
fn variables_of_an_iteration_are_its_own() {
    let fragment = "#version 150\nin vec4 v;\nuniform float u[4];\nout vec4 color;\n\
        float wave(float x) {\n    float r = 0.25;\n    if (v.x > x) { r = 0.5; if (v.y > x) r = 0.75; }\n    return r;\n}\n\
        void main() {\n    float c = 1.0;\n    for (int i = 0; i < 4; i++) { float n = wave(float(i)); c += u[i] * n; }\n    \
        color = vec4(c);\n}\n";
    let residual = residual(fragment, &[("u", &[0.0, 1.0, 0.0, 0.0])]);
    let text = residual.text(Stage::Fragment).expect("a stage");
    // Its definition and one call, if it is no part of `main`.
    assert!(text.matches("wave(").count() <= 2 && text.matches("= 0.75").count() == 1, "{text}");
}

/// A component that the next store overwrites, and a call that only gives what is overwritten.
#[test]
fn overwritten_components_go() {
    for (with, without) in [
        ("c.x = v.w; c.x = v.y;", "c.x = v.y;"),
        ("c.xy = v.ww; c.x = v.y; c.y = v.x;", "c.x = v.y; c.y = v.x;"),
        ("c[1] = v.w; c.y = v.x;", "c.y = v.x;"),
        ("c.x *= v.w; c.xz = v.yy;", "c.xz = v.yy;"),
        ("c.x++; c = v.zyx;", "c = v.zyx;"),
    ] {
        assert_eq!(left_of(with), left_of(without), "{with}");
    }
    for kept in [
        "c.x = v.w; c.y = c.x;",
        "c.xy = v.ww; c.x = v.y;",
        "c.x *= v.w; c.x += v.y;",
        "c.x = v.w; int i = int(v.x); c[i] = v.y;",
    ] {
        assert!(left_of(kept).contains("v.w"), "{kept}");
    }
}

/// A case knows what the cases before it declare (GLSL 1.50 §6.2), and a constant has its value there.
#[test]
fn a_decided_case_knows_the_declarations_before_it() {
    let fragment = "#version 150\nin vec4 v;\nuniform int mode;\nout vec4 color;\nfloat t = 0.5;\nfloat global() { return t; }\n\
        void main() {\n    switch (mode) {\n    case 0: float t; const vec3 tint = vec3(0.25, 0.5, 1.0); color = vec4(1.0); break;\n\
        case 1: t = v.x + global(); color = vec4(tint * t * v.y, global()); break;\n    }\n}\n";
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let program = Compiler::new(Options::default()).compile(&sources).program.expect("it compiles");
    let mut known = Known::default();
    known.uniforms.insert("mode".into(), vec![ScalarValue::Int(1)]);
    let residual = specialize(&program, &known);
    assert!(residual.fault.is_none(), "{:?}", residual.fault);
    let text = residual.text(Stage::Fragment).expect("a stage");
    assert!(!text.contains("switch") && text.contains("float t = v.x"), "{text}");
}

/// Names that the language of the residual does not allow, which that of the original does (GLSL 1.10 §3.6).
#[test]
fn words_of_later_versions_are_no_names_of_a_residual() {
    let fragment = "uniform float k;\nvarying vec4 v;\nfloat common;\nstruct Pair { float smooth; float active; };\n\
        float filter(float case) { common += case; if (common > v.w) return case; return common * case; }\n\
        void main() {\n    vec2 flat = v.xy * 2.0;\n    Pair precision = Pair(flat.x, v.z);\n    if (k > 0.5) flat = v.zw;\n\
        gl_FragColor = vec4(flat, filter(precision.smooth), precision.active);\n}\n";
    let vertex = "attribute vec4 p;\nvarying vec4 v;\nvoid main() { v = p; gl_Position = p; }\n";
    let source = |name: &str, text: &str, stage| Source {
        name: name.into(),
        text: format!("#version 110\n{text}").into(),
        stage,
    };
    let sources = [source("a.vert", vertex, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let program = Compiler::new(Options::default()).compile(&sources).program.expect("it compiles");
    for value in [0.0, 1.0] {
        let mut known = Known::default();
        known.uniforms.insert("k".into(), vec![ScalarValue::Float(value)]);
        let residual = specialize(&program, &known);
        assert!(residual.fault.is_none(), "{:?}", residual.fault);
    }
}

#[test]
fn a_decided_operand_goes_from_either_side() {
    for (condition, wanted) in [
        ("b && w > 0.5", "(b ? "),
        ("w > 0.5 && b", "(b ? "),
        ("b || w < 0.5", "(b ? "),
        ("b == (w > 0.5)", "(b ? "),
        ("(w < 0.5) != b", "(b ? "),
        ("b ^^ (w > 0.5)", "(!b ? "),
        ("b == (w < 0.5)", "(!b ? "),
    ] {
        let left = left_of(&format!("bool b = v.x > 0.1; c *= {condition} ? v.y : v.z; if (b) c += v.xyz;"));
        assert!(left.replace("c *= ", "(").contains(wanted), "{condition}: {left}");
    }
}

/// Parts of variables, parameters and results that nobody reads are not computed.
#[test]
fn what_nobody_reads_goes() {
    for statements in [
        "vec4 s; s.xyz = c; s.w = sin(v.x); c = s.xyz;",
        "vec4 s; s.xyz = c; s.w = 1.0; s.w *= sin(v.x); c = s.xyz;",
        "vec4 s = vec4(c, sin(v.x)); c = s.xyz;",
        "vec4 s; s = vec4(c, sin(v.x)); c = s.xyz * v.w; c += s.xyz;",
        "mat3 m = mat3(sin(c), c, c.zxy); c = m[1] * m[2];",
        "mat2 m = mat2(sin(c.x), sin(c.y), c.xy); c.x = m[1].x;",
        "float k[4]; k[0] = c.y; k[3] = sin(c.y); c.x = k[0];",
        "float k[3] = float[3](c.x, sin(c.y), c.z); c.x = k[0] + k[2];",
        "float a; float b; both(c.x, a, b); c.x = a;",
        "result(c.x); c.y = kept;",
    ] {
        let left = of_functions(statements);
        assert!(!left.contains("sin"), "{statements}: {left}");
    }
    for statements in [
        "vec4 s; s.xyz = c; s.w = sin(v.x); c = s.xyz * s.w;",
        "vec4 s = vec4(c, sin(v.x)); s.x = s.w; c = s.xyz;",
        "vec4 s = vec4(c, sin(v.x)); s = s.wxyz; c = s.xyz;",
        "float k[4]; k[0] = c.y; k[3] = sin(c.y); c.x = k[int(v.x)];",
        "float a; float b; both(c.x, a, b); c.x = b;",
        "float a; float b; both(c.x, a, b); c.x = a; both(c.y, b, a); c.y = a;",
        "float a = c.y; more(a); c.x = a;",
        "mat2 m = mat2(sin(c.x), c.y, c.z, c.x); m = inverse(m); c.x = m[1].x;",
        "float a = sin(c.x); vec2 b = vec2(a, c.y); b.y = dot(b, b); c.x = b.y;",
        "c.x = result(c.x);",
    ] {
        let left = of_functions(statements);
        assert!(left.contains("sin"), "{statements}: {left}");
    }
}

/// What is left of statements that may call functions with several results.
fn of_functions(statements: &str) -> String {
    let fragment = format!(
        "#version 150\nin vec4 v;\nout vec4 color;\nfloat kept;\n\
         void both(float x, out float a, out float b) {{ a = x * v.z; if (v.z > 0.5) a += v.x; b = sin(x); }}\n\
         void more(inout float a) {{ a += sin(v.x); }}\n\
         float result(float x) {{ kept = x * v.z; if (v.z > 0.5) kept += v.x; return sin(x); }}\n\
         void main() {{ vec3 c = v.xyz; {statements} color = vec4(c, 1.0); }}\n"
    );
    residual(&fragment, &[]).text(Stage::Fragment).expect("a stage").to_owned()
}

/// What goes late decides more, until nothing is left to find.
#[test]
fn a_second_run_finds_nothing() {
    let fragment = "#version 150\nin vec4 v;\nuniform int leaf;\nout vec4 color;\nvoid main() {\n\
        float t = 1000.0; int n = 0; bool hit = false;\n\
        while (n < int(v.x)) { if (leaf > 0) { hit = true; } else if (leaf < 0) { t = sin(v.x); }\n\
        if (hit) t = min(t, cos(v.y)); n++; }\n\
        color = t == 1000.0 ? vec4(1.0) : vec4(sin(t)); }\n";
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let program = Compiler::new(Options::default()).compile(&sources).program.expect("it compiles");
    let mut known = Known::default();
    known.uniforms.insert("leaf".into(), vec![ScalarValue::Int(0)]);
    let first = specialize(&program, &known);
    let text = first.text(Stage::Fragment).expect("a stage");
    assert!(text.contains("color = vec4(1.0);") && !text.contains("while"), "{text}");
    assert!(!specialize(&first.program, &known).is_smaller());
}

/// With calls one operand is executed; without them both would be.
#[test]
fn no_call_goes_into_an_operand_that_may_not_be_evaluated() {
    let left = of_functions("c.x = v.x > 0.5 ? result(c.x) : v.y;");
    assert!(left.contains("result("), "{left}");
}

#[test]
fn a_literal_must_not_free_the_driver() {
    // Expression, values of u and w, and the uniforms that stay.
    let cases: &[(&str, f32, f32, &[&str])] = &[
        // A driver may drop what is multiplied by a literal 0.
        ("v.x * u", 0.0, 0.0, &["u"]),
        ("v.x * u", 0.5, 0.0, &[]),
        ("dot(v.xy, vec2(u, w))", 0.0, 1.0, &["u", "w"]),
        ("dot(v.xy, vec2(u, w))", 2.0, 1.0, &[]),
        ("mix(v.x, v.y, u)", 1.0, 0.0, &["u"]),
        ("pow(v.x, u)", 2.0, 0.0, &["u"]),
        ("pow(abs(v.x), u)", 2.0, 0.0, &[]),
        ("u / v.x", 0.0, 0.0, &["u"]),
        ("v.x / u", 0.0, 0.0, &["u"]),
        ("v.x / u", 4.0, 0.0, &[]),
        // Constants that may be joined: beyond the greatest float one way, within it the other.
        ("(v.x * u) * w", 1e30, 1e-30, &["w"]),
        ("(v.x * u) * w", 0.5, 0.25, &[]),
        ("(v.x + u) + w", 3e38, -3e38, &["u", "w"]),
        ("(v.x + u) + w", 3.0, -2.0, &[]),
        // What is bounded may be multiplied by anything.
        ("clamp(gl_FragCoord.x, 0.0, 1.0) * u", 0.5, 0.0, &[]),
        ("1.0 / u", 0.0, 0.0, &["u"]),
        // `fma` is a product and a sum.
        ("fma(v.x, u, v.y)", 0.0, 0.0, &["u"]),
        ("fma(v.x, u, v.y)", 0.5, 0.0, &[]),
        ("fma(v.x, v.y, u)", 0.0, 0.0, &["u"]),
        ("fma(v.x, v.y, u)", 0.5, 0.0, &[]),
        ("fma(v.x, u, -v.x)", 1.0, 0.0, &["u"]),
        // A component of 0 is NaN where the others leave nothing to divide by.
        ("normalize(vec2(v.x, u)).y", 0.0, 0.0, &["u"]),
        ("normalize(vec3(clamp(gl_FragCoord.xy, 0.0, 1.0), u)).y", 1.0, 0.0, &[]),
        ("reflect(v.xy, vec2(u, w)).x", 0.0, 1.0, &["u", "w"]),
        ("faceforward(v.xy, vec2(u, w), v.zw).x", 0.0, 1.0, &["u", "w"]),
        ("clamp(u, v.x, v.y)", 0.0, 0.0, &["u"]),
        // What a driver finds to be 0 through other functions.
        ("sqrt(clamp(gl_FragCoord.x, 0.0, 1.0) * u) * v.x", 0.0, 0.0, &["u"]),
        ("dot(clamp(gl_FragCoord.xy, 0.0, 1.0), vec2(u)) * v.x", 0.0, 0.0, &["u"]),
        ("(clamp(gl_FragCoord.x, 0.0, 1.0) * u + w) * v.x", 0.0, 0.0, &["u", "w"]),
        ("float(bitfieldExtract(int(v.x), int(u), 8))", 30.0, 0.0, &["u"]),
        ("float(bitfieldExtract(int(v.x), int(u), 8))", 8.0, 0.0, &[]),
        ("sqrt(u)", -1.0, 0.0, &["u"]),
        ("sqrt(u)", 2.0, 0.0, &[]),
    ];
    for (expression, u, w, stays) in cases {
        let text = of(expression, *u, *w);
        for name in ["u", "w"] {
            let declared = text.contains(&format!("uniform float {name};"));
            assert_eq!(declared, stays.contains(&name), "`{name}` in `{expression}` by {u}, {w}:\n{text}");
        }
    }
}

/// The result of a function of numbers, by its row in the table.
fn computed(function: BuiltinFunction, arguments: &[f64]) -> Option<f64> {
    let ternary = |op: Ternary| Some(op.of(*arguments.first()?, *arguments.get(1)?, *arguments.get(2)?));
    let binary = |op: Binary| Some(op.of(*arguments.first()?, *arguments.get(1)?));
    match function.class() {
        Class::Binary(op) => binary(op),
        Class::Ternary(op) => ternary(op),
        Class::Numbers(Numbers::Atan) => binary(Binary::Atan2),
        Class::Numbers(Numbers::Min) => binary(Binary::Min),
        Class::Numbers(Numbers::Max) => binary(Binary::Max),
        Class::Numbers(Numbers::Clamp) => ternary(Ternary::Clamp),
        Class::Numbers(Numbers::Mix) => ternary(Ternary::Mix),
        _ => None,
    }
}

/// Of every function of the table: where it forgets an argument that is finite, and not one that is not, what makes it forget
/// stays in its uniform.
#[test]
fn no_function_forgets_what_may_be_nan() {
    let finite = [0.3, 0.7, 1.9, -2.5, 1e6, -1e6];
    let other = [f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    let (mut wrong, mut n_checked) = (Vec::new(), 0);
    for function in BuiltinFunction::ALL {
        let Some(arity) = (2..=3).find(|arity| computed(*function, &[0.5, 0.5, 0.5][..*arity]).is_some()) else {
            continue;
        };
        for mask in 1..(1u32 << arity) - 1 {
            for value in [0.0, 1.0, -1.0, 2.0] {
                let result = |unknown: [f64; 2]| {
                    let mut unknown = unknown.into_iter();
                    let one = |index: u32| if mask >> index & 1 == 1 { value } else { unknown.next().unwrap_or(0.5) };
                    let arguments: Vec<f64> = (0..arity as u32).map(one).collect();
                    computed(*function, &arguments).map(f64::to_bits)
                };
                let first = result([finite[0], finite[1]]);
                let forgets = finite.iter().all(|x| finite.iter().all(|y| result([*x, *y]) == first));
                let remembers = other.iter().any(|x| result([*x, 0.5]) != first || result([0.5, *x]) != first);
                if !forgets || !remembers {
                    continue;
                }
                let mut unknown = ["v.x", "v.y"].into_iter();
                let one = |index: u32| if mask >> index & 1 == 1 { "u" } else { unknown.next().unwrap_or("v.z") };
                let call =
                    format!("{}({})", function.name(), (0..arity as u32).map(one).collect::<Vec<_>>().join(", "));
                n_checked += 1;
                if !of(&call, value as f32, 0.0).contains("uniform float u;") {
                    wrong.push(format!("{call} by {value}"));
                }
            }
        }
    }
    assert!(wrong.is_empty() && n_checked >= 5, "{n_checked}: {wrong:?}");
}

/// What cancels may be infinite: a driver that sees one expression twice makes 0 of the difference.
#[test]
fn what_becomes_one_expression_stays_apart() {
    let cases: &[(&str, f32, f32, &[&str])] = &[
        ("v.x - v.x * u", 1.0, 0.0, &["u"]),
        ("v.x * u - v.x * w", 2.0, 2.0, &["u", "w"]),
        ("v.x * u - v.x * w", 2.0, 3.0, &[]),
        ("(v.x * u) / v.x", 1.0, 0.0, &["u"]),
        ("-v.x + v.x * u", 1.0, 0.0, &["u"]),
        ("v.x - (v.x - u)", 0.0, 0.0, &["u"]),
        ("distance(v.xy, v.xy * u)", 1.0, 0.0, &["u"]),
        ("mod(v.x, v.x * u)", 1.0, 0.0, &["u"]),
        ("float(v.x <= v.x * u)", 1.0, 0.0, &["u"]),
        ("max(v.x, v.x * u)", 1.0, 0.0, &[]),
        // What the original says twice is its own affair, and what is bounded is never infinite.
        ("v.x * u - v.x * u", 1.0, 0.0, &[]),
        ("step(0.5, v.x) - step(0.5, v.x) * u", 1.0, 0.0, &[]),
    ];
    for (expression, u, w, stays) in cases {
        let text = of(expression, *u, *w);
        for name in ["u", "w"] {
            let declared = text.contains(&format!("uniform float {name};"));
            assert_eq!(declared, stays.contains(&name), "`{name}` in `{expression}` by {u}, {w}:\n{text}");
        }
    }
    // The same through a variable.
    let text = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n\
        void main() { vec4 a = v * u; color = v - a; }\n";
    let left = residual(text, &[("u", &[1.0])]).text(Stage::Fragment).expect("a stage").to_owned();
    assert!(left.contains("uniform float u;"), "{left}");
}

#[test]
fn what_is_known_is_folded_as_the_reference_computes_it() {
    assert!(of("v.x + u * w", 0.25, 8.0).contains("v.x + 2.0"));
    assert!(of("v.x + u / w", 1.0, 3.0).contains("v.x + 0.33333334"));
    assert!(of("v.x + sin(u)", 1.0, 3.0).contains("v.x + 0.84147096"));
    assert!(of("v.x + fract(sin(dot(vec2(u, w), vec2(12.9898, 78.233))) * 43758.547)", 1.0, 3.0).contains("v.x + 0."));
    // What is not finite or too small stays the target's.
    assert!(of("v.x + u / w", 1.0, 0.0).contains(" / "));
    assert!(of("v.x + exp(u)", -200.0, 0.0).contains("exp("));
    // Of a vector of which a part is known that part is folded.
    let text = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n\
        void main() { vec2 a = sin(vec2(u, v.x)); color = vec4(a.x, a.x, a.x, 1.0); }\n";
    let left = residual(text, &[("u", &[1.0])]).text(Stage::Fragment).expect("a stage").to_owned();
    assert!(left.contains("0.84147096") && !left.contains("sin"), "{left}");
    // x + 0.0 is no x where x may be -0, x - 0.0 is.
    assert!(of("v.x + u", 0.0, 0.0).contains("v.x + 0.0"));
    assert!(!of("v.x - u", 0.0, 0.0).contains("0.0"));
    assert!(!of("v.x * u", 1.0, 0.0).contains("1.0"));
}

#[test]
fn a_decided_branch_goes_and_its_effects_stay() {
    let fragment = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\nfloat count = 0.0;\n\
        bool more() { count += v.x; return true; }\n\
        void main() { if (more() && u > 1.0) discard; color = u < 1.0 ? vec4(count) : vec4(0.0, 0.0, 0.0, v.y); }\n";
    let text = residual(fragment, &[("u", &[0.5])]).text(Stage::Fragment).expect("a stage").to_owned();
    assert!(text.contains("count") && text.contains("more()") && !text.contains("discard"), "{text}");
    let text = residual(fragment, &[("u", &[2.0])]).text(Stage::Fragment).expect("a stage").to_owned();
    assert!(text.contains("discard"), "{text}");
}

#[test]
fn a_varying_that_is_the_same_everywhere_is_known_across_the_stages() {
    let fragment = "#version 150\nin vec4 v;\nout vec4 color;\n\
        void main() { if (v.w > 2.0) discard; color = vec4(v.xyz, 1.0); }\n";
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let program = Compiler::new(Options::default()).compile(&sources).program.expect("a program");
    let mut known = Known::default();
    let one = Input::Value(ScalarValue::Float(0.5));
    known.attributes.insert("q".into(), vec![one, one, one, one]);
    let residual = specialize(&program, &known);
    assert!(
        residual
            .text(Stage::Fragment)
            .is_some_and(|text| text.contains("vec4(0.5, 0.5, 0.5, 1.0)") || text.contains("vec4(vec3(0.5), 1.0)")),
        "{residual:?}"
    );
    assert!(residual.program.interface.varyings.is_empty() && residual.program.interface.attributes.len() == 1);
    assert!(residual.left_out.iter().any(|one| one.what.name() == "varying"));
}

/// Depth is rounded, so that a comparison far from it is decided, and no other; 1 / 1 is 1.
#[test]
fn the_depth_that_all_vertices_have_decides_what_it_can() {
    let left = |body: &str, framebuffer: Option<[u32; 2]>| {
        let vertex = "#version 150\nin vec2 p;\nvoid main() { gl_Position = vec4(p, 0.0, 1.0); }\n";
        let fragment = format!("#version 150\nout vec4 color;\nvoid main() {{ color = vec4({body}); }}\n");
        let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
        let sources = [source("a.vert", vertex, Stage::Vertex), source("a.frag", &fragment, Stage::Fragment)];
        let program = Compiler::new(Options::default()).compile(&sources).program.expect("it compiles");
        let mut known = Known::default();
        known.state.framebuffer = framebuffer;
        specialize(&program, &known).text(Stage::Fragment).expect("a stage").to_owned()
    };
    for decided in
        ["gl_FragCoord.z > 0.6 ? 1.0 : 0.5", "gl_FragCoord.w < 0.5", "gl_FragCoord.w * 3.0", "gl_FragCoord.z < 0.4"]
    {
        let text = left(decided, Some([16, 16]));
        assert!(!text.contains("gl_FragCoord"), "{decided}: {text}");
        let text = left(decided, None);
        assert!(text.contains("gl_FragCoord"), "whoever draws may have another range of depths: {text}");
    }
    for open in ["gl_FragCoord.z > 0.5", "gl_FragCoord.z", "gl_FragCoord.z == 0.5"] {
        let text = left(open, Some([16, 16]));
        assert!(text.contains("gl_FragCoord.z"), "{open}: {text}");
    }
}

#[test]
fn a_loop_that_stays_counts_what_it_counts() {
    const WORK: &str = "c += sin(c * 3.0 + c.yzx); c *= cos(c);";
    let kept = |body: &str| left_of(&format!("{body} c /= float(k);"));
    for (body, count) in [
        (format!("int k = 0; for (int i = 0; i < 100; i++) {{ {WORK} k++; }}"), "100.0"),
        (
            format!("int k = 5; for (int i = 0; i < 70; i++) for (int j = -1; j <= 1; ++j) {{ {WORK} k += 2; }}"),
            "425.0",
        ),
        (format!("int k = 0; for (; k < 90; k++) {{ {WORK} }}"), "90.0"),
    ] {
        let text = kept(&body);
        assert!(text.contains("for (") && text.contains(count) && !text.contains("float("), "{body}: {text}");
    }
    for body in [
        format!("int k = 1; for (int i = 0; i < 100; i++) {{ {WORK} if (c.x > 0.5) k++; }}"),
        format!("int k = 1; for (int i = 0; i < 100; i++) {{ {WORK} if (c.x > 0.5) break; k++; }}"),
        format!("int k = 1; for (int i = 0; i < 100; i++) {{ {WORK} k++; k *= 2; }}"),
        format!("int k = 1; for (int i = 0; i < 100; i++) {{ {WORK} k++; i += int(c.x); }}"),
    ] {
        let text = kept(&body);
        assert!(text.contains("float(k"), "{body}: {text}");
    }
}

#[test]
fn hostile_programs_come_back() {
    let time = |what: &str, fragment: &str, known: &[(&str, &[f32])]| {
        let start = Instant::now();
        residual(fragment, known);
        // This catches what runs away, not what is slow: a build without optimization on a busy machine is given time.
        assert!(start.elapsed() < Duration::from_secs(120), "{what}: {:?}", start.elapsed());
    };
    let head = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n";
    let endless = format!(
        "{head}void main() {{ float s = 0.0; for (int i = 0; i < 2147483647; ++i) {{ s += u; if (s > v.x) break; }} \
         for (int i = 0; i < 1000; ++i) for (int j = 0; j < 1000; ++j) for (int k = 0; k < 1000; ++k) s *= u; color = vec4(s); }}\n"
    );
    time("a loop to 2^31", &endless, &[("u", &[1.5])]);
    let calls: String = (0..40)
        .map(|n| {
            let next = if n == 0 { "x * u".to_owned() } else { format!("f{}(x) + f{}(x + u)", n - 1, n - 1) };
            format!("float f{n}(float x) {{ return {next}; }}\n")
        })
        .collect();
    time("calls that double", &format!("{head}{calls}void main() {{ color = vec4(f39(v.x)); }}\n"), &[("u", &[1.5])]);
    let lines: String = (0..10_000).map(|n| format!("    float x{n} = v.x * {n}.5 + u;\n    s += x{n};\n")).collect();
    time(
        "10,000 lines",
        &format!("{head}void main() {{\n    float s = 0.0;\n{lines}    color = vec4(s);\n}}\n"),
        &[("u", &[1.5])],
    );
    let branches: String =
        (0..3_000).map(|n| format!("    if (v.x > {n}.0) {{ s += u; }} else {{ t -= s; }}\n")).collect();
    let branches =
        format!("{head}void main() {{\n    float s = 0.0, t = 0.0;\n{branches}    color = vec4(s, t, s, t);\n}}\n");
    time("3,000 branches", &branches, &[("u", &[1.5])]);
}

/// The number of expressions of all stages.
fn size(program: &glisten_front::Program) -> usize {
    program.stages.iter().map(|shader| shader.exprs.len()).sum()
}

/// Twice the program makes at most twice the residual and a constant more, whatever is written out and cloned.
#[test]
fn residuals_grow_as_programs_do() {
    let of = |functions: usize| {
        let bodies: String = (0..functions)
            .map(|n| {
                format!(
                    "float f{n}(float x, int k) {{ float s = x; for (int i = 0; i < 4; ++i) {{ if (k == i) s += u * {n}.5; \
                     else s *= x; }} return s; }}\n"
                )
            })
            .collect();
        let calls: String =
            (0..functions).map(|n| format!("    s += f{n}(v.x, {}) + f{n}(v.y, {});\n", n % 4, n % 3)).collect();
        let head = "#version 150\nin vec4 v;\nuniform float u;\nout vec4 color;\n";
        let text = format!("{head}{bodies}void main() {{\n    float s = 0.0;\n{calls}    color = vec4(s);\n}}\n");
        size(&residual(&text, &[("u", &[1.5])]).program)
    };
    let [one, two, four] = [100, 200, 400].map(of);
    assert!(two * 10 <= one * 21 + 40_000 && four * 10 <= two * 21 + 40_000, "{one}, {two}, {four}");
}

#[test]
fn lights_by_the_hundred_come_back_and_stay_short() {
    let text = "#version 150\nstruct Light { float kind; vec3 towards; vec3 color; };\nin vec4 v;\nout vec4 color;\n\
        uniform Light lights[256];\nuniform float count;\nvoid main() { vec3 sum = vec3(0.0);\n\
        for (int i = 0; i < int(count); ++i) { if (lights[i].kind > 1.0) continue;\n\
        sum += max(dot(v.xyz, lights[i].towards), 0.0) * lights[i].color; } color = vec4(sum, 1.0); }\n";
    let names: Vec<[String; 3]> =
        (0..256).map(|n| ["kind", "towards", "color"].map(|member| format!("lights[{n}].{member}"))).collect();
    let mut known: Vec<(&str, &[f32])> = vec![("count", &[256.0])];
    for (n, [kind, towards, color]) in names.iter().enumerate() {
        known.extend([
            (kind.as_str(), if n % 3 == 2 { &[2.0][..] } else { &[0.0][..] }),
            (towards.as_str(), &[0.5, 0.25, 0.75][..]),
            (color.as_str(), &[0.5, 0.5, 0.5][..]),
        ]);
    }
    let start = Instant::now();
    let left = residual(text, &known);
    assert!(start.elapsed() < Duration::from_secs(120), "{:?}", start.elapsed());
    // Written out or not: not much longer than what 256 lights are.
    let length = left.text(Stage::Fragment).map_or(0, |text| text.lines().count());
    assert!(length < 256 * 5, "{length} lines");
}

/// Of an expression whose value nobody reads, what its operands do stays, from left to right, and nothing else.
#[test]
fn effects_stay_without_the_arithmetic_around_them() {
    let fragment = "#version 150\nin vec4 v;\nout vec4 color;\nfloat n = 0.0;\n\
        float a() { if (v.x < 0.5) discard; n += v.y; return n; }\nfloat b() { n *= v.z; return n; }\n\
        void main() { float z = (a() * v.w + sin(v.x)) / vec2(v.y, b()).y; color = vec4(n); }\n";
    let text = residual(fragment, &[]).text(Stage::Fragment).expect("a stage").to_owned();
    let (first, second) = (text.find("    a();"), text.find("    b();"));
    assert!(first.is_some() && first < second, "{text}");
    assert!(!text.contains("sin(") && !text.contains("v.w") && !text.contains('/'), "{text}");
}

/// The account tells why a function is gone, by what was decided in it, and of conditions that rounds decide differently.
#[test]
fn what_is_decided_in_functions_and_rounds_is_told() {
    let fragment = "#version 150\nin vec4 v;\nuniform float op;\nuniform float k[2];\nout vec4 color;\n\
        float tone(float c) {\n    if (op == 0.0) return c;\n    return c / (1.0 + c);\n}\n\
        void main() {\n    float s = tone(v.x);\n    for (int i = 0; i < 2; i++)\n        s += k[i] == 0.0 ? v.y : v.z;\n    color = vec4(s);\n}\n";
    let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
    let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
    let compiled = Compiler::new(Options::default()).compile(&sources);
    let program = compiled.program.expect("it compiles");
    let mut known = Known::default();
    known.uniforms.insert("op".into(), vec![ScalarValue::Float(0.0)]);
    known.uniforms.insert("k".into(), [0.0, 1.0].map(ScalarValue::Float).to_vec());
    let options = glisten_specialize::Options { sources: Some(&compiled.sources), ..Default::default() };
    let told: Vec<String> = specialize_with(&program, &known, &options)
        .left_out
        .iter()
        .map(|one| format!("{}: {}", one.name, one.because))
        .collect();
    let has = |text: &str| told.iter().any(|one| one == text);
    assert!(has("tone: no call of it is left; `op == 0.0` is true: `op` is 0.0"), "{told:#?}");
    assert!(
        has(
            "k[i] == 0.0 ? ..: `k[i] == 0.0` is known: true in some calls or rounds, false in others: `k[0]` is 0.0, `k[1]` is 1.0"
        ),
        "{told:#?}"
    );
}
