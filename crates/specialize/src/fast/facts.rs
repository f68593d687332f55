//! Facts under finite math and fast math.
//!
//! *In:* an operation, the facts of its operands, and those of its result by the exact rules. *Out:* better ones: what the
//! compiler's constant folding computes from known operands, and what algebra says of the others (`x * 0.0` is 0).
//! *Holds:* a result that is not finite, or subnormal, is not folded: the target computes it.

use crate::Math;
use crate::facts::{self, Fact, Facts, GREATEST, Operation, Range, Values, What, at, values};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue, Shader, Type, TypeId, Types};

/// Facts and the type of an operand.
type Operand<'a> = (&'a [Fact], TypeId);

/// The facts of a result of type `ty`, at least as good as `facts`. `like` is a shader of the same version.
pub(crate) fn improved(
    types: &Types,
    like: &Shader,
    operation: Operation,
    operands: &[Operand<'_>],
    ty: TypeId,
    facts: Facts,
) -> Facts {
    if types.scalar_of(ty).is_none() || values(&facts).is_some() {
        return facts;
    }
    let folded = folded(types, like, operation, operands, ty);
    let facts = folded.unwrap_or_else(|| by_algebra(types, operation, operands, ty, facts));
    finite(Math::Fast, types, ty, facts)
}

/// Takes every `float` to be finite, under fast math no zero to have a sign, and under exact math nothing.
pub(crate) fn finite(math: Math, types: &Types, ty: TypeId, facts: Facts) -> Facts {
    if math == Math::Exact || types.scalar_of(ty) != Some(Scalar::Float) {
        return facts;
    }
    let len = types.flat_len(ty) as usize;
    let facts = if facts.is_empty() { Facts::from_elem(Fact::ANY, len) } else { facts };
    let limited = |fact: Fact| match fact.what {
        What::Value(_) => fact,
        _ => {
            let range = fact.range();
            let (low, high) = (range.low.clamp(-GREATEST, GREATEST), range.high.clamp(-GREATEST, GREATEST));
            let negative_zero = range.negative_zero && math != Math::Fast;
            Fact { what: What::Float(Range { low, high, nan: false, negative_zero }), ..fact }
        }
    };
    facts.into_iter().map(limited).collect()
}

/// The value of an operation on known operands.
fn folded(types: &Types, like: &Shader, operation: Operation, operands: &[Operand<'_>], ty: TypeId) -> Option<Facts> {
    let known: Vec<(Values, TypeId)> =
        operands.iter().map(|(facts, ty)| Some((values(facts)?, *ty))).collect::<Option<_>>()?;
    let folded = facts::folded(types, like, operation, &known, ty)?;
    Some(folded.into_iter().map(unsigned_zero).map(Fact::bound).collect())
}

fn unsigned_zero(value: ScalarValue) -> ScalarValue {
    match value {
        // -0 and 0 make 0; other numbers stay.
        ScalarValue::Float(value) => ScalarValue::Float(value + 0.0),
        value => value,
    }
}

/// What algebra says of a result some of whose operands are known.
fn by_algebra(types: &Types, operation: Operation, operands: &[Operand<'_>], ty: TypeId, facts: Facts) -> Facts {
    if types.scalar_of(ty) != Some(Scalar::Float) {
        return facts;
    }
    let len = types.flat_len(ty) as usize;
    let operand = |argument: usize, index: usize| match operands.get(argument) {
        Some((facts, ty)) if types.flat_len(*ty) == 1 => at(facts, 0),
        Some((facts, _)) => at(facts, index),
        None => Fact::ANY,
    };
    let each = |f: &dyn Fn([Fact; 3]) -> Option<Fact>| -> Facts {
        let one = |index: usize| f([operand(0, index), operand(1, index), operand(2, index)]);
        (0..len).map(|index| one(index).unwrap_or_else(|| at(&facts, index))).collect()
    };
    match operation {
        Operation::Binary(BinaryOp::Mul) | Operation::Call(F::MatrixCompMult) => each(&|[a, b, _]| product(a, b)),
        Operation::Binary(BinaryOp::Div) => each(&|[a, ..]| is(a, 0.0).then(zero)),
        Operation::Binary(BinaryOp::MatMul) => {
            let (Some(a), Some(b)) = (operands.first(), operands.get(1)) else { return facts };
            matrix_product(types, *a, *b).into_iter().enumerate().map(|(i, one)| one.unwrap_or(at(&facts, i))).collect()
        }
        Operation::Call(F::Dot) => {
            let (Some((a, ty)), Some((b, _))) = (operands.first(), operands.get(1)) else { return facts };
            let pairs = (0..types.flat_len(*ty) as usize).map(|index| (at(a, index), at(b, index)));
            if vanishes(pairs) { Facts::from_elem(zero(), 1) } else { facts }
        }
        Operation::Call(F::Mix) => each(&|[x, y, a]| match () {
            () if is(a, 0.0) => Some(x),
            () if is(a, 1.0) => Some(y),
            () => None,
        }),
        Operation::Call(F::Pow) => each(&|[x, y, _]| match () {
            () if is(y, 0.0) || is(x, 1.0) => Some(Fact::bound(ScalarValue::Float(1.0))),
            () if is(y, 1.0) => Some(x),
            () if is(x, 0.0) && y.range().low > 0.0 => Some(zero()),
            () => None,
        }),
        _ => facts,
    }
}

fn zero() -> Fact {
    Fact::bound(ScalarValue::Float(0.0))
}

/// Whether it is this `float`; 0 of either sign is 0.
fn is(fact: Fact, value: f32) -> bool {
    matches!(fact.value(), Some(ScalarValue::Float(known)) if known == value)
}

fn product(a: Fact, b: Fact) -> Option<Fact> {
    (is(a, 0.0) || is(b, 0.0)).then(zero)
}

/// Whether each product has a factor that is 0.
fn vanishes(mut pairs: impl Iterator<Item = (Fact, Fact)>) -> bool {
    pairs.all(|(a, b)| is(a, 0.0) || is(b, 0.0))
}

/// The scalars of a linear algebra product (§5.10) that are 0.
fn matrix_product(types: &Types, (a, a_ty): Operand<'_>, (b, b_ty): Operand<'_>) -> Vec<Option<Fact>> {
    let (inner, rows) = match types.get(a_ty) {
        Type::Matrix(columns, rows) => (usize::from(columns), usize::from(rows)),
        _ => (types.flat_len(a_ty) as usize, 1),
    };
    let columns = if let Type::Matrix(columns, _) = types.get(b_ty) { usize::from(columns) } else { 1 };
    let mut result = Vec::with_capacity(columns * rows);
    for column in 0..columns {
        for row in 0..rows {
            let pairs = (0..inner).map(|k| (at(a, k * rows + row), at(b, column * inner + k)));
            result.push(vanishes(pairs).then(zero));
        }
    }
    result
}
