//! [`Big`]: numbers of 192 bits, a reference for the reference.
//!
//! *In:* f64 values. *Out:* the results of each operation, rounded once to 192 bits; functions are those of `astro-float`,
//! computed with more bits and their arguments reduced in full, so that the sine of 1e22 has all digits.
//!
//! *Holds:* it is a fixed-size number, since registers are copied. Exponents are those of binary128: a result of 2^16384 or
//! more is infinite, one below 2^-16384 is 0. Infinities, NaNs and signed zeros follow IEEE 754, as in f64.

mod functions;
#[cfg(test)]
mod tests;
mod words;

use super::{Element, WIDTH};
use astro_float_num::{BigFloat, RoundingMode, Sign};
use std::cmp::Ordering;

/// The bits of a number.
pub const BITS: usize = 64 * WORDS;
const WORDS: usize = 3;

/// Exponents are at most that far from 0.
const MOST_EXPONENT: i32 = 16_384;

const TO_EVEN: RoundingMode = RoundingMode::ToEven;

/// A number without its sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Class {
    #[default]
    Zero,
    /// `0.mantissa` times 2 to the exponent.
    Finite,
    Infinite,
    Nan,
}

/// A number of 192 bits, which may be infinite or NaN.
#[derive(Clone, Copy, Debug, Default)]
pub struct Big {
    /// The least significant word first; the highest bit of the last is set. 0 unless the number is finite and not 0.
    words: [u64; WORDS],
    exponent: i32,
    class: Class,
    negative: bool,
}

impl Element for Big {
    type Block = [Self; WIDTH];
}

impl Big {
    const NAN: Self = Self { words: [0; WORDS], exponent: 0, class: Class::Nan, negative: false };

    /// Exactly this value.
    fn of(value: f64) -> Self {
        let negative = value.is_sign_negative();
        let special = |class: Class| Self { class, negative, ..Self::default() };
        match value {
            _ if value.is_nan() => Self::NAN,
            _ if value.is_infinite() => special(Class::Infinite),
            0.0 => special(Class::Zero),
            _ => {
                let bits = value.to_bits();
                let fraction = bits & ((1 << 52) - 1);
                let biased = (bits >> 52 & 0x7ff) as i32;
                let whole = if biased == 0 { fraction } else { fraction | 1 << 52 };
                let shift = whole.leading_zeros();
                // The value is `whole` times 2^(max(biased, 1) - 1075), and `whole` is 0.words times 2^(64 - shift).
                let exponent = biased.max(1) - 1075 + 64 - shift as i32;
                Self { words: [0, 0, whole << shift], exponent, class: Class::Finite, negative }
            }
        }
    }

    /// The nearest f64.
    fn nearest(self) -> f64 {
        let sign = if self.negative { -1.0 } else { 1.0 };
        let size = match self.class {
            Class::Zero => 0.0,
            Class::Infinite => f64::INFINITY,
            Class::Nan => return f64::NAN,
            Class::Finite => self.nearest_size(),
        };
        sign * size
    }

    fn nearest_size(self) -> f64 {
        let [low, middle, high] = self.words;
        // What is below the highest word decides ties only.
        let sticky = u64::from(low | middle != 0);
        match self.exponent {
            1025.. => f64::INFINITY,
            // Normal: the conversion rounds to 53 bits, with the lowest as the sticky one. The two factors are exact.
            exponent @ -1021.. => {
                (high | sticky) as f64 * 2f64.powi(-64 + exponent / 2) * 2f64.powi(exponent - exponent / 2)
            }
            // Subnormal: a whole multiple of 2^-1074.
            exponent => {
                let drop = -1010 - exponent;
                match drop {
                    ..64 => {
                        let (kept, rest) = (high >> drop, high << (64 - drop) | sticky);
                        let up = rest > 1 << 63 || (rest == 1 << 63 && kept & 1 == 1);
                        f64::from_bits(kept + u64::from(up))
                    }
                    64 if high > 1 << 63 || (high == 1 << 63 && sticky == 1) => f64::from_bits(1),
                    _ => 0.0,
                }
            }
        }
    }

