//! Evaluates constant expressions exactly (GLSL 1.50 §4.3.3).
//!
//! *In:* an expression of the typed program. *Out:* its value, or `None` if it is not constant. *Holds:* integers
//! wrap at 32 bits; each operator on floats rounds once to f32; each built-in function is computed in f64 and rounded
//! once. So the value is the same on every machine. These cases are defined here because the specification leaves
//! them undefined:
//!
//! | expression | value |
//! | --- | --- |
//! | integer `a / 0`, `a % 0` | all bits set, as on lavapipe |
//! | the smallest `int` divided by -1 | itself, remainder 0 |
//! | shifts by 32 or more | shifts by the lowest five bits |
//! | `float` to an integer type that cannot represent it | the nearest integer, 0 for NaN |
//! | built-in functions outside their domain | the result of the [kernels](crate::builtin::operations::kernel), as on
//! the reference |
//!
//! The traversal is a loop, so chains of any length need no stack. *Not done here:* explaining why something is not
//! constant.

mod builtins;
mod construct;
mod operators;

pub use operators::{convert, scalar_binary, unary};

use crate::hir::{Expr, ExprId, ExprKind, ScalarValue, Shader, Storage, Type, TypeId, Types, Value, VarRef};
use smallvec::SmallVec;
use std::cell::Cell;

/// The scalars of a value in flat order.
type Scalars = SmallVec<[ScalarValue; 4]>;

/// The inputs of an evaluation.
struct Context<'a> {
    shader: &'a Shader,
    types: &'a Types,
    variables: &'a dyn Fn(VarRef) -> Option<&'a Value>,
}

enum Task {
    Visit(ExprId),
    Apply(ExprId),
}

/// The scalars of an intermediate value.
enum Held<'a> {
    Own(Scalars),
    /// The scalars of a variable. An array is not copied to select one element.
    Lent(&'a [ScalarValue]),
}

impl std::ops::Deref for Held<'_> {
    type Target = [ScalarValue];

    fn deref(&self) -> &[ScalarValue] {
        match self {
            Self::Own(scalars) => scalars,
            Self::Lent(scalars) => scalars,
        }
    }
}

/// An intermediate value with its type.
struct Operand<'a> {
    ty: TypeId,
    scalars: Held<'a>,
}

/// The value of an expression if it is constant. `variables` contains the values of variables that count as constant
/// besides global constants: local constants, or those that a specialization fixes.
pub fn evaluate<'a>(
    shader: &'a Shader,
    types: &'a Types,
    expr: ExprId,
    variables: &'a dyn Fn(VarRef) -> Option<&'a Value>,
) -> Option<Value> {
    evaluate_within(shader, types, expr, variables, &Cell::new(u64::MAX))
}

/// Evaluates like [`evaluate`], with at most `fuel` steps (about one per scalar read or written). Returns `None` if
/// they do not suffice.
pub(super) fn evaluate_within<'a>(
    shader: &'a Shader,
    types: &'a Types,
    expr: ExprId,
    variables: &'a dyn Fn(VarRef) -> Option<&'a Value>,
    fuel: &Cell<u64>,
) -> Option<Value> {
    let context = Context { shader, types, variables };
    let mut tasks = vec![Task::Visit(expr)];
    let mut operands: Vec<Operand<'a>> = Vec::new();
    while let Some(task) = tasks.pop() {
        match task {
            Task::Visit(id) => match &shader.expr(id).kind {
                ExprKind::Literal(value) => {
                    let scalars = Held::Own(Scalars::from_slice(&[*value]));
                    operands.push(Operand { ty: shader.expr(id).ty, scalars });
                }
                ExprKind::Var(variable) => operands.push(context.variable(*variable)?),
                kind => {
                    let children = children(kind)?;
                    tasks.push(Task::Apply(id));
                    tasks.extend(children.into_iter().rev().map(Task::Visit));
                }
            },
            Task::Apply(id) => {
                let expr = shader.expr(id);
                let n_children = children(&expr.kind)?.len();
                let arguments = operands.split_off(operands.len().checked_sub(n_children)?);
                burn(fuel, cost(&expr.kind, &arguments))?;
                let scalars = context.apply(expr, &arguments)?;
                operands.push(Operand { ty: expr.ty, scalars: Held::Own(scalars) });
            }
        }
    }
    let Operand { ty, scalars } = operands.pop()?;
    let scalars = match scalars {
        Held::Own(scalars) => scalars.into_vec(),
        Held::Lent(scalars) => scalars.to_vec(),
    };
    Some(Value { ty, scalars })
}

fn burn(fuel: &Cell<u64>, steps: u64) -> Option<()> {
    let left = fuel.get().checked_sub(steps);
    fuel.set(left.unwrap_or(0));
    left.map(|_| ())
}

