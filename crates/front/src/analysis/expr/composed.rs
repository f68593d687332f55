//! Built-in functions that no target has as such: their calls are written out in other operations (GLSL 4.00 §8.3,
//! §8.8; AMD_shader_trinary_minmax).
//!
//! *Holds:* arguments are evaluated once and in order. What is used twice is kept in a local.

use super::super::context::Analyzer;
use crate::builtin::{BuiltinFunction as F, fixed};
use crate::hir::{BinaryOp, ConstructKind, ExprId, ExprKind, Local, LocalKind, Scalar, ScalarValue, TypeId, VarRef};
use crate::source::Span;

/// The bits of the exponent of a float, and the exponent that is 0.
const EXPONENT: u32 = 0x7f80_0000;
const BIAS: i32 = 127;

impl Analyzer<'_> {
    /// A call of such a function; its arguments have the types of the parameters.
    pub(super) fn composed(&mut self, function: F, arguments: &[ExprId], span: Span) -> ExprId {
        if function == F::Ftransform {
            return self.ftransform(span);
        }
        let mut out = Writer { analyzer: self, span };
        let call = match (function, arguments) {
            (F::Min3, &[x, y, z]) => out.extremum(F::Min, x, y, z),
            (F::Max3, &[x, y, z]) => out.extremum(F::Max, x, y, z),
            (F::Mid3, &[x, y, z]) => out.median(x, y, z),
            (F::Ldexp, &[x, exponent]) => out.ldexp(x, exponent),
            (F::Frexp, &[x, exponent]) => out.frexp(x, exponent),
            (F::UaddCarry, &[x, y, carry]) => out.carried(x, y, carry, BinaryOp::Add),
            (F::UsubBorrow, &[x, y, borrow]) => out.carried(x, y, borrow, BinaryOp::Sub),
            (F::UmulExtended, &[x, y, high, low]) => out.multiplied(x, y, high, low, false),
            (F::ImulExtended, &[x, y, high, low]) => out.multiplied(x, y, high, low, true),
            _ => None,
        };
        call.unwrap_or_else(|| self.poison(span))
    }
}

impl Analyzer<'_> {
    /// `gl_ModelViewProjectionMatrix * gl_Vertex` (GLSL 1.20 §8.4).
    fn ftransform(&mut self, span: Span) -> ExprId {
        let mut variable = |name| {
            let row = fixed::named(name, self.ast.version, self.stage)?;
            let id = self.fixed_global(row);
            Some(self.variable(VarRef::Global(id), span))
        };
        match (variable("gl_ModelViewProjectionMatrix"), variable("gl_Vertex")) {
            (Some(matrix), Some(vertex)) => {
                self.push(ExprKind::Binary(BinaryOp::MatMul, matrix, vertex), TypeId::VEC4, span)
            }
            _ => self.poison(span),
        }
    }
}

/// Writes expressions at one place.
struct Writer<'w, 'a> {
    analyzer: &'w mut Analyzer<'a>,
    span: Span,
}

impl Writer<'_, '_> {
    fn push(&mut self, kind: ExprKind, ty: TypeId) -> ExprId {
        self.analyzer.push(kind, ty, self.span)
    }

    /// The type with as many components as another.
    fn like(&self, ty: TypeId, scalar: Scalar) -> TypeId {
        TypeId::vector(scalar, self.analyzer.types.flat_len(ty).min(4) as u8)
    }

    fn binary(&mut self, op: BinaryOp, a: ExprId, b: ExprId) -> ExprId {
        let ty = self.analyzer.ty(a);
        self.push(ExprKind::Binary(op, a, b), ty)
    }

    /// A number in every component of a type.
    fn number(&mut self, value: ScalarValue, ty: TypeId) -> ExprId {
        let one = self.analyzer.literal(value, self.span);
        if self.analyzer.types.flat_len(ty) == 1 {
            return one;
        }
        self.push(ExprKind::Construct(ConstructKind::Splat, vec![one]), ty)
    }

    fn int(&mut self, value: i32, like: TypeId) -> ExprId {
        let ty = self.like(like, Scalar::Int);
        self.number(ScalarValue::Int(value), ty)
    }

