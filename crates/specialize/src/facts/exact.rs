//! Exact folding: what every conforming target computes alike.
//!
//! *In:* exact operands. *Out:* the result, or `None` where a target may compute another: a quotient (2.5 ULP), a root, a
//! function, a sum of products that rounds, a subnormal (which may be flushed), what is infinite or NaN, and what GLSL
//! leaves undefined (division by zero, shifts by 32 or more, floats that no integer holds).

use ScalarValue::{Bool, Float, Int, Uint};
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue, UnaryOp};

/// Whether no target can see another number in its place.
pub(super) fn is_plain(value: f32) -> bool {
    value.is_normal() || value == 0.0
}

fn plain(value: f32) -> Option<ScalarValue> {
    is_plain(value).then_some(Float(value))
}

/// A scalar as another scalar type (§5.4.1).
pub(super) fn convert(value: ScalarValue, to: Scalar) -> Option<ScalarValue> {
    Some(match (to, value) {
        (Scalar::Bool, Bool(a)) => Bool(a),
        (Scalar::Bool, Int(a)) => Bool(a != 0),
        (Scalar::Bool, Uint(a)) => Bool(a != 0),
        (Scalar::Bool, Float(a)) if is_plain(a) => Bool(a != 0.0),
        (Scalar::Int, Bool(a)) => Int(i32::from(a)),
        (Scalar::Int, Int(a)) => Int(a),
        (Scalar::Int, Uint(a)) => Int(a as i32),
        (Scalar::Int, Float(a)) if is_plain(a) && a.abs() < 2_147_483_600.0 => Int(a as i32),
        (Scalar::Uint, Bool(a)) => Uint(u32::from(a)),
        (Scalar::Uint, Int(a)) => Uint(a as u32),
        (Scalar::Uint, Uint(a)) => Uint(a),
        (Scalar::Uint, Float(a)) if is_plain(a) && (0.0..4_294_967_000.0).contains(&a) => Uint(a as u32),
        (Scalar::Float, Bool(a)) => Float(f32::from(u8::from(a))),
        (Scalar::Float, Int(a)) => Float(a as f32),
        (Scalar::Float, Uint(a)) => Float(a as f32),
        (Scalar::Float, Float(a)) => Float(a),
        (Scalar::Bool | Scalar::Int | Scalar::Uint, Float(_)) => return None,
    })
}

/// One operand.
pub(super) fn unary(op: UnaryOp, value: ScalarValue) -> Option<ScalarValue> {
    match (op, value) {
        (UnaryOp::Negate, Int(a)) => Some(Int(a.wrapping_neg())),
        (UnaryOp::Negate, Uint(a)) => Some(Uint(a.wrapping_neg())),
        (UnaryOp::Negate, Float(a)) => plain(-a),
        (UnaryOp::Not, Bool(a)) => Some(Bool(!a)),
        (UnaryOp::BitNot, Int(a)) => Some(Int(!a)),
        (UnaryOp::BitNot, Uint(a)) => Some(Uint(!a)),
        _ => None,
    }
}

/// Two operands, component by component.
pub(super) fn binary(op: BinaryOp, left: ScalarValue, right: ScalarValue) -> Option<ScalarValue> {
    match (left, right) {
        (Float(a), Float(b)) if is_plain(a) && is_plain(b) => float(op, a, b),
        (Int(a), Int(b)) => int(op, a, b),
        (Uint(a), Uint(b)) => uint(op, a, b),
        // Only shifts mix signs (§5.9).
        (Int(a), Uint(b)) => int(op, a, i32::try_from(b).ok()?),
        (Uint(a), Int(b)) => uint(op, a, u32::try_from(b).ok()?),
        (Bool(a), Bool(b)) if op == BinaryOp::LogicalXor => Some(Bool(a ^ b)),
        _ => None,
    }
}

fn float(op: BinaryOp, a: f32, b: f32) -> Option<ScalarValue> {
    Some(match op {
        BinaryOp::Add => return plain(a + b),
        BinaryOp::Sub => return plain(a - b),
        // A product that vanishes might be a subnormal elsewhere.
        BinaryOp::Mul if a * b == 0.0 && a != 0.0 && b != 0.0 => return None,
        BinaryOp::Mul => return plain(a * b),
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
        BinaryOp::Div => Int(a.checked_div(b)?),
        // The sign of a remainder is undefined where an operand is negative (§5.9).
        BinaryOp::Rem if a >= 0 && b > 0 => Int(a.checked_rem(b)?),
        BinaryOp::Shl if (0..32).contains(&b) => Int(a.wrapping_shl(b as u32)),
        BinaryOp::Shr if (0..32).contains(&b) => Int(a.wrapping_shr(b as u32)),
        BinaryOp::BitAnd => Int(a & b),
        BinaryOp::BitXor => Int(a ^ b),
        BinaryOp::BitOr => Int(a | b),
        BinaryOp::Less => Bool(a < b),
        BinaryOp::Greater => Bool(a > b),
        BinaryOp::LessEqual => Bool(a <= b),
        BinaryOp::GreaterEqual => Bool(a >= b),
        _ => return None,
    })
}

