//! The bits of floats in the envelope (GLSL 3.30 §8.3, 4.20 §8.4).
//!
//! *Holds:* among numbers of one sign, larger ones have larger bits, so an interval on one side of 0 is an interval of
//! bits. A 0 that arithmetic gives may have either sign; one that is loaded has its own. An interval with both signs, or with NaN,
//! may have any bits.

use super::{EnvelopeFloat, EnvelopeInt};
use crate::domain::{Integer, Number};
use glisten_front::builtin::operations::{from_half, to_half};

/// The bit of the sign.
const SIGN: u32 = 1 << 31;

/// The bits of the nearest f32.
fn single(value: f64) -> u32 {
    (value as f32).to_bits()
}

/// A 16-bit float with its sign in bit 31, so that it compares as an `int` does.
fn spread(half: u32) -> u32 {
    half & 0x7fff | (half & 0x8000) << 16
}

impl EnvelopeFloat {
    /// The bits by a function that keeps the order of numbers of one sign.
    fn bits_by(self, f: impl Fn(f64) -> u32) -> EnvelopeInt {
        let bits = f(self.value);
        if self.may_be_nan {
            return EnvelopeInt::with_interval(bits, i32::MIN, i32::MAX);
        }
        if self.has_open_sign() {
            return EnvelopeInt::either(bits, bits ^ SIGN);
        }
        if self.low == self.high {
            return EnvelopeInt::from_bits(bits);
        }
        let (low, high) = (f(self.low) as i32, f(self.high) as i32);
        match (self.low >= 0.0, self.high <= 0.0) {
            // -0 at an end belongs to the other side.
            (true, _) => EnvelopeInt::with_interval(bits, low.max(0), high),
            (_, true) if high < 0 => EnvelopeInt::with_interval(bits, high, low),
            _ => EnvelopeInt::with_interval(bits, i32::MIN, i32::MAX),
        }
    }

    /// Whether it is 0 as the result of arithmetic, whose sign nobody promises (Vulkan: without `SignedZeroInfNanPreserve`). Rounding outward
    /// leaves 0 and -0 as its ends.
    fn has_open_sign(self) -> bool {
        self.low == 0.0 && self.high == 0.0 && self.low.to_bits() != self.high.to_bits()
    }

    pub(super) fn bits_of(self) -> EnvelopeInt {
        self.bits_by(single)
    }

    pub(super) fn half_of(self) -> EnvelopeInt {
        if self.has_open_sign() {
            let bits = to_half(self.value);
            return EnvelopeInt::either(bits, bits ^ 0x8000);
        }
        let wide = self.bits_by(|value| spread(to_half(value)));
        let narrow = |bits: i32| bits & 0x7fff | (bits >> 31 & 1) << 15;
        let (low, high) = wide.interval();
        let bits = to_half(self.value);
        // Bits of one sign stay in their order.
        match (low < 0) == (high < 0) {
            true => EnvelopeInt::with_interval(bits, narrow(low), narrow(high)),
            false => EnvelopeInt::with_interval(bits, 0, 0xffff),
        }
    }

    pub(super) fn with_bits(bits: EnvelopeInt) -> Self {
        let of = |bits: u32| f64::from(f32::from_bits(bits));
        if bits.is_decided() {
            return Self::from_f64(of(bits.bits));
        }
        let (low, high) = bits.interval();
        let (a, b) = (of(low as u32), of(high as u32));
        if (low < 0) != (high < 0) && !bits.is_bound || a.is_nan() || b.is_nan() {
            return Self::anything(of(bits.bits));
        }
        let hull = Self::from_f64(of(bits.bits)).joined(Self::from_f64(a)).joined(Self::from_f64(b));
        let is_zero = hull.low == 0.0 && hull.high == 0.0;
        if is_zero { Self { low: 0.0, high: -0.0, ..hull } } else { hull }
    }

    pub(super) fn with_half(bits: EnvelopeInt) -> Self {
        let of = |bits: u32| from_half(bits & 0xffff);
        let (low, high) = bits.interval();
        let (a, b) = (of(low as u32), of(high as u32));
        let ordered = (low >= 0 && high < 0x8000) || (low >= 0x8000 && high <= 0xffff) || bits.is_bound;
        if !ordered || a.is_nan() || b.is_nan() {
            return Self::anything(of(bits.bits));
        }
        let hull = Self::from_f64(of(bits.bits)).joined(Self::from_f64(a)).joined(Self::from_f64(b));
        // Numbers below 2^-14 may be flushed to 0.
        let small = hull.low < 6.103_515_625e-5 && hull.high > -6.103_515_625e-5;
        if small { hull.joined(Self::from_f64(0.0)) } else { hull }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glisten_scene::picture::Interval;

    fn of(low: f64, high: f64) -> EnvelopeFloat {
        EnvelopeFloat::with_interval(low, Interval { low, high, may_be_nan: false })
    }

    #[test]
    fn bits_of_one_sign_are_in_order() {
        for (low, high) in [(1.0, 1.5), (-1.5, -1.0), (0.0, 2.0)] {
            let bits = of(low, high).bits_of();
            for step in 0..=16 {
                let value = (low + (high - low) * f64::from(step) / 16.0) as f32;
                let (least, most) = bits.interval();
                assert!((least..=most).contains(&(value.to_bits() as i32)), "{value}");
            }
            let back = EnvelopeFloat::with_bits(bits);
            assert!(back.low <= low && back.high >= high);
        }
        assert_eq!(of(-1.0, 1.0).bits_of().interval(), (i32::MIN, i32::MAX));
        let zero = of(0.0, 0.0);
        assert_eq!(zero.bits_of(), EnvelopeInt::either(0, SIGN));
        assert!(EnvelopeFloat::with_bits(zero.bits_of()).has_open_sign());
        assert!(EnvelopeFloat::from_f64(0.0).bits_of().is_decided(), "it is loaded");
        let back = EnvelopeFloat::with_half(zero.half_of());
        assert_eq!((back.low, back.high), (0.0, 0.0));
        assert!(of(1.0, 1.0).bits_of().is_decided());
    }

    #[test]
    fn halves_are_in_order() {
        for (low, high) in [(1.0, 1.5), (-1.5, -1.0)] {
            let bits = of(low, high).half_of();
            let back = EnvelopeFloat::with_half(bits);
            assert!(back.low <= low && back.high >= high && back.high - back.low < 0.6, "{back:?}");
        }
    }
}
