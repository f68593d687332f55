//! Recognizes expressions that are known to be unstable.
//!
//! *In:* the typed expression at a span. *Out:* the [`Pattern`] that it has. *Holds:* only the form is looked at; whether
//! it harms is measured elsewhere.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, ScalarValue, Shader, Type, Types, UnaryOp, same_value};
use glisten_front::source::Span;

/// A form of expression that is known to be unstable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pattern {
    /// `1 - c * c`
    OneMinusSquare,
    /// `c * c - 1`
    SquareMinusOne,
    /// `1 - dot(v, v)`, `dot(v, v) - 1`
    VectorAndOne,
    /// `1 - cos(x)`
    OneMinusCos,
    /// `b * b - 4 * a * c`, and a square minus any other number.
    Discriminant,
    /// `-b + sqrt(d)`
    QuadraticRoot,
    /// `a - m * m`: a mean of squares minus a squared mean, or a square by another name.
    Variance,
    /// `x * x - y * y`
    DifferenceOfSquares,
    /// `dot(x, x) - dot(y, y)`
    DifferenceOfDots,
    /// `dot(x, x) - y * y`, `y * y - dot(x, x)`
    VectorAndSquare,
    /// `a * b - c * d`
    DifferenceOfProducts,
    /// `sqrt(a) - sqrt(b)`
    DifferenceOfRoots,
    /// `exp(x) - 1`
    ExpMinusOne,
    /// `pow(1 + x, n) - 1`
    PowMinusOne,
    /// `f - z * (f - n)`, `f + n - z * (f - n)`: the depth buffer made linear.
    LinearDepth,
    /// A matrix times a vector.
    MatrixProduct,
    /// `normalize(a + b)`
    HalfVector,
    /// `a - b` of two positions.
    Difference,
    /// `smoothstep(a, b, x)`
    Smoothstep,
    /// Another expression.
    Other,
}

/// The text and form of an expression in a stage.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub(super) expr: ExprId,
    pub(super) pattern: Pattern,
}

/// The expression at a span; the outermost one, if several share it.
pub(super) fn at(types: &Types, shader: &Shader, span: Span) -> Option<Found> {
    let expr = shader.expr_at(span)?;
    Some(Found { expr, pattern: pattern(types, shader, expr) })
}

fn pattern(types: &Types, shader: &Shader, id: ExprId) -> Pattern {
    match &shader.expr(id).kind {
        ExprKind::Binary(BinaryOp::Sub, a, b) => difference(types, shader, *a, *b),
        ExprKind::Assign(Some(BinaryOp::Sub), a, b) => difference(types, shader, *a, *b),
        ExprKind::Binary(BinaryOp::Add, a, b)
            if is_negation(shader, *a) && calls(shader, *b, BuiltinFunction::Sqrt) =>
        {
            Pattern::QuadraticRoot
        }
        ExprKind::Binary(BinaryOp::Mul, a, b) if [*a, *b].iter().any(|side| is_matrix(types, shader, *side)) => {
            Pattern::MatrixProduct
        }
        ExprKind::BuiltinCall(BuiltinFunction::Normalize, list) => {
            let sum = list.first().map(|inner| &shader.expr(bare(shader, *inner)).kind);
            if matches!(sum, Some(ExprKind::Binary(BinaryOp::Add, ..))) { Pattern::HalfVector } else { Pattern::Other }
        }
        ExprKind::BuiltinCall(BuiltinFunction::Smoothstep, _) => Pattern::Smoothstep,
        ExprKind::Convert(inner) => pattern(types, shader, *inner),
        _ => Pattern::Other,
    }
}

fn difference(types: &Types, shader: &Shader, a: ExprId, b: ExprId) -> Pattern {
    let (a, b) = (bare(shader, a), bare(shader, b));
    // The factors of a product of matrices cannot be exchanged.
    let square = |id: ExprId| square(shader, id).filter(|root| !is_matrix(types, shader, *root));
    let (left, right) = (square(a), square(b));
    let dots = [a, b].map(|id| calls(shader, id, BuiltinFunction::Dot));
    match (left, right) {
        (None, Some(_)) if is_one(shader, a) => {
            if dots[1] {
                Pattern::VectorAndOne
            } else {
                Pattern::OneMinusSquare
            }
        }
        (Some(_), None) if is_one(shader, b) => {
            if dots[0] {
                Pattern::VectorAndOne
            } else {
                Pattern::SquareMinusOne
            }
        }
        (Some(x), Some(y)) => match dots {
            [false, false] => Pattern::DifferenceOfSquares,
            [true, true] if shader.expr(x).ty == shader.expr(y).ty => Pattern::DifferenceOfDots,
            _ => Pattern::VectorAndSquare,
        },
        (Some(_), None) => Pattern::Discriminant,
        (None, Some(_)) => Pattern::Variance,
        (None, None) => without_squares(types, shader, a, b),
    }
}

