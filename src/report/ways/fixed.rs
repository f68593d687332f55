//! [`Fixed`]: the numbers that a draw fixes, by the expressions that stand for them.
//!
//! *In:* a draw and a stage of its program. *Out:* the value of an expression of literals, constants, fixed uniforms and
//! locals that are names for these. *Holds:* a uniform that is `dynamic` has no value, nor has anything computed from
//! it.

use super::names::Names;
use crate::specialize::known;
use glisten_front::fold;
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, FunctionId, GlobalId, ScalarValue, Shader, Stage, Storage, Type, TypeId,
    Types, UnaryOp, VarRef,
};
use glisten_scene::{Draw, Framebuffer};

/// An expression may have so many parts.
const MOST_PARTS: u32 = 64;

/// The numbers that a draw fixes in one stage.
pub(super) struct Fixed {
    /// For each global its scalars, as far as they are fixed.
    globals: Vec<Vec<Option<ScalarValue>>>,
}

impl Fixed {
    /// Those of a stage.
    pub(super) fn of(draw: &Draw, framebuffer: &Framebuffer, stage: Stage) -> Self {
        let program = &draw.program;
        let Some(shader) = program.stage(stage) else { return Self { globals: Vec::new() } };
        let len = |ty: TypeId| program.types.flat_len(ty) as usize;
        let mut globals: Vec<Vec<Option<ScalarValue>>> =
            shader.globals.iter().map(|global| vec![None; len(global.ty)]).collect();
        for (index, global) in shader.globals.iter().enumerate() {
            if let (Storage::Const, Some(value), Some(cell)) = (global.storage, &global.value, globals.get_mut(index)) {
                *cell = value.scalars.iter().copied().map(Some).collect();
            }
        }
        let known = known(draw, framebuffer, &[]);
        for leaf in &program.interface.uniforms {
            let Some(values) = known.uniforms.get(&leaf.name) else { continue };
            let root = program.interface.roots.get(leaf.root.0 as usize);
            let global = root.and_then(|root| root.globals.iter().find(|(of, _)| *of == stage));
            let Some(cell) = global.and_then(|(_, id)| globals.get_mut(id.index())) else { continue };
            let slots = cell.iter_mut().skip(leaf.flat_offset as usize);
            slots.zip(values).for_each(|(slot, value)| *slot = Some(*value));
        }
        Self { globals }
    }

    /// The scalars of an expression of a function; `None` if one of them is not fixed.
    pub(super) fn value(&self, at: &Place<'_>, function: FunctionId, id: ExprId) -> Option<Vec<f64>> {
        let mut parts = MOST_PARTS;
        Some(self.of_expr(at, function, id, &mut parts)?.into_iter().map(number).collect())
    }

    /// The one number of a scalar, or of a vector of equal components.
    pub(super) fn scalar(&self, at: &Place<'_>, function: FunctionId, id: ExprId) -> Option<f64> {
        let values = self.value(at, function, id)?;
        let first = *values.first()?;
        values.iter().all(|value| *value == first).then_some(first)
    }

    fn of_expr(&self, at: &Place<'_>, function: FunctionId, id: ExprId, parts: &mut u32) -> Option<Vec<ScalarValue>> {
        *parts = parts.checked_sub(1)?;
        let expr = at.shader.expr(id);
        let mut of = |id: ExprId| self.of_expr(at, function, id, parts);
        Some(match &expr.kind {
            ExprKind::Literal(value) => vec![*value],
            ExprKind::Var(VarRef::Global(global)) => self.global(*global)?,
            ExprKind::Var(VarRef::Local(local)) => {
                if let Some(value) = &at.shader.function(function).local(*local).value {
                    return Some(value.scalars.clone());
                }
                let (function, value) = at.names.get(function, *local)?;
                return self.of_expr(at, function, value, parts);
            }
            ExprKind::Member(base, member) => {
                let (start, len) = member_range(at.types, at.shader.expr(*base).ty, *member)?;
                self.part(at, *base, start, len)?
            }
            ExprKind::Index(base, index) => {
                let index = number(*of(*index)?.first()?) as usize;
                let len = at.types.flat_len(expr.ty) as usize;
                self.part(at, *base, index.checked_mul(len)?, len)?
            }
            ExprKind::Swizzle(base, swizzle) => {
                let values = of(*base)?;
                swizzle.as_slice().iter().map(|part| values.get(usize::from(*part)).copied()).collect::<Option<_>>()?
            }
            ExprKind::Convert(base) => {
                let to = at.types.scalar_of(expr.ty)?;
                of(*base)?.into_iter().map(|value| fold::convert(value, to)).collect()
            }
            ExprKind::Construct(ConstructKind::Splat, list) => {
                vec![*of(*list.first()?)?.first()?; at.types.flat_len(expr.ty) as usize]
            }
            ExprKind::Construct(ConstructKind::Compose, list) => {
                let mut values = Vec::new();
                for part in list {
                    values.extend(of(*part)?);
                }
                values.truncate(at.types.flat_len(expr.ty) as usize);
                values
            }
            ExprKind::Unary(op @ UnaryOp::Negate, base) => {
                of(*base)?.into_iter().map(|value| fold::unary(*op, value)).collect::<Option<_>>()?
            }
            ExprKind::Binary(op, a, b) => combined(*op, &of(*a)?, &of(*b)?)?,
            _ => return None,
        })
    }

