//! [`EnvelopeInt`]: an `int`, `uint` or `bool` that may have one of several values.
//!
//! *Holds:* the interval is one of `int`s; an inexact `uint` above 2^31 may be anything. Operations on few values
//! try all of them, so that `bool`s and short intervals stay precise. Sums, products and comparisons of longer
//! intervals are computed from their bounds; the results of all other operations may be anything. Of two values that are far
//! apart, such as the bits of 0 and of -0, both are known, and nothing between them.

use crate::domain::{Element, Integer, WIDTH};

/// The largest number of pairs of values that are tried one by one.
const TRIED: i64 = 64;

/// Bits, with the interval of values that a conforming GPU may have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EnvelopeInt {
    /// The result of exact arithmetic.
    pub bits: u32,
    /// The lower bound, as an `int`.
    pub low: i32,
    /// The upper bound, as an `int`.
    pub high: i32,
    /// Whether it is one of the bounds, and none of the values between them.
    pub is_bound: bool,
}

impl Element for EnvelopeInt {
    type Block = [Self; WIDTH];
}

impl EnvelopeInt {
    /// An undecided condition.
    #[inline(always)]
    pub(super) fn undecided(answer: bool) -> Self {
        Self { bits: u32::from(answer), low: 0, high: 1, is_bound: true }
    }

    /// Any integer.
    pub(in crate::domain) fn unknown(bits: u32) -> Self {
        Self { bits, low: i32::MIN, high: i32::MAX, is_bound: false }
    }

    /// The one or the other of two values, of which `bits` is one.
    pub(super) fn either(bits: u32, other: u32) -> Self {
        let (a, b) = (bits as i32, other as i32);
        Self { bits, low: a.min(b), high: a.max(b), is_bound: true }
    }

    /// An interval of wide integers; unknown if they do not fit.
    fn of_wide(bits: u32, low: i64, high: i64) -> Self {
        match (i32::try_from(low), i32::try_from(high)) {
            (Ok(low), Ok(high)) => Self { bits, low, high, is_bound: false },
            _ => Self::unknown(bits),
        }
    }

    fn count(self) -> i64 {
        let distance = i64::from(self.high) - i64::from(self.low);
        if self.is_bound { distance.min(1) + 1 } else { distance + 1 }
    }

    /// The values, if they are few.
    fn values(self) -> impl Iterator<Item = u32> {
        let (from, step) = (i64::from(self.low), i64::from(self.high) - i64::from(self.low));
        let step = if self.is_bound { step.max(1) } else { 1 };
        (0..self.count()).map(move |index| (from + index * step) as i32 as u32)
    }

    fn hull(bits: u32, values: impl Iterator<Item = u32>) -> Self {
        let mut hull = Self::from_bits(bits);
        let (mut second, mut is_more) = (bits, false);
        for value in values {
            (hull.low, hull.high) = (hull.low.min(value as i32), hull.high.max(value as i32));
            is_more |= value != bits && second != bits && value != second;
            second = if second == bits { value } else { second };
        }
        Self { is_bound: second != bits && !is_more, ..hull }
    }

    /// The same set of values by a function that keeps their order, without overflow.
    fn moved(self, bits: u32, f: impl Fn(i64) -> i64) -> Self {
        let moved = Self::of_wide(bits, f(i64::from(self.low)), f(i64::from(self.high)));
        // An overflow has left all integers.
        let fits = i64::from(moved.low) == f(i64::from(self.low)) && i64::from(moved.high) == f(i64::from(self.high));
        Self { is_bound: self.is_bound && fits, ..moved }
    }

    fn tried1(self, f: impl Fn(u32) -> u32) -> Self {
        let bits = f(self.bits);
        if self.count() > TRIED {
            return Self::unknown(bits);
        }
        Self::hull(bits, self.values().map(f))
    }

