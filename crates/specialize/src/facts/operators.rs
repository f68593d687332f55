//! Operators (§5.9) and conversions on facts.

use super::{Fact, Facts, Range, What, at, exact, spread};
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue, Type, TypeId, Types, UnaryOp};

/// A conversion of each component.
pub(crate) fn convert(facts: &[Fact], from: Scalar, to: Scalar) -> Facts {
    if from == to {
        return facts.iter().copied().collect();
    }
    facts.iter().map(|fact| convert_one(*fact, to)).collect()
}

fn convert_one(fact: Fact, to: Scalar) -> Fact {
    let what = match (fact.what, to) {
        (What::Value(value), _) => exact::convert(value, to).map_or(What::Any, What::Value),
        (What::Int(low, high), Scalar::Uint) if low >= 0 => What::Uint(low as u32, high as u32),
        (What::Uint(low, high), Scalar::Int) if high <= i32::MAX as u32 => What::Int(low as i32, high as i32),
        (What::Int(low, high), Scalar::Float) => What::Float(whole(f64::from(low), f64::from(high))),
        (What::Uint(low, high), Scalar::Float) => What::Float(whole(f64::from(low), f64::from(high))),
        (What::Any, Scalar::Float) => What::Float(whole(f64::from(i32::MIN), f64::from(u32::MAX))),
        (What::Float(range), Scalar::Int) if range.is_finite() && range.magnitude() < 2e9 => {
            What::Int(range.low.trunc() as i32, range.high.trunc() as i32)
        }
        _ => What::Any,
    };
    Fact::result(what, &[fact])
}

/// Whole numbers as floats: never -0, and rounded once, or by the reference in f64 not at all.
fn whole(low: f64, high: f64) -> Range {
    let range = Range::between(low.min(f64::from(low as f32)), high.max(f64::from(high as f32)));
    Range { negative_zero: false, ..range }
}

/// An operator with one operand, component by component.
pub(crate) fn unary(op: UnaryOp, facts: &[Fact]) -> Facts {
    facts
        .iter()
        .map(|fact| {
            let what = match (fact.what, op) {
                (What::Value(value), _) => exact::unary(op, value).map_or(What::Any, What::Value),
                (What::Float(range), UnaryOp::Negate) => What::Float(range.neg()),
                (What::Int(low, high), UnaryOp::Negate) if low > i32::MIN => What::Int(-high, -low),
                _ => What::Any,
            };
            let norm = if op == UnaryOp::Negate { fact.norm } else { f32::INFINITY };
            Fact { scaled: fact.scaled, up: fact.up, norm, ..Fact::result(what, &[*fact]) }
        })
        .collect()
}

/// An operator with two operands of these types; `scalar` is the left one's.
pub(crate) fn binary(op: BinaryOp, scalar: Scalar, len: usize, left: &[Fact], right: &[Fact]) -> Facts {
    match op {
        BinaryOp::Equal => Facts::from_elem(equal(scalar, left, right), 1),
        BinaryOp::NotEqual => unary(UnaryOp::Not, &[equal(scalar, left, right)]),
        _ => (0..len).map(|index| component(op, scalar, spread(left, index), spread(right, index))).collect(),
    }
}

fn component(op: BinaryOp, scalar: Scalar, left: Fact, right: Fact) -> Fact {
    if let (What::Value(a), What::Value(b)) = (left.what, right.what)
        && let Some(value) = exact::binary(op, a, b)
    {
        return Fact::result(What::Value(value), &[left, right]);
    }
    let what = match scalar {
        Scalar::Float if matches!(op, BinaryOp::Mul | BinaryOp::Div) => return product(op, left, right),
        Scalar::Float => float(op, left.range(), right.range()),
        Scalar::Int => integer(op, left.integers(scalar), right.integers(scalar), scalar),
        Scalar::Uint => integer(op, left.integers(scalar), right.integers(scalar), scalar),
        Scalar::Bool => What::Any,
    };
    Fact::result(what, &[left, right])
}

/// A product or quotient, and whether constants are among its factors.
fn product(op: BinaryOp, left: Fact, right: Fact) -> Fact {
    let fact = Fact::result(float(op, left.range(), right.range()), &[left, right]);
    let grows = |constant: Fact, divides: bool| {
        let range = constant.range();
        if divides { range.has_zero() || range.low.abs().min(range.high.abs()) < 1.0 } else { range.magnitude() > 1.0 }
    };
    let (mut scaled, mut up) = (left.scaled || right.scaled, left.up || right.up);
    if left.constant != right.constant {
        scaled = true;
        up |= if left.constant { grows(left, false) } else { grows(right, op == BinaryOp::Div) };
    }
    Fact { scaled, up, ..fact }
}

fn answer(truth: Option<bool>) -> What {
    truth.map_or(What::Any, |truth| What::Value(ScalarValue::Bool(truth)))
}

fn float(op: BinaryOp, a: Range, b: Range) -> What {
    let range = match op {
        BinaryOp::Add => a.add(b),
        BinaryOp::Sub => a.sub(b),
        BinaryOp::Mul => a.mul(b),
        BinaryOp::Div => a.div(b),
        BinaryOp::Less => return answer(a.less(b)),
        BinaryOp::Greater => return answer(b.less(a)),
        BinaryOp::LessEqual => return answer(a.less_equal(b)),
        BinaryOp::GreaterEqual => return answer(b.less_equal(a)),
        _ => return What::Any,
    };
    match range {
        // Whatever the operands are, it is exactly this.
        Range { low: 0.0, high: 0.0, nan: false, negative_zero: false } => What::Value(ScalarValue::Float(0.0)),
        range => What::Float(range),
    }
}

