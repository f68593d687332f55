//! Folding by the reference: what its f32 arithmetic computes of known operands.
//!
//! *In:* an operation on operands some of whose scalars are known. *Out:* the values that the compiler's constant folding
//! gives, which are those of the reference in f32, bit for bit. *Holds:* a quotient, a root, a function, or a sum of products
//! that rounds may be computed otherwise by a target. Its envelope has the reference's value in it, so a literal is within what
//! the original may draw. What is infinite, NaN or subnormal, the sign of a zero that was rounded to, a result that vanishes
//! by underflow, conversions to integers and derivatives stay the target's.

use super::{Fact, Facts, What, at, exact, spread, values};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::builtin::operations::{Binary, Class, Composite, MatrixFunction, Numbers, Ternary, Unary};
use glisten_front::fold;
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, Scalar, ScalarValue, Shader, Type, TypeId, Types, UnaryOp,
};
use glisten_front::source::Span;
use smallvec::SmallVec;

/// The scalars of a known operand.
pub(crate) type Values = SmallVec<[ScalarValue; 4]>;

/// An operation without its operands.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Operation {
    Convert,
    Unary(UnaryOp),
    Binary(BinaryOp),
    Call(F),
}

impl Operation {
    /// Whether each component of the result is that of the components of the operands.
    fn is_componentwise(self) -> bool {
        match self {
            Self::Convert | Self::Unary(_) => true,
            Self::Binary(op) => matches!(op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div),
            Self::Call(function) => {
                matches!(function.class(), Class::Unary(_) | Class::Binary(_) | Class::Ternary(_) | Class::Numbers(_))
            }
        }
    }

    /// When a 0 may be what a target rounded a small number to.
    fn vanishing(self) -> Vanishing {
        match self {
            Self::Binary(op) => match op {
                BinaryOp::Mul | BinaryOp::Div => Vanishing::Any,
                BinaryOp::MatMul => Vanishing::FromNonzero,
                BinaryOp::Add
                | BinaryOp::Sub
                | BinaryOp::Rem
                | BinaryOp::Shl
                | BinaryOp::Shr
                | BinaryOp::BitAnd
                | BinaryOp::BitXor
                | BinaryOp::BitOr
                | BinaryOp::Less
                | BinaryOp::Greater
                | BinaryOp::LessEqual
                | BinaryOp::GreaterEqual
                | BinaryOp::Equal
                | BinaryOp::NotEqual
                | BinaryOp::LogicalXor => Vanishing::Never,
            },
            Self::Call(function) => of_class(function.class()),
            Self::Convert | Self::Unary(_) => Vanishing::Never,
        }
    }
}

/// When a 0 may be what a target rounded a small number to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Vanishing {
    /// A 0 is a 0.
    Never,
    /// Where no operand is 0.
    FromNonzero,
    /// Where the last operand is above the first.
    AboveFirst,
    /// Whatever the operands are.
    Any,
}

/// [`Vanishing`] of a function. There is no wildcard: who adds an operation decides it here.
fn of_class(class: Class) -> Vanishing {
    match class {
        Class::Unary(op) => match op {
            Unary::Exp | Unary::Exp2 => Vanishing::Any,
            // Exact, or a 0 at one argument alone, near which the result is no smaller than what separates arguments.
            Unary::Neg
            | Unary::Abs
            | Unary::Sign
            | Unary::Floor
            | Unary::Trunc
            | Unary::Round
            | Unary::Ceil
            | Unary::Fract
            | Unary::Log
            | Unary::Log2
            | Unary::Acos
            | Unary::Acosh => Vanishing::Never,
            Unary::Radians
            | Unary::Degrees
            | Unary::Sin
            | Unary::Cos
            | Unary::Tan
            | Unary::Asin
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Asinh
            | Unary::Atanh
            | Unary::Sqrt
            | Unary::Inversesqrt => Vanishing::FromNonzero,
        },
        Class::Binary(op) => match op {
            Binary::Mul | Binary::Div => Vanishing::Any,
            Binary::Mod | Binary::Min | Binary::Max | Binary::Step | Binary::Add | Binary::Sub => Vanishing::Never,
            // Of 0 to a power above 0 every target makes 0.
            Binary::Atan2 | Binary::Pow => Vanishing::FromNonzero,
        },
        Class::Ternary(op) => match op {
            Ternary::Clamp => Vanishing::Never,
            Ternary::Smoothstep => Vanishing::AboveFirst,
            Ternary::Mix => Vanishing::FromNonzero,
            Ternary::Fma => Vanishing::Any,
        },
        Class::Numbers(Numbers::Abs | Numbers::Sign | Numbers::Min | Numbers::Max | Numbers::Clamp) => Vanishing::Never,
        Class::Numbers(Numbers::Atan | Numbers::Mix) => Vanishing::FromNonzero,
        Class::Composite(op) => match op {
            Composite::Faceforward => Vanishing::Never,
            Composite::Length
            | Composite::Distance
            | Composite::Dot
            | Composite::Cross
            | Composite::Normalize
            | Composite::Reflect
            | Composite::Refract
            | Composite::Determinant
            | Composite::Inverse => Vanishing::FromNonzero,
        },
        Class::Matrix(MatrixFunction::ComponentProduct | MatrixFunction::OuterProduct) => Vanishing::Any,
        Class::Matrix(MatrixFunction::Transpose)
        | Class::Relation(_)
        | Class::Boolean(_)
        | Class::Test(_)
        | Class::BitCast(_)
        | Class::Bits(_)
        | Class::Packing(_) => Vanishing::Never,
        Class::Modf
        | Class::Composed
        | Class::Derivative(_)
        | Class::Noise(_)
        | Class::Texture(_)
        | Class::Emission(_) => Vanishing::Any,
    }
}