    fn tried2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        let bits = f(self.bits, other.bits);
        if self.count().saturating_mul(other.count()) > TRIED {
            return Self::unknown(bits);
        }
        let pairs = self.values().flat_map(|a| other.values().map(move |b| (a, b)));
        Self::hull(bits, pairs.map(|(a, b)| f(a, b)))
    }

    /// Computes from the corners of the box, for functions that are monotonic in each operand.
    fn by_corners(self, other: Self, bits: u32, f: impl Fn(i64, i64) -> i64) -> Self {
        let corners = [(self.low, other.low), (self.low, other.high), (self.high, other.low), (self.high, other.high)]
            .map(|(a, b)| f(i64::from(a), i64::from(b)));
        let (low, high) = corners.iter().fold((i64::MAX, i64::MIN), |(low, high), &c| (low.min(c), high.max(c)));
        Self::of_wide(bits, low, high)
    }

    /// Whether an `int` comparison gives the same result as a `uint` comparison.
    fn is_small(self) -> bool {
        self.low >= 0
    }
}

impl Integer for EnvelopeInt {
    #[inline(always)]
    fn from_bits(bits: u32) -> Self {
        Self { bits, low: bits as i32, high: bits as i32, is_bound: false }
    }
    fn with_interval(bits: u32, low: i32, high: i32) -> Self {
        Self { bits, low: low.min(bits as i32), high: high.max(bits as i32), is_bound: false }
    }
    #[inline(always)]
    fn bits(self) -> u32 {
        self.bits
    }
    #[inline(always)]
    fn is_decided(self) -> bool {
        self.low == self.high
    }
    #[inline(always)]
    fn interval(self) -> (i32, i32) {
        (self.low, self.high)
    }
    #[inline(always)]
    fn lift1(self, f: impl Fn(u32) -> u32) -> Self {
        if self.is_decided() { Self::from_bits(f(self.bits)) } else { self.tried1(f) }
    }
    #[inline(always)]
    fn lift2(self, other: Self, f: impl Fn(u32, u32) -> u32) -> Self {
        if self.is_decided() && other.is_decided() {
            Self::from_bits(f(self.bits, other.bits))
        } else {
            self.tried2(other, f)
        }
    }
    fn neg(self) -> Self {
        Self::of_wide(self.bits.wrapping_neg(), -i64::from(self.high), -i64::from(self.low))
    }
    fn add(self, other: Self) -> Self {
        if self.is_decided() && other.is_decided() {
            return Self::from_bits(self.bits.wrapping_add(other.bits));
        }
        self.by_corners(other, self.bits.wrapping_add(other.bits), |a, b| a + b)
    }
    fn sub(self, other: Self) -> Self {
        if self.is_decided() && other.is_decided() {
            return Self::from_bits(self.bits.wrapping_sub(other.bits));
        }
        self.by_corners(other, self.bits.wrapping_sub(other.bits), |a, b| a - b)
    }
    fn mul(self, other: Self) -> Self {
        if self.is_decided() && other.is_decided() {
            return Self::from_bits(self.bits.wrapping_mul(other.bits));
        }
        self.by_corners(other, self.bits.wrapping_mul(other.bits), |a, b| a * b)
    }
    fn shl(self, other: Self) -> Self {
        if other.is_decided() && !self.is_decided() {
            let factor = 1i64 << (other.bits & 31);
            return self.moved(self.bits.wrapping_shl(other.bits), |a| a * factor);
        }
        self.lift2(other, u32::wrapping_shl)
    }
    fn shr_signed(self, other: Self) -> Self {
        if other.is_decided() {
            let shift = |a: i32| a.wrapping_shr(other.bits);
            return Self {
                bits: shift(self.bits as i32) as u32,
                low: shift(self.low),
                high: shift(self.high),
                is_bound: self.is_bound,
            };
        }
        self.lift2(other, |a, b| (a as i32).wrapping_shr(b) as u32)
    }
    fn shr_unsigned(self, other: Self) -> Self {
        if self.is_small() { self.shr_signed(other) } else { self.lift2(other, u32::wrapping_shr) }
    }
    fn equal(self, other: Self) -> Self {
        let answer = self.bits == other.bits;
        if self.is_decided() && other.is_decided() {
            return Self::from_bool(answer);
        }
        let is_apart = self.high < other.low || other.high < self.low;
        if is_apart {
            return Self::from_bool(false);
        }
        // Two values, or one of two.
        if self.is_bound && (other.is_bound || other.is_decided()) {
            return self.tried2(other, |a, b| u32::from(a == b));
        }
        Self::undecided(answer)
    }
    fn less_signed(self, other: Self) -> Self {
        if self.high < other.low {
            Self::from_bool(true)
        } else if self.low >= other.high {
            Self::from_bool(false)
        } else {
            Self::undecided((self.bits as i32) < other.bits as i32)
        }
    }
    fn less_unsigned(self, other: Self) -> Self {
        if self.is_small() && other.is_small() {
            return self.less_signed(other);
        }
        let answer = self.bits < other.bits;
        if self.is_decided() && other.is_decided() { Self::from_bool(answer) } else { Self::undecided(answer) }
    }
    fn less_equal_signed(self, other: Self) -> Self {
        other.less_signed(self).not()
    }
    fn less_equal_unsigned(self, other: Self) -> Self {
        other.less_unsigned(self).not()
    }
    fn clamp_index(self, last: Self) -> Self {
        let most = (last.bits as i32).max(0);
        let limit = |a: i32| a.min(most).max(0);
        Self {
            bits: limit(self.bits as i32) as u32,
            low: limit(self.low),
            high: limit(self.high),
            is_bound: self.is_bound,
        }
    }
    fn select(self, yes: Self, no: Self) -> Self {
        let (chosen, other) = if self.is_true() { (yes, no) } else { (no, yes) };
        if self.is_decided() { chosen } else { chosen.joined(other) }
    }
    fn joined(self, other: Self) -> Self {
        let is_bound = self.is_decided() && other.is_decided() && self.bits != other.bits;
        Self { bits: self.bits, low: self.low.min(other.low), high: self.high.max(other.high), is_bound }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(low: i32, high: i32) -> EnvelopeInt {
        EnvelopeInt { bits: low as u32, low, high, is_bound: false }
    }

    #[test]
    fn of_two_values_that_are_far_apart_nothing_is_between() {
        const SIGN: u32 = 1 << 31;
        let zero = EnvelopeInt::either(0, SIGN);
        assert_eq!(zero.shr_unsigned(of(31, 31)).interval(), (0, 1));
        let masked = zero.and(EnvelopeInt::from_bits(SIGN)).or(EnvelopeInt::from_bits(0x3f80_0000));
        assert_eq!(masked, EnvelopeInt::either(0x3f80_0000, 0xbf80_0000));
        assert!(zero.equal(of(5, 5)).is_decided() && !zero.equal(of(0, 0)).is_decided());
        let choice = EnvelopeInt::from_bits(1).joined(EnvelopeInt::from_bits(1000)).shl(of(2, 2));
        assert_eq!((choice.values().collect::<Vec<_>>(), choice.is_bound), (vec![4, 4000], true));
        let third = choice.joined(EnvelopeInt::from_bits(7));
        assert!(!third.is_bound && third.lift1(|a| a & 1).interval() == (i32::MIN, i32::MAX));
        assert_eq!(EnvelopeInt::either(1, SIGN).shl(of(1, 1)).interval(), (i32::MIN, i32::MAX), "it may wrap");
    }

    #[test]
    fn short_intervals_are_tried_and_long_ones_go_by_their_ends() {
        let a = of(3, 5).lift2(of(2, 2), |a, b| a % b);
        assert_eq!((a.low, a.high), (0, 1));
        let sum = of(0, 1000).add(of(-5, 7));
        assert_eq!((sum.low, sum.high), (-5, 1007));
        let product = of(-3, 100).mul(of(-2, 2));
        assert_eq!((product.low, product.high), (-200, 200));
        assert_eq!(of(0, 1000).xor(of(1, 1)).interval(), (i32::MIN, i32::MAX));
        assert_eq!(of(i32::MAX, i32::MAX).add(of(0, 1)).interval(), (i32::MIN, i32::MAX), "it may wrap");
    }

    #[test]
    fn comparisons_know_what_is_apart() {
        assert!(of(0, 3).less_signed(of(4, 9)).is_decided());
        assert!(!of(0, 4).less_signed(of(4, 9)).is_decided());
        assert!(!of(-1, 4).less_unsigned(of(5, 9)).is_decided(), "-1 is the greatest uint");
        assert_eq!(of(0, 1).not().interval(), (0, 1));
        assert_eq!(of(0, 1).and(of(0, 0)), EnvelopeInt::from_bits(0));
        assert_eq!(of(-4, 90).clamp_index(of(7, 7)).interval(), (0, 7));
    }
}
