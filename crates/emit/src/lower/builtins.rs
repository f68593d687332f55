//! Lowers built-in functions (§8) except texture functions, in terms of naga's functions.
//!
//! *Holds:* the match is exhaustive, so a new function does not compile until it is lowered.

use super::function::Ctx;
use super::operators::Typed;
use super::{Try, unsupported};
use crate::target::WindowOrigin;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, Scalar, ScalarValue, TypeId};
use naga::{BinaryOperator, DerivativeAxis, DerivativeControl, Expression, Handle, MathFunction, UnaryOperator};

/// How a function is lowered.
enum Rule {
    /// naga's math function with the same arguments; a scalar among vectors is splatted.
    Math(MathFunction),
    /// A component-wise comparison of vectors.
    Compare(BinaryOperator),
    /// A derivative.
    Derivative(DerivativeAxis),
    /// A lowering of its own.
    Own,
    /// A texture function.
    Texture,
}

fn rule(function: BuiltinFunction) -> Rule {
    use BuiltinFunction as F;
    use MathFunction as M;
    match function {
        F::Radians => Rule::Math(M::Radians),
        F::Degrees => Rule::Math(M::Degrees),
        F::Sin => Rule::Math(M::Sin),
        F::Cos => Rule::Math(M::Cos),
        F::Tan => Rule::Math(M::Tan),
        F::Asin => Rule::Math(M::Asin),
        F::Acos => Rule::Math(M::Acos),
        F::Sinh => Rule::Math(M::Sinh),
        F::Cosh => Rule::Math(M::Cosh),
        F::Tanh => Rule::Math(M::Tanh),
        F::Asinh => Rule::Math(M::Asinh),
        F::Acosh => Rule::Math(M::Acosh),
        F::Atanh => Rule::Math(M::Atanh),
        F::Pow => Rule::Math(M::Pow),
        F::Exp => Rule::Math(M::Exp),
        F::Log => Rule::Math(M::Log),
        F::Exp2 => Rule::Math(M::Exp2),
        F::Log2 => Rule::Math(M::Log2),
        F::Sqrt => Rule::Math(M::Sqrt),
        F::Inversesqrt => Rule::Math(M::InverseSqrt),
        F::Abs => Rule::Math(M::Abs),
        F::Sign => Rule::Math(M::Sign),
        F::Floor => Rule::Math(M::Floor),
        F::Trunc => Rule::Math(M::Trunc),
        // §8.3 leaves open in which direction `round` rounds a half; naga's rounds it to even.
        F::Round | F::RoundEven => Rule::Math(M::Round),
        F::Ceil => Rule::Math(M::Ceil),
        F::Fract => Rule::Math(M::Fract),
        F::Min => Rule::Math(M::Min),
        F::Max => Rule::Math(M::Max),
        F::Clamp => Rule::Math(M::Clamp),
        F::Step => Rule::Math(M::Step),
        F::Length => Rule::Math(M::Length),
        F::Distance => Rule::Math(M::Distance),
        F::Cross => Rule::Math(M::Cross),
        F::Transpose => Rule::Math(M::Transpose),
        F::Determinant => Rule::Math(M::Determinant),
        F::Inverse => Rule::Math(M::Inverse),
        F::LessThan => Rule::Compare(BinaryOperator::Less),
        F::LessThanEqual => Rule::Compare(BinaryOperator::LessEqual),
        F::GreaterThan => Rule::Compare(BinaryOperator::Greater),
        F::GreaterThanEqual => Rule::Compare(BinaryOperator::GreaterEqual),
        F::Equal => Rule::Compare(BinaryOperator::Equal),
        F::NotEqual => Rule::Compare(BinaryOperator::NotEqual),
        F::DFdx => Rule::Derivative(DerivativeAxis::X),
        F::DFdy => Rule::Derivative(DerivativeAxis::Y),
        F::Fwidth => Rule::Derivative(DerivativeAxis::Width),
        F::Atan
        | F::Mod
        | F::Modf
        | F::Mix
        | F::Smoothstep
        | F::Isnan
        | F::Isinf
        | F::Dot
        | F::Normalize
        | F::Faceforward
        | F::Reflect
        | F::Refract
        | F::MatrixCompMult
        | F::OuterProduct
        | F::Any
        | F::All
        | F::Not
        | F::Noise1
        | F::Noise2
        | F::Noise3
        | F::Noise4
        | F::EmitVertex
        | F::EndPrimitive => Rule::Own,
        F::TextureSize
        | F::Texture
        | F::TextureProj
        | F::TextureLod
        | F::TextureOffset
        | F::TexelFetch
        | F::TexelFetchOffset
        | F::TextureProjOffset
        | F::TextureLodOffset
        | F::TextureProjLod
        | F::TextureProjLodOffset
        | F::TextureGrad
        | F::TextureGradOffset
        | F::TextureProjGrad
        | F::TextureProjGradOffset => Rule::Texture,
    }
}