/// The facts of a result of type `ty`, at least as good as `facts`. `like` is a shader of the same version.
pub(crate) fn by_reference(
    types: &Types,
    like: &Shader,
    operation: Operation,
    operands: &[(&[Fact], TypeId)],
    ty: TypeId,
    facts: Facts,
) -> Facts {
    if types.scalar_of(ty).is_none() || values(&facts).is_some() || operands.iter().any(|(facts, _)| facts.is_empty()) {
        return facts;
    }
    let known: Option<Vec<(Values, TypeId)>> = operands.iter().map(|(facts, ty)| Some((values(facts)?, *ty))).collect();
    if let Some(known) = known {
        let all: Facts = operands.iter().flat_map(|(facts, _)| facts.iter().copied()).collect();
        let found = folded(types, like, operation, &known, ty).filter(|found| is_certain(operation, &known, found));
        return found.map_or(facts, |found| found.into_iter().map(|value| result(value, &all)).collect());
    }
    let len = types.flat_len(ty) as usize;
    let improved: Option<Vec<Option<Fact>>> = match operation {
        Operation::Binary(BinaryOp::MatMul) => {
            operands.first().zip(operands.get(1)).map(|(a, b)| product(types, *a, *b))
        }
        _ if operation.is_componentwise() => {
            let Some(scalar) = types.scalar_of(ty).map(|scalar| TypeId::vector(scalar, 1)) else { return facts };
            Some((0..len).map(|index| component(types, like, operation, operands, scalar, index)).collect())
        }
        _ => None,
    };
    match improved {
        Some(improved) if improved.iter().any(Option::is_some) => {
            improved.into_iter().enumerate().map(|(index, one)| one.unwrap_or_else(|| at(&facts, index))).collect()
        }
        _ => facts,
    }
}

fn result(value: ScalarValue, operands: &[Fact]) -> Fact {
    Fact::result(What::Value(value), operands)
}

/// A component of which all operands are known.
fn component(
    types: &Types,
    like: &Shader,
    operation: Operation,
    operands: &[(&[Fact], TypeId)],
    ty: TypeId,
    index: usize,
) -> Option<Fact> {
    let facts: Facts = operands.iter().map(|(facts, _)| spread(facts, index)).collect();
    let known: Option<Vec<(Values, TypeId)>> = facts
        .iter()
        .map(|fact| fact.value().map(|value| (Values::from_slice(&[value]), TypeId::vector(value.scalar(), 1))))
        .collect();
    let known = known?;
    let found = folded(types, like, operation, &known, ty).filter(|found| is_certain(operation, &known, found))?;
    Some(result(found.first().copied()?, &facts))
}

/// The scalars of a linear algebra product (§5.10) whose factors are all known: products are added in order.
fn product(types: &Types, (a, a_ty): (&[Fact], TypeId), (b, b_ty): (&[Fact], TypeId)) -> Vec<Option<Fact>> {
    let (inner, rows) = match types.get(a_ty) {
        Type::Matrix(columns, rows) => (usize::from(columns), usize::from(rows)),
        _ => (types.flat_len(a_ty) as usize, 1),
    };
    let columns = if let Type::Matrix(columns, _) = types.get(b_ty) { usize::from(columns) } else { 1 };
    let number = |fact: Fact| match fact.value() {
        Some(ScalarValue::Float(value)) if exact::is_plain(value) => Some(value),
        _ => None,
    };
    let mut results = Vec::with_capacity(columns * rows);
    for column in 0..columns {
        for row in 0..rows {
            let pairs: Vec<(Fact, Fact)> =
                (0..inner).map(|k| (at(a, k * rows + row), at(b, column * inner + k))).collect();
            let products: Option<Vec<f32>> = pairs.iter().map(|(a, b)| Some(number(*a)? * number(*b)?)).collect();
            let sum = products.and_then(|products| products.into_iter().reduce(|sum, product| sum + product));
            let operands: Facts = pairs.iter().flat_map(|(a, b)| [*a, *b]).collect();
            results.push(sum.filter(|sum| sum.is_normal()).map(|sum| result(ScalarValue::Float(sum), &operands)));
        }
    }
    results
}