fn uint(op: BinaryOp, a: u32, b: u32) -> Option<ScalarValue> {
    Some(match op {
        BinaryOp::Add => Uint(a.wrapping_add(b)),
        BinaryOp::Sub => Uint(a.wrapping_sub(b)),
        BinaryOp::Mul => Uint(a.wrapping_mul(b)),
        BinaryOp::Div => Uint(a.checked_div(b)?),
        BinaryOp::Rem => Uint(a.checked_rem(b)?),
        BinaryOp::Shl if b < 32 => Uint(a.wrapping_shl(b)),
        BinaryOp::Shr if b < 32 => Uint(a.wrapping_shr(b)),
        BinaryOp::BitAnd => Uint(a & b),
        BinaryOp::BitXor => Uint(a ^ b),
        BinaryOp::BitOr => Uint(a | b),
        BinaryOp::Less => Bool(a < b),
        BinaryOp::Greater => Bool(a > b),
        BinaryOp::LessEqual => Bool(a <= b),
        BinaryOp::GreaterEqual => Bool(a >= b),
        _ => return None,
    })
}

/// Whether two scalars are equal, as `==` has it (-0 equals 0).
pub(super) fn equal(left: ScalarValue, right: ScalarValue) -> Option<bool> {
    match (left, right) {
        (Float(a), Float(b)) => (is_plain(a) && is_plain(b)).then_some(a == b),
        _ => Some(left == right),
    }
}

/// `a0 b0 + a1 b1 + ...`, if no order of summation rounds anything: all products are whole multiples of one power of two,
/// and together at most 2^24 of it.
pub(super) fn sum_of_products(pairs: &[(f32, f32)]) -> Option<f32> {
    if pairs.iter().any(|(a, b)| !is_plain(*a) || !is_plain(*b)) {
        return None;
    }
    let products = || pairs.iter().map(|(a, b)| f64::from(*a) * f64::from(*b)).filter(|product| *product != 0.0);
    // The sign of a sum that is 0 depends on the signs of all products.
    if products().next().is_none() {
        return pairs.iter().all(|(a, b)| a.is_sign_positive() && b.is_sign_positive()).then_some(0.0);
    }
    let unit = products().map(lowest_bit).fold(f64::INFINITY, f64::min);
    let total: f64 = products().map(f64::abs).sum();
    if total > unit * 16_777_216.0 || unit < 1e-30 {
        return None;
    }
    let sum: f64 = products().sum();
    if sum == 0.0 { None } else { Some(sum as f32) }
}

/// The power of two of a number's lowest bit.
fn lowest_bit(value: f64) -> f64 {
    let bits = value.to_bits();
    let mantissa = (bits & ((1 << 52) - 1)) | (1 << 52);
    let exponent = ((bits >> 52) & 0x7ff) as i32 - 1075;
    2f64.powi(exponent + mantissa.trailing_zeros() as i32)
}

#[cfg(test)]
mod tests {
    use super::{binary, lowest_bit, sum_of_products};
    use glisten_front::hir::{BinaryOp, ScalarValue};

    #[test]
    fn only_what_every_target_computes_alike_is_folded() {
        let float = |op, a, b| binary(op, ScalarValue::Float(a), ScalarValue::Float(b));
        assert_eq!(float(BinaryOp::Mul, 0.1, 3.0), Some(ScalarValue::Float(0.1 * 3.0)));
        assert_eq!(float(BinaryOp::Div, 1.0, 2.0), None);
        assert_eq!(float(BinaryOp::Mul, 1e30, 1e30), None);
        assert_eq!(float(BinaryOp::Mul, 1e-30, 1e-30), None);
        assert_eq!(binary(BinaryOp::Div, ScalarValue::Int(1), ScalarValue::Int(0)), None);
        assert_eq!(binary(BinaryOp::Rem, ScalarValue::Int(-7), ScalarValue::Int(3)), None);
    }

    #[test]
    fn a_sum_of_products_is_folded_where_it_does_not_round() {
        assert_eq!(lowest_bit(6.0), 2.0);
        assert_eq!(sum_of_products(&[(1.0, 0.3), (0.0, 5.0)]), Some(0.3));
        assert_eq!(sum_of_products(&[(2.0, 3.0), (0.5, 5.0)]), Some(8.5));
        assert_eq!(sum_of_products(&[(0.1, 0.1), (0.2, 0.2)]), None);
        assert_eq!(sum_of_products(&[(-1.0, 0.0), (1.0, 0.0)]), None);
    }
}
