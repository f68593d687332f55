//! [`advice`]: what to write instead of an unstable expression.
//!
//! *In:* a cause, and the typed expression at its place. *Out:* a help text, which names the library's function where it has
//! one. *Holds:* an ill-posed cause says so, because no rewriting of the expression helps.

use super::forms;
use super::patterns::{self, Found, Pattern};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{ExprKind, Shader, same_value};
use glisten_reference::stability::{Cause, CauseKind};
use glisten_scene::Scene;

/// The help for a cause.
pub(super) fn advice(scene: &Scene, cause: &Cause) -> String {
    if cause.ill_posed && !cause.equality {
        return if cause.kind.is_decision() { ILL_POSED } else { ILL_POSED_LOOP }.to_owned();
    }
    let in_draw = scene.draws.iter().find_map(|draw| {
        let shader = draw.program.stage(cause.stage)?;
        patterns::at(&draw.program.types, shader, cause.span).map(|found| (shader, found))
    });
    if let (Some(_), Some((shader, found))) = (cause.undefined, in_draw)
        && let Some(text) = of_undefined(shader, found)
    {
        return text.to_owned();
    }
    if let Some((shader, found)) = in_draw
        && let Some(form) = forms::around(shader, found.expr)
    {
        return form.advice().to_owned();
    }
    let text = match (cause.kind, in_draw) {
        (CauseKind::Comparison, _) if cause.equality => EQUALITY,
        (CauseKind::Accumulation, Some((shader, found))) if !adds(shader, found) => FEEDBACK,
        (kind, Some((shader, found))) => of_pattern(kind, shader, found).unwrap_or_else(|| of_kind(kind)),
        (kind, None) => of_kind(kind),
    };
    text.to_owned()
}

const ILL_POSED: &str = "the problem is ill-posed here: the exact result itself jumps when an input moves by one rounding, so no \
    rewriting of this expression helps. Move the threshold away from the values that occur, make the step soft \
    (`smoothstep`), or compute with integers";

const ILL_POSED_LOOP: &str = "the problem is ill-posed here: the loop magnifies every difference, so the exact result itself changes as much when an \
    input moves by one rounding, and no rewriting of this expression helps. An explicit method with steps beyond its limit does so: take \
    smaller steps or an implicit method; of chaos, use fewer iterations or only what all of them have in common, such as a mean";

const EQUALITY: &str = "do not compare computed floats with `==`: use `abs(a - b) <= tolerance`, with a tolerance of some roundings of \
    the operands, or carry an integer";

const FEEDBACK: &str = "each iteration feeds the rounding of the last one back: use fewer iterations, a recurrence that runs the stable way, \
    or a closed form";

/// Whether an expression adds to a sum.
fn adds(shader: &Shader, found: Found) -> bool {
    use glisten_front::hir::BinaryOp::{Add, Sub};
    matches!(shader.expr(found.expr).kind, ExprKind::Binary(Add | Sub, ..) | ExprKind::Assign(Some(Add | Sub), ..))
}

/// Whether a number is too large or too small for f32 on the way.
fn leaves_range(kind: CauseKind) -> bool {
    matches!(kind, CauseKind::Overflow | CauseKind::Underflow)
}

/// Whether a function of two arguments has one value for both.
fn is_squared(shader: &Shader, found: Found) -> bool {
    match &shader.expr(found.expr).kind {
        ExprKind::BuiltinCall(_, list) => matches!(list.as_slice(), [a, b] if same_value(shader, *a, *b)),
        _ => false,
    }
}

/// Whether the base of a power is computed from a dot product.
fn raises_dot(shader: &Shader, found: Found) -> bool {
    let ExprKind::BuiltinCall(_, arguments) = &shader.expr(found.expr).kind else { return false };
    let mut raises = false;
    if let Some(base) = arguments.first() {
        shader.visit_expr(*base, &mut |id| {
            raises |= matches!(shader.expr(id).kind, ExprKind::BuiltinCall(BuiltinFunction::Dot, _));
        });
    }
    raises
}

fn called(shader: &Shader, found: Found) -> Option<BuiltinFunction> {
    match shader.expr(found.expr).kind {
        ExprKind::BuiltinCall(function, _) => Some(function),
        _ => None,
    }
}

