//! Lowers built-in functions (§8) except texture functions, in terms of naga's functions.
//!
//! *Holds:* the matches over the classes of the table of operations are exhaustive, so a new row does not compile until
//! it is lowered.

use super::function::Ctx;
use super::operators::Typed;
use super::{Try, unsupported};
use crate::target::WindowOrigin;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{
    self, Binary, BooleanFunction, Class, Composite, Derivative, Emission, MatrixFunction, Numbers, Relation, Ternary,
    Test, Unary,
};
use glisten_front::hir::{BinaryOp, ExprId, Scalar, ScalarValue, TypeId};
use naga::{BinaryOperator, DerivativeAxis, DerivativeControl, Expression, Handle, MathFunction, UnaryOperator};

/// The function of one float in naga; negation, the only operator, is lowered with the operators.
fn math_function(op: Unary) -> Option<MathFunction> {
    use MathFunction as M;
    Some(match op {
        Unary::Neg => return None,
        Unary::Radians => M::Radians,
        Unary::Degrees => M::Degrees,
        Unary::Sin => M::Sin,
        Unary::Cos => M::Cos,
        Unary::Tan => M::Tan,
        Unary::Asin => M::Asin,
        Unary::Acos => M::Acos,
        Unary::Atan => M::Atan,
        Unary::Sinh => M::Sinh,
        Unary::Cosh => M::Cosh,
        Unary::Tanh => M::Tanh,
        Unary::Asinh => M::Asinh,
        Unary::Acosh => M::Acosh,
        Unary::Atanh => M::Atanh,
        Unary::Exp => M::Exp,
        Unary::Log => M::Log,
        Unary::Exp2 => M::Exp2,
        Unary::Log2 => M::Log2,
        Unary::Sqrt => M::Sqrt,
        Unary::Inversesqrt => M::InverseSqrt,
        Unary::Abs => M::Abs,
        Unary::Sign => M::Sign,
        Unary::Floor => M::Floor,
        Unary::Trunc => M::Trunc,
        // §8.3 leaves open in which direction `round` rounds a half; naga's rounds it to even.
        Unary::Round => M::Round,
        Unary::Ceil => M::Ceil,
        Unary::Fract => M::Fract,
    })
}

fn relation(op: Relation) -> BinaryOperator {
    match op {
        Relation::Less => BinaryOperator::Less,
        Relation::LessEqual => BinaryOperator::LessEqual,
        Relation::Greater => BinaryOperator::Greater,
        Relation::GreaterEqual => BinaryOperator::GreaterEqual,
        Relation::Equal => BinaryOperator::Equal,
        Relation::NotEqual => BinaryOperator::NotEqual,
    }
}

fn axis(of: Derivative) -> DerivativeAxis {
    match of.axis() {
        operations::DerivativeAxis::X => DerivativeAxis::X,
        operations::DerivativeAxis::Y => DerivativeAxis::Y,
        operations::DerivativeAxis::Width => DerivativeAxis::Width,
    }
}

