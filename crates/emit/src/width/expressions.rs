//! Expressions in another width.
//!
//! *In:* an expression in f32, whose operands are rewritten. *Out:* its [`Value`]. *Holds:* what is computed has the other
//! width; what is read from the interface is converted as soon as it is a scalar, vector or matrix.

use super::Refusal;
use super::rewriter::{Rewriter, Value};
use naga::{ArraySize, Expression, Handle, MathFunction, SampleLevel, ScalarKind, Type, TypeInner};

/// No aggregate with more parts is converted as a whole.
const MOST_PARTS: u32 = 256;

/// Whether a function converts between an integer and floats of 32 bits (GLSL.std.450), whatever the width of the rest.
fn is_packing(fun: MathFunction) -> bool {
    use MathFunction as M;
    matches!(
        fun,
        M::Pack4x8snorm
            | M::Pack4x8unorm
            | M::Pack2x16snorm
            | M::Pack2x16unorm
            | M::Pack2x16float
            | M::Unpack4x8snorm
            | M::Unpack4x8unorm
            | M::Unpack2x16snorm
            | M::Unpack2x16unorm
            | M::Unpack2x16float
    )
}

impl Rewriter<'_, '_> {
    pub(super) fn expression(&mut self, old: Handle<Expression>, expression: &Expression) -> Result<Value, Refusal> {
        use Expression as E;
        let is_float = self.is_float(old);
        match expression {
            E::FunctionArgument(index) => {
                let raw = self.add(expression.clone());
                let kept = self.new.arguments.get(*index as usize).map(|argument| argument.ty)
                    == self.old.arguments.get(*index as usize).map(|argument| argument.ty);
                Ok(self.read(old, raw, kept && is_float))
            }
            E::GlobalVariable(variable) => {
                let kept = self.widths.old.global_variables[*variable].space != naga::AddressSpace::Private;
                Ok(Value { handle: self.add(expression.clone()), kept })
            }
            E::LocalVariable(variable) => {
                let kept = self.widths.interface.contains(&self.old.local_variables[*variable].ty);
                Ok(Value { handle: self.add(expression.clone()), kept })
            }
            E::Access { base, .. } | E::AccessIndex { base, .. } => {
                let kept = self.value(*base).kept;
                let raw = self.mapped(expression)?;
                Ok(self.read(old, raw, kept))
            }
            E::Load { pointer } => {
                let Value { handle, kept } = self.value(*pointer);
                let raw = self.add(E::Load { pointer: handle });
                if !(kept && is_float) {
                    return Ok(Value { handle: raw, kept: false });
                }
                match self.info[old].ty.handle() {
                    Some(ty) if !self.widths.interface.contains(&ty) => {
                        let handle = self.converted(raw, ty, &mut MOST_PARTS.clone())?;
                        Ok(Value { handle, kept: false })
                    }
                    _ => Ok(self.read(old, raw, true)),
                }
            }
            E::Compose { ty, components } if self.widths.interface.contains(ty) => {
                let components = components.iter().map(|component| self.single(*component)).collect();
                Ok(Value { handle: self.add(E::Compose { ty: *ty, components }), kept: true })
            }
            E::ZeroValue(ty) if self.widths.interface.contains(ty) => {
                Ok(Value { handle: self.add(expression.clone()), kept: true })
            }
            E::ImageSample { .. } | E::ImageLoad { .. } | E::Derivative { .. } => {
                let raw = self.in_f32(expression)?;
                Ok(self.read(old, raw, is_float))
            }
            E::As { expr, kind, convert: None } => {
                let raw = E::As { expr: self.single(*expr), kind: *kind, convert: None };
                let raw = self.add(raw);
                Ok(self.read(old, raw, is_float))
            }
            E::Math { fun, .. } if self.is_narrow(*fun) || is_packing(*fun) => {
                let raw = self.in_f32(expression)?;
                Ok(self.read(old, raw, is_float))
            }
            _ => Ok(Value { handle: self.mapped(expression)?, kept: false }),
        }
    }

    /// A value that was read: a scalar, vector or matrix in f32 is converted, the rest stays as it is.
    fn read(&mut self, old: Handle<Expression>, raw: Handle<Expression>, kept: bool) -> Value {
        let is_leaf =
            matches!(self.inner(old), TypeInner::Scalar(_) | TypeInner::Vector { .. } | TypeInner::Matrix { .. });
        if !(kept && is_leaf && self.is_float(old)) {
            return Value { handle: raw, kept };
        }
        Value { handle: self.to(self.widths.width, raw), kept: false }
    }

    /// An aggregate in f32, member by member.
    fn converted(
        &mut self,
        raw: Handle<Expression>,
        ty: Handle<Type>,
        left: &mut u32,
    ) -> Result<Handle<Expression>, Refusal> {
        let old = self.widths.old;
        let changed = self.widths.value_type(ty)?;
        *left = left.checked_sub(1).ok_or("an aggregate of a uniform block is too large to be converted as a whole")?;
        let parts: Vec<Handle<Type>> = match &old.types[ty].inner {
            _ if changed == ty => return Ok(raw),
            TypeInner::Struct { members, .. } => members.iter().map(|member| member.ty).collect(),
            TypeInner::Array { base, size: ArraySize::Constant(size), .. } if size.get() <= MOST_PARTS => {
                vec![*base; size.get() as usize]
            }
            TypeInner::Array { .. } => {
                return Err("an array of a uniform block is too large to be converted as a whole".into());
            }
            _ => return Ok(self.to(self.widths.width, raw)),
        };
        let mut components = Vec::new();
        for (index, part) in (0..).zip(parts) {
            let member = self.add(Expression::AccessIndex { base: raw, index });
            components.push(self.converted(member, part, left)?);
        }
        Ok(self.add(Expression::Compose { ty: changed, components }))
    }

