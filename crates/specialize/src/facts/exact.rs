//! Exact folding: what every conforming target computes alike.
//!
//! *In:* exact operands. *Out:* the result of [`fold`], or `None` where a target may compute another: a quotient (2.5 ULP), a root, a
//! function, a sum of products that rounds, a subnormal (which may be flushed), what is infinite or NaN, and what GLSL
//! leaves undefined (division by zero, shifts by 32 or more, floats that no integer holds).

use ScalarValue::{Bool, Float, Int, Uint};
use glisten_front::fold;
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue, UnaryOp};

/// Whether no target can see another number in its place.
pub(super) fn is_plain(value: f32) -> bool {
    value.is_normal() || value == 0.0
}

/// Whether no target can see another value in its place.
fn is_exact(value: &ScalarValue) -> bool {
    !matches!(value, Float(value) if !is_plain(*value))
}

/// A scalar as another scalar type (§5.4.1).
pub(super) fn convert(value: ScalarValue, to: Scalar) -> Option<ScalarValue> {
    let is_defined = match (to, value) {
        (Scalar::Bool, Float(a)) => is_plain(a),
        (Scalar::Int, Float(a)) => is_plain(a) && a.abs() < 2_147_483_600.0,
        (Scalar::Uint, Float(a)) => is_plain(a) && (0.0..4_294_967_000.0).contains(&a),
        (Scalar::Float, Float(_)) | (_, Bool(_) | Int(_) | Uint(_)) => true,
    };
    is_defined.then(|| fold::convert(value, to))
}

/// One operand.
pub(super) fn unary(op: UnaryOp, value: ScalarValue) -> Option<ScalarValue> {
    fold::unary(op, value).filter(is_exact)
}

/// Two operands, component by component.
pub(super) fn binary(op: BinaryOp, left: ScalarValue, right: ScalarValue) -> Option<ScalarValue> {
    let is_known = is_exact(&left) && is_exact(&right) && is_defined(op, left, right);
    is_known.then(|| fold::scalar_binary(op, left, right)).flatten().filter(is_exact)
}

/// Whether GLSL defines the result, and every target computes it alike.
fn is_defined(op: BinaryOp, left: ScalarValue, right: ScalarValue) -> bool {
    match (op, left, right) {
        (BinaryOp::Div, Int(a), Int(b)) => a.checked_div(b).is_some(),
        // The sign of a remainder is undefined where an operand is negative (§5.9).
        (BinaryOp::Rem, Int(a), Int(b)) => a >= 0 && b > 0,
        (BinaryOp::Div | BinaryOp::Rem, Uint(_), Uint(b)) => b != 0,
        (BinaryOp::Div | BinaryOp::Rem, ..) => false,
        (BinaryOp::Shl | BinaryOp::Shr, _, Int(b)) => (0..32).contains(&b),
        (BinaryOp::Shl | BinaryOp::Shr, _, Uint(b)) => b < 32,
        // A product that vanishes might be a subnormal elsewhere.
        (BinaryOp::Mul, Float(a), Float(b)) => a * b != 0.0 || a == 0.0 || b == 0.0,
        _ => true,
    }
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