    fn convert(&mut self, value: ExprId, scalar: Scalar) -> ExprId {
        let ty = self.like(self.analyzer.ty(value), scalar);
        if ty == self.analyzer.ty(value) { value } else { self.push(ExprKind::Convert(value), ty) }
    }

    fn call(&mut self, function: F, arguments: Vec<ExprId>, ty: TypeId) -> ExprId {
        self.push(ExprKind::BuiltinCall(function, arguments), ty)
    }

    /// A local that holds a value, and the assignment. Outside of functions there is none.
    fn keep(&mut self, value: ExprId) -> Option<(VarRef, ExprId)> {
        let ty = self.analyzer.ty(value);
        let local = Local { name: "part".to_owned(), ty, kind: LocalKind::Variable, value: None, span: self.span };
        let id = self.analyzer.add_local(local)?;
        self.analyzer.body.as_mut()?.parts.push(id);
        let place = VarRef::Local(id);
        let target = self.push(ExprKind::Var(place), ty);
        Some((place, self.push(ExprKind::Assign(None, target, value), ty)))
    }

    fn read(&mut self, place: VarRef, like: ExprId) -> ExprId {
        let ty = self.analyzer.ty(like);
        self.push(ExprKind::Var(place), ty)
    }

    fn assign(&mut self, target: ExprId, value: ExprId) -> ExprId {
        let ty = self.analyzer.ty(target);
        self.push(ExprKind::Assign(None, target, value), ty)
    }

    /// `a, b, c`
    fn sequence(&mut self, steps: &[ExprId]) -> Option<ExprId> {
        let (&first, rest) = steps.split_first()?;
        Some(rest.iter().fold(first, |all, &next| {
            let ty = self.analyzer.ty(next);
            self.push(ExprKind::Comma(all, next), ty)
        }))
    }

    /// `a < b` of `uint`s as 0 or 1.
    fn below(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let ty = self.analyzer.ty(a);
        let truth = self.like(ty, Scalar::Bool);
        let less = match self.analyzer.types.flat_len(ty) {
            1 => self.push(ExprKind::Binary(BinaryOp::Less, a, b), truth),
            _ => self.call(F::LessThan, vec![a, b], truth),
        };
        self.convert(less, Scalar::Uint)
    }

    /// `2^exponent`, for exponents of normal floats.
    fn power(&mut self, exponent: ExprId) -> ExprId {
        let ty = self.analyzer.ty(exponent);
        let float = self.like(ty, Scalar::Float);
        let bias = self.int(BIAS, ty);
        let biased = self.binary(BinaryOp::Add, exponent, bias);
        let places = self.int(23, ty);
        let bits = self.binary(BinaryOp::Shl, biased, places);
        self.call(F::IntBitsToFloat, vec![bits], float)
    }

    /// `min(min(x, y), z)` and the same of `max`.
    fn extremum(&mut self, function: F, x: ExprId, y: ExprId, z: ExprId) -> Option<ExprId> {
        let ty = self.analyzer.ty(x);
        let first = self.call(function, vec![x, y], ty);
        Some(self.call(function, vec![first, z], ty))
    }

    /// `mid3`: `max(min(x, y), min(max(x, y), z))`.
    fn median(&mut self, x: ExprId, y: ExprId, z: ExprId) -> Option<ExprId> {
        let ty = self.analyzer.ty(x);
        let of = |this: &mut Self, [a, b]: [ExprId; 2], [c, d]: [ExprId; 2]| {
            let low = this.call(F::Min, vec![a, b], ty);
            let high = this.call(F::Max, vec![c, d], ty);
            let most = this.call(F::Min, vec![high, z], ty);
            this.call(F::Max, vec![low, most], ty)
        };
        let is_constant = [x, y, z].into_iter().all(|id| self.analyzer.is_constant(id));
        if is_constant || self.analyzer.body.is_none() {
            // A constant, or the initializer of a global: it is written out twice.
            return Some(of(self, [x, y], [x, y]));
        }
        let ((x_place, x_kept), (y_place, y_kept)) = (self.keep(x)?, self.keep(y)?);
        let [first, second] = [0, 1].map(|_| [self.read(x_place, x), self.read(y_place, y)]);
        let result = of(self, first, second);
        self.sequence(&[x_kept, y_kept, result])
    }

