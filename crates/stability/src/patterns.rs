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
    /// `1 - cos(x)`
    OneMinusCos,
    /// `b * b - 4 * a * c`
    Discriminant,
    /// `-b + sqrt(d)`
    QuadraticRoot,
    /// `a - m * m`: a mean of squares minus a squared mean.
    Variance,
    /// `x * x - y * y`
    DifferenceOfSquares,
    /// `a * b - c * d`
    DifferenceOfProducts,
    /// `sqrt(a) - sqrt(b)`
    DifferenceOfRoots,
    /// `exp(x) - 1`, `pow(1 + x, n) - 1`
    ExpMinusOne,
    /// `f - z * (f - n)`: the depth buffer made linear.
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
    let (left, right) = (square(shader, a), square(shader, b));
    let product = |id: ExprId| matches!(shader.expr(id).kind, ExprKind::Binary(BinaryOp::Mul, ..));
    match () {
        () if is_one(shader, a) && right.is_some() => Pattern::OneMinusSquare,
        () if is_one(shader, a) && calls(shader, b, BuiltinFunction::Cos) => Pattern::OneMinusCos,
        () if is_one(shader, b)
            && (calls(shader, a, BuiltinFunction::Exp) || calls(shader, a, BuiltinFunction::Pow)) =>
        {
            Pattern::ExpMinusOne
        }
        () if left.is_some() && right.is_some() => Pattern::DifferenceOfSquares,
        () if left.is_some() && product(b) => Pattern::Discriminant,
        () if left.is_some() => Pattern::Discriminant,
        () if right.is_some() => Pattern::Variance,
        () if calls(shader, a, BuiltinFunction::Sqrt) && calls(shader, b, BuiltinFunction::Sqrt) => {
            Pattern::DifferenceOfRoots
        }
        () if calls(shader, b, BuiltinFunction::Sqrt) || (calls(shader, a, BuiltinFunction::Sqrt) && !product(b)) => {
            Pattern::QuadraticRoot
        }
        () if product(b) && has_difference(shader, b) && !product(a) => Pattern::LinearDepth,
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

fn has_difference(shader: &Shader, id: ExprId) -> bool {
    let children = shader.expr(id).kind.children();
    children.iter().any(|child| matches!(shader.expr(*child).kind, ExprKind::Binary(BinaryOp::Sub, ..)))
}