    /// Whether all scalars of a global are fixed.
    pub(super) fn is_fixed(&self, id: GlobalId) -> bool {
        self.global(id).is_some()
    }

    fn global(&self, id: GlobalId) -> Option<Vec<ScalarValue>> {
        self.globals.get(id.index())?.iter().copied().collect()
    }

    /// A part of a variable, of which other parts need not be fixed.
    fn part(&self, at: &Place<'_>, base: ExprId, start: usize, len: usize) -> Option<Vec<ScalarValue>> {
        let (mut base, mut start) = (base, start);
        loop {
            let expr = at.shader.expr(base);
            match &expr.kind {
                ExprKind::Var(VarRef::Global(global)) => {
                    let cell = self.globals.get(global.index())?;
                    return cell.get(start..start.checked_add(len)?)?.iter().copied().collect();
                }
                ExprKind::Member(inner, member) => {
                    start += member_range(at.types, at.shader.expr(*inner).ty, *member)?.0;
                    base = *inner;
                }
                ExprKind::Index(inner, index) => {
                    let ExprKind::Literal(index) = at.shader.expr(*index).kind else { return None };
                    start += number(index) as usize * at.types.flat_len(expr.ty) as usize;
                    base = *inner;
                }
                _ => return None,
            }
        }
    }
}

/// A stage with its types, and the locals that are names.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub(super) types: &'a Types,
    pub(super) shader: &'a Shader,
    pub(super) names: &'a Names,
}

/// Where a member is in the flat layout of a struct.
fn member_range(types: &Types, ty: TypeId, member: u32) -> Option<(usize, usize)> {
    let Type::Struct(id) = types.get(ty) else { return None };
    let members = &types.structure(id).members;
    let len = |ty: TypeId| types.flat_len(ty) as usize;
    let start = members.iter().take(member as usize).map(|member| len(member.ty)).sum();
    Some((start, len(members.get(member as usize)?.ty)))
}

fn number(value: ScalarValue) -> f64 {
    match value {
        ScalarValue::Bool(value) => f64::from(u8::from(value)),
        ScalarValue::Int(value) => f64::from(value),
        ScalarValue::Uint(value) => f64::from(value),
        ScalarValue::Float(value) => f64::from(value),
    }
}

/// An operation component by component; a scalar goes with every component. `None` for a division of integers by zero.
fn combined(op: BinaryOp, a: &[ScalarValue], b: &[ScalarValue]) -> Option<Vec<ScalarValue>> {
    let is_known = matches!(op, BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Div);
    let get = |list: &[ScalarValue], index: usize| {
        if list.len() == 1 { list.first().copied() } else { list.get(index).copied() }
    };
    let apply = |index: usize| match (get(a, index)?, get(b, index)?) {
        (_, ScalarValue::Int(0) | ScalarValue::Uint(0)) if op == BinaryOp::Div => None,
        (a, b) => fold::scalar_binary(op, a, b),
    };
    if is_known { (0..a.len().max(b.len())).map(apply).collect() } else { None }
}

#[cfg(test)]
mod tests {
    use super::combined;
    use glisten_front::hir::BinaryOp;
    use glisten_front::hir::ScalarValue::{Float, Int};

    #[test]
    fn integers_divide_as_integers() {
        let quotient = |a, b| combined(BinaryOp::Div, &[a], &[b]);
        assert_eq!(quotient(Int(7), Int(2)), Some(vec![Int(3)]));
        assert_eq!(quotient(Int(-7), Int(2)), Some(vec![Int(-3)]));
        assert_eq!(quotient(Float(7.0), Float(2.0)), Some(vec![Float(3.5)]));
        assert_eq!(quotient(Int(7), Int(0)), None);
        assert_eq!(combined(BinaryOp::Mul, &[Int(2)], &[Int(3), Int(4)]), Some(vec![Int(6), Int(8)]));
        assert_eq!(combined(BinaryOp::Less, &[Int(2)], &[Int(3)]), None);
    }
}