    /// `x 2^e` as two products, so that the power may be outside of the range of normal floats.
    fn ldexp(&mut self, x: ExprId, exponent: ExprId) -> Option<ExprId> {
        let ty = self.analyzer.ty(exponent);
        let (least, most) = (self.int(-252, ty), self.int(254, ty));
        let limited = self.call(F::Clamp, vec![exponent, least, most], ty);
        let is_constant = self.analyzer.is_constant(x) && self.analyzer.is_constant(exponent);
        if is_constant || self.analyzer.body.is_none() {
            // A constant, or the initializer of a global: it is written out twice.
            let (half, rest) = self.halves(limited, limited);
            return Some(self.scaled(x, half, rest));
        }
        let (x_place, x_kept) = self.keep(x)?;
        let (place, kept) = self.keep(limited)?;
        let (one, other) = (self.read(place, limited), self.read(place, limited));
        let (half, rest) = self.halves(one, other);
        let x = self.read(x_place, x);
        let product = self.scaled(x, half, rest);
        self.sequence(&[x_kept, kept, product])
    }

    /// `e / 2`, and what is left of `e`.
    fn halves(&mut self, one: ExprId, other: ExprId) -> (ExprId, ExprId) {
        let ty = self.analyzer.ty(one);
        let two = self.int(2, ty);
        let half = self.binary(BinaryOp::Div, one, two);
        let rest = self.binary(BinaryOp::Sub, other, half);
        (half, rest)
    }

    fn scaled(&mut self, x: ExprId, half: ExprId, rest: ExprId) -> ExprId {
        let (half, rest) = (self.power(half), self.power(rest));
        let product = self.binary(BinaryOp::Mul, x, half);
        self.binary(BinaryOp::Mul, product, rest)
    }

    /// `frexp`: the fraction in 0.5 to 1, and the exponent, by the bits; 0 has both 0.
    fn frexp(&mut self, x: ExprId, exponent: ExprId) -> Option<ExprId> {
        let ty = self.analyzer.ty(x);
        let (ints, truth) = (self.like(ty, Scalar::Int), self.like(ty, Scalar::Bool));
        let as_bits = self.call(F::FloatBitsToInt, vec![x], ints);
        let (place, kept) = self.keep(as_bits)?;
        let masked = |this: &mut Self, mask: u32| {
            let bits = this.read(place, as_bits);
            let mask = this.int(mask as i32, ty);
            this.binary(BinaryOp::BitAnd, bits, mask)
        };
        // A number without exponent bits counts as 0, as on GPUs that flush it.
        let field = masked(self, EXPONENT);
        let zero = self.int(0, ty);
        let is_zero = match self.analyzer.types.flat_len(ty) {
            1 => self.push(ExprKind::Binary(BinaryOp::Equal, field, zero), truth),
            _ => self.call(F::Equal, vec![field, zero], truth),
        };
        let (zero_place, zero_kept) = self.keep(is_zero)?;
        let field = masked(self, EXPONENT);
        let places = self.int(23, ty);
        let shifted = self.binary(BinaryOp::Shr, field, places);
        let bias = self.int(BIAS - 1, ty);
        let plain = self.binary(BinaryOp::Sub, shifted, bias);
        let none = self.int(0, ty);
        let was_zero = self.read(zero_place, is_zero);
        let chosen = self.select(was_zero, none, plain);
        let stored = self.assign(exponent, chosen);
        let rest = masked(self, !EXPONENT);
        let half = self.int(0x3f00_0000, ty);
        let joined = self.binary(BinaryOp::BitOr, rest, half);
        let fraction = self.call(F::IntBitsToFloat, vec![joined], ty);
        let nothing = self.number(ScalarValue::Float(0.0), ty);
        let was_zero = self.read(zero_place, is_zero);
        let result = self.select(was_zero, nothing, fraction);
        self.sequence(&[kept, zero_kept, stored, result])
    }

    /// `condition ? yes : no`, component by component.
    fn select(&mut self, condition: ExprId, yes: ExprId, no: ExprId) -> ExprId {
        let ty = self.analyzer.ty(yes);
        match self.analyzer.types.flat_len(ty) {
            1 => self.push(ExprKind::Ternary(condition, yes, no), ty),
            _ => self.call(F::Mix, vec![no, yes, condition], ty),
        }
    }