impl Ctx<'_, '_> {
    /// A call of a built-in function.
    pub(super) fn builtin(
        &mut self,
        function: BuiltinFunction,
        arguments: &[ExprId],
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let rule = rule(function);
        if matches!(rule, Rule::Texture) {
            return self.texture_call(function, arguments);
        }
        if function == BuiltinFunction::Modf {
            return self.modf(arguments);
        }
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push((self.value(*argument)?, self.shader.expr(*argument).ty));
        }
        let Some(&first) = values.first() else {
            return Err(self.slip("a built-in function without arguments"));
        };
        match rule {
            Rule::Math(fun) => Ok(self.math(fun, &values)),
            Rule::Compare(op) => match values.get(1) {
                Some(second) => Ok(self.op(op, first.0, second.0)),
                None => Err(self.slip("a comparison of one value")),
            },
            Rule::Derivative(axis) => Ok(self.derivative(axis, first.0)),
            Rule::Own | Rule::Texture => self.own(function, &values, ty),
        }
    }

    /// naga's math function, with scalars splatted to the size of the largest argument.
    fn math(&mut self, fun: MathFunction, values: &[Typed]) -> Handle<Expression> {
        let size = values.iter().map(|value| self.size_of(value.1)).max().unwrap_or(1);
        let mut arguments = values.iter().map(|&(value, ty)| (value, self.size_of(ty))).collect::<Vec<_>>().into_iter();
        let mut next = || {
            let (value, own) = arguments.next()?;
            Some(if own < size { self.splat(value, size) } else { value })
        };
        let (first, arg1, arg2) = (next(), next(), next());
        match first {
            Some(arg) => self.add(Expression::Math { fun, arg, arg1, arg2, arg3: None }),
            // No function is called without arguments; `builtin` has checked that.
            None => self.float(0.0),
        }
    }

    /// `dFdx`, `dFdy`, `fwidth`. Where the target's rows run downwards, so does its y axis.
    fn derivative(&mut self, axis: DerivativeAxis, expr: Handle<Expression>) -> Handle<Expression> {
        let value = self.add(Expression::Derivative { axis, ctrl: DerivativeControl::None, expr });
        if axis == DerivativeAxis::Y && self.low.conventions.window_origin == WindowOrigin::UpperLeft {
            return self.add(Expression::Unary { op: UnaryOperator::Negate, expr: value });
        }
        value
    }

    fn own(&mut self, function: BuiltinFunction, values: &[Typed], ty: TypeId) -> Try<Handle<Expression>> {
        use BuiltinFunction as F;
        let (a, a_ty) = values.first().copied().ok_or_else(|| self.slip("an argument is missing"))?;
        let size = self.size_of(a_ty);
        match (function, values) {
            (F::Atan, [_]) => Ok(self.math1(MathFunction::Atan, a)),
            (F::Atan, _) => Ok(self.math(MathFunction::Atan2, values)),
            (F::Mod, [_, b]) => self.modulo((a, a_ty), *b),
            (F::Mix, [_, b, c]) => self.mix((a, a_ty), *b, *c),
            (F::Smoothstep, [_, b, c]) => self.smoothstep((a, a_ty), *b, *c),
            (F::Isnan, _) => Ok(self.bits_beyond_infinity(a, size, BinaryOperator::Greater)),
            (F::Isinf, _) => Ok(self.bits_beyond_infinity(a, size, BinaryOperator::Equal)),
            (F::Dot, [_, b]) if size == 1 => Ok(self.op(BinaryOperator::Multiply, a, b.0)),
            (F::Dot, [_, b]) => Ok(self.math2(MathFunction::Dot, a, b.0)),
            (F::Normalize, _) if size == 1 => Ok(self.math1(MathFunction::Sign, a)),
            (F::Normalize, _) => Ok(self.math1(MathFunction::Normalize, a)),
            (F::Faceforward, [_, i, n]) if size == 1 => Ok(self.faceforward_scalar(a, i.0, n.0)),
            (F::Faceforward, [_, i, n]) => Ok(self.math3(MathFunction::FaceForward, a, i.0, n.0)),
            (F::Reflect, [_, n]) if size == 1 => Ok(self.reflect_scalar(a, n.0)),
            (F::Reflect, [_, n]) => Ok(self.math2(MathFunction::Reflect, a, n.0)),
            (F::Refract, [_, n, eta]) if size == 1 => Ok(self.refract_scalar(a, n.0, eta.0)),
            (F::Refract, [_, n, eta]) => Ok(self.math3(MathFunction::Refract, a, n.0, eta.0)),
            (F::MatrixCompMult, [_, b]) => self.component_product(a, b.0, a_ty),
            (F::OuterProduct, [_, b]) => self.outer_product(a, b.0, ty),
            (F::Any, _) => Ok(self.any(a, size)),
            (F::All, _) => Ok(self.all(a, size)),
            (F::Not, _) => Ok(self.not(a)),
            // §8.9 allows a constant; hardware of that time and Mesa return 0.
            (F::Noise1 | F::Noise2 | F::Noise3 | F::Noise4, _) => {
                let ty = self.low.value_type(ty)?;
                Ok(self.zero(ty))
            }
            _ => Err(unsupported(self.here(), format!("`{}` is not lowered in this form", function.name()))),
        }
    }

    /// `x - y * floor(x / y)` (§8.3)
    fn modulo(&mut self, x: Typed, y: Typed) -> Try<Handle<Expression>> {
        let quotient = self.binary_values(BinaryOp::Div, x, y)?;
        let floor = self.math1(MathFunction::Floor, quotient);
        let product = self.binary_values(BinaryOp::Mul, y, (floor, x.1))?;
        self.binary_values(BinaryOp::Sub, x, (product, x.1))
    }

    /// `modf(x, out i)`: both parts have the sign of `x` (§8.3).
    fn modf(&mut self, arguments: &[ExprId]) -> Try<Handle<Expression>> {
        let [argument, target] = arguments else { return Err(self.slip("`modf` takes two arguments")) };
        let value = self.value(*argument)?;
        let place = self.target(*target)?;
        let whole = self.math1(MathFunction::Trunc, value);
        self.store_place(&place, whole)?;
        Ok(self.op(BinaryOperator::Subtract, value, whole))
    }

    fn mix(&mut self, a: Typed, b: Typed, factor: Typed) -> Try<Handle<Expression>> {
        if self.low.types.scalar_of(factor.1) == Some(Scalar::Bool) {
            return Ok(self.add(Expression::Select { condition: factor.0, accept: b.0, reject: a.0 }));
        }
        Ok(self.math3(MathFunction::Mix, a.0, b.0, factor.0))
    }

    /// `smoothstep`. Spelled out if both edges are literals in the wrong order, which WGSL rejects and drivers
    /// accept.
    fn smoothstep(&mut self, low: Typed, high: Typed, x: Typed) -> Try<Handle<Expression>> {
        let literal = |ctx: &Self, handle| match ctx.expressions()[handle] {
            Expression::Literal(naga::Literal::F32(value)) => Some(value),
            _ => None,
        };
        let reversed = matches!((literal(self, low.0), literal(self, high.0)), (Some(a), Some(b)) if a >= b);
        if !reversed {
            return Ok(self.math(MathFunction::SmoothStep, &[low, high, x]));
        }
        let above = self.binary_values(BinaryOp::Sub, x, low)?;
        let width = self.op(BinaryOperator::Subtract, high.0, low.0);
        let ratio = self.binary_values(BinaryOp::Div, (above, x.1), (width, TypeId::FLOAT))?;
        let (zero, one) = (self.float(0.0), self.float(1.0));
        let t = self.math(MathFunction::Clamp, &[(ratio, x.1), (zero, TypeId::FLOAT), (one, TypeId::FLOAT)]);
        let (two, three) = (self.float(2.0), self.float(3.0));
        let twice = self.op(BinaryOperator::Multiply, two, t);
        let rest = self.binary_values(BinaryOp::Sub, (three, TypeId::FLOAT), (twice, x.1))?;
        let square = self.op(BinaryOperator::Multiply, t, t);
        Ok(self.op(BinaryOperator::Multiply, square, rest))
    }

    /// `isnan` and `isinf`, by bits: targets may assume that neither occurs and fold comparisons.
    fn bits_beyond_infinity(&mut self, value: Handle<Expression>, size: u8, op: BinaryOperator) -> Handle<Expression> {
        let bits = self.add(Expression::As { expr: value, kind: naga::ScalarKind::Uint, convert: None });
        let mask = self.uint(0x7fff_ffff);
        let mask = self.splat(mask, size);
        let magnitude = self.op(BinaryOperator::And, bits, mask);
        let infinity = self.uint(0x7f80_0000);
        let infinity = self.splat(infinity, size);
        self.op(op, magnitude, infinity)
    }

    fn faceforward_scalar(
        &mut self,
        n: Handle<Expression>,
        i: Handle<Expression>,
        reference: Handle<Expression>,
    ) -> Handle<Expression> {
        let dot = self.op(BinaryOperator::Multiply, reference, i);
        let zero = self.float(0.0);
        let condition = self.op(BinaryOperator::Less, dot, zero);
        let reject = self.add(Expression::Unary { op: UnaryOperator::Negate, expr: n });
        self.add(Expression::Select { condition, accept: n, reject })
    }

    /// `i - 2 * dot(n, i) * n` (§8.4)
    fn reflect_scalar(&mut self, i: Handle<Expression>, n: Handle<Expression>) -> Handle<Expression> {
        let dot = self.op(BinaryOperator::Multiply, n, i);
        let two = self.float(2.0);
        let twice = self.op(BinaryOperator::Multiply, two, dot);
        let along = self.op(BinaryOperator::Multiply, twice, n);
        self.op(BinaryOperator::Subtract, i, along)
    }

    /// `k = 1 - eta^2 (1 - dot(n, i)^2)`; 0 below 0, else `eta i - (eta dot(n, i) + sqrt(k)) n` (§8.4)
    fn refract_scalar(
        &mut self,
        i: Handle<Expression>,
        n: Handle<Expression>,
        eta: Handle<Expression>,
    ) -> Handle<Expression> {
        use BinaryOperator as Op;
        let one = self.literal(ScalarValue::Float(1.0));
        let zero = self.float(0.0);
        let dot = self.op(Op::Multiply, n, i);
        let square = self.op(Op::Multiply, dot, dot);
        let sine = self.op(Op::Subtract, one, square);
        let eta_square = self.op(Op::Multiply, eta, eta);
        let bent = self.op(Op::Multiply, eta_square, sine);
        let k = self.op(Op::Subtract, one, bent);
        let total = self.op(Op::Less, k, zero);
        let inside = self.math2(MathFunction::Max, k, zero);
        let root = self.math1(MathFunction::Sqrt, inside);
        let eta_dot = self.op(Op::Multiply, eta, dot);
        let factor = self.op(Op::Add, eta_dot, root);
        let along = self.op(Op::Multiply, factor, n);
        let eta_i = self.op(Op::Multiply, eta, i);
        let refracted = self.op(Op::Subtract, eta_i, along);
        self.add(Expression::Select { condition: total, accept: zero, reject: refracted })
    }
}
