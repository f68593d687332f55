//! Builds the expressions of a function.

use super::function::Builder;
use super::lookups::derivative;
use super::names::short_type;
use super::tree::{Expr, Number};
use naga::common::wgsl::TryToWgsl;
use naga::{BinaryOperator, Expression, Handle, Literal, MathFunction, TypeInner};
use std::borrow::Cow;

/// A result, or the message of an internal error.
pub(super) type Try<T> = Result<T, String>;

/// The names of components.
pub(super) const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];
/// How deep an expression is searched for parts that are not constant. Each level multiplies the work by up to four.
const DEEPEST_CONSTANT: u32 = 4;

/// How a pointer is written: as a reference (`a`, `*p`), or as a pointer (`&a`, `p`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Reference,
    Pointer,
}

impl<'m> Builder<'m> {
    /// A value, or a pointer to pass on.
    pub(super) fn value(&mut self, handle: Handle<Expression>) -> Try<Expr<'m>> {
        if let Some(name) = self.named(handle) {
            return Ok(Expr::Local(name));
        }
        let (expr, form) = self.plain(handle)?;
        Ok(if form == Some(Form::Reference) { Expr::Unary("&", Box::new(expr)) } else { expr })
    }

    /// The variable, or the part of one, behind a pointer.
    pub(super) fn reference(&mut self, handle: Handle<Expression>) -> Try<Expr<'m>> {
        let (expr, form) = self.plain(handle)?;
        Ok(if form == Some(Form::Reference) { expr } else { Expr::Unary("*", Box::new(expr)) })
    }

    /// An expression without `&` and `*`, and whether it is a pointer.
    fn plain(&mut self, handle: Handle<Expression>) -> Try<(Expr<'m>, Option<Form>)> {
        let function = self.function;
        let expr = match &function.expressions[handle] {
            Expression::LocalVariable(variable) => {
                let expr = self.variable(*variable)?;
                return Ok((expr, Some(Form::Reference)));
            }
            Expression::GlobalVariable(variable) => {
                let form = match self.module.global_variables[*variable].space {
                    naga::AddressSpace::Handle => None,
                    _ => Some(Form::Reference),
                };
                return Ok((self.names.global(*variable), form));
            }
            Expression::FunctionArgument(index) => {
                let pointer = self.is_pointer(handle);
                return Ok((self.argument(*index)?, pointer.then_some(Form::Pointer)));
            }
            Expression::Access { base, index } => {
                let (base, form) = self.base(*base)?;
                let mut index = self.value(*index)?;
                if let Expr::Number(number) = &mut index {
                    number.suffixed = false;
                }
                return Ok((Expr::Index(Box::new(base), Box::new(index)), form));
            }
            Expression::AccessIndex { base, index } => return self.access(*base, *index),
            Expression::Load { pointer } => self.reference(*pointer)?,
            Expression::Literal(literal) => number(*literal),
            Expression::Constant(constant) => self.names.constant(*constant),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => self.compose(*ty, components)?,
            Expression::Splat { size, value } => {
                let name = short_type(&TypeInner::Vector { size: *size, scalar: naga::Scalar::F32 });
                let value = self.value(*value)?;
                Expr::Call(name.into(), vec![value])
            }
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(*vector)?;
                let parts = pattern.iter().take(*size as usize).map(|part| COMPONENTS[*part as usize & 3]);
                Expr::Member(Box::new(vector), parts.collect::<String>().into())
            }
            Expression::Unary { op, expr } => {
                let op = match op {
                    naga::UnaryOperator::Negate => "-",
                    naga::UnaryOperator::LogicalNot => "!",
                    naga::UnaryOperator::BitwiseNot => "~",
                };
                let mut operand = self.value(*expr)?;
                operand.make_concrete();
                Expr::Unary(op, Box::new(operand))
            }
            Expression::Binary { op, left, right } => {
                let (left, right) = self.without_splats(*op, *left, *right);
                let mut operands = [self.value(left)?, self.value(right)?];
                concrete(&mut operands);
                let [left, right] = operands;
                Expr::Binary(naga::back::binary_operation_str(*op), Box::new(left), Box::new(right))
            }
            Expression::Select { condition, accept, reject } => {
                let (reject, accept) = (self.value(*reject)?, self.value(*accept)?);
                let condition = self.value(*condition)?;
                Expr::Call("select".into(), vec![reject, accept, condition])
            }
            Expression::Relational { fun, argument } => {
                let name = match fun {
                    naga::RelationalFunction::All => "all",
                    naga::RelationalFunction::Any => "any",
                    other => return Err(format!("WGSL has no {other:?}")),
                };
                let argument = self.value(*argument)?;
                Expr::Call(name.into(), vec![argument])
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let arguments: Vec<_> = [Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect();
                self.math(*fun, &arguments)?
            }
            Expression::As { expr, kind, convert } => self.conversion(*expr, *kind, *convert)?,
            Expression::Derivative { axis, ctrl, expr } => {
                let name = derivative(*axis, *ctrl);
                let mut argument = self.value(*expr)?;
                argument.make_concrete();
                Expr::Call(name.into(), vec![argument])
            }
            Expression::CallResult(_) => self.call_of(handle)?,
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => {
                self.lookup(handle)?
            }
            other => return Err(format!("no WGSL for {other:?}")),
        };
        Ok((expr, None))
    }

    /// The operands of an operator without the vector of equal components that WGSL makes of a scalar itself (§8.7).
    fn without_splats(
        &self,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> (Handle<Expression>, Handle<Expression>) {
        use BinaryOperator::{Add, Divide, Multiply, Subtract};
        let scalar = |handle: Handle<Expression>| match self.function.expressions[handle] {
            Expression::Splat { value, .. } if self.named(handle).is_none() => Some(value),
            _ => None,
        };
        // A matrix times a vector is no vector times a scalar.
        let is_vector = |handle: Handle<Expression>| {
            matches!(self.info[handle].ty.inner_with(&self.module.types), TypeInner::Vector { .. })
        };
        match (scalar(left), scalar(right)) {
            _ if !is_vector(left) || !is_vector(right) => (left, right),
            _ if !self.is_full() || !matches!(op, Add | Subtract | Multiply | Divide) => (left, right),
            (Some(scalar), None) => (scalar, right),
            (None, Some(scalar)) => (left, scalar),
            _ => (left, right),
        }
    }

    fn base(&mut self, base: Handle<Expression>) -> Try<(Expr<'m>, Option<Form>)> {
        if let Some(name) = self.named(base) {
            return Ok((Expr::Local(name), None));
        }
        let (expr, form) = self.plain(base)?;
        Ok(match form {
            Some(Form::Pointer) => (Expr::Unary("*", Box::new(expr)), Some(Form::Reference)),
            form => (expr, form),
        })
    }

    fn access(&mut self, base: Handle<Expression>, index: u32) -> Try<(Expr<'m>, Option<Form>)> {
        if let (Expression::Compose { components, .. }, true) = (&self.function.expressions[base], self.is_open(base))
            && let Some(component) = components.get(index as usize)
        {
            return Ok((self.value(*component)?, None));
        }
        let (expr, form) = self.base(base)?;
        let resolution = &self.info[base].ty;
        let types = &self.module.types;
        let mut handle = resolution.handle();
        let mut inner = resolution.inner_with(types);
        if let TypeInner::Pointer { base, .. } = *inner {
            handle = Some(base);
            inner = &types[base].inner;
        }
        let base = Box::new(expr);
        let expr = match inner {
            TypeInner::Vector { .. } | TypeInner::ValuePointer { size: Some(_), .. } => {
                Expr::Member(base, COMPONENTS[index as usize & 3].into())
            }
            TypeInner::Struct { .. } => {
                let handle = handle.ok_or("a struct has no type")?;
                Expr::Member(base, self.names.member(handle, index))
            }
            _ => {
                let digits = index.to_string();
                Expr::Index(base, Box::new(Expr::Number(Number { digits, suffix: "", suffixed: false })))
            }
        };
        Ok((expr, form))
    }

    /// The zero value of a type.
    fn zero(&self, ty: Handle<naga::Type>) -> Expr<'m> {
        let inner = &self.module.types[ty].inner;
        match (inner, self.is_full()) {
            (TypeInner::Scalar(scalar), true) => zero_scalar(*scalar),
            (TypeInner::Vector { scalar, .. }, true) => {
                Expr::Call(short_type(inner).into(), vec![concrete_zero(*scalar)])
            }
            _ => Expr::Call(self.names.ty(self.module, ty).into(), Vec::new()),
        }
    }

    fn compose(&mut self, ty: Handle<naga::Type>, components: &[Handle<Expression>]) -> Try<Expr<'m>> {
        let module = self.module;
        let inner = &module.types[ty].inner;
        let is_vector = matches!(inner, TypeInner::Vector { .. });
        let first = components.first().copied();
        let is_scalar =
            |handle: Handle<Expression>| matches!(self.info[handle].ty.inner_with(&module.types), TypeInner::Scalar(_));
        // `vec3(1.0)` for three equal numbers.
        let is_literal = |handle| matches!(self.function.expressions[handle], Expression::Literal(_));
        let equal = first.is_some_and(|first| {
            let same = |other: &Handle<Expression>| {
                *other == first || self.function.expressions[*other] == self.function.expressions[first]
            };
            components.len() > 1 && is_literal(first) && is_scalar(first) && components.iter().all(same)
        });
        let components = match (is_vector && equal && self.is_full(), first) {
            (true, Some(first)) => vec![self.value(first)?],
            _ if is_vector && self.has_constant_vector(components) => self.taken_apart(components)?,
            _ if is_vector && self.is_full() => self.joined(components)?,
            _ => components.iter().map(|component| self.value(*component)).collect::<Try<Vec<_>>>()?,
        };
        let name: Cow<'m, str> = match inner {
            TypeInner::Vector { .. } => short_type(inner).into(),
            _ => self.names.ty(module, ty).into(),
        };
        let mut call = Expr::Call(name, components);
        let inferred = matches!(inner, TypeInner::Vector { scalar, .. } if matches!(*scalar, naga::Scalar::F32 | naga::Scalar::I32));
        if !inferred && !matches!(inner, TypeInner::Struct { .. } | TypeInner::Array { .. }) {
            match &mut call {
                Expr::Call(_, arguments) => arguments.iter_mut().for_each(Expr::make_concrete),
                other => other.make_concrete(),
            }
        }
        Ok(call)
    }

    /// Whether a vector has a constant of a vector among its components, and all of them may be constant.
    fn has_constant_vector(&self, components: &[Handle<Expression>]) -> bool {
        let is_vector = |handle: Handle<Expression>| {
            matches!(self.info[handle].ty.inner_with(&self.module.types), TypeInner::Vector { .. })
        };
        let is_named = |one: &Handle<Expression>| {
            matches!(self.function.expressions[*one], Expression::Constant(_)) && is_vector(*one)
        };
        components.iter().any(is_named) && components.iter().all(|one| self.may_be_constant(*one, DEEPEST_CONSTANT))
    }

    /// Whether naga may take an expression for a constant one when it reads the text: one that is computed from constants and local
    /// variables alone, which may never change.
    fn may_be_constant(&self, handle: Handle<Expression>, depth: u32) -> bool {
        let Some(depth) = depth.checked_sub(1) else { return true };
        let all = |list: &[Handle<Expression>]| list.iter().all(|one| self.may_be_constant(*one, depth));
        match &self.function.expressions[handle] {
            Expression::Literal(_)
            | Expression::Constant(_)
            | Expression::ZeroValue(_)
            | Expression::LocalVariable(_) => true,
            Expression::Load { pointer: base }
            | Expression::AccessIndex { base, .. }
            | Expression::Swizzle { vector: base, .. }
            | Expression::Splat { value: base, .. }
            | Expression::Unary { expr: base, .. }
            | Expression::As { expr: base, .. } => all(&[*base]),
            Expression::Compose { components, .. } => all(components),
            Expression::Access { base, index } => all(&[*base, *index]),
            Expression::Binary { left, right, .. } => all(&[*left, *right]),
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                all(&[*arg]) && [arg1, arg2, arg3].into_iter().flatten().all(|arg| all(&[*arg]))
            }
            _ => false,
        }
    }

    /// The components of a constant vector, those that are constants of vectors one by one: of `vec4(c, 1.0, 1.0)`, where `c` is one,
    /// naga makes a constant of SPIR-V that has a vector among its components, which SPIR-V forbids.
    fn taken_apart(&mut self, components: &[Handle<Expression>]) -> Try<Vec<Expr<'m>>> {
        let mut result = Vec::with_capacity(4);
        for component in components {
            let value = self.value(*component)?;
            let size =
                match (&self.function.expressions[*component], self.info[*component].ty.inner_with(&self.module.types))
                {
                    (Expression::Constant(_), TypeInner::Vector { size, .. }) => *size as usize,
                    _ => 0,
                };
            let parts = COMPONENTS.iter().take(size).map(|part| Expr::Member(Box::new(value.clone()), (*part).into()));
            result.extend(parts);
            if size == 0 {
                result.push(value);
            }
        }
        Ok(result)
    }

    /// The components of a vector, with neighbors of the same vector as one: `p.xy` for `p.x, p.y`.
    fn joined(&mut self, components: &[Handle<Expression>]) -> Try<Vec<Expr<'m>>> {
        let mut result: Vec<Expr<'m>> = Vec::with_capacity(components.len());
        let mut before = false;
        for component in components {
            let is_component = self.is_component(*component);
            let value = self.value(*component)?;
            match (result.last_mut(), &value) {
                (Some(Expr::Member(known, parts)), Expr::Member(base, part))
                    if before && is_component && known == base && base.is_plain_place() =>
                {
                    *parts = format!("{parts}{part}").into();
                }
                _ => result.push(value),
            }
            before = is_component;
        }
        Ok(result)
    }

    /// Whether a value is written as a component of a vector.
    fn is_component(&self, handle: Handle<Expression>) -> bool {
        let expressions = &self.function.expressions;
        let place = match expressions[handle] {
            _ if self.named(handle).is_some() => return false,
            Expression::Load { pointer } => pointer,
            _ => handle,
        };
        let Expression::AccessIndex { base, .. } = expressions[place] else { return false };
        let inner = match *self.info[base].ty.inner_with(&self.module.types) {
            TypeInner::Pointer { base, .. } => &self.module.types[base].inner,
            ref inner => inner,
        };
        matches!(inner, TypeInner::Vector { .. } | TypeInner::ValuePointer { size: Some(_), .. })
    }

    fn math(&mut self, fun: MathFunction, arguments: &[Handle<Expression>]) -> Try<Expr<'m>> {
        let name: Cow<'m, str> = match (fun.try_to_wgsl(), arguments) {
            (Some(name), _) => name.into(),
            (None, [matrix]) if fun == MathFunction::Inverse => {
                self.inverse(self.info[*matrix].ty.inner_with(&self.module.types))?.into()
            }
            _ => return Err(format!("WGSL has no {fun:?}")),
        };
        let mut values = arguments.iter().map(|argument| self.value(*argument)).collect::<Try<Vec<_>>>()?;
        concrete(&mut values);
        Ok(Expr::Call(name, values))
    }

    fn conversion(
        &mut self,
        expr: Handle<Expression>,
        kind: naga::ScalarKind,
        convert: Option<naga::Bytes>,
    ) -> Try<Expr<'m>> {
        let mut inner = self.info[expr].ty.inner_with(&self.module.types).clone();
        if inner.scalar().is_some_and(|scalar| self.is_full() && (scalar.kind, Some(scalar.width)) == (kind, convert)) {
            // A second name for a value.
            return self.value(expr);
        }
        match &mut inner {
            TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => {
                *scalar = naga::Scalar { kind, width: convert.unwrap_or(scalar.width) };
            }
            other => return Err(format!("no conversion of {other:?}")),
        }
        let ty = self.names.inner(self.module, &inner);
        let mut operand = self.value(expr)?;
        operand.make_concrete();
        let name = if convert.is_some() { ty } else { format!("bitcast<{ty}>") };
        Ok(Expr::Call(name.into(), vec![operand]))
    }
}