/// Whether a folded value is a number that the reference alone decides: no zero by underflow or with a sign.
fn is_certain(operation: Operation, operands: &[(Values, TypeId)], found: &[ScalarValue]) -> bool {
    let plain = |value: &ScalarValue| !matches!(value, ScalarValue::Float(value) if !exact::is_plain(*value));
    let to_integer = matches!(operation, Operation::Convert);
    let zero = |value: &ScalarValue| matches!(value, ScalarValue::Float(value) if *value == 0.0);
    let signed = |value: &ScalarValue| matches!(value, ScalarValue::Float(value) if value.to_bits() == 1 << 31);
    let vanishes = found.iter().any(zero)
        && match operation.vanishing() {
            Vanishing::Never => false,
            Vanishing::FromNonzero => !operands.iter().any(|(values, _)| values.iter().any(zero)),
            Vanishing::AboveFirst => !is_below_first(operands),
            Vanishing::Any => true,
        };
    // Cofactors that are 0 have the sign that the order of their products gives them, and any target may choose another order.
    let has_sign = !matches!(operation, Operation::Call(F::Inverse)) && found.iter().any(signed);
    // Of 0 and -0 a target gives either.
    let chooses = matches!(operation, Operation::Call(F::Min | F::Max | F::Clamp));
    let either = chooses && found.iter().any(zero) && operands.iter().any(|(values, _)| values.iter().any(signed));
    !to_integer && !vanishes && !either && !has_sign && operands.iter().all(|(values, _)| values.iter().all(plain))
}

/// Whether each component of the last operand is at most that of the first.
fn is_below_first(operands: &[(Values, TypeId)]) -> bool {
    let (Some((first, _)), Some((last, _))) = (operands.first(), operands.last()) else { return false };
    let number = |values: &Values, index: usize| {
        let value = values.get(if values.len() == 1 { 0 } else { index });
        if let Some(ScalarValue::Float(value)) = value { *value } else { f32::NAN }
    };
    (0..first.len().max(last.len())).all(|index| number(last, index) <= number(first, index))
}

/// The value of an operation on known operands, as the reference computes it in f32. None of what is not finite, subnormal,
/// or known of integers alone, for which the exact rules know all that is defined.
pub(crate) fn folded(
    types: &Types,
    like: &Shader,
    operation: Operation,
    operands: &[(Values, TypeId)],
    ty: TypeId,
) -> Option<Values> {
    let mut shader = Shader::new(like.stage, like.version);
    let mut ids = Vec::with_capacity(operands.len());
    for (values, ty) in operands {
        ids.push(constant(types, &mut shader, values, *ty)?);
    }
    let (first, second) = (ids.first().copied(), ids.get(1).copied());
    let kind = match operation {
        Operation::Convert => ExprKind::Convert(first?),
        Operation::Unary(op) => ExprKind::Unary(op, first?),
        Operation::Binary(op) => ExprKind::Binary(op, first?, second?),
        // The interpolation of a constant has no slope, but a target may find one for it.
        Operation::Call(function) if matches!(function.class(), Class::Derivative(_)) => return None,
        Operation::Call(function) => ExprKind::BuiltinCall(function, ids),
    };
    let id = shader.push(kind, ty, Span::default());
    let value = fold::evaluate(&shader, types, id, &|_| None)?;
    let usable = |value: &ScalarValue| !matches!(value, ScalarValue::Float(value) if !exact::is_plain(*value));
    let floats = operands.iter().map(|(_, ty)| *ty).chain([ty]).any(|ty| types.scalar_of(ty) == Some(Scalar::Float));
    (floats && value.scalars.iter().all(usable)).then(|| value.scalars.into_iter().collect())
}

/// Numbers as an expression.
fn constant(types: &Types, shader: &mut Shader, values: &[ScalarValue], ty: TypeId) -> Option<ExprId> {
    let scalar = TypeId::vector(types.scalar_of(ty)?, 1);
    let mut parts = Vec::with_capacity(values.len());
    for value in values {
        parts.push(shader.push(ExprKind::Literal(*value), scalar, Span::default()));
    }
    match types.get(ty) {
        Type::Scalar(_) => parts.first().copied(),
        _ => Some(shader.push(ExprKind::Construct(ConstructKind::Compose, parts), ty, Span::default())),
    }
}
