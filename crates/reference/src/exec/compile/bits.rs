//! Compiles the functions of the bits of numbers (GLSL 3.30 §8.3; 4.20 §8.4, §8.8) to instructions on scalars.

use super::super::inst::{Class as File, Float1, Float2, Float3, FloatToInt, Inst, Int1, Int2, IntToFloat, Operand};
use super::expr::component;
use super::{Compiler, Val};
use glisten_front::builtin::operations::{BitCast, BitFunction, Format, Packing};
use glisten_front::hir::Scalar;

impl Compiler<'_> {
    pub(super) fn bit_cast(&mut self, op: BitCast, values: &[Operand]) -> Val {
        let one = |this: &mut Self, a: Operand| match op {
            BitCast::FloatToInt | BitCast::FloatToUint => this.float_as_int(FloatToInt::Bits, a),
            BitCast::IntToFloat | BitCast::UintToFloat => this.int_as_float(IntToFloat::Bits, a),
        };
        values.iter().map(|a| one(self, *a)).collect()
    }

    fn float_as_int(&mut self, op: FloatToInt, a: Operand) -> Operand {
        self.emit.pure(File::Int, &[a], |dst| Inst::FloatToInt { op, dst, a })
    }

    fn int_as_float(&mut self, op: IntToFloat, a: Operand) -> Operand {
        self.emit.pure(File::Float, &[a], |dst| Inst::IntToFloat { op, dst, a })
    }

    /// A function of integers; the counts of fields are scalars.
    pub(super) fn bit_function(&mut self, op: BitFunction, values: &[Val], scalar: Scalar) -> Val {
        let Some(first) = values.first() else { return Val::new() };
        let signed = scalar == Scalar::Int;
        let one = match op {
            BitFunction::Extract | BitFunction::Insert => return self.fields(op, values, signed),
            BitFunction::Reverse => Int1::Reverse,
            BitFunction::Count => Int1::Count,
            BitFunction::Lowest => Int1::Lowest,
            BitFunction::Highest if signed => Int1::HighestSigned,
            BitFunction::Highest => Int1::HighestUnsigned,
        };
        first.iter().map(|a| self.int1(one, *a)).collect()
    }

    /// `bitfieldExtract(value, offset, bits)`, `bitfieldInsert(base, insert, offset, bits)`
    fn fields(&mut self, op: BitFunction, values: &[Val], signed: bool) -> Val {
        let (Some((count, rest)), Some(first)) = (values.split_last(), values.first()) else { return Val::new() };
        let scalar = |value: Option<&Val>| value.and_then(|value| component(value, 0));
        let (Some(count), Some(offset)) = (scalar(Some(count)), scalar(rest.last())) else { return Val::new() };
        let mask = self.mask(count);
        // A field without bits is defined at any offset, and no shift finds it.
        let offset = self.unless(count, 0, offset);
        let inserted: &[Operand] =
            if op == BitFunction::Insert { values.get(1).map_or(&[], |value| value) } else { &[] };
        (0..first.len())
            .filter_map(|flat| {
                let value = component(first, flat)?;
                Some(match component(inserted, flat) {
                    Some(insert) => self.inserted(value, insert, offset, mask),
                    None => self.extracted(value, offset, count, mask, signed),
                })
            })
            .collect()
    }

    /// An amount to shift by, and 0 if `count` is `zero`: there the result of the shift is not read.
    fn unless(&mut self, count: Operand, zero: u32, amount: Operand) -> Operand {
        let (zero, nothing) = (self.emit.int(zero), self.emit.int(0));
        let is_zero = self.int2(Int2::Equal, count, zero);
        self.select(File::Int, is_zero, nothing, amount)
    }

    /// The lowest `count` bits; all of them for 32.
    fn mask(&mut self, count: Operand) -> Operand {
        let (one, all, limit) = (self.emit.int(1), self.emit.int(u32::MAX), self.emit.int(32));
        let amount = self.unless(count, 32, count);
        let power = self.int2(Int2::Shl, one, amount);
        let below = self.int2(Int2::Sub, power, one);
        let is_all = self.int2(Int2::LessEqualSigned, limit, count);
        self.select(File::Int, is_all, all, below)
    }

    fn extracted(&mut self, value: Operand, offset: Operand, count: Operand, mask: Operand, signed: bool) -> Operand {
        let shifted = self.int2(Int2::ShrUnsigned, value, offset);
        let field = self.int2(Int2::And, shifted, mask);
        if !signed {
            return field;
        }
        let bits = self.emit.int(32);
        let spare = self.int2(Int2::Sub, bits, count);
        let spare = self.unless(count, 0, spare);
        let raised = self.int2(Int2::Shl, field, spare);
        self.int2(Int2::ShrSigned, raised, spare)
    }

    fn inserted(&mut self, base: Operand, insert: Operand, offset: Operand, mask: Operand) -> Operand {
        let field = self.int2(Int2::Shl, mask, offset);
        let outside = self.int1(Int1::BitNot, field);
        let kept = self.int2(Int2::And, base, outside);
        let low = self.int2(Int2::And, insert, mask);
        let placed = self.int2(Int2::Shl, low, offset);
        self.int2(Int2::Or, kept, placed)
    }

    /// `packUnorm4x8` and so on: the components from the lowest bits up.
    pub(super) fn packing(&mut self, op: Packing, values: &[Operand]) -> Val {
        if op.unpacks {
            let Some(bits) = component(values, 0) else { return Val::new() };
            return (0..u32::from(op.components)).map(|index| self.unpacked(op, bits, index)).collect();
        }
        let mut all: Option<Operand> = None;
        for (index, value) in (0..).zip(values) {
            let part = self.packed(op, *value);
            let amount = self.emit.int(index * op.bits());
            let placed = self.int2(Int2::Shl, part, amount);
            all = Some(match all {
                None => placed,
                Some(before) => self.int2(Int2::Or, before, placed),
            });
        }
        all.into_iter().collect()
    }

    fn packed(&mut self, op: Packing, value: Operand) -> Operand {
        let least = match op.format {
            Format::Half => return self.float_as_int(FloatToInt::Half, value),
            Format::Unorm => 0.0,
            Format::Snorm => -1.0,
        };
        let (least, most, one) = (self.emit.float(least), self.emit.float(1.0), self.emit.float(op.one() as f32));
        let limited = self.emit.pure(File::Float, &[value, least, most], |dst| Inst::Float3 {
            op: Float3::Clamp,
            dst,
            a: value,
            b: least,
            c: most,
        });
        let scaled = self.float2(Float2::Mul, limited, one);
        let rounded = self.float1(Float1::Round, scaled);
        let bits = self.float_as_int(FloatToInt::Int, rounded);
        let mask = self.emit.int((1u32 << op.bits()) - 1);
        self.int2(Int2::And, bits, mask)
    }

    fn unpacked(&mut self, op: Packing, bits: Operand, index: u32) -> Operand {
        let (width, places) = (op.bits(), index * op.bits());
        let (amount, mask) = (self.emit.int(places), self.emit.int((1u32 << width) - 1));
        let shifted = self.int2(Int2::ShrUnsigned, bits, amount);
        let part = self.int2(Int2::And, shifted, mask);
        let one = self.emit.float(op.one() as f32);
        match op.format {
            Format::Half => self.int_as_float(IntToFloat::Half, part),
            Format::Unorm => {
                let number = self.int_as_float(IntToFloat::Uint, part);
                self.float2(Float2::Div, number, one)
            }
            Format::Snorm => {
                let spare = self.emit.int(32 - width);
                let raised = self.int2(Int2::Shl, part, spare);
                let number = self.int2(Int2::ShrSigned, raised, spare);
                let number = self.int_as_float(IntToFloat::Int, number);
                let quotient = self.float2(Float2::Div, number, one);
                let least = self.emit.float(-1.0);
                self.float2(Float2::Max, quotient, least)
            }
        }
    }
}
