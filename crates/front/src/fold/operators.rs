//! Evaluates conversions (§4.1.10, §5.4.1) and operators (§5.9) on constant scalars, vectors and matrices.

use super::{Operand, Scalars};
use crate::hir::{BinaryOp, LogicalOp, Scalar, ScalarValue, Type, Types, UnaryOp};
use ScalarValue::{Bool, Float, Int, Uint};

/// A scalar as another scalar type (§5.4.1). Between `int` and `uint` the bits are unchanged.
pub fn convert(value: ScalarValue, to: Scalar) -> ScalarValue {
    match (to, value) {
        (Scalar::Bool, Bool(a)) => Bool(a),
        (Scalar::Bool, Int(a)) => Bool(a != 0),
        (Scalar::Bool, Uint(a)) => Bool(a != 0),
        (Scalar::Bool, Float(a)) => Bool(a != 0.0),
        (Scalar::Int, Bool(a)) => Int(i32::from(a)),
        (Scalar::Int, Int(a)) => Int(a),
        (Scalar::Int, Uint(a)) => Int(a as i32),
        (Scalar::Int, Float(a)) => Int(a as i32),
        (Scalar::Uint, Bool(a)) => Uint(u32::from(a)),
        (Scalar::Uint, Int(a)) => Uint(a as u32),
        (Scalar::Uint, Uint(a)) => Uint(a),
        (Scalar::Uint, Float(a)) => Uint(a as u32),
        (Scalar::Float, Bool(a)) => Float(f32::from(u8::from(a))),
        (Scalar::Float, Int(a)) => Float(a as f32),
        (Scalar::Float, Uint(a)) => Float(a as f32),
        (Scalar::Float, Float(a)) => Float(a),
    }
}

/// An operator on a scalar; `None` if there is none for its type.
pub fn unary(op: UnaryOp, value: ScalarValue) -> Option<ScalarValue> {
    match (op, value) {
        (UnaryOp::Negate, Int(a)) => Some(Int(a.wrapping_neg())),
        (UnaryOp::Negate, Uint(a)) => Some(Uint(a.wrapping_neg())),
        (UnaryOp::Negate, Float(a)) => Some(Float(-a)),
        (UnaryOp::Not, Bool(a)) => Some(Bool(!a)),
        (UnaryOp::BitNot, Int(a)) => Some(Int(!a)),
        (UnaryOp::BitNot, Uint(a)) => Some(Uint(!a)),
        (UnaryOp::Negate, Bool(_))
        | (UnaryOp::Not, Int(_) | Uint(_) | Float(_))
        | (UnaryOp::BitNot, Bool(_) | Float(_)) => None,
    }
}

pub(super) fn logical(op: LogicalOp, left: bool, right: bool) -> bool {
    match op {
        LogicalOp::And => left && right,
        LogicalOp::Or => left || right,
    }
}

pub(super) fn binary(types: &Types, op: BinaryOp, left: &Operand<'_>, right: &Operand<'_>) -> Option<Scalars> {
    match op {
        BinaryOp::MatMul => mat_mul(types, left, right),
        BinaryOp::Equal => Some(Scalars::from_slice(&[Bool(equal(left, right))])),
        BinaryOp::NotEqual => Some(Scalars::from_slice(&[Bool(!equal(left, right))])),
        _ => componentwise(left, right, |a, b| scalar_binary(op, a, b)),
    }
}

/// Applies `f` to pairs of components. A scalar is combined with every component of the other operand.
pub(super) fn componentwise(
    left: &Operand<'_>,
    right: &Operand<'_>,
    f: impl Fn(ScalarValue, ScalarValue) -> Option<ScalarValue>,
) -> Option<Scalars> {
    let len = left.scalars.len().max(right.scalars.len());
    let pick = |scalars: &[ScalarValue], index: usize| {
        if scalars.len() == 1 { scalars.first().copied() } else { scalars.get(index).copied() }
    };
    (0..len).map(|index| f(pick(&left.scalars, index)?, pick(&right.scalars, index)?)).collect()
}

/// Equality by `==`: NaN differs from itself, -0 equals 0.
fn equal(left: &Operand<'_>, right: &Operand<'_>) -> bool {
    left.scalars.len() == right.scalars.len() && left.scalars.iter().zip(&*right.scalars).all(|(a, b)| a == b)
}

/// An operator on two scalars; `None` if there is none for their types, and for those that compare or multiply whole values.
pub fn scalar_binary(op: BinaryOp, left: ScalarValue, right: ScalarValue) -> Option<ScalarValue> {
    match (left, right) {
        (Float(a), Float(b)) => float(op, a, b),
        (Int(a), Int(b)) => int(op, a, b),
        (Uint(a), Uint(b)) => uint(op, a, b),
        // Only shifts mix signs (§5.9).
        (Int(a), Uint(b)) => int(op, a, b as i32),
        (Uint(a), Int(b)) => uint(op, a, b as u32),
        (Bool(a), Bool(b)) if op == BinaryOp::LogicalXor => Some(Bool(a ^ b)),
        _ => None,
    }
}

