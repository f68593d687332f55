//! Each built-in function against an independent computation, in f64 and in f32.

use super::text::run_in;
use crate::domain::{F32, F64};

const EDGES: [f64; 16] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    2.0,
    -2.5,
    0.75,
    1e-6,
    -100.25,
    3.0e6,
    1.5,
    -1.5,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
];

type One = fn(f64) -> f64;
type Two = fn(f64, f64) -> f64;

fn close(a: f64, b: f64) -> bool {
    (a.is_nan() && b.is_nan()) || a == b || (a - b).abs() <= 4.0 * f64::EPSILON * b.abs()
}

/// The argument of a lane as both domains see it.
fn argument(lane: usize) -> f64 {
    f64::from(EDGES[lane % 16] as f32)
}

fn second(lane: usize) -> f64 {
    f64::from(EDGES[(lane / 16 * 5 + lane) % 16] as f32)
}

fn input(name: &str, lane: usize) -> f64 {
    if name == "a" { argument(lane) } else { second(lane) }
}

/// Checks `o.x` of a program of `a` and `b`: f64 to a few roundings, f32 to the single one at the end.
fn check(expression: &str, expected: impl Fn(f64, f64) -> f64) {
    let body = format!("in float a, b; void main() {{ o = vec4({expression}) + 0.0 * 0.0; }}");
    let (wide, single) = (run_in::<F64>(&body, input), run_in::<F32>(&body, input));
    for lane in 0..64 {
        let (a, b) = (argument(lane), second(lane));
        let expected = expected(a, b);
        assert!(close(wide[lane][0], expected), "{expression} of {a}, {b}: {} for {expected}", wide[lane][0]);
        let rounded = f64::from(expected as f32);
        let neighbor =
            (f64::from(single[lane][0] as f32) - rounded).abs() <= f64::from(f32::EPSILON) * rounded.abs() * 0.51;
        let same = single[lane][0] == rounded || (single[lane][0].is_nan() && rounded.is_nan());
        assert!(same || neighbor, "f32 {expression} of {a}, {b}: {} for {rounded}", single[lane][0]);
    }
}

#[test]
fn functions_of_one_float() {
    let rows: [(&str, One); 29] = [
        ("radians(a)", |a| a * std::f64::consts::PI / 180.0),
        ("degrees(a)", |a| a / std::f64::consts::PI * 180.0),
        ("sin(a)", f64::sin),
        ("cos(a)", f64::cos),
        ("tan(a)", f64::tan),
        ("asin(a)", f64::asin),
        ("acos(a)", f64::acos),
        ("atan(a)", f64::atan),
        ("sinh(a)", f64::sinh),
        ("cosh(a)", f64::cosh),
        ("tanh(a)", f64::tanh),
        ("asinh(a)", f64::asinh),
        ("acosh(a)", f64::acosh),
        ("atanh(a)", f64::atanh),
        ("exp(a)", f64::exp),
        ("log(a)", f64::ln),
        ("exp2(a)", f64::exp2),
        ("log2(a)", f64::log2),
        ("sqrt(a)", f64::sqrt),
        ("inversesqrt(a)", |a| 1.0 / a.sqrt()),
        ("abs(a)", f64::abs),
        ("sign(a)", |a| if a.is_nan() || a == 0.0 { 0.0 } else { a.signum() }),
        ("floor(a)", f64::floor),
        ("ceil(a)", f64::ceil),
        ("trunc(a)", f64::trunc),
        ("roundEven(a)", f64::round_ties_even),
        ("fract(a)", |a| a - a.floor()),
        ("float(isnan(a))", |a| f64::from(u8::from(a.is_nan()))),
        ("float(isinf(a))", |a| f64::from(u8::from(a.is_infinite()))),
    ];
    for (expression, expected) in rows {
        check(expression, |a, _| expected(a));
    }
}

#[test]
fn functions_of_two_floats() {
    let rows: [(&str, Two); 9] = [
        ("atan(a, b)", f64::atan2),
        ("pow(a, b)", |a, b| if a < 0.0 { f64::NAN } else { a.powf(b) }),
        ("mod(a, b)", |a, b| a - b * (a / b).floor()),
        ("min(a, b)", f64::min),
        ("max(a, b)", f64::max),
        ("step(a, b)", |a, b| if b < a { 0.0 } else { 1.0 }),
        ("clamp(a, -1.0, b)", |a, b| a.max(-1.0).min(b)),
        ("mix(a, b, 0.25)", |a, b| a * 0.75 + b * 0.25),
        ("smoothstep(0.0, 2.0, a)", |a, _| {
            // `clamp` of a NaN is 0 here and NaN there.
            let t = match a / 2.0 {
                t if t >= 1.0 => 1.0,
                t if t > 0.0 => t,
                _ => 0.0,
            };
            t * t * (3.0 - 2.0 * t)
        }),
    ];
    for (expression, expected) in rows {
        check(expression, expected);
    }
}