/// The steps of one operation. Selecting an element does not read the others; a member is read after those before it.
fn cost(kind: &ExprKind, operands: &[Operand<'_>]) -> u64 {
    match kind {
        ExprKind::Index(..) | ExprKind::Swizzle(..) => 1,
        ExprKind::Member(_, member) => u64::from(*member) + 1,
        _ => operands.iter().map(|operand| operand.scalars.len() as u64).sum::<u64>() + 1,
    }
}

/// The operands of an expression that may be constant; `None` for one that never is.
fn children(kind: &ExprKind) -> Option<SmallVec<[ExprId; 4]>> {
    Some(match kind {
        ExprKind::Literal(_) | ExprKind::Var(_) => SmallVec::new(),
        ExprKind::Member(a, _) | ExprKind::Swizzle(a, _) | ExprKind::Convert(a) | ExprKind::Unary(_, a) => {
            SmallVec::from_slice(&[*a])
        }
        ExprKind::Index(a, b) | ExprKind::Binary(_, a, b) | ExprKind::Logical(_, a, b) | ExprKind::Comma(a, b) => {
            SmallVec::from_slice(&[*a, *b])
        }
        ExprKind::Ternary(a, b, c) => SmallVec::from_slice(&[*a, *b, *c]),
        ExprKind::Construct(_, arguments) | ExprKind::BuiltinCall(_, arguments) => SmallVec::from_slice(arguments),
        ExprKind::Error | ExprKind::IncDec(..) | ExprKind::Assign(..) | ExprKind::Call(..) => return None,
    })
}

impl<'a> Context<'a> {
    fn variable(&self, variable: VarRef) -> Option<Operand<'a>> {
        let own = match variable {
            VarRef::Global(id) => {
                let global = self.shader.global(id);
                if global.storage == Storage::Const { global.value.as_ref() } else { None }
            }
            VarRef::Local(_) => None,
        };
        let value = match own {
            Some(value) => value,
            None => (self.variables)(variable)?,
        };
        Some(Operand { ty: value.ty, scalars: Held::Lent(&value.scalars) })
    }

    fn apply(&self, expr: &Expr, operands: &[Operand<'_>]) -> Option<Scalars> {
        let scalars = |index: usize| operands.get(index).map(|operand| &*operand.scalars);
        match &expr.kind {
            ExprKind::Member(_, member) => self.member(operands.first()?, *member),
            ExprKind::Index(..) => self.element(operands.first()?, operands.get(1)?),
            ExprKind::Swizzle(_, swizzle) => {
                let base = scalars(0)?;
                swizzle.as_slice().iter().map(|&component| base.get(usize::from(component)).copied()).collect()
            }
            ExprKind::Convert(_) => {
                let to = self.types.scalar_of(expr.ty)?;
                Some(scalars(0)?.iter().map(|&scalar| convert(scalar, to)).collect())
            }
            ExprKind::Construct(kind, _) => construct::construct(self.types, *kind, expr.ty, operands),
            ExprKind::Unary(op, _) => scalars(0)?.iter().map(|&scalar| unary(*op, scalar)).collect(),
            ExprKind::Binary(op, ..) => operators::binary(self.types, *op, operands.first()?, operands.get(1)?),
            ExprKind::Logical(op, ..) => {
                let value = operators::logical(*op, boolean(scalars(0)?)?, boolean(scalars(1)?)?);
                Some(Scalars::from_slice(&[ScalarValue::Bool(value)]))
            }
            ExprKind::Ternary(..) => {
                let chosen = if boolean(scalars(0)?)? { 1 } else { 2 };
                Some(Scalars::from_slice(scalars(chosen)?))
            }
            ExprKind::Comma(..) => Some(Scalars::from_slice(scalars(1)?)),
            ExprKind::BuiltinCall(function, _) => builtins::call(self.types, *function, expr.ty, operands),
            ExprKind::Error
            | ExprKind::Literal(_)
            | ExprKind::Var(_)
            | ExprKind::IncDec(..)
            | ExprKind::Assign(..)
            | ExprKind::Call(..) => None,
        }
    }

    fn member(&self, base: &Operand<'_>, member: u32) -> Option<Scalars> {
        let Type::Struct(id) = self.types.get(base.ty) else { return None };
        let members = &self.types.structure(id).members;
        let before = members.get(..member as usize)?.iter().map(|member| self.types.flat_len(member.ty)).sum();
        self.slice(base, before, members.get(member as usize)?.ty)
    }

    fn element(&self, base: &Operand<'_>, index: &Operand<'_>) -> Option<Scalars> {
        let index = match index.scalars.first()? {
            ScalarValue::Int(index) => u32::try_from(*index).ok()?,
            ScalarValue::Uint(index) => *index,
            ScalarValue::Bool(_) | ScalarValue::Float(_) => return None,
        };
        let element = self.types.element(base.ty)?;
        self.slice(base, index.checked_mul(self.types.flat_len(element))?, element)
    }

    fn slice(&self, base: &Operand<'_>, start: u32, ty: TypeId) -> Option<Scalars> {
        let start = start as usize;
        let end = start.checked_add(self.types.flat_len(ty) as usize)?;
        base.scalars.get(start..end).map(Scalars::from_slice)
    }
}

fn boolean(scalars: &[ScalarValue]) -> Option<bool> {
    match scalars.first()? {
        ScalarValue::Bool(value) => Some(*value),
        ScalarValue::Int(_) | ScalarValue::Uint(_) | ScalarValue::Float(_) => None,
    }
}

#[cfg(test)]
mod tests;
