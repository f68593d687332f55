//! [`Chain`]: a variable with members and elements, as in `lights[i].maps[2]`.
//!
//! *In:* an expression. *Out:* its root and steps, apart from the indices that are not constant. *Holds:* two chains with equal
//! roots and steps denote the same for equal indices.

use glisten_front::hir::{ArraySize, ExprId, ExprKind, Shader, Swizzle, Type, TypeId, Types, VarRef};

/// A step from a variable, or a part of it, to a part of that.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Step {
    Member(u32),
    /// An element with a constant index.
    Element(u32),
    /// An element of so many, chosen by the next of the indices; each has a branch.
    Chosen(u32),
    /// An element of something in memory, by the next of the indices.
    Indexed,
    Swizzle(Swizzle),
}

/// A chain of steps.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) root: VarRef,
    /// The expression of the root.
    pub(super) base: ExprId,
    /// The steps, each with the type that it leads to.
    pub(super) steps: Vec<(Step, TypeId)>,
    /// The indices that are not constant, in the order of the steps.
    pub(super) indices: Vec<ExprId>,
}

impl Chain {
    /// The chain that an expression is.
    pub(super) fn of(
        types: &Types,
        shader: &Shader,
        mut id: ExprId,
        constant: &dyn Fn(ExprId) -> Option<u32>,
    ) -> Option<Self> {
        let (mut steps, mut indices) = (Vec::new(), Vec::new());
        loop {
            let expr = shader.expr(id);
            let (step, base) = match expr.kind {
                ExprKind::Var(root) => {
                    steps.reverse();
                    indices.reverse();
                    return Some(Self { root, base: id, steps, indices });
                }
                ExprKind::Member(base, member) => (Step::Member(member), base),
                ExprKind::Swizzle(base, swizzle) => (Step::Swizzle(swizzle), base),
                ExprKind::Index(base, index) => match constant(index) {
                    Some(element) => (Step::Element(element), base),
                    None => {
                        indices.push(index);
                        let block = super::is_block_array(types, shader, base);
                        let chosen = block || types.contains_sampler(expr.ty);
                        (if chosen { Step::Chosen(len(types, shader.expr(base).ty)) } else { Step::Indexed }, base)
                    }
                },
                _ => return None,
            };
            steps.push((step, expr.ty));
            id = base;
        }
    }

    /// The numbers of elements of what is chosen.
    pub(super) fn lengths(&self) -> impl Iterator<Item = u32> {
        self.steps.iter().filter_map(|(step, _)| match step {
            Step::Chosen(len) => Some(*len),
            _ => None,
        })
    }

    /// Whether an index that is not constant chooses a sampler or a block.
    pub(super) fn is_chosen(&self) -> bool {
        self.lengths().next().is_some()
    }
}

fn len(types: &Types, ty: TypeId) -> u32 {
    match types.get(ty) {
        Type::Array(_, ArraySize::Sized(len)) => len.max(1),
        _ => 1,
    }
}