/// `(a, a + 1, a + 2)` and `(b, b + 1, b + 2)`, as the harness fills vectors.
fn vectors(name: &str, lane: usize) -> f64 {
    let base = [0.0, 1.0, -2.0, 0.5][lane % 4];
    if name == "a" { base } else { base * 0.5 - 1.0 }
}

fn check_vector(expression: &str, expected: impl Fn([f64; 3], [f64; 3]) -> [f64; 4]) {
    let body = format!("in vec3 a, b; void main() {{ o = vec4({expression}); }}");
    for (name, lanes, slack) in
        [("f64", run_in::<F64>(&body, vectors), 1e-14), ("f32", run_in::<F32>(&body, vectors), 1.2e-7)]
    {
        for (lane, found) in lanes.iter().enumerate().take(4) {
            let at = |name: &str| std::array::from_fn(|k| vectors(name, lane) + k as f64);
            for (found, wanted) in found.iter().zip(expected(at("a"), at("b"))) {
                let fine =
                    (found - wanted).abs() <= slack * wanted.abs().max(1.0) || (found.is_nan() && wanted.is_nan());
                assert!(fine, "{name} {expression}, lane {lane}: {found} for {wanted}");
            }
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn functions_of_vectors() {
    let with = |v: [f64; 3], w: f64| [v[0], v[1], v[2], w];
    check_vector("normalize(a), length(b)", |a, b| {
        let length = dot(a, a).sqrt();
        with(a.map(|x| x / length), dot(b, b).sqrt())
    });
    check_vector("cross(a, b), dot(a, b)", |a, b| {
        with([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dot(a, b))
    });
    check_vector("reflect(a, b), distance(a, b)", |a, b| {
        let gap: [f64; 3] = std::array::from_fn(|k| a[k] - b[k]);
        with(std::array::from_fn(|k| a[k] - 2.0 * dot(a, b) * b[k]), dot(gap, gap).sqrt())
    });
    check_vector("faceforward(a, b, a), 1.0", |a, b| {
        let sign = if dot(a, b) < 0.0 { 1.0 } else { -1.0 };
        with(a.map(|x| x * sign), 1.0)
    });
    check_vector("refract(a, b, 0.1), 1.0", |a, b| {
        let (eta, cosine) = (f64::from(0.1f32), dot(a, b));
        let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
        let bent = std::array::from_fn(|i| if k < 0.0 { 0.0 } else { eta * a[i] - (eta * cosine + k.sqrt()) * b[i] });
        with(bent, 1.0)
    });
}

#[test]
fn inverse_and_determinant() {
    for size in 2..=4 {
        // Diagonally dominant, so that it has an inverse.
        let columns: Vec<String> = (0..size * size)
            .map(|k| if k % (size + 1) == 0 { "9.0 + a".into() } else { format!("{}.0 - b", k % 3) })
            .collect();
        let matrix = format!("mat{size}({})", columns.join(", "));
        let body = format!(
            "in float a, b; void main() {{ mat{size} m = {matrix}; mat{size} i = m * inverse(m); float off = 0.0; \
             for (int c = 0; c < {size}; c++) for (int r = 0; r < {size}; r++) off += abs(i[c][r] - float(c == r)); \
             o = vec4(off, determinant(m) * determinant(inverse(m)), 0.0, 0.0); }}"
        );
        for lane in run_in::<F64>(&body, |name, lane| if name == "a" { lane as f64 } else { 0.5 }) {
            assert!(lane[0] < 1e-13 && (lane[1] - 1.0).abs() < 1e-13, "{size}: {lane:?}");
        }
    }
}

#[test]
fn integers_wrap_and_division_by_zero_is_defined() {
    let body = "in float a; void main() { int i = int(a); uint u = uint(3); int z = i - i; \
                o = vec4(float((2147483647 + i) == -2147483648), float(i / z), float(u % uint(z) == 0xffffffffu), \
                float((-7 >> i) * 100 + (1 << (i + 32)))); }";
    assert_eq!(run_in::<F64>(body, |_, _| 1.0)[0], [1.0, -1.0, 1.0, -398.0]);
}
