//! Compiles calls of built-in functions (§8), by their class in the table of operations.

use super::super::inst::{
    Class as File, Composite, Derivative, Float1, Float2, Float3, FloatToInt, Inst, Int1, Int2, Operand,
};
use super::expr::component;
use super::{Compiler, Val};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{BooleanFunction, Class, Emission, MatrixFunction, Numbers, Relation, Test};
use glisten_front::hir::{BinaryOp, ExprId, Scalar, Stage, Type, TypeId};

fn relation(op: Relation) -> BinaryOp {
    match op {
        Relation::Less => BinaryOp::Less,
        Relation::LessEqual => BinaryOp::LessEqual,
        Relation::Greater => BinaryOp::Greater,
        Relation::GreaterEqual => BinaryOp::GreaterEqual,
        Relation::Equal => BinaryOp::Equal,
        Relation::NotEqual => BinaryOp::NotEqual,
    }
}

impl Compiler<'_> {
    pub(super) fn builtin_call(&mut self, function: BuiltinFunction, arguments: &[ExprId], ty: TypeId) -> Val {
        if function.class() == Class::Modf {
            return self.modf(arguments);
        }
        let values = self.in_order(arguments);
        let types: Vec<TypeId> = arguments.iter().map(|argument| self.ty(*argument)).collect();
        self.apply(function.class(), &values, &types, ty)
    }

    /// A function of evaluated arguments.
    fn apply(&mut self, class: Class, values: &[Val], types: &[TypeId], ty: TypeId) -> Val {
        let a: &[Operand] = values.first().map_or(&[], |value| value);
        let b: &[Operand] = values.get(1).map_or(&[], |value| value);
        let first_ty = types.first().copied().unwrap_or(TypeId::ERROR);
        let scalar = self.types.scalar_of(first_ty).unwrap_or(Scalar::Float);
        match class {
            Class::Unary(op) => a.iter().map(|a| self.float1(op, *a)).collect(),
            Class::Binary(op) => self.zip(a, b, |this, a, b| this.float2(op, a, b)),
            Class::Ternary(op) => self.zip3(values, |this, a, b, c| this.float3(op, a, b, c)),
            Class::Numbers(op) => self.numbers(op, values, types, scalar),
            Class::Composite(op) => self.composite_function(op, values, first_ty),
            Class::Matrix(MatrixFunction::ComponentProduct) => {
                self.zip(a, b, |this, a, b| this.float2(Float2::Mul, a, b))
            }
            Class::Matrix(MatrixFunction::OuterProduct) => self.outer_product(a, b),
            Class::Matrix(MatrixFunction::Transpose) => self.transpose(a, first_ty),
            Class::Relation(op) => self.zip(a, b, |this, a, b| this.arithmetic(relation(op), a, b, Some(scalar))),
            Class::Boolean(BooleanFunction::Any) => self.fold(Int2::Or, a),
            Class::Boolean(BooleanFunction::All) => self.fold(Int2::And, a),
            Class::Boolean(BooleanFunction::Not) => a.iter().map(|a| self.int1(Int1::Not, *a)).collect(),
            Class::Test(Test::Nan) => a.iter().map(|a| self.classify(FloatToInt::IsNan, *a)).collect(),
            Class::Test(Test::Infinite) => a.iter().map(|a| self.classify(FloatToInt::IsInf, *a)).collect(),
            Class::BitCast(op) => self.bit_cast(op, a),
            Class::Bits(op) => self.bit_function(op, values, scalar),
            Class::Packing(op) => self.packing(op, a),
            Class::Derivative(op) => self.derivative(op, a),
            // §8.9 leaves the values open. 0 has the right range and mean.
            Class::Noise(_) => {
                let zero = self.emit.float(0.0);
                (0..self.types.flat_len(ty)).map(|_| zero).collect()
            }
            Class::Emission(Emission::Vertex) => self.emit_vertex(),
            Class::Emission(Emission::Primitive) => self.end_primitive(),
            Class::Texture(form) => self.texture_call(form, values, first_ty, ty),
            // `modf` writes an argument, and is compiled before its arguments are; the analysis writes others out.
            Class::Modf | Class::Composed => Val::new(),
        }
    }

    /// The functions that depend on the types of the arguments.
    fn numbers(&mut self, op: Numbers, values: &[Val], types: &[TypeId], scalar: Scalar) -> Val {
        let a: &[Operand] = values.first().map_or(&[], |value| value);
        let b: &[Operand] = values.get(1).map_or(&[], |value| value);
        let floats = scalar == Scalar::Float;
        match op {
            Numbers::Atan if values.len() == 2 => self.zip(a, b, |this, a, b| this.float2(Float2::Atan2, a, b)),
            Numbers::Atan => a.iter().map(|a| self.float1(Float1::Atan, *a)).collect(),
            Numbers::Abs if floats => a.iter().map(|a| self.float1(Float1::Abs, *a)).collect(),
            Numbers::Abs => a.iter().map(|a| self.int1(Int1::Abs, *a)).collect(),
            Numbers::Sign if floats => a.iter().map(|a| self.float1(Float1::Sign, *a)).collect(),
            Numbers::Sign => a.iter().map(|a| self.int1(Int1::Sign, *a)).collect(),
            Numbers::Min => self.zip(a, b, |this, a, b| this.extremum(true, scalar, a, b)),
            Numbers::Max => self.zip(a, b, |this, a, b| this.extremum(false, scalar, a, b)),
            Numbers::Clamp => self.clamp(values, scalar),
            Numbers::Mix => self.mix(values, types),
        }
    }

    /// The functions of whole vectors and matrices.
    fn composite_function(&mut self, op: Composite, values: &[Val], first_ty: TypeId) -> Val {
        let a: &[Operand] = values.first().map_or(&[], |value| value);
        if op == Composite::Length && a.len() == 1 {
            return a.iter().map(|a| self.float1(Float1::Abs, *a)).collect();
        }
        let matrix = match self.types.get(first_ty) {
            Type::Matrix(columns, _) => usize::from(columns),
            _ => 2,
        };
        let (size, count) = match op {
            Composite::Length | Composite::Distance | Composite::Dot => (a.len(), 1),
            Composite::Cross => (3, 3),
            Composite::Normalize | Composite::Faceforward | Composite::Reflect | Composite::Refract => {
                (a.len(), a.len())
            }
            Composite::Determinant => (matrix, 1),
            Composite::Inverse => (matrix, matrix * matrix),
        };
        let arguments: Vec<&[Operand]> = values.iter().map(|value| &value[..]).collect();
        let results = self.composite(op, size, &arguments, count);
        self.define_composite(op, values, &results);
        results
    }

    /// Applies a function component by component. A scalar is combined with every component.
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
        self.emit.pure(File::Float, &[a, b, c], |dst| Inst::Float3 { op, dst, a, b, c })
    }

    fn classify(&mut self, op: FloatToInt, a: Operand) -> Operand {
        self.emit.pure(File::Int, &[a], |dst| Inst::FloatToInt { op, dst, a })
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

    /// `mix(x, y, a)`. If `a` is a `bvec`, selects the components of `y` where it is true.
    fn mix(&mut self, values: &[Val], types: &[TypeId]) -> Val {
        let boolean = types.get(2).and_then(|ty| self.types.scalar_of(*ty)) == Some(Scalar::Bool);
        let class = types.first().map_or(File::Float, |ty| self.class(*ty));
        self.zip3(
            values,
            |this, x, y, a| {
                if boolean { this.select(class, a, y, x) } else { this.float3(Float3::Mix, x, y, a) }
            },
        )
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

    /// Derivatives exist in fragment stages. They are 0 for values that are the same in all lanes.
    fn derivative(&mut self, op: Derivative, a: &[Operand]) -> Val {
        a.iter()
            .map(|a| {
                if a.is_scalar() || self.shader.stage != Stage::Fragment {
                    return self.emit.float(0.0);
                }
                let noise = if self.emit.form.rewrites() { self.noise(*a) } else { None };
                self.emit.pure(File::Float, &[*a], |dst| Inst::Derivative { op, dst, a: *a, noise })
            })
            .collect()
    }

    /// A function of whole vectors or matrices with `count` results.
    fn composite(&mut self, op: Composite, size: usize, arguments: &[&[Operand]], count: usize) -> Val {
        let mut flat: Vec<Operand> = arguments.concat();
        let hoisted = flat.iter().all(|operand| operand.is_scalar());
        if !hoisted {
            flat.iter_mut().for_each(|operand| *operand = self.emit.in_register(File::Float, *operand));
        }
        let results: Val = (0..count)
            .map(|_| if hoisted { self.emit.preamble_result(File::Float) } else { self.emit.temp(File::Float) })
            .collect();
        let arguments = self.emit.list(File::Float, &flat, hoisted);
        let list = self.emit.list(File::Float, &results, hoisted);
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