    /// `uaddCarry`, `usubBorrow`
    fn carried(&mut self, x: ExprId, y: ExprId, carry: ExprId, op: BinaryOp) -> Option<ExprId> {
        let (x_place, x_kept) = self.keep(x)?;
        let (y_place, y_kept) = self.keep(y)?;
        let (a, b) = (self.read(x_place, x), self.read(y_place, y));
        let result = self.binary(op, a, b);
        let (place, kept) = self.keep(result)?;
        let first = self.read(x_place, x);
        // A sum that wrapped is below its terms; a difference wraps if the first number is below the second.
        let over = match op {
            BinaryOp::Add => {
                let sum = self.read(place, result);
                self.below(sum, first)
            }
            _ => {
                let second = self.read(y_place, y);
                self.below(first, second)
            }
        };
        let stored = self.assign(carry, over);
        let value = self.read(place, result);
        self.sequence(&[x_kept, y_kept, kept, stored, value])
    }

    /// `umulExtended`, `imulExtended`: the high half by the products of the 16-bit halves.
    fn multiplied(&mut self, x: ExprId, y: ExprId, high: ExprId, low: ExprId, signed: bool) -> Option<ExprId> {
        let unsigned = |this: &mut Self, value| this.convert(value, Scalar::Uint);
        let (a, b) = (unsigned(self, x), unsigned(self, y));
        let (a_place, a_kept) = self.keep(a)?;
        let (b_place, b_kept) = self.keep(b)?;
        let mut steps = vec![a_kept, b_kept];
        let part = |this: &mut Self, place: VarRef, like: ExprId, upper: bool| {
            let value = this.read(place, like);
            let ty = this.analyzer.ty(like);
            let amount = this.number(ScalarValue::Uint(if upper { 16 } else { 0xffff }), ty);
            this.binary(if upper { BinaryOp::Shr } else { BinaryOp::BitAnd }, value, amount)
        };
        let product = |this: &mut Self, a_upper: bool, b_upper: bool| {
            let (one, other) = (part(this, a_place, a, a_upper), part(this, b_place, b, b_upper));
            this.binary(BinaryOp::Mul, one, other)
        };
        // t = a1 b0 + (a0 b0 >> 16); m = a0 b1 + (t & 0xffff); high = a1 b1 + (t >> 16) + (m >> 16)
        let lowest = product(self, false, false);
        let (lowest_place, kept) = self.keep(lowest)?;
        steps.push(kept);
        let (cross, carried) = (product(self, true, false), part(self, lowest_place, lowest, true));
        let t = self.binary(BinaryOp::Add, cross, carried);
        let (t_place, kept) = self.keep(t)?;
        steps.push(kept);
        let (cross, carried) = (product(self, false, true), part(self, t_place, t, false));
        let m = self.binary(BinaryOp::Add, cross, carried);
        let (m_place, kept) = self.keep(m)?;
        steps.push(kept);
        let top = product(self, true, true);
        let (above, more) = (part(self, t_place, t, true), part(self, m_place, m, true));
        let top = self.binary(BinaryOp::Add, top, above);
        let mut top = self.binary(BinaryOp::Add, top, more);
        if signed {
            top = self.less_where_negative(top, (a_place, a), (b_place, b));
            top = self.less_where_negative(top, (b_place, b), (a_place, a));
        }
        let result = if signed { self.convert(top, Scalar::Int) } else { top };
        steps.push(self.assign(high, result));
        let (one, other) = (self.read(a_place, a), self.read(b_place, b));
        let product = self.binary(BinaryOp::Mul, one, other);
        let result = if signed { self.convert(product, Scalar::Int) } else { product };
        steps.push(self.assign(low, result));
        self.sequence(&steps)
    }

    /// `top - other` where the highest bit of `one` is set: `-(one >> 31) & other` is subtracted.
    fn less_where_negative(&mut self, top: ExprId, one: (VarRef, ExprId), other: (VarRef, ExprId)) -> ExprId {
        let ty = self.analyzer.ty(one.1);
        let value = self.read(one.0, one.1);
        let places = self.number(ScalarValue::Uint(31), ty);
        let sign = self.binary(BinaryOp::Shr, value, places);
        let other = self.read(other.0, other.1);
        let taken = self.binary(BinaryOp::Mul, sign, other);
        self.binary(BinaryOp::Sub, top, taken)
    }
}