/// The help for an expression that GLSL leaves undefined, where that for a loss of digits says less.
fn of_undefined(shader: &Shader, found: Found) -> Option<&'static str> {
    use glisten_front::hir::BinaryOp;
    Some(match (&shader.expr(found.expr).kind, called(shader, found)) {
        (_, Some(BuiltinFunction::Atan)) => "the zero vector has no angle: treat it apart",
        (_, Some(BuiltinFunction::Clamp)) => "order the limits: `clamp(x, min(a, b), max(a, b))`",
        (_, Some(BuiltinFunction::Smoothstep)) => {
            "put the smaller edge first, `1.0 - smoothstep(low, high, x)` for a step down, and keep the edges apart"
        }
        (
            ExprKind::Binary(BinaryOp::Div | BinaryOp::Rem, ..)
            | ExprKind::Assign(Some(BinaryOp::Div | BinaryOp::Rem), ..),
            _,
        ) => "treat a divisor of 0 apart, and keep the operands of `%` from 0 up",
        _ => return None,
    })
}

/// The help for an expression of a known form.
fn of_pattern(kind: CauseKind, shader: &Shader, found: Found) -> Option<&'static str> {
    let function = called(shader, found);
    Some(match (found.pattern, function) {
        (Pattern::OneMinusSquare, _) => {
            "write `(1.0 - c) * (1.0 + c)`; for the sine of an angle between unit vectors, `length(cross(a, b))` keeps all \
             digits, and `safeOneMinusCos` of <glisten/safe.glsl> is 1 - cos"
        }
        (Pattern::OneMinusCos, _) => {
            "write `2.0 * s * s` with `s = sin(0.5 * x)`; `safeOneMinusCos` of <glisten/safe.glsl> takes two unit vectors"
        }
        (Pattern::SquareMinusOne, _) => "write `(c - 1.0) * (c + 1.0)`",
        (Pattern::VectorAndOne, _) => {
            "a length near 1 has too few digits left for its distance from 1: pass what is computed from that, such as the third \
             component of a unit vector, instead of taking it from the other two"
        }
        (Pattern::Discriminant, _) => {
            "a square minus a number cancels: for a ray and a sphere, take the discriminant from the distance of the center to \
             the ray, `r * r - dot(q, q)` with `q = oc - dot(oc, d) * d`; from a square that is known by its root, \
             `x * x - y * y` is `(x - y) * (x + y)`"
        }
        (Pattern::QuadraticRoot, _) => {
            "of the two roots of `a * x * x + b * x + c`, take the one that does not cancel, `q / a` with `s = sqrt(b * b - 4.0 * a * c)` \
             and `q = -0.5 * (b + (b < 0.0 ? -s : s))`, and the other as `c / q`"
        }
        (Pattern::Variance, _) => {
            "a number minus a square cancels: if it is the square of a known number, `x * x - y * y` is `(x - y) * (x + y)`; if it is a \
             mean of squares, average the squares of the differences from the mean, or subtract a common offset from all \
             values first"
        }
        (Pattern::DifferenceOfSquares, _) => "write `(x - y) * (x + y)`",
        (Pattern::DifferenceOfDots, _) => "write `dot(x - y, x + y)`",
        (Pattern::VectorAndSquare, _) => {
            "`dot(x, x) - dot(y, y)` is `dot(x - y, x + y)`: use that with a vector of the number's length near the other one, if their \
             difference is known to more digits"
        }
        (Pattern::DifferenceOfProducts, _) => {
            "a difference of products cancels: move the origin to one of the points first, so that the factors are small, \
             or order the terms so that the differences come before the products"
        }
        (Pattern::DifferenceOfRoots, _) => "write `(a - b) / (sqrt(a) + sqrt(b))`",
        (Pattern::ExpMinusOne, _) => {
            "near 0, use the series `x * (1.0 + x * (0.5 + x / 6.0))`, or carry the difference from 1 instead of the number"
        }
        (Pattern::PowMinusOne, _) => {
            "carry the base's difference from 1, `x`: for a small `n * x`, the power minus 1 is `n * x * (1.0 + 0.5 * (n - 1.0) * x)`; \
             `safePowOneMinus` of <glisten/safe.glsl> is the power of a base below 1 by its distance from 1"
        }
        (Pattern::LinearDepth, _) => {
            "depth made linear cancels far away: pass the distance from the camera as a varying, or store depth reversed \
             (1 near, 0 far), where the difference is small"
        }
        (Pattern::MatrixProduct, _) => {
            "the coordinates are large against their differences: subtract the camera's position on the host in double \
             precision, or multiply the matrices there, and pass positions relative to the camera"
        }
        (Pattern::HalfVector, _) if kind != CauseKind::Overflow => {
            "the sum of two vectors vanishes where they are opposite: for a half vector, `halfVector` of \
             <glisten/blinn_phong.glsl> is defined everywhere; `safeNormalize` of <glisten/safe.glsl> is for every vector"
        }
        (Pattern::Smoothstep, _) if kind == CauseKind::Division => {
            "`smoothstep` with equal edges is 0 / 0: keep the edges apart, or use `step`"
        }
        (_, Some(BuiltinFunction::Normalize)) if kind == CauseKind::Division => {
            "a vector of length 0 has no direction: treat the case apart, or use `safeNormalize` of <glisten/safe.glsl>, which \
             yields the zero vector"
        }
        (_, Some(BuiltinFunction::Normalize)) if leaves_range(kind) => {
            "the square of this length leaves the range of f32: `safeNormalize` of <glisten/safe.glsl> scales first and \
             is defined for the zero vector"
        }
        (_, Some(BuiltinFunction::Length | BuiltinFunction::Distance)) if leaves_range(kind) => {
            "the square of this length leaves the range of f32: `safeLength` of <glisten/safe.glsl> scales first"
        }
        (_, Some(BuiltinFunction::Dot)) if leaves_range(kind) && is_squared(shader, found) => {
            "the squares of this vector leave the range of f32: for its length or its direction, `safeLength` and `safeNormalize` of \
             <glisten/safe.glsl> scale first; else scale it by a power of two, and undo that in the result"
        }
        (Pattern::Difference, _) | (_, Some(BuiltinFunction::Distance)) => {
            "the operands are large against their difference: subtract the common offset on the host in double precision, \
             and pass positions relative to the camera"
        }
        (_, Some(BuiltinFunction::Acos | BuiltinFunction::Asin)) => {
            "an angle from its cosine has few digits near 0 and 180 degrees, and none beyond: use `atan(length(cross(a, b)), \
             dot(a, b))`, or at least `clamp(c, -1.0, 1.0)`"
        }
        (
            _,
            Some(
                BuiltinFunction::Sqrt
                | BuiltinFunction::Inversesqrt
                | BuiltinFunction::Log
                | BuiltinFunction::Log2
                | BuiltinFunction::Pow,
            ),
        ) if kind == CauseKind::Underflow => {
            "the argument leaves the range of f32 on the way: for a length, `safeLength` of <glisten/safe.glsl> scales first; else scale \
             the factors of the argument by a power of two, and undo it in the result"
        }
        (_, Some(BuiltinFunction::Sqrt | BuiltinFunction::Inversesqrt)) => {
            "rounding makes the argument negative or 0: use `sqrt(max(x, 0.0))`, and bound the divisor from below"
        }
        (_, Some(BuiltinFunction::Log)) => {
            "the argument reaches 0 or is near 1: bound it from below; `safeLogOneMinus` of <glisten/safe.glsl> is the logarithm of a \
             number below 1 by its distance from 1, and that of `1.0 + x` for a small x is `2.0 * y * (1.0 + y * y / 3.0)` with \
             `y = x / (2.0 + x)`"
        }
        (_, Some(BuiltinFunction::Log2)) => {
            "the argument reaches 0 or is near 1: bound it from below; `1.442695 * safeLogOneMinus(d)` of <glisten/safe.glsl> is that of a \
             number below 1 by its distance from 1, and `log2(1.0 + x)` for a small x is `2.885390 * y * (1.0 + y * y / 3.0)` with \
             `y = x / (2.0 + x)`"
        }
        (_, Some(BuiltinFunction::Pow)) if kind == CauseKind::Domain => {
            "`pow` of a negative base is undefined, and so is that of 0 with an exponent that is not above 0 (GLSL 1.50 §8.2): write a whole \
             power as products, `x * x`, say by `abs` or `max(x, 0.0)` what a negative base means, and treat 0 to the power of 0 apart; \
             `safePow` of <glisten/safe.glsl> is 1 there, for bases from 0 to 1 and exponents from 0 on"
        }
        (_, Some(BuiltinFunction::Tan)) if kind == CauseKind::Argument => {
            "near a pole of the tangent each digit of the angle counts: take the angle from there, `1.0 / tan(d)` with the distance `d` \
             from the pole; reduce an angle before it becomes large"
        }
        (_, Some(BuiltinFunction::Pow)) if raises_dot(shader, found) => {
            "the dot product has lost the digits that a large power needs, so no other `pow` of it helps: for the cosine of two unit \
             vectors, `safeCosPow(a, b, n)` of <glisten/safe.glsl> takes the vectors, which have more digits"
        }
        (_, Some(BuiltinFunction::Pow)) => {
            "the exponent magnifies the rounding of the base, so no other `pow` of it helps: compute the distance `d` of the base from 1 \
             directly, and take `safePowOneMinus(d, n)` of <glisten/safe.glsl>; of a base `1.0 + x` with a small x, it is `exp(n * l)` with \
             `l = 2.0 * y * (1.0 + y * y / 3.0)` and `y = x / (2.0 + x)`; for a power of the cosine between two vectors, `safeCosPow` takes \
             the vectors, which have more digits; `safePow` is defined at 0, for bases from 0 to 1 and exponents from 0 on"
        }
        (_, Some(BuiltinFunction::Inverse | BuiltinFunction::Determinant)) => {
            "the matrix is nearly singular: compute its inverse on the host in double precision"
        }
        (_, Some(BuiltinFunction::Cross)) => {
            "the vectors are nearly parallel or large against their differences: subtract a common point first, and take \
             longer edges"
        }
        (_, Some(BuiltinFunction::Exp | BuiltinFunction::Exp2)) if kind == CauseKind::Overflow => {
            "compute with the exponent, or with an exponential of a negative argument, `exp(-abs(x))`; where larger results look the same, \
             bound the argument from above: `exp(min(x, 80.0))`"
        }
        (_, Some(BuiltinFunction::Mix)) => {
            "`mix(a, b, t)` is `a * (1.0 - t) + b * t`: where `a` and `b` are near each other, write `a + t * (b - a)`; where `t` is near 1 \
             and `a` large, compute `1.0 - t` directly, as `s`, and write `a * s + b * (1.0 - s)`"
        }
        (_, Some(BuiltinFunction::Mod)) => {
            "`mod` of a number that is large against the divisor keeps few digits: reduce it on the host, or count in integers"
        }
        _ => return None,
    })
}

