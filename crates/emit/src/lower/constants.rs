//! Lowers constant values (§4.3.3), and keeps the target from evaluating what is not finite.
//!
//! *Holds:* WGSL has no non-finite literals, and every constant expression with such a value is an error. A
//! non-finite float is therefore read as bits from a private variable, which no target evaluates before the shader
//! runs.

use super::function::Ctx;
use super::slots::{GlobalSlot, LocalSlot};
use super::{Lower, Try, for_each_operand, internal};
use glisten_front::hir::{
    ArraySize, ExprId, FunctionId, LocalKind, Scalar, ScalarValue, Storage, Type, TypeId, Value, VarRef,
};
use naga::{
    AddressSpace, Arena, BinaryOperator, Expression, GlobalVariable, Handle, Literal, MathFunction, Module, TypeInner,
    UnaryOperator,
};

/// Whether a float has a literal. The largest float has none: its shortest decimal spelling is a little larger than
/// it is, and Tint rejects that.
fn is_spellable(value: f32) -> bool {
    value.abs() < f32::MAX
}

/// The numbers of a constant scalar or vector; none where they are not evident.
fn numbers(module: &Module, expressions: &Arena<Expression>, handle: Handle<Expression>) -> Vec<f64> {
    match &expressions[handle] {
        Expression::Constant(constant) => numbers(module, &module.global_expressions, module.constants[*constant].init),
        Expression::ZeroValue(ty) => match module.types[*ty].inner {
            TypeInner::Scalar(_) => vec![0.0],
            TypeInner::Vector { size, .. } => vec![0.0; size as usize],
            _ => Vec::new(),
        },
        Expression::Literal(Literal::F32(value)) => vec![f64::from(*value)],
        Expression::Literal(Literal::I32(value)) => vec![f64::from(*value)],
        Expression::Literal(Literal::U32(value)) => vec![f64::from(*value)],
        Expression::Unary { op: UnaryOperator::Negate, expr } => {
            numbers(module, expressions, *expr).into_iter().map(|value| -value).collect()
        }
        Expression::Splat { size, value } => numbers(module, expressions, *value).repeat(*size as usize),
        Expression::Compose { components, .. } => {
            let parts = || components.iter().map(|part| numbers(module, expressions, *part));
            if parts().any(|part| part.is_empty()) { Vec::new() } else { parts().flatten().collect() }
        }
        _ => Vec::new(),
    }
}

/// Whether every part of a value has a literal.
pub(super) fn is_constant(value: &Value) -> bool {
    value.scalars.iter().all(|scalar| match scalar {
        ScalarValue::Float(value) => is_spellable(*value),
        ScalarValue::Bool(_) | ScalarValue::Int(_) | ScalarValue::Uint(_) => true,
    })
}

impl Ctx<'_, '_> {
    /// A scalar constant, which need not be finite.
    pub(super) fn scalar(&mut self, value: ScalarValue) -> Handle<Expression> {
        match value {
            ScalarValue::Float(float) if !is_spellable(float) => {
                let variable = self.low.hidden_bits(float.to_bits());
                let pointer = self.global_variable(variable);
                let bits = self.load(pointer);
                self.add(Expression::As { expr: bits, kind: naga::ScalarKind::Float, convert: None })
            }
            _ => self.literal(value),
        }
    }

    /// A constant of any type, spelled out.
    pub(super) fn constant(&mut self, value: &Value) -> Try<Handle<Expression>> {
        let mut scalars = value.scalars.iter().copied();
        self.spelled(value.ty, &mut scalars)
    }