    fn sign(self) -> Sign {
        if self.negative { Sign::Neg } else { Sign::Pos }
    }

    /// The number for `astro-float`, if it is finite.
    fn wide(self) -> BigFloat {
        match self.class {
            Class::Finite => BigFloat::from_words(&words::of_machine(&self.words), self.sign(), self.exponent),
            _ => BigFloat::from_f64(0.0, BITS),
        }
    }

    /// The nearest number to one of any precision.
    fn rounded(value: &BigFloat) -> Self {
        if value.is_nan() {
            return Self::NAN;
        }
        let negative = value.is_negative();
        if value.is_inf() {
            return Self { class: Class::Infinite, negative, ..Self::default() };
        }
        let Some((given, _, _, exponent, _)) = value.as_raw_parts() else { return Self::NAN };
        let Some(top) = given.last().filter(|_| !value.is_zero()) else {
            return Self { negative, ..Self::default() };
        };
        if top.leading_zeros() > 0 || exponent < -MOST_EXPONENT {
            // Below the range of exponents, where the mantissa may not be normalized either.
            return Self { negative, ..Self::default() };
        }
        let given = words::of_64_bits(given);
        let (rest, kept) = given.split_at(given.len().saturating_sub(WORDS));
        let mut words = [0; WORDS];
        words[WORDS - kept.len()..].copy_from_slice(kept);
        Self { words, exponent, class: Class::Finite, negative }.rounded_by(rest)
    }

    /// Rounds to even by the words below.
    fn rounded_by(mut self, rest: &[u64]) -> Self {
        const HALF: u64 = 1 << 63;
        let Some((first, lower)) = rest.split_last() else { return self.limited() };
        let beyond = lower.iter().any(|word| *word != 0);
        let up = *first > HALF || (*first == HALF && (beyond || self.words[0] & 1 == 1));
        let mut carry = up;
        for word in &mut self.words {
            (*word, carry) = word.overflowing_add(u64::from(carry));
        }
        if carry {
            self.words = [0, 0, HALF];
            self.exponent += 1;
        }
        self.limited()
    }

    /// The number within the range of exponents.
    fn limited(self) -> Self {
        match self.exponent {
            exponent if exponent > MOST_EXPONENT => {
                Self { class: Class::Infinite, negative: self.negative, ..Self::default() }
            }
            exponent if exponent < -MOST_EXPONENT => Self { negative: self.negative, ..Self::default() },
            _ => self,
        }
    }

    /// Whether IEEE 754 has a rule for an operand that no arithmetic is needed for.
    fn is_special(self) -> bool {
        self.class != Class::Finite
    }

    /// An f64 of the same class and sign, for the rules of IEEE 754 about zeros, infinities and NaNs.
    fn token(self) -> f64 {
        let size = match self.class {
            Class::Zero => 0.0,
            Class::Finite => 1.0,
            Class::Infinite => f64::INFINITY,
            Class::Nan => f64::NAN,
        };
        if self.negative { -size } else { size }
    }

    fn signed(self, negative: bool) -> Self {
        Self { negative, ..self }
    }

    /// The order; `None` with a NaN.
    fn order(self, other: Self) -> Option<Ordering> {
        if self.is_special() || other.is_special() {
            // A finite number against a special one, or two special ones: their tokens are in the same order.
            return self.token().partial_cmp(&other.token());
        }
        let size =
            self.exponent.cmp(&other.exponent).then_with(|| self.words.iter().rev().cmp(other.words.iter().rev()));
        Some(match (self.negative, other.negative) {
            (false, true) => Ordering::Greater,
            (true, false) => Ordering::Less,
            (false, false) => size,
            (true, true) => size.reverse(),
        })
    }
}