/// The help for any other expression.
fn of_kind(kind: CauseKind) -> &'static str {
    match kind {
        CauseKind::Cancellation => {
            "rearrange the difference so that the large parts cancel in the formula and not in the numbers, or subtract a \
             common offset earlier, where it is still exact"
        }
        CauseKind::Rounding => {
            "the number is large against the digits that matter: keep a large offset apart, on the host or in an integer, \
             and add it last or never"
        }
        CauseKind::Overflow => "scale the operands before they are multiplied, or bound them with `min`",
        CauseKind::Underflow => {
            "scale the operands by a power of two before they are multiplied, and undo it after the division or root"
        }
        CauseKind::Division => "bound the divisor from below, `max(abs(d), 1e-6)`, or treat the case 0 apart",
        CauseKind::Domain => "clamp the argument into the domain of the function before the call",
        CauseKind::Power => {
            "the exponent multiplies the relative error of the base: compute the base's distance from 1 instead of the \
             base; `safePow` and `safePowOneMinus` of <glisten/safe.glsl> do for a base from 0 to 1"
        }
        CauseKind::Argument => {
            "reduce the angle before it becomes large: keep time or phase modulo the period on the host, `fract(phase) * \
             6.2831853`"
        }
        CauseKind::Comparison => {
            "leave room for rounding: compare with a tolerance, or make the step soft with `smoothstep`"
        }
        CauseKind::Conversion => {
            "rounding moves the number over a whole one: keep it small (subtract a multiple of the period on the host), \
             or add half a step before `floor` and `int`"
        }
        CauseKind::Accumulation => {
            "compute each step from its index, `start + float(i) * step`, or sum the rounding errors beside the sum (Kahan)"
        }
    }
}