fn float(op: BinaryOp, a: f32, b: f32) -> Option<ScalarValue> {
    Some(match op {
        BinaryOp::Add => Float(a + b),
        BinaryOp::Sub => Float(a - b),
        BinaryOp::Mul => Float(a * b),
        BinaryOp::Div => Float(a / b),
        BinaryOp::Less => Bool(a < b),
        BinaryOp::Greater => Bool(a > b),
        BinaryOp::LessEqual => Bool(a <= b),
        BinaryOp::GreaterEqual => Bool(a >= b),
        _ => return None,
    })
}

fn int(op: BinaryOp, a: i32, b: i32) -> Option<ScalarValue> {
    Some(match op {
        BinaryOp::Add => Int(a.wrapping_add(b)),
        BinaryOp::Sub => Int(a.wrapping_sub(b)),
        BinaryOp::Mul => Int(a.wrapping_mul(b)),
        BinaryOp::Div => Int(if b == 0 { -1 } else { a.wrapping_div(b) }),
        BinaryOp::Rem => Int(if b == 0 { -1 } else { a.wrapping_rem(b) }),
        BinaryOp::Shl => Int(a.wrapping_shl(b as u32)),
        BinaryOp::Shr => Int(a.wrapping_shr(b as u32)),
        BinaryOp::BitAnd => Int(a & b),
        BinaryOp::BitXor => Int(a ^ b),
        BinaryOp::BitOr => Int(a | b),
        BinaryOp::Less => Bool(a < b),
        BinaryOp::Greater => Bool(a > b),
        BinaryOp::LessEqual => Bool(a <= b),
        BinaryOp::GreaterEqual => Bool(a >= b),
        BinaryOp::MatMul | BinaryOp::Equal | BinaryOp::NotEqual | BinaryOp::LogicalXor => return None,
    })
}

fn uint(op: BinaryOp, a: u32, b: u32) -> Option<ScalarValue> {
    Some(match op {
        BinaryOp::Add => Uint(a.wrapping_add(b)),
        BinaryOp::Sub => Uint(a.wrapping_sub(b)),
        BinaryOp::Mul => Uint(a.wrapping_mul(b)),
        BinaryOp::Div => Uint(a.checked_div(b).unwrap_or(u32::MAX)),
        BinaryOp::Rem => Uint(a.checked_rem(b).unwrap_or(u32::MAX)),
        BinaryOp::Shl => Uint(a.wrapping_shl(b)),
        BinaryOp::Shr => Uint(a.wrapping_shr(b)),
        BinaryOp::BitAnd => Uint(a & b),
        BinaryOp::BitXor => Uint(a ^ b),
        BinaryOp::BitOr => Uint(a | b),
        BinaryOp::Less => Bool(a < b),
        BinaryOp::Greater => Bool(a > b),
        BinaryOp::LessEqual => Bool(a <= b),
        BinaryOp::GreaterEqual => Bool(a >= b),
        BinaryOp::MatMul | BinaryOp::Equal | BinaryOp::NotEqual | BinaryOp::LogicalXor => return None,
    })
}

/// Linear-algebraic multiplication: a vector on the left is a row, on the right a column. Products are added in
/// order, with each operation rounded.
fn mat_mul(types: &Types, left: &Operand<'_>, right: &Operand<'_>) -> Option<Scalars> {
    let (inner, rows) = match types.get(left.ty) {
        Type::Matrix(columns, rows) => (columns, rows),
        Type::Vector(_, size) => (size, 1),
        _ => return None,
    };
    let columns = match types.get(right.ty) {
        Type::Matrix(columns, _) => columns,
        Type::Vector(..) => 1,
        _ => return None,
    };
    let (inner, rows, columns) = (usize::from(inner), usize::from(rows), usize::from(columns));
    let mut result = Scalars::new();
    for column in 0..columns {
        for row in 0..rows {
            let mut sum = None;
            for k in 0..inner {
                let a = as_float(left.scalars.get(k * rows + row)?)?;
                let b = as_float(right.scalars.get(column * inner + k)?)?;
                sum = Some(sum.map_or(a * b, |sum: f32| sum + a * b));
            }
            result.push(Float(sum?));
        }
    }
    Some(result)
}

/// The number of a `float`.
pub(super) fn as_float(value: &ScalarValue) -> Option<f32> {
    match value {
        Float(value) => Some(*value),
        Bool(_) | Int(_) | Uint(_) => None,
    }
}