fn control(of: Derivative) -> DerivativeControl {
    match of.control() {
        operations::DerivativeControl::Any => DerivativeControl::None,
        operations::DerivativeControl::Fine => DerivativeControl::Fine,
        operations::DerivativeControl::Coarse => DerivativeControl::Coarse,
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
        let class = function.class();
        if let Class::Texture(form) = class {
            return self.texture_call(form, arguments, ty);
        }
        if class == Class::Modf {
            return self.modf(arguments);
        }
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push((self.value(*argument)?, self.shader.expr(*argument).ty));
        }
        match class {
            Class::Unary(op) => self.unary_function(op, &values),
            Class::Binary(op) => self.binary_function(op, &values),
            Class::Ternary(op) => self.ternary_function(op, &values),
            Class::Numbers(op) => self.numbers(op, &values),
            Class::Composite(op) => self.composite(op, &values),
            Class::Matrix(op) => self.matrix_function(op, &values, ty),
            Class::Relation(op) => {
                let [a, b] = self.of(&values)?;
                Ok(self.op(relation(op), a.0, b.0))
            }
            Class::Boolean(op) => {
                let [(a, a_ty)] = self.of(&values)?;
                let size = self.size_of(a_ty);
                Ok(match op {
                    BooleanFunction::Any => self.any(a, size),
                    BooleanFunction::All => self.all(a, size),
                    BooleanFunction::Not => self.not(a),
                })
            }
            Class::Test(test) => {
                let [(a, a_ty)] = self.of(&values)?;
                let op = match test {
                    Test::Nan => BinaryOperator::Greater,
                    Test::Infinite => BinaryOperator::Equal,
                };
                Ok(self.bits_beyond_infinity(a, self.size_of(a_ty), op))
            }
            Class::BitCast(op) => {
                let [(a, _)] = self.of(&values)?;
                Ok(self.bit_cast(op, a))
            }
            Class::Bits(op) => self.bit_function(op, &values, ty),
            Class::Packing(op) => {
                let [(a, _)] = self.of(&values)?;
                Ok(self.packing(op, a))
            }
            Class::Derivative(of) => {
                let [(a, _)] = self.of(&values)?;
                Ok(self.derivative(of, a))
            }
            // §8.9 allows a constant; hardware of that time and Mesa return 0.
            Class::Noise(_) => {
                let ty = self.low.value_type(ty)?;
                Ok(self.zero(ty))
            }
            Class::Emission(Emission::Vertex | Emission::Primitive) => {
                Err(unsupported(self.here(), format!("`{}`", function.name())))
            }
            Class::Texture(_) | Class::Modf => Err(self.internal_error("these are lowered before their arguments")),
            Class::Composed => Err(self.internal_error("the analysis writes this function out")),
        }
    }

    /// As many arguments as a function has.
    fn of<const N: usize>(&self, values: &[Typed]) -> Try<[Typed; N]> {
        values.try_into().map_err(|_| self.internal_error("a built-in function has too few or too many arguments"))
    }

    fn unary_function(&mut self, op: Unary, values: &[Typed]) -> Try<Handle<Expression>> {
        match math_function(op) {
            Some(function) => Ok(self.math(function, values)),
            None => Err(self.internal_error("an operator is called as a function")),
        }
    }

    fn binary_function(&mut self, op: Binary, values: &[Typed]) -> Try<Handle<Expression>> {
        match op {
            Binary::Pow => Ok(self.math(MathFunction::Pow, values)),
            Binary::Mod => {
                let [x, y] = self.of(values)?;
                self.modulo(x, y)
            }
            Binary::Min => Ok(self.math(MathFunction::Min, values)),
            Binary::Max => Ok(self.math(MathFunction::Max, values)),
            Binary::Step => Ok(self.math(MathFunction::Step, values)),
            Binary::Atan2 => Ok(self.math(MathFunction::Atan2, values)),
            Binary::Add | Binary::Sub | Binary::Mul | Binary::Div => {
                Err(self.internal_error("an operator is called as a function"))
            }
        }
    }

    fn ternary_function(&mut self, op: Ternary, values: &[Typed]) -> Try<Handle<Expression>> {
        let [a, b, c] = self.of(values)?;
        match op {
            Ternary::Clamp => Ok(self.math(MathFunction::Clamp, values)),
            Ternary::Mix => self.mix(a, b, c),
            Ternary::Smoothstep => self.smoothstep(a, b, c),
            Ternary::Fma => Ok(self.math(MathFunction::Fma, values)),
        }
    }

    /// naga's functions take integers as well as floats.
    fn numbers(&mut self, op: Numbers, values: &[Typed]) -> Try<Handle<Expression>> {
        match op {
            Numbers::Atan if values.len() == 2 => self.binary_function(Binary::Atan2, values),
            Numbers::Atan => self.unary_function(Unary::Atan, values),
            Numbers::Abs => self.unary_function(Unary::Abs, values),
            Numbers::Sign => self.unary_function(Unary::Sign, values),
            Numbers::Min => self.binary_function(Binary::Min, values),
            Numbers::Max => self.binary_function(Binary::Max, values),
            Numbers::Clamp => self.ternary_function(Ternary::Clamp, values),
            Numbers::Mix => self.ternary_function(Ternary::Mix, values),
        }
    }

    /// naga has no scalar forms of most functions of vectors.
    fn composite(&mut self, op: Composite, values: &[Typed]) -> Try<Handle<Expression>> {
        let scalar = values.first().is_some_and(|value| self.size_of(value.1) == 1);
        match op {
            Composite::Length => Ok(self.math(MathFunction::Length, values)),
            Composite::Distance => Ok(self.math(MathFunction::Distance, values)),
            Composite::Cross => Ok(self.math(MathFunction::Cross, values)),
            Composite::Determinant => Ok(self.math(MathFunction::Determinant, values)),
            Composite::Inverse if !self.low.can().inverts_matrices => {
                let [matrix] = self.of(values)?;
                self.inverse(matrix.0, matrix.1)
            }
            Composite::Inverse => Ok(self.math(MathFunction::Inverse, values)),
            Composite::Dot => {
                let [a, b] = self.of(values)?;
                Ok(match scalar {
                    true => self.op(BinaryOperator::Multiply, a.0, b.0),
                    false => self.math2(MathFunction::Dot, a.0, b.0),
                })
            }
            Composite::Normalize => {
                let [a] = self.of(values)?;
                Ok(self.math1(if scalar { MathFunction::Sign } else { MathFunction::Normalize }, a.0))
            }
            Composite::Faceforward => {
                let [n, i, reference] = self.of(values)?;
                Ok(match scalar {
                    true => self.faceforward_scalar(n.0, i.0, reference.0),
                    false => self.math3(MathFunction::FaceForward, n.0, i.0, reference.0),
                })
            }
            Composite::Reflect => {
                let [i, n] = self.of(values)?;
                Ok(match scalar {
                    true => self.reflect_scalar(i.0, n.0),
                    false => self.math2(MathFunction::Reflect, i.0, n.0),
                })
            }
            Composite::Refract => {
                let [i, n, eta] = self.of(values)?;
                Ok(match scalar {
                    true => self.refract_scalar(i.0, n.0, eta.0),
                    false => self.math3(MathFunction::Refract, i.0, n.0, eta.0),
                })
            }
        }
    }

    fn matrix_function(&mut self, op: MatrixFunction, values: &[Typed], ty: TypeId) -> Try<Handle<Expression>> {
        match op {
            MatrixFunction::ComponentProduct => {
                let [a, b] = self.of(values)?;
                self.component_product(a.0, b.0, a.1)
            }
            MatrixFunction::OuterProduct => {
                let [a, b] = self.of(values)?;
                self.outer_product(a.0, b.0, ty)
            }
            MatrixFunction::Transpose => Ok(self.math(MathFunction::Transpose, values)),
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
    fn derivative(&mut self, of: Derivative, expr: Handle<Expression>) -> Handle<Expression> {
        let axis = axis(of);
        let value = self.add(Expression::Derivative { axis, ctrl: control(of), expr });
        if axis == DerivativeAxis::Y && self.low.conventions.window_origin == WindowOrigin::UpperLeft {
            return self.add(Expression::Unary { op: UnaryOperator::Negate, expr: value });
        }
        value
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
        let [argument, target] = arguments else { return Err(self.internal_error("`modf` takes two arguments")) };
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