    fn spelled(&mut self, ty: TypeId, scalars: &mut dyn Iterator<Item = ScalarValue>) -> Try<Handle<Expression>> {
        let parts: Vec<TypeId> = match self.low.types.get(ty) {
            Type::Scalar(_) => {
                let value = scalars.next().ok_or_else(|| internal(self.here(), "a constant is too short"))?;
                return Ok(self.scalar(value));
            }
            Type::Struct(id) => self.low.types.structure(id).members.iter().map(|member| member.ty).collect(),
            Type::Array(element, ArraySize::Sized(len)) => vec![element; len as usize],
            Type::Vector(scalar, size) => vec![TypeId::vector(scalar, 1); usize::from(size)],
            Type::Matrix(columns, _) => vec![self.low.element_type(ty); usize::from(columns)],
            _ => return Err(internal(self.here(), "a constant of no type of values")),
        };
        let mut components = Vec::with_capacity(parts.len());
        for part in parts {
            components.push(self.spelled(part, scalars)?);
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// A named constant: a constant of the module, or a variable if it is indexed by a variable (the SPIR-V writer
    /// would copy it for each index).
    pub(super) fn named_constant(
        &mut self,
        var: VarRef,
        name: &str,
        value: &Value,
        indexed: bool,
    ) -> Try<Handle<Expression>> {
        if !is_constant(value) || !self.low.has_value(value.ty) {
            return self.constant(value);
        }
        let ty = self.low.value_type(value.ty)?;
        let init = self.low.global_constant(value)?;
        if indexed {
            let variable = GlobalVariable {
                name: Some(name.to_owned()),
                space: AddressSpace::Private,
                binding: None,
                ty,
                init: Some(init),
                memory_decorations: naga::MemoryDecorations::empty(),
            };
            let variable = self.low.module.global_variables.append(variable, naga::Span::UNDEFINED);
            let pointer = self.global_variable(variable);
            self.remember(var, GlobalSlot::Private(variable), LocalSlot::Pointer(pointer));
            return Ok(pointer);
        }
        let constant = naga::Constant { name: Some(name.to_owned()), ty, init };
        let constant = self.low.module.constants.append(constant, naga::Span::UNDEFINED);
        let handle = self.module_constant(constant);
        self.remember(var, GlobalSlot::Constant(constant), LocalSlot::Value(handle));
        Ok(handle)
    }

    fn remember(&mut self, var: VarRef, global: GlobalSlot, local: LocalSlot) {
        match var {
            VarRef::Global(id) => {
                if let Some(place) = self.low.globals.get_mut(id.index()) {
                    *place = global;
                }
            }
            VarRef::Local(id) => self.set_slot(id, local),
        }
    }
}

impl Ctx<'_, '_> {
    /// Whether a target knows the value of an expression before the shader runs: all of its operands are constant, and
    /// none is a named value.
    pub(super) fn is_known(&self, expression: &Expression) -> bool {
        let computes = matches!(
            expression,
            Expression::Compose { .. }
                | Expression::Splat { .. }
                | Expression::Swizzle { .. }
                | Expression::Access { .. }
                | Expression::AccessIndex { .. }
                | Expression::Unary { .. }
                | Expression::Binary { .. }
                | Expression::Select { .. }
                | Expression::Relational { .. }
                | Expression::Math { .. }
                | Expression::As { .. }
        );
        let mut known = computes;
        for_each_operand(expression, |operand| {
            known = known
                && self.known.get(operand.index()).copied().unwrap_or(false)
                && !self.out.named_expressions.contains_key(&operand);
        });
        known
    }

    /// Hides operands from the target's constant evaluation. Targets reject constant expressions whose result does
    /// not fit, integer division by a constant 0, and a clamp whose constant limits are the wrong way round, of which GLSL
    /// only says that the result is undefined (§8.3). What GLSL calls constant has been evaluated already; an operand
    /// that became constant during lowering (`(n++, 5)`) is read from a variable. naga 30 panics where it evaluates a
    /// selection by a vector that is composed of others, or between such vectors.
    pub(super) fn kept_from_evaluation(&mut self, expression: Expression) -> Expression {
        use BinaryOperator as Op;
        match expression {
            Expression::Binary { op: op @ (Op::Divide | Op::Modulo), left, right } if self.may_be_zero(right) => {
                Expression::Binary { op, left, right: self.hidden_operand(right) }
            }
            Expression::Binary {
                op:
                    op @ (Op::Add | Op::Subtract | Op::Multiply | Op::Divide | Op::Modulo | Op::ShiftLeft | Op::ShiftRight),
                left,
                right,
            } if self.is_known(&expression) => {
                let hidden = self.hidden_operand(left);
                let right = if hidden == left { self.hidden_operand(right) } else { right };
                Expression::Binary { op, left: hidden, right }
            }
            Expression::Math { fun: MathFunction::Clamp, arg, arg1: Some(low), arg2: Some(high), .. }
                if self.is_reversed(low, high) =>
            {
                let above = self.math2(MathFunction::Max, arg, low);
                let arg1 = Some(high);
                let below = Expression::Math { fun: MathFunction::Min, arg: above, arg1, arg2: None, arg3: None };
                self.kept_from_evaluation(below)
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } if self.is_known(&expression) => {
                let hidden = self.hidden_operand(arg);
                let arg1 = if hidden == arg { arg1.map(|arg| self.hidden_operand(arg)) } else { arg1 };
                Expression::Math { fun, arg: hidden, arg1, arg2, arg3 }
            }
            Expression::Select { condition, accept, reject } if self.is_known(&expression) => {
                let hidden = self.hidden_operand(condition);
                let accept = if hidden == condition { self.hidden_operand(accept) } else { accept };
                Expression::Select { condition: hidden, accept, reject }
            }
            other => other,
        }
    }

    /// A vector composed of constants, of which one is a vector, with components in its place: naga's SPIR-V writer
    /// makes of all these one constant, which must have a constituent for each component.
    pub(super) fn with_scalar_constituents(&mut self, expression: Expression) -> Expression {
        let Expression::Compose { ty, components } = &expression else { return expression };
        let TypeInner::Vector { size, .. } = self.low.module.types[*ty].inner else { return expression };
        let complete = components.len() == size as usize;
        if complete
            || !self.low.can().wants_scalar_constituents
            || !components.iter().all(|part| self.is_constant_to_naga(*part))
        {
            return expression;
        }
        let (ty, parts) = (*ty, components.clone());
        let mut components = Vec::new();
        for part in parts {
            let length = self.constant_length(part);
            let one_by_one = (0..length).map(|index| self.add(Expression::AccessIndex { base: part, index }));
            match length {
                1 => components.push(part),
                _ => components.extend(one_by_one.collect::<Vec<_>>()),
            }
        }
        Expression::Compose { ty, components }
    }

    /// Whether naga's SPIR-V writer makes a constant of the expression.
    fn is_constant_to_naga(&self, handle: Handle<Expression>) -> bool {
        let expressions = self.expressions();
        match &expressions[handle] {
            Expression::Literal(_) | Expression::Constant(_) | Expression::ZeroValue(_) => true,
            Expression::Splat { value, .. } => self.is_constant_to_naga(*value),
            Expression::Compose { components, .. } => components.iter().all(|part| self.is_constant_to_naga(*part)),
            _ => false,
        }
    }

    /// The number of components of a constant scalar or vector.
    fn constant_length(&self, handle: Handle<Expression>) -> u32 {
        let expressions = self.expressions();
        let ty = match &expressions[handle] {
            Expression::Constant(constant) => self.low.module.constants[*constant].ty,
            Expression::ZeroValue(ty) | Expression::Compose { ty, .. } => *ty,
            Expression::Splat { size, .. } => return *size as u32,
            _ => return 1,
        };
        match self.low.module.types[ty].inner {
            TypeInner::Vector { size, .. } => size as u32,
            _ => 1,
        }
    }

    /// The operand, read from a variable if its type is evident.
    fn hidden_operand(&mut self, operand: Handle<Expression>) -> Handle<Expression> {
        let Some(ty) = self.type_of_known(operand) else { return operand };
        let variable = self.variable("operand", ty);
        self.store(variable, operand);
        self.load(variable)
    }

    /// Whether an operand is an integer constant that contains a 0.
    fn may_be_zero(&self, operand: Handle<Expression>) -> bool {
        let expressions = self.expressions();
        let zero = |handle: &Handle<Expression>| {
            matches!(expressions[*handle], Expression::Literal(Literal::I32(0) | Literal::U32(0)))
        };
        match &expressions[operand] {
            Expression::Compose { components, .. } => components.iter().any(zero),
            Expression::Splat { value, .. } => zero(value),
            Expression::ZeroValue(_) => true,
            _ => zero(&operand),
        }
    }

    /// Whether constant limits of a clamp are the wrong way round.
    fn is_reversed(&self, low: Handle<Expression>, high: Handle<Expression>) -> bool {
        let [low, high] = [low, high].map(|limit| numbers(&self.low.module, self.expressions(), limit));
        low.iter().zip(&high).any(|(low, high)| low > high)
    }

    /// The type of a constant, as far as it is evident.
    fn type_of_known(&mut self, handle: Handle<Expression>) -> Option<Handle<naga::Type>> {
        let scalar = |literal: &Literal| match literal {
            Literal::F32(_) => Some(Scalar::Float),
            Literal::I32(_) => Some(Scalar::Int),
            Literal::U32(_) => Some(Scalar::Uint),
            _ => None,
        };
        match self.out.expressions[handle] {
            Expression::Literal(literal) => Some(self.low.vector_type(scalar(&literal)?, 1)),
            Expression::Compose { ty, .. } | Expression::ZeroValue(ty) => Some(ty),
            Expression::Constant(constant) => Some(self.low.module.constants[constant].ty),
            Expression::Splat { size, value } => match self.out.expressions[value] {
                Expression::Literal(literal) => Some(self.low.vector_type(scalar(&literal)?, size as u8)),
                _ => None,
            },
            Expression::Unary { expr, .. } => self.type_of_known(expr),
            Expression::Binary { op, left, .. } if has_type_of_operands(op) => self.type_of_known(left),
            Expression::Select { accept, .. } => self.type_of_known(accept),
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => {
                let ty = self.type_of_known(base)?;
                match self.low.module.types[ty].inner {
                    TypeInner::Vector { scalar, .. } => Some(self.low.insert_type(None, TypeInner::Scalar(scalar))),
                    TypeInner::Matrix { rows: size, scalar, .. } => {
                        Some(self.low.insert_type(None, TypeInner::Vector { size, scalar }))
                    }
                    TypeInner::Array { base, .. } => Some(base),
                    _ => None,
                }
            }
            Expression::Swizzle { size, vector, .. } => {
                let ty = self.type_of_known(vector)?;
                let scalar = self.low.module.types[ty].inner.scalar()?;
                Some(self.low.insert_type(None, TypeInner::Vector { size, scalar }))
            }
            _ => None,
        }
    }
}

/// Whether the result of an operator has the type of its left operand: integers' operators, and sums, whose operands are brought to one
/// size before.
fn has_type_of_operands(op: BinaryOperator) -> bool {
    use BinaryOperator as Op;
    matches!(
        op,
        Op::Add
            | Op::Subtract
            | Op::And
            | Op::InclusiveOr
            | Op::ExclusiveOr
            | Op::ShiftLeft
            | Op::ShiftRight
            | Op::Modulo
    )
}

impl Lower<'_> {
    /// A private variable that contains these bits. Every NaN is the same: its sign depends on the machine that folds it.
    fn hidden_bits(&mut self, bits: u32) -> Handle<GlobalVariable> {
        let bits = if f32::from_bits(bits).is_nan() { f32::NAN.to_bits() } else { bits };
        if let Some((_, known)) = self.hidden.iter().find(|(known, _)| *known == bits) {
            return *known;
        }
        let ty = self.vector_type(Scalar::Uint, 1);
        let literal = Expression::Literal(Literal::U32(bits));
        let init = self.module.global_expressions.append(literal, naga::Span::UNDEFINED);
        let name = match f32::from_bits(bits) {
            value if value.is_finite() => "largest_bits",
            value if value.is_nan() => "nan_bits",
            value if value > 0.0 => "infinity_bits",
            _ => "negative_infinity_bits",
        };
        let variable = GlobalVariable {
            name: Some(name.to_owned()),
            space: AddressSpace::Private,
            binding: None,
            ty,
            init: Some(init),
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        let variable = self.module.global_variables.append(variable, naga::Span::UNDEFINED);
        self.hidden.push((bits, variable));
        variable
    }

    /// Declares the constants of the texts, in their order. What is indexed by a variable is declared where it is used.
    pub(super) fn declare_constants(&mut self) -> Try<()> {
        let shader = self.shader;
        for (id, global) in
            shader.globals().filter(|(_, global)| global.storage == Storage::Const && global.builtin.is_none())
        {
            let is_indexed = self.facts.indexed.get(id.index()).copied().unwrap_or(false);
            let value = global.value.as_ref().filter(|value| is_constant(value) && self.has_value(value.ty));
            let (Some(value), false) = (value, is_indexed) else { continue };
            let (ty, init) = (self.value_type(value.ty)?, self.global_constant(value)?);
            let constant = naga::Constant { name: Some(global.name.clone()), ty, init };
            let constant = self.module.constants.append(constant, naga::Span::UNDEFINED);
            if let Some(slot) = self.globals.get_mut(id.index()) {
                *slot = GlobalSlot::Constant(constant);
            }
        }
        Ok(())
    }

    /// A finite constant as an expression of the module.
    pub(super) fn global_constant(&mut self, value: &Value) -> Try<Handle<Expression>> {
        let mut scalars = value.scalars.iter().copied();
        self.global_part(value.ty, &mut scalars)
    }

    fn global_part(&mut self, ty: TypeId, scalars: &mut dyn Iterator<Item = ScalarValue>) -> Try<Handle<Expression>> {
        let types = self.types;
        let parts: Vec<TypeId> = match types.get(ty) {
            Type::Scalar(_) => {
                let literal = match scalars.next() {
                    Some(ScalarValue::Bool(value)) => Literal::Bool(value),
                    Some(ScalarValue::Int(value)) => Literal::I32(value),
                    Some(ScalarValue::Uint(value)) => Literal::U32(value),
                    Some(ScalarValue::Float(value)) => Literal::F32(value),
                    None => return Err(internal(Default::default(), "a constant is too short")),
                };
                let literal = Expression::Literal(literal);
                return Ok(self.module.global_expressions.append(literal, naga::Span::UNDEFINED));
            }
            Type::Struct(id) => types.structure(id).members.iter().map(|member| member.ty).collect(),
            Type::Array(element, ArraySize::Sized(len)) => vec![element; len as usize],
            Type::Vector(scalar, size) => vec![TypeId::vector(scalar, 1); usize::from(size)],
            Type::Matrix(columns, _) => vec![self.element_type(ty); usize::from(columns)],
            _ => return Err(internal(Default::default(), "a constant of no type of values")),
        };
        let mut components = Vec::with_capacity(parts.len());
        for part in parts {
            components.push(self.global_part(part, scalars)?);
        }
        let ty = self.value_type(ty)?;
        let compose = Expression::Compose { ty, components };
        Ok(self.module.global_expressions.append(compose, naga::Span::UNDEFINED))
    }

    /// The value of an expression, if it is constant.
    pub(super) fn evaluated(&self, function: FunctionId, id: ExprId) -> Option<Value> {
        if !self.facts.nature(id).constant {
            return None;
        }
        let locals = &self.shader.functions.get(function.index())?.locals;
        glisten_front::fold::evaluate(self.shader, self.types, id, &|var| match var {
            VarRef::Local(local) => {
                let local = locals.get(local.index())?;
                local.value.as_ref().filter(|_| local.kind == LocalKind::Const)
            }
            VarRef::Global(_) => None,
        })
    }

    /// The value of a scalar expression, if it is constant.
    pub(super) fn constant_of(&self, function: FunctionId, id: ExprId) -> Option<ScalarValue> {
        match self.evaluated(function, id)?.scalars.as_slice() {
            [one] => Some(*one),
            _ => None,
        }
    }
}