fn integer(op: BinaryOp, a: (i64, i64), b: (i64, i64), scalar: Scalar) -> What {
    let less = |a: (i64, i64), b: (i64, i64)| match () {
        () if a.1 < b.0 => Some(true),
        () if a.0 >= b.1 => Some(false),
        () => None,
    };
    let (low, high) = match op {
        BinaryOp::Less => return answer(less(a, b)),
        BinaryOp::Greater => return answer(less(b, a)),
        BinaryOp::LessEqual => return answer(less(b, a).map(|truth| !truth)),
        BinaryOp::GreaterEqual => return answer(less(a, b).map(|truth| !truth)),
        BinaryOp::Add => (a.0 + b.0, a.1 + b.1),
        BinaryOp::Sub => (a.0 - b.1, a.1 - b.0),
        BinaryOp::Mul => {
            let corners = [a.0, a.1].map(|x| [b.0, b.1].map(|y| x.checked_mul(y)));
            let corners: Option<Vec<i64>> = corners.into_iter().flatten().collect();
            let Some(corners) = corners else { return What::Any };
            (corners.iter().copied().min().unwrap_or(0), corners.iter().copied().max().unwrap_or(0))
        }
        BinaryOp::Rem if a.0 >= 0 && b.0 > 0 => (0, a.1.min(b.1 - 1)),
        BinaryOp::Div if a.0 >= 0 && b.0 > 0 => (a.0 / b.1, a.1 / b.0),
        BinaryOp::BitAnd if a.0 >= 0 && b.0 >= 0 => (0, a.1.min(b.1)),
        // No bit is set that one of them lacks, its sign included.
        BinaryOp::BitAnd if a.0 >= 0 => (0, a.1),
        BinaryOp::BitAnd if b.0 >= 0 => (0, b.1),
        _ => return What::Any,
    };
    match scalar {
        // Whatever the operands are, it is exactly this.
        Scalar::Int if low == high && i32::try_from(low).is_ok() => What::Value(ScalarValue::Int(low as i32)),
        Scalar::Int => Fact::int(low, high).what,
        Scalar::Uint if low == high && u32::try_from(low).is_ok() => What::Value(ScalarValue::Uint(low as u32)),
        Scalar::Uint if low >= 0 && high <= i64::from(u32::MAX) => What::Uint(low as u32, high as u32),
        _ => What::Any,
    }
}

/// Whether two values are equal in all scalars.
fn equal(scalar: Scalar, left: &[Fact], right: &[Fact]) -> Fact {
    let operands: Facts = left.iter().chain(right).copied().collect();
    if left.is_empty() || left.len() != right.len() {
        return Fact::ANY;
    }
    let mut all = Some(true);
    for (a, b) in left.iter().zip(right) {
        match equal_one(scalar, *a, *b) {
            Some(true) => {}
            Some(false) => return Fact::result(answer(Some(false)), &operands),
            None => all = None,
        }
    }
    Fact::result(answer(all), &operands)
}

/// Whether two scalars are equal, where that is sure.
pub(super) fn equal_one(scalar: Scalar, left: Fact, right: Fact) -> Option<bool> {
    match (left.what, right.what, scalar) {
        (What::Value(a), What::Value(b), _) => exact::equal(a, b),
        (_, _, Scalar::Float) => left.range().equal(right.range()),
        (_, _, Scalar::Int | Scalar::Uint) => {
            let (a, b) = (left.integers(scalar), right.integers(scalar));
            (a.1 < b.0 || b.1 < a.0).then_some(false)
        }
        (_, _, Scalar::Bool) => None,
    }
}

/// The linear algebra product (§5.10).
pub(crate) fn mat_mul(
    types: &Types,
    (left, left_ty): (&[Fact], TypeId),
    (right, right_ty): (&[Fact], TypeId),
) -> Facts {
    // A vector on the left is a row, one on the right a column.
    let (inner, rows) = match types.get(left_ty) {
        Type::Matrix(columns, rows) => (usize::from(columns), usize::from(rows)),
        _ => (types.flat_len(left_ty) as usize, 1),
    };
    let columns = match types.get(right_ty) {
        Type::Matrix(columns, _) => usize::from(columns),
        _ => 1,
    };
    let mut result = Facts::new();
    for column in 0..columns {
        for row in 0..rows {
            let pairs: Vec<(Fact, Fact)> =
                (0..inner).map(|k| (at(left, k * rows + row), at(right, column * inner + k))).collect();
            result.push(sum_of_products(&pairs));
        }
    }
    result
}

/// `a0 b0 + a1 b1 + ...`
pub(super) fn sum_of_products(pairs: &[(Fact, Fact)]) -> Fact {
    let operands: Facts = pairs.iter().flat_map(|(a, b)| [*a, *b]).collect();
    let numbers: Option<Vec<(f32, f32)>> = pairs
        .iter()
        .map(|(a, b)| match (a.what, b.what) {
            (What::Value(ScalarValue::Float(a)), What::Value(ScalarValue::Float(b))) => Some((a, b)),
            _ => None,
        })
        .collect();
    if let Some(sum) = numbers.and_then(|numbers| exact::sum_of_products(&numbers)) {
        return Fact::result(What::Value(ScalarValue::Float(sum)), &operands);
    }
    let terms: Vec<Range> = pairs.iter().map(|(a, b)| a.range().mul(b.range())).collect();
    let sum = Range::sum(&terms);
    // Whatever the order, a sum is -0 only if all terms are.
    Fact::result(What::Float(Range { negative_zero: terms.iter().all(|term| term.negative_zero), ..sum }), &operands)
}
