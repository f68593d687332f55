//! The parts of uniforms that an expression names.
//!
//! *In:* an expression of a stage. *Out:* [`Part`]s: scalars of a uniform or block. *Holds:* an index that is no literal names all
//! elements.

use glisten_front::hir::{ExprId, ExprKind, GlobalId, ScalarValue, Shader, Type, Types, VarRef};
use std::ops::Range;

/// The most ranges of scalars of a part.
const MAX_RANGES: usize = 64;

/// Scalars of a global, by their places in its flat layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) global: GlobalId,
    pub(crate) scalars: Vec<Range<u32>>,
}

impl Part {
    /// Whether it has some of these scalars.
    pub(crate) fn meets(&self, scalars: &Range<u32>) -> bool {
        self.scalars.iter().any(|own| own.start < scalars.end && scalars.start < own.end)
    }
}

/// The parts that an expression names, in the order of the text.
pub(crate) fn named_parts(types: &Types, shader: &Shader, root: ExprId) -> Vec<Part> {
    let mut parts = Vec::new();
    let mut stack = vec![root];
    while let Some(id) = stack.pop() {
        let mut children = shader.expr(id).kind.children().to_vec();
        if let Some(part) = part(types, shader, id) {
            parts.push(part);
            children = indices(shader, id);
        }
        stack.extend(children.into_iter().rev());
    }
    parts
}

/// The part that an expression is.
fn part(types: &Types, shader: &Shader, id: ExprId) -> Option<Part> {
    let expr = shader.expr(id);
    match &expr.kind {
        ExprKind::Var(VarRef::Global(global)) => {
            let whole = 0..types.flat_len(expr.ty);
            Some(Part { global: *global, scalars: std::iter::once(whole).collect() })
        }
        ExprKind::Member(base, member) => {
            let Type::Struct(of) = types.get(shader.expr(*base).ty) else { return None };
            let members = &types.structure(of).members;
            let before = members.iter().take(*member as usize).map(|member| types.flat_len(member.ty)).sum();
            Some(part(types, shader, *base)?.narrowed(&[before], types.flat_len(expr.ty)))
        }
        ExprKind::Index(base, index) => {
            let len = types.flat_len(expr.ty);
            let whole = part(types, shader, *base)?;
            let count = types.flat_len(shader.expr(*base).ty).checked_div(len).unwrap_or(0);
            let elements = match literal(shader, *index) {
                Some(index) => index..index.saturating_add(1),
                None if count as usize * whole.scalars.len() > MAX_RANGES => return Some(whole),
                None => 0..count,
            };
            let offsets: Vec<u32> = elements.map(|element| element.saturating_mul(len)).collect();
            Some(whole.narrowed(&offsets, len))
        }
        // The components of a vector are told together.
        ExprKind::Swizzle(base, _) | ExprKind::Convert(base) => part(types, shader, *base),
        _ => None,
    }
}

impl Part {
    /// The scalars at these offsets of each range, `len` of them.
    fn narrowed(self, offsets: &[u32], len: u32) -> Self {
        let at = |range: &Range<u32>, offset: &u32| {
            let start = range.start.saturating_add(*offset);
            start..start.saturating_add(len)
        };
        let scalars =
            self.scalars.iter().flat_map(|range| offsets.iter().map(move |offset| at(range, offset))).collect();
        Self { scalars, ..self }
    }
}

/// The indices in the path of a part.
fn indices(shader: &Shader, mut id: ExprId) -> Vec<ExprId> {
    let mut indices = Vec::new();
    loop {
        id = match &shader.expr(id).kind {
            ExprKind::Index(base, index) => {
                indices.push(*index);
                *base
            }
            ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) | ExprKind::Convert(base) => *base,
            _ => {
                indices.reverse();
                return indices;
            }
        };
    }
}

fn literal(shader: &Shader, id: ExprId) -> Option<u32> {
    match shader.expr(id).kind {
        ExprKind::Literal(ScalarValue::Int(value)) => u32::try_from(value).ok(),
        ExprKind::Literal(ScalarValue::Uint(value)) => Some(value),
        _ => None,
    }
}
