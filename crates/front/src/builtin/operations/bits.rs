//! The functions of the bits of numbers on plain `u32`s and f64s, for constant folding and for the reference.
//!
//! Undefined by GLSL and defined here: the place and the size of a field that is not inside of 32 bits are amounts of shifts, of
//! which the lowest five bits count; a NaN is packed as the least number.

use super::{BitFunction, Format, Packing, kernel};

/// The lowest `count` bits.
#[inline(always)]
pub(super) fn mask(count: u32) -> u32 {
    if count as i32 >= 32 { u32::MAX } else { 1u32.wrapping_shl(count).wrapping_sub(1) }
}

/// `bitfieldExtract`: `count` bits from `offset` on, the highest of them repeated if `signed` (GLSL 4.00 §8.8).
pub(super) fn extract(value: u32, offset: u32, count: u32, signed: bool) -> u32 {
    let field = value.wrapping_shr(offset) & mask(count);
    let spare = 32u32.wrapping_sub(count);
    if signed { (field.wrapping_shl(spare) as i32).wrapping_shr(spare) as u32 } else { field }
}

/// `bitfieldInsert`: `base` with the lowest `count` bits of `insert` from `offset` on (GLSL 4.00 §8.8).
pub(super) fn insert(base: u32, insert: u32, offset: u32, count: u32) -> u32 {
    let low = mask(count);
    base & !low.wrapping_shl(offset) | (insert & low).wrapping_shl(offset)
}

/// `findLSB`: the place of the lowest bit that is set, or -1.
pub(super) fn lowest(value: u32) -> u32 {
    if value == 0 { u32::MAX } else { value.trailing_zeros() }
}

/// `findMSB`: the place of the highest bit that is set, or for negative `int`s of the highest that is not; or -1.
pub(super) fn highest(value: u32, signed: bool) -> u32 {
    let value = if signed && (value as i32) < 0 { !value } else { value };
    31u32.wrapping_sub(value.leading_zeros())
}

impl BitFunction {
    /// The function with up to two integers and two counts; `signed` for `int`s.
    pub fn of(self, a: u32, b: u32, offset: u32, count: u32, signed: bool) -> u32 {
        match self {
            Self::Extract => extract(a, offset, count, signed),
            Self::Insert => insert(a, b, offset, count),
            Self::Reverse => a.reverse_bits(),
            Self::Count => a.count_ones(),
            Self::Lowest => lowest(a),
            Self::Highest => highest(a, signed),
        }
    }
}

/// The 16-bit float nearest to a number, to even at halves.
pub fn to_half(value: f64) -> u32 {
    let sign = u32::from(value.is_sign_negative()) << 15;
    let size = value.abs();
    if size.is_nan() {
        return sign | 0x7e00;
    }
    // The largest finite one is 65504; from half a step above it on, numbers round to infinity.
    if size >= 65520.0 {
        return sign | 0x7c00;
    }
    // Below 2^-14 the steps are 2^-24.
    let exponent = ((size.to_bits() >> 52) as i32 - 1023).max(-14);
    let step = f64::from_bits(((1023 + exponent - 10) as u64) << 52);
    let steps = (size / step).round_ties_even() as u32;
    // A carry into the next power of two is right as it is.
    sign | (((exponent + 14) as u32) << 10).wrapping_add(steps)
}

/// The number that the bits of a 16-bit float mean.
pub fn from_half(bits: u32) -> f64 {
    let (sign, exponent, fraction) = (bits >> 15 & 1, bits >> 10 & 31, bits & 0x3ff);
    let power = |exponent: i32| f64::from_bits(((1023 + exponent) as u64) << 52);
    let size = match exponent {
        0 => f64::from(fraction) * power(-24),
        31 if fraction == 0 => f64::INFINITY,
        31 => f64::NAN,
        _ => f64::from(fraction | 0x400) * power(exponent as i32 - 25),
    };
    if sign == 1 { -size } else { size }
}

impl Packing {
    /// A component as the bits that it takes (GLSL 4.20 §8.4). The product is one of f32, as in a shader.
    pub fn packed(self, value: f64) -> u32 {
        let scaled = |value: f64| ((value * f64::from(self.one())) as f32).round_ties_even();
        let bits = match self.format {
            Format::Unorm => scaled(kernel::clamp(value, 0.0, 1.0)) as u32,
            Format::Snorm => scaled(kernel::clamp(value, -1.0, 1.0)) as i32 as u32,
            Format::Half => to_half(value),
        };
        bits & mask(self.bits())
    }

    /// The component that the lowest bits mean.
    pub fn unpacked(self, bits: u32) -> f64 {
        let one = f64::from(self.one());
        match self.format {
            Format::Unorm => f64::from(bits & mask(self.bits())) / one,
            Format::Snorm => (f64::from(extract(bits, 0, self.bits(), true) as i32) / one).max(-1.0),
            Format::Half => from_half(bits & 0xffff),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields() {
        assert_eq!(extract(0xabcd_1234, 8, 8, false), 0x12);
        assert_eq!(extract(0x0000_8000, 8, 8, true), 0xffff_ff80);
        assert_eq!(extract(0xabcd_1234, 0, 32, true), 0xabcd_1234);
        assert_eq!(extract(0xabcd_1234, 32, 0, true), 0);
        assert_eq!(insert(0xffff_ffff, 0, 4, 8), 0xffff_f00f);
        assert_eq!(insert(0x1234_5678, 0xffff_ffff, 0, 32), 0xffff_ffff);
        assert_eq!((lowest(0), lowest(8)), (u32::MAX, 3));
        assert_eq!((highest(0, false), highest(0x80, false)), (u32::MAX, 7));
        assert_eq!((highest(u32::MAX, true), highest(0xffff_ff00, true)), (u32::MAX, 7));
    }

    #[test]
    fn halves_go_there_and_back() {
        for bits in 0..0x1_0000 {
            let value = from_half(bits);
            if !value.is_nan() {
                assert_eq!(to_half(value), bits, "{value}");
            }
        }
        assert_eq!(to_half(65519.9), 0x7bff);
        assert_eq!(to_half(65520.0), 0x7c00);
        assert_eq!(to_half(1.0 + 1.0 / 2048.0), 0x3c00, "to even");
        assert_eq!(to_half(1e-9), 0);
        assert_eq!(to_half(2047.9 / 2048.0), 0x3c00, "carries");
    }

    #[test]
    fn normalized_formats() {
        let unorm = Packing { unpacks: false, format: Format::Unorm, components: 4 };
        assert_eq!((unorm.packed(1.0), unorm.packed(2.0), unorm.packed(f64::NAN)), (255, 255, 0));
        // 76.5 in f32, and more than that before it is rounded.
        assert_eq!(unorm.packed(f64::from(0.3_f32)), 76);
        let snorm = Packing { format: Format::Snorm, ..unorm };
        assert_eq!((snorm.packed(-1.0), snorm.unpacked(0x80), snorm.unpacked(0x81)), (0x81, -1.0, -1.0));
    }
}
