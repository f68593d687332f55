//! The table of the textbook's equations in f32: each as printed, next to the library's form.
//!
//! *In:* `glisten stability --library`. *Out:* Markdown. *Holds:* figures come from the examination; only the column that says
//! where an equation breaks is written here.

use glisten_stability::library::{FunctionFound, LibraryOptions, Verdict, examine_library};
use std::fmt::Write;

/// The calls of each function.
const CASES: usize = 1024;

/// An equation, the function that computes it, and where the printed form breaks.
static EQUATIONS: &[(&str, &str, &str)] = &[
    ("(82)", "lambertUnclamped(vec3,vec3,vec3,vec3)", "nowhere, for unit vectors"),
    ("(83)", "lambertFactor(vec3,vec3)", "nowhere; the sign of a grazing N.L is that of its rounding"),
    ("(84)", "mirrorDirection(vec3,vec3)", "nowhere"),
    (
        "(86)",
        "phongFactor(vec3,vec3,vec3,float)",
        "large exponents multiply the rounding of R.V near 1, which may exceed 1; 0^0",
    ),
    ("(87)", "halfVector(vec3,vec3)", "L = -V is 0 / 0"),
    ("(89)", "blinnPhongFactor(vec3,vec3,vec3,float)", "as (86), and L = -V"),
    ("(90)", "schlick(float,float)", "t = K = 0 is 0 / 0; between vectors K - t K cancels near t = 1"),
    (
        "(90)",
        "schlickBetween(vec3,vec3,float)",
        "t above 1 by rounding, times K; the pole at t = -K / (1 - K) for t below 0",
    ),
    (
        "(91)",
        "thresholdStep(float,float)",
        "-1 at c = 0, t = 1, where the ceiling of -1 is printed and a step is meant",
    ),
    ("(91)", "thresholdFactor(vec3,vec3,vec3,float)", "2 where rounding makes N.H larger than 1 and t = 0; L = -V"),
    ("(94)", "lightDistance(vec3,vec3)", "the square overflows from 1.8e19 on, and vanishes below 1.1e-19"),
    ("(95)", "attenuationInverseSquare(float)", "r = 0 is 1 / 0, and so is every r whose square vanishes"),
    ("(96)", "attenuation(float,vec3)", "0 times infinity for a zero weight where the square overflows"),
    ("(97)", "illumination(vec3,vec3,vec3,float)", "nowhere"),
    ("(98)", "spotFactor(vec3,vec3,float)", "as (86)"),
    ("(99)", "illumination(vec3,vec3,vec3,float,float)", "nowhere"),
    ("(105)", "barycentric(vec2,vec2,vec2,vec2)", "a triangle without area is 0 / 0; slivers cancel in both forms"),
    ("(106)", "interpolateLinear(vec2,vec4,vec4,vec4)", "nowhere"),
    ("(107)", "segmentPoint(float,vec2,vec2)", "nowhere, for z > 0"),
    ("(108)", "interpolatePerspective(vec2,vec3,vec4,vec4,vec4)", "nowhere, for w from 1e-30 to 1e30"),
    ("N'", "normalMatrix(mat4)", "a singular matrix has no inverse"),
    ("N'", "transformNormal(mat3,vec3)", "normals whose squared length overflows or vanishes"),
    (
        "hemisphere",
        "hemisphere(vec3,vec3,vec3,vec3)",
        "near a pole, the weight of the other half is a difference that cancels",
    ),
];

/// The table.
pub(crate) fn equations() -> Result<String, String> {
    let mut options = LibraryOptions { cases: CASES, only: None, progress: &mut |_, _, _| {} };
    let found = examine_library(&mut options).map_err(|error| error.message)?;
    let mut text =
        "| equation | function | as printed: verdict | error | not finite | results | library: error | operations | \
        where the printed form breaks |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n"
            .to_owned();
    for (equation, signature, place) in EQUATIONS {
        let function = found.iter().find(|found| found.signature == *signature);
        let row = function.and_then(row).ok_or_else(|| format!("`{signature}` has no naive form"))?;
        let _ = writeln!(text, "| {equation} | {row} | {place} |");
    }
    Ok(text)
}

fn row(function: &FunctionFound) -> Option<String> {
    let naive = function.naive.as_ref()?;
    let verdict = match naive.verdict {
        Verdict::Stable => "stable",
        Verdict::Degraded => "degraded",
        Verdict::Broken => "broken",
    };
    let figures = &naive.figures;
    let finite = match (figures.non_finite, naive.undefined) {
        (0, _) => "0".to_owned(),
        (count, 0) => format!("{count}"),
        (count, undefined) => format!("{count}, of which {undefined} have no value"),
    };
    let [low, high] = naive.range.map(shown);
    let cost = function.cost.map_or_else(|| "-".to_owned(), |cost| format!("{cost:.1} times"));
    Some(format!(
        "`{}` | {verdict} | {} | {finite} | {low} to {high} | {} | {cost}",
        function.function,
        digit(figures.unexplained),
        digit(function.figures.unexplained)
    ))
}

/// An error, to one digit.
fn digit(error: f64) -> String {
    if error < 1e-12 { "0".to_owned() } else { format!("{error:.0e}") }
}

/// A result, to the digits that show whether it is out of range.
fn shown(number: f64) -> String {
    match number.abs() {
        size if size == size.round() && size < 1e5 => format!("{number}"),
        size if size < 1e4 => format!("{number:.3}"),
        _ => format!("{number:.1e}"),
    }
}
