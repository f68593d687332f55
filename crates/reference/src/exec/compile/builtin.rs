//! Calls of built-in functions (§8).

use super::super::inst::{Class, Composite, Derivative, Float1, Float2, Float3, FloatToInt, Inst, Int1, Int2, Operand};
use super::expr::component;
use super::{Compiler, Val};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::diagnostic::codes;
use glisten_front::hir::{BinaryOp, ExprId, Scalar, Stage, Type, TypeId};
use glisten_front::source::Span;

/// What a function of one float is computed by, component by component.
fn float_function(function: F) -> Option<Float1> {
    Some(match function {
        F::Radians => Float1::Radians,
        F::Degrees => Float1::Degrees,
        F::Sin => Float1::Sin,
        F::Cos => Float1::Cos,
        F::Tan => Float1::Tan,
        F::Asin => Float1::Asin,
        F::Acos => Float1::Acos,
        F::Sinh => Float1::Sinh,
        F::Cosh => Float1::Cosh,
        F::Tanh => Float1::Tanh,
        F::Asinh => Float1::Asinh,
        F::Acosh => Float1::Acosh,
        F::Atanh => Float1::Atanh,
        F::Exp => Float1::Exp,
        F::Log => Float1::Log,
        F::Exp2 => Float1::Exp2,
        F::Log2 => Float1::Log2,
        F::Sqrt => Float1::Sqrt,
        F::Inversesqrt => Float1::Inversesqrt,
        F::Floor => Float1::Floor,
        F::Trunc => Float1::Trunc,
        F::Round | F::RoundEven => Float1::Round,
        F::Ceil => Float1::Ceil,
        F::Fract => Float1::Fract,
        _ => return None,
    })
}