/// The form of a difference of which neither side is a square.
fn without_squares(types: &Types, shader: &Shader, a: ExprId, b: ExprId) -> Pattern {
    let product = |id: ExprId| matches!(shader.expr(id).kind, ExprKind::Binary(BinaryOp::Mul, ..));
    match () {
        () if is_one(shader, a) && calls(shader, b, BuiltinFunction::Cos) => Pattern::OneMinusCos,
        () if is_one(shader, b) && calls(shader, a, BuiltinFunction::Exp) => Pattern::ExpMinusOne,
        () if is_one(shader, b) && calls(shader, a, BuiltinFunction::Pow) => Pattern::PowMinusOne,
        () if calls(shader, a, BuiltinFunction::Sqrt) && calls(shader, b, BuiltinFunction::Sqrt) => {
            Pattern::DifferenceOfRoots
        }
        () if calls(shader, b, BuiltinFunction::Sqrt) || (calls(shader, a, BuiltinFunction::Sqrt) && !product(b)) => {
            Pattern::QuadraticRoot
        }
        () if is_linear_depth(shader, a, b) => Pattern::LinearDepth,
        () if product(a) && product(b) => Pattern::DifferenceOfProducts,
        () if matches!(types.get(shader.expr(a).ty), Type::Vector(..)) => Pattern::Difference,
        () => Pattern::Other,
    }
}

/// An expression without conversions and sign.
fn bare(shader: &Shader, id: ExprId) -> ExprId {
    match shader.expr(id).kind {
        ExprKind::Convert(inner) => bare(shader, inner),
        _ => id,
    }
}

fn is_one(shader: &Shader, id: ExprId) -> bool {
    match &shader.expr(id).kind {
        ExprKind::Literal(ScalarValue::Float(value)) => *value == 1.0,
        ExprKind::Construct(_, parts) => {
            !parts.is_empty() && parts.iter().all(|part| is_one(shader, bare(shader, *part)))
        }
        _ => false,
    }
}

fn is_negation(shader: &Shader, id: ExprId) -> bool {
    matches!(shader.expr(id).kind, ExprKind::Unary(UnaryOp::Negate, _))
}

fn calls(shader: &Shader, id: ExprId, function: BuiltinFunction) -> bool {
    matches!(shader.expr(id).kind, ExprKind::BuiltinCall(called, _) if called == function)
}

fn is_matrix(types: &Types, shader: &Shader, id: ExprId) -> bool {
    matches!(types.get(shader.expr(id).ty), Type::Matrix(..))
}

/// The operand of `x * x`, `pow(x, 2)` or `dot(x, x)`.
fn square(shader: &Shader, id: ExprId) -> Option<ExprId> {
    match &shader.expr(id).kind {
        ExprKind::Binary(BinaryOp::Mul, a, b) if same_value(shader, *a, *b) => Some(*a),
        ExprKind::BuiltinCall(BuiltinFunction::Dot, list) => match list.as_slice() {
            [a, b] if same_value(shader, *a, *b) => Some(*a),
            _ => None,
        },
        ExprKind::BuiltinCall(BuiltinFunction::Pow, list) => {
            let exponent = list.get(1).map(|exponent| &shader.expr(bare(shader, *exponent)).kind);
            let is_two = matches!(exponent, Some(ExprKind::Literal(ScalarValue::Float(value))) if *value == 2.0);
            list.first().copied().filter(|_| is_two)
        }
        _ => None,
    }
}

/// Whether a difference has the form `f - z * (f - n)`, or `f + n - z * (f - n)`.
fn is_linear_depth(shader: &Shader, a: ExprId, b: ExprId) -> bool {
    let ExprKind::Binary(BinaryOp::Mul, x, y) = shader.expr(b).kind else { return false };
    let is_far = |far: ExprId| match shader.expr(a).kind {
        ExprKind::Binary(BinaryOp::Add, c, d) => [c, d].iter().any(|term| same_value(shader, *term, far)),
        _ => same_value(shader, a, far),
    };
    [x, y].iter().any(|factor| match shader.expr(bare(shader, *factor)).kind {
        ExprKind::Binary(BinaryOp::Sub, far, _) => {
            !matches!(shader.expr(far).kind, ExprKind::Literal(_)) && is_far(far)
        }
        _ => false,
    })
}