    /// Whether a function has arguments of 16 and 32 bits alone (GLSL.std.450).
    fn is_narrow(&self, fun: MathFunction) -> bool {
        use MathFunction as M;
        let transcendental = matches!(
            fun,
            M::Sin
                | M::Cos
                | M::Tan
                | M::Asin
                | M::Acos
                | M::Atan
                | M::Atan2
                | M::Sinh
                | M::Cosh
                | M::Tanh
                | M::Asinh
                | M::Acosh
                | M::Atanh
                | M::Exp
                | M::Exp2
                | M::Log
                | M::Log2
                | M::Pow
                | M::Radians
                | M::Degrees
        );
        self.widths.width == 8 && transcendental
    }

    /// An expression with its operands in f32.
    fn in_f32(&mut self, expression: &Expression) -> Result<Handle<Expression>, Refusal> {
        self.with_operands(expression, &mut |rewriter, operand| rewriter.single(operand))
    }

    /// An expression with its operands as they were rewritten.
    fn mapped(&mut self, expression: &Expression) -> Result<Handle<Expression>, Refusal> {
        self.with_operands(expression, &mut |rewriter, operand| rewriter.value(operand).handle)
    }

    fn with_operands(
        &mut self,
        expression: &Expression,
        of: &mut dyn FnMut(&mut Self, Handle<Expression>) -> Handle<Expression>,
    ) -> Result<Handle<Expression>, Refusal> {
        use Expression as E;
        let width = self.widths.width;
        let new = match *expression {
            E::Literal(literal) => E::Literal(self.widths.literal(literal)?),
            E::Constant(_) | E::CallResult(_) => expression.clone(),
            E::ZeroValue(ty) => E::ZeroValue(self.widths.value_type(ty)?),
            E::Compose { ty, ref components } => E::Compose {
                ty: self.widths.value_type(ty)?,
                components: components.iter().map(|one| of(self, *one)).collect(),
            },
            E::Access { base, index } => E::Access { base: of(self, base), index: of(self, index) },
            E::AccessIndex { base, index } => E::AccessIndex { base: of(self, base), index },
            E::Splat { size, value } => E::Splat { size, value: of(self, value) },
            E::Swizzle { size, vector, pattern } => E::Swizzle { size, vector: of(self, vector), pattern },
            E::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => E::ImageSample {
                image: of(self, image),
                sampler: of(self, sampler),
                gather,
                coordinate: of(self, coordinate),
                array_index: array_index.map(|one| of(self, one)),
                offset: offset.map(|one| of(self, one)),
                level: match level {
                    SampleLevel::Auto | SampleLevel::Zero => level,
                    SampleLevel::Exact(one) => SampleLevel::Exact(of(self, one)),
                    SampleLevel::Bias(one) => SampleLevel::Bias(of(self, one)),
                    SampleLevel::Gradient { x, y } => SampleLevel::Gradient { x: of(self, x), y: of(self, y) },
                },
                depth_ref: depth_ref.map(|one| of(self, one)),
                clamp_to_edge,
            },
            E::ImageLoad { image, coordinate, array_index, sample, level } => E::ImageLoad {
                image: of(self, image),
                coordinate: of(self, coordinate),
                array_index: array_index.map(|one| of(self, one)),
                sample: sample.map(|one| of(self, one)),
                level: level.map(|one| of(self, one)),
            },
            E::ImageQuery { image, query } => {
                let query = match query {
                    naga::ImageQuery::Size { level } => {
                        naga::ImageQuery::Size { level: level.map(|one| of(self, one)) }
                    }
                    other => other,
                };
                E::ImageQuery { image: of(self, image), query }
            }
            E::Unary { op, expr } => E::Unary { op, expr: of(self, expr) },
            E::Binary { op, left, right } => E::Binary { op, left: of(self, left), right: of(self, right) },
            E::Select { condition, accept, reject } => {
                E::Select { condition: of(self, condition), accept: of(self, accept), reject: of(self, reject) }
            }
            E::Derivative { axis, ctrl, expr } => E::Derivative { axis, ctrl, expr: of(self, expr) },
            E::Relational { fun, argument } => E::Relational { fun, argument: of(self, argument) },
            E::Math { fun, arg, arg1, arg2, arg3 } => E::Math {
                fun,
                arg: of(self, arg),
                arg1: arg1.map(|one| of(self, one)),
                arg2: arg2.map(|one| of(self, one)),
                arg3: arg3.map(|one| of(self, one)),
            },
            E::As { expr, kind: ScalarKind::Float, convert: Some(4) } => {
                E::As { expr: of(self, expr), kind: ScalarKind::Float, convert: Some(width) }
            }
            E::As { expr, kind, convert } => E::As { expr: of(self, expr), kind, convert },
            E::ArrayLength(array) => E::ArrayLength(of(self, array)),
            _ => return Err("it contains an expression that no vertex or fragment stage has".into()),
        };
        Ok(self.add(new))
    }
}