/// Numbers alone would be evaluated with more precision than `f32` has.
fn concrete(operands: &mut [Expr<'_>]) {
    if operands.iter().all(Expr::is_abstract) {
        operands.iter_mut().for_each(Expr::make_concrete);
    }
}

fn zero_scalar(scalar: naga::Scalar) -> Expr<'static> {
    match scalar.kind {
        naga::ScalarKind::Bool => Expr::Leaf("false".into()),
        _ => concrete_zero(scalar),
    }
}

fn concrete_zero(scalar: naga::Scalar) -> Expr<'static> {
    match (scalar.kind, scalar.width) {
        (naga::ScalarKind::Float, 4) => number(Literal::F32(0.0)),
        (naga::ScalarKind::Float, _) => Expr::Leaf("0h".into()),
        (naga::ScalarKind::Sint, _) => suffixed(number(Literal::I32(0))),
        (naga::ScalarKind::Uint, _) => number(Literal::U32(0)),
        _ => Expr::Leaf("false".into()),
    }
}

fn suffixed(mut number: Expr<'_>) -> Expr<'_> {
    number.make_concrete();
    number
}

/// A literal.
pub(super) fn number(literal: Literal) -> Expr<'static> {
    let (digits, suffix, suffixed) = match literal {
        Literal::Bool(value) => return Expr::Leaf(if value { "true" } else { "false" }.into()),
        Literal::F32(value) => return float(value),
        // WGSL has no literal for the least number: its sign is an operator.
        Literal::I32(i32::MIN) => return Expr::Call("i32".into(), vec![Expr::Leaf("-2147483648".into())]),
        Literal::I32(value) => (value.to_string(), "i", false),
        Literal::U32(value) => (value.to_string(), "u", true),
        Literal::F16(value) => (value.to_string(), "h", true),
        other => return Expr::Leaf(format!("{other:?}").into()),
    };
    Expr::Number(Number { digits, suffix, suffixed })
}

/// A float: without its suffix, if the digits mean the same without it.
fn float(value: f32) -> Expr<'static> {
    let shortest = value.to_string();
    let digits = if shortest.len() > 12 { format!("{value:e}") } else { shortest };
    let digits = if digits.contains(['.', 'e']) { digits } else { digits + ".0" };
    let same = digits.parse::<f64>().is_ok_and(|wide| (wide as f32).to_bits() == value.to_bits());
    let suffixed = !same || value.abs() > 1e38;
    Expr::Number(Number { digits, suffix: "f", suffixed })
}
