//! The expected results of the functions of bits, computed bit by bit.

use super::oracle::{Argument, Want};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::Scalar;

/// The argument's component, or its only one.
fn bits(arguments: &[Argument], argument: usize, component: usize) -> u32 {
    let bits = &arguments[argument].bits;
    bits[if bits.len() == 1 { 0 } else { component }]
}

fn bit(value: u32, place: u32) -> bool {
    place < 32 && (value >> place) & 1 == 1
}

fn of_bits(f: impl Fn(u32) -> bool) -> u32 {
    (0..32).map(|place| u32::from(f(place)) << place).sum()
}

/// The component `k` of the result.
pub(super) fn expected(function: F, arguments: &[Argument], k: usize) -> Want {
    let value = bits(arguments, 0, k);
    let signed = arguments[0].scalar == Scalar::Int;
    match function {
        F::BitfieldReverse => Want::Bits(of_bits(|place| bit(value, 31 - place))),
        F::BitCount => Want::Bits((0..32).filter(|place| bit(value, *place)).count() as u32),
        F::FindLsb => Want::Bits((0..32).find(|place| bit(value, *place)).unwrap_or(u32::MAX)),
        F::FindMsb => {
            let sign = signed && bit(value, 31);
            Want::Bits((0..32).rev().find(|place| bit(value, *place) != sign).unwrap_or(u32::MAX))
        }
        F::BitfieldExtract => match field(arguments, 1) {
            None => Want::Anything,
            Some((offset, count)) => Want::Bits(of_bits(|place| match place < count {
                true => bit(value, offset + place),
                false => signed && count > 0 && bit(value, offset + count - 1),
            })),
        },
        F::BitfieldInsert => match field(arguments, 2) {
            None => Want::Anything,
            Some((offset, count)) => Want::Bits(of_bits(|place| match place.checked_sub(offset) {
                Some(within) if within < count => bit(bits(arguments, 1, k), within),
                _ => bit(value, place),
            })),
        },
        _ => Want::Anything,
    }
}

/// The offset and the number of bits, where they are defined (GLSL 4.00 §8.8).
fn field(arguments: &[Argument], first: usize) -> Option<(u32, u32)> {
    let (offset, count) = (bits(arguments, first, 0), bits(arguments, first + 1, 0));
    (offset <= 32 && count <= 32 && offset + count <= 32).then_some((offset, count))
}

/// The component `k` of an unpacked `uint`.
pub(super) fn unpacked(function: F, arguments: &[Argument], k: usize) -> f64 {
    let value = u64::from(arguments[0].bits[0]);
    let (halves, bytes) = (value >> (16 * k), value >> (8 * k));
    match function {
        F::UnpackUnorm2x16 => f64::from(halves as u16) / 65535.0,
        F::UnpackSnorm2x16 => (f64::from(halves as i16) / 32767.0).max(-1.0),
        F::UnpackUnorm4x8 => f64::from(bytes as u8) / 255.0,
        F::UnpackSnorm4x8 => (f64::from(bytes as i8) / 127.0).max(-1.0),
        _ => half(halves as u16),
    }
}

/// A 16-bit float as an f32 whose exponent is 112 too small.
fn half(bits: u16) -> f64 {
    let sign = if bits & 0x8000 == 0 { 1.0 } else { -1.0 };
    let size = u32::from(bits & 0x7fff);
    match size {
        0x7c00 => sign * f64::INFINITY,
        0x7c01.. => f64::NAN,
        _ => sign * f64::from(f32::from_bits(size << 13)) * 2.0_f64.powi(112),
    }
}
