//! [`Integer`]: the `int`, `uint` and `bool` of a domain.

use super::{Element, WIDTH};

/// 32 bits: an `int` in two's complement, a `uint`, or a `bool` as 0 or 1. Arithmetic wraps (GLSL 1.50 §4.1.3).
///
/// These cases are defined here because GLSL leaves them undefined: division by zero, and its remainder, have all
/// bits set; the smallest `int` divided by -1 wraps; shift counts are taken modulo 32.
pub trait Integer: Element<Block = [Self; WIDTH]> {
    /// Exactly these bits.
    fn from_bits(bits: u32) -> Self;
    /// The bits; for an inexact integer, those of the most likely value.
    fn bits(self) -> u32;
    /// The bits of the second value, in domains that compute two values.
    #[inline(always)]
    fn second(self) -> u32 {
        self.bits()
    }
    /// The bits of both values; domains with one value ignore the second.
    #[inline(always)]
    fn paired(bits: u32, second: u32) -> Self {
        let _ = second;
        Self::from_bits(bits)
    }
    /// These bits, or those of another `int` within the bounds. Domains without envelopes ignore the bounds.
    fn with_interval(bits: u32, low: i32, high: i32) -> Self {
        let _ = (low, high);
        Self::from_bits(bits)
    }
    /// The interval of `int`s that a conforming GPU may have.
    #[inline(always)]
    fn interval(self) -> (i32, i32) {
        (self.bits() as i32, self.bits() as i32)
    }
    /// The hull of both, with this one's bits.
    #[inline(always)]
    fn joined(self, other: Self) -> Self {
        let _ = other;
        self
    }
    /// Whether every conforming GPU has these bits.
    fn is_decided(self) -> bool {
        true
    }
    /// The integer that follows from exact arithmetic, in a domain that follows it; otherwise unchanged.
    #[inline(always)]
    fn corrected(self) -> Self {
        self
    }
    /// A function of one operand.
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self;
    /// A function of two operands.
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self;

    /// 0 or 1.
    #[inline(always)]
    fn from_bool(value: bool) -> Self {
        Self::from_bits(u32::from(value))
    }
    /// Whether the bits are not all 0.
    #[inline(always)]
    fn is_true(self) -> bool {
        self.bits() != 0
    }
    /// `!a` of a `bool`.
    #[inline(always)]
    fn not(self) -> Self {
        self.lift1(|bits| bits ^ 1)
    }
    /// `-a`
    #[inline(always)]
    fn neg(self) -> Self {
        self.lift1(u32::wrapping_neg)
    }
    /// `min(max(a, 0), last)` of `int`s: an index clamped into range.
    #[inline(always)]
    fn clamp_index(self, last: Self) -> Self {
        self.lift2(last, |a, last| (a as i32).min(last as i32).max(0) as u32)
    }
    /// `a + b`
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.lift2(other, u32::wrapping_add)
    }
    /// `a - b`
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.lift2(other, u32::wrapping_sub)
    }
    /// `a * b`
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.lift2(other, u32::wrapping_mul)
    }
    /// `a / b` of `int`s.
    #[inline(always)]
    fn div_signed(self, other: Self) -> Self {
        self.lift2(other, |a, b| if b == 0 { u32::MAX } else { (a as i32).wrapping_div(b as i32) as u32 })
    }
    /// `a % b` of `int`s, with the sign of the dividend.
    #[inline(always)]
    fn rem_signed(self, other: Self) -> Self {
        self.lift2(other, |a, b| if b == 0 { u32::MAX } else { (a as i32).wrapping_rem(b as i32) as u32 })
    }
    /// `a / b` of `uint`s.
    #[inline(always)]
    fn div_unsigned(self, other: Self) -> Self {
        self.lift2(other, |a, b| a.checked_div(b).unwrap_or(u32::MAX))
    }
    /// `a % b` of `uint`s.
    #[inline(always)]
    fn rem_unsigned(self, other: Self) -> Self {
        self.lift2(other, |a, b| a.checked_rem(b).unwrap_or(u32::MAX))
    }
    /// `a << b`
    #[inline(always)]
    fn shl(self, other: Self) -> Self {
        self.lift2(other, u32::wrapping_shl)
    }
    /// `a >> b` of an `int`.
    #[inline(always)]
    fn shr_signed(self, other: Self) -> Self {
        self.lift2(other, |a, b| (a as i32).wrapping_shr(b) as u32)
    }
    /// `a >> b` of a `uint`.
    #[inline(always)]
    fn shr_unsigned(self, other: Self) -> Self {
        self.lift2(other, u32::wrapping_shr)
    }
    /// `a & b`
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.lift2(other, |a, b| a & b)
    }
    /// `a | b`
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.lift2(other, |a, b| a | b)
    }
    /// `a ^ b`
    #[inline(always)]
    fn xor(self, other: Self) -> Self {
        self.lift2(other, |a, b| a ^ b)
    }
    /// `a == b`
    #[inline(always)]
    fn equal(self, other: Self) -> Self {
        self.lift2(other, |a, b| u32::from(a == b))
    }
    /// `a < b` of `int`s.
    #[inline(always)]
    fn less_signed(self, other: Self) -> Self {
        self.lift2(other, |a, b| u32::from((a as i32) < b as i32))
    }
    /// `a < b` of `uint`s.
    #[inline(always)]
    fn less_unsigned(self, other: Self) -> Self {
        self.lift2(other, |a, b| u32::from(a < b))
    }
    /// `a <= b` of `int`s.
    #[inline(always)]
    fn less_equal_signed(self, other: Self) -> Self {
        self.lift2(other, |a, b| u32::from(a as i32 <= b as i32))
    }
    /// `a <= b` of `uint`s.
    #[inline(always)]
    fn less_equal_unsigned(self, other: Self) -> Self {
        self.lift2(other, |a, b| u32::from(a <= b))
    }
    /// `c ? a : b`, where `c` is this.
    #[inline(always)]
    fn select(self, yes: Self, no: Self) -> Self {
        if self.is_true() { yes } else { no }
    }
}

impl Integer for u32 {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        bits
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self
    }
    #[inline(always)]
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self {
        f(self)
    }
    #[inline(always)]
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        f(self, other)
    }
}
