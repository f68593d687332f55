//! Lowers the functions of the bits of numbers (GLSL 3.30 §8.3; 4.20 §8.4, §8.8).

use super::Try;
use super::function::Ctx;
use super::operators::Typed;
use glisten_front::builtin::operations::{BitCast, BitFunction, Format, Packing};
use glisten_front::hir::{Scalar, TypeId};
use naga::{Expression, Handle, Literal, MathFunction, ScalarKind};

/// The bits of an integer.
const BITS: u32 = 32;

impl Ctx<'_, '_> {
    /// The same bits as another type.
    pub(super) fn bit_cast(&mut self, op: BitCast, value: Handle<Expression>) -> Handle<Expression> {
        let kind = match op {
            BitCast::FloatToInt => ScalarKind::Sint,
            BitCast::FloatToUint => ScalarKind::Uint,
            BitCast::IntToFloat | BitCast::UintToFloat => ScalarKind::Float,
        };
        self.add(Expression::As { expr: value, kind, convert: None })
    }

    /// A function of integers. naga's functions return the type of their argument, and take counts that are `uint`s.
    pub(super) fn bit_function(&mut self, op: BitFunction, values: &[Typed], ty: TypeId) -> Try<Handle<Expression>> {
        let function = match op {
            BitFunction::Extract => MathFunction::ExtractBits,
            BitFunction::Insert => MathFunction::InsertBits,
            BitFunction::Reverse => MathFunction::ReverseBits,
            BitFunction::Count => MathFunction::CountOneBits,
            BitFunction::Lowest => MathFunction::FirstTrailingBit,
            BitFunction::Highest => MathFunction::FirstLeadingBit,
        };
        let Some(&(arg, arg_ty)) = values.first() else {
            return Err(self.internal_error("a function of bits without an argument"));
        };
        let n_numbers = if op == BitFunction::Insert { 2 } else { 1 };
        let mut arguments = Vec::with_capacity(3);
        // Bits beyond the last are undefined (4.00 §8.8), and WGSL rejects constants that ask for them.
        let mut free = Some(BITS);
        for (index, &(value, _)) in values.iter().enumerate().skip(1) {
            arguments.push(match (index < n_numbers, self.literal_count(value), free) {
                (true, ..) => value,
                (false, Some(count), most) => {
                    let count = count.min(most.unwrap_or(BITS));
                    free = most.map(|most| most - count);
                    self.uint(count)
                }
                (false, None, _) => {
                    free = None;
                    self.as_kind(value, ScalarKind::Uint)
                }
            });
        }
        let mut rest = arguments.into_iter();
        let (arg1, arg2, arg3) = (rest.next(), rest.next(), rest.next());
        let result = self.add(Expression::Math { fun: function, arg, arg1, arg2, arg3 });
        let (from, to) = (self.low.types.scalar_of(arg_ty), self.low.types.scalar_of(ty));
        Ok(if from == Some(Scalar::Uint) && to == Some(Scalar::Int) {
            self.as_kind(result, ScalarKind::Sint)
        } else {
            result
        })
    }

    /// The value of a literal, a negative one as a large number.
    pub(super) fn literal_count(&self, expr: Handle<Expression>) -> Option<u32> {
        match self.expressions()[expr] {
            Expression::Literal(Literal::I32(count)) => Some(count as u32),
            Expression::Literal(Literal::U32(count)) => Some(count),
            _ => None,
        }
    }

    fn as_kind(&mut self, expr: Handle<Expression>, kind: ScalarKind) -> Handle<Expression> {
        self.add(Expression::As { expr, kind, convert: None })
    }

    /// `packUnorm4x8` and so on.
    pub(super) fn packing(&mut self, op: Packing, value: Handle<Expression>) -> Handle<Expression> {
        use MathFunction as M;
        let function = match (op.unpacks, op.format, op.components) {
            (false, Format::Half, _) => M::Pack2x16float,
            (true, Format::Half, _) => M::Unpack2x16float,
            (false, Format::Unorm, 2) => M::Pack2x16unorm,
            (true, Format::Unorm, 2) => M::Unpack2x16unorm,
            (false, Format::Snorm, 2) => M::Pack2x16snorm,
            (true, Format::Snorm, 2) => M::Unpack2x16snorm,
            (false, Format::Unorm, _) => M::Pack4x8unorm,
            (true, Format::Unorm, _) => M::Unpack4x8unorm,
            (false, Format::Snorm, _) => M::Pack4x8snorm,
            (true, Format::Snorm, _) => M::Unpack4x8snorm,
        };
        self.math1(function, value)
    }
}