impl Compiler<'_> {
    pub(super) fn builtin_call(&mut self, function: F, arguments: &[ExprId], ty: TypeId, span: Span) -> Val {
        if function == F::Modf {
            return self.modf(arguments);
        }
        let values = self.in_order(arguments);
        let types: Vec<TypeId> = arguments.iter().map(|argument| self.ty(*argument)).collect();
        self.apply(function, &values, &types, ty, span)
    }

    /// A function of evaluated arguments.
    fn apply(&mut self, function: F, values: &[Val], types: &[TypeId], ty: TypeId, span: Span) -> Val {
        let a: &[Operand] = values.first().map_or(&[], |value| value);
        let b: &[Operand] = values.get(1).map_or(&[], |value| value);
        let first_ty = types.first().copied().unwrap_or(TypeId::ERROR);
        let scalar = self.types.scalar_of(first_ty).unwrap_or(Scalar::Float);
        if let Some(op) = float_function(function) {
            return a.iter().map(|a| self.float1(op, *a)).collect();
        }
        match function {
            F::Atan if values.len() == 2 => self.zip(a, b, |this, a, b| this.float2(Float2::Atan2, a, b)),
            F::Atan => a.iter().map(|a| self.float1(Float1::Atan, *a)).collect(),
            F::Pow => self.zip(a, b, |this, a, b| this.float2(Float2::Pow, a, b)),
            F::Mod => self.zip(a, b, |this, a, b| this.float2(Float2::Mod, a, b)),
            F::Step => self.zip(a, b, |this, a, b| this.float2(Float2::Step, a, b)),
            F::Abs | F::Sign => a.iter().map(|a| self.abs_or_sign(function, scalar, *a)).collect(),
            F::Min | F::Max => self.zip(a, b, |this, a, b| this.extremum(function == F::Min, scalar, a, b)),
            F::Clamp => self.clamp(values, scalar),
            F::Mix => self.mix(values, types),
            F::Smoothstep => self.zip3(values, |this, a, b, c| this.float3(Float3::Smoothstep, a, b, c)),
            F::Isnan => a.iter().map(|a| self.classify(FloatToInt::IsNan, *a)).collect(),
            F::Isinf => a.iter().map(|a| self.classify(FloatToInt::IsInf, *a)).collect(),
            F::Length if a.len() == 1 => a.iter().map(|a| self.float1(Float1::Abs, *a)).collect(),
            F::Length => self.composite(Composite::Length, a.len(), &[a], 1),
            F::Distance => self.composite(Composite::Distance, a.len(), &[a, b], 1),
            F::Dot => self.composite(Composite::Dot, a.len(), &[a, b], 1),
            F::Cross => self.composite(Composite::Cross, 3, &[a, b], 3),
            F::Normalize => self.composite(Composite::Normalize, a.len(), &[a], a.len()),
            F::Faceforward | F::Refract => {
                let op = if function == F::Refract { Composite::Refract } else { Composite::Faceforward };
                let c: &[Operand] = values.get(2).map_or(&[], |value| value);
                self.composite(op, a.len(), &[a, b, c], a.len())
            }
            F::Reflect => self.composite(Composite::Reflect, a.len(), &[a, b], a.len()),
            F::MatrixCompMult => self.zip(a, b, |this, a, b| this.float2(Float2::Mul, a, b)),
            F::OuterProduct => self.outer_product(a, b),
            F::Transpose => self.transpose(a, first_ty),
            F::Determinant | F::Inverse => {
                let size = match self.types.get(first_ty) {
                    Type::Matrix(columns, _) => usize::from(columns),
                    _ => 2,
                };
                match function {
                    F::Determinant => self.composite(Composite::Determinant, size, &[a], 1),
                    _ => self.composite(Composite::Inverse, size, &[a], size * size),
                }
            }
            F::LessThan => self.relation(BinaryOp::Less, a, b, scalar),
            F::LessThanEqual => self.relation(BinaryOp::LessEqual, a, b, scalar),
            F::GreaterThan => self.relation(BinaryOp::Greater, a, b, scalar),
            F::GreaterThanEqual => self.relation(BinaryOp::GreaterEqual, a, b, scalar),
            F::Equal => self.relation(BinaryOp::Equal, a, b, scalar),
            F::NotEqual => self.relation(BinaryOp::NotEqual, a, b, scalar),
            F::Any => self.fold(Int2::Or, a),
            F::All => self.fold(Int2::And, a),
            F::Not => a.iter().map(|a| self.int1(Int1::Not, *a)).collect(),
            F::DFdx => self.derivative(Derivative::X, a),
            F::DFdy => self.derivative(Derivative::Y, a),
            F::Fwidth => self.derivative(Derivative::Width, a),
            // §8.9 leaves the values open; 0 has the right range and mean.
            F::Noise1 | F::Noise2 | F::Noise3 | F::Noise4 => {
                let zero = self.emit.float(0.0);
                (0..self.types.flat_len(ty)).map(|_| zero).collect()
            }
            F::EmitVertex | F::EndPrimitive => {
                self.refuse(&codes::general::NOT_SUPPORTED_YET, span, "geometry stages");
                Val::new()
            }
            _ => self.texture_call(function, values, first_ty, ty, span),
        }
    }

    /// Component by component; a scalar goes with every component.
    fn zip(&mut self, a: &[Operand], b: &[Operand], mut f: impl FnMut(&mut Self, Operand, Operand) -> Operand) -> Val {
        (0..a.len().max(b.len()))
            .filter_map(|flat| Some((component(a, flat)?, component(b, flat)?)))
            .map(|(a, b)| f(self, a, b))
            .collect()
    }

    fn zip3(&mut self, values: &[Val], mut f: impl FnMut(&mut Self, Operand, Operand, Operand) -> Operand) -> Val {
        let [a, b, c] = values else { return Val::new() };
        (0..a.len().max(b.len()).max(c.len()))
            .filter_map(|flat| Some((component(a, flat)?, component(b, flat)?, component(c, flat)?)))
            .map(|(a, b, c)| f(self, a, b, c))
            .collect()
    }

    fn float3(&mut self, op: Float3, a: Operand, b: Operand, c: Operand) -> Operand {
        self.emit.pure(Class::Float, &[a, b, c], |dst| Inst::Float3 { op, dst, a, b, c })
    }

    fn classify(&mut self, op: FloatToInt, a: Operand) -> Operand {
        self.emit.pure(Class::Int, &[a], |dst| Inst::FloatToInt { op, dst, a })
    }

    fn abs_or_sign(&mut self, function: F, scalar: Scalar, a: Operand) -> Operand {
        match (function == F::Abs, scalar == Scalar::Float) {
            (true, true) => self.float1(Float1::Abs, a),
            (false, true) => self.float1(Float1::Sign, a),
            (true, false) => self.int1(Int1::Abs, a),
            (false, false) => self.int1(Int1::Sign, a),
        }
    }

    fn extremum(&mut self, least: bool, scalar: Scalar, a: Operand, b: Operand) -> Operand {
        match (scalar, least) {
            (Scalar::Float, true) => self.float2(Float2::Min, a, b),
            (Scalar::Float, false) => self.float2(Float2::Max, a, b),
            (Scalar::Uint, true) => self.int2(Int2::MinUnsigned, a, b),
            (Scalar::Uint, false) => self.int2(Int2::MaxUnsigned, a, b),
            (_, true) => self.int2(Int2::MinSigned, a, b),
            (_, false) => self.int2(Int2::MaxSigned, a, b),
        }
    }

    /// `min(max(x, least), most)` (§8.3).
    fn clamp(&mut self, values: &[Val], scalar: Scalar) -> Val {
        self.zip3(values, |this, x, least, most| {
            if scalar == Scalar::Float {
                return this.float3(Float3::Clamp, x, least, most);
            }
            let raised = this.extremum(false, scalar, x, least);
            this.extremum(true, scalar, raised, most)
        })
    }

    /// `mix(x, y, a)`; with a `bvec` for `a` the components of `y` where it is true.
    fn mix(&mut self, values: &[Val], types: &[TypeId]) -> Val {
        let boolean = types.get(2).and_then(|ty| self.types.scalar_of(*ty)) == Some(Scalar::Bool);
        let class = types.first().map_or(Class::Float, |ty| self.class(*ty));
        self.zip3(
            values,
            |this, x, y, a| {
                if boolean { this.select(class, a, y, x) } else { this.float3(Float3::Mix, x, y, a) }
            },
        )
    }

    fn relation(&mut self, op: BinaryOp, a: &[Operand], b: &[Operand], scalar: Scalar) -> Val {
        self.zip(a, b, |this, a, b| this.arithmetic(op, a, b, Some(scalar)))
    }

    fn fold(&mut self, op: Int2, a: &[Operand]) -> Val {
        let mut all: Option<Operand> = None;
        for a in a {
            all = Some(match all {
                None => *a,
                Some(before) => self.int2(op, before, *a),
            });
        }
        all.into_iter().collect()
    }

    /// Derivatives exist in fragment stages; of what is the same for all lanes they are 0.
    fn derivative(&mut self, op: Derivative, a: &[Operand]) -> Val {
        a.iter()
            .map(|a| {
                if a.is_scalar() || self.shader.stage != Stage::Fragment {
                    return self.emit.float(0.0);
                }
                self.emit.pure(Class::Float, &[*a], |dst| Inst::Derivative { op, dst, a: *a })
            })
            .collect()
    }

    /// A function of whole vectors or matrices with `count` results.
    fn composite(&mut self, op: Composite, size: usize, arguments: &[&[Operand]], count: usize) -> Val {
        let mut flat: Vec<Operand> = arguments.concat();
        let hoisted = flat.iter().all(|operand| operand.is_scalar());
        if !hoisted {
            flat.iter_mut().for_each(|operand| *operand = self.emit.in_register(Class::Float, *operand));
        }
        let results: Val = (0..count)
            .map(|_| if hoisted { self.emit.preamble_result(Class::Float) } else { self.emit.temp(Class::Float) })
            .collect();
        let arguments = self.emit.list(Class::Float, &flat, hoisted);
        let list = self.emit.list(Class::Float, &results, hoisted);
        let span = self.emit.span;
        let inst = Inst::Composite { op, size: size as u8, results: list, arguments };
        if hoisted {
            self.emit.preamble.push(inst, span)
        } else {
            self.emit.push(inst)
        }
        results
    }

    /// `modf(x, out i)`: the fraction, with the sign of `x`; `i` is the whole part (§8.3).
    fn modf(&mut self, arguments: &[ExprId]) -> Val {
        let [x, out] = arguments else { return Val::new() };
        let value = self.expr(*x);
        let value = self.keep_all(*x, value);
        let path = self.path(*out);
        let whole: Val = value.iter().map(|a| self.float1(Float1::Trunc, *a)).collect();
        let fraction = self.zip(&value, &whole, |this, a, b| this.float2(Float2::Sub, a, b));
        self.write_path(&path, &whole);
        fraction
    }
}
