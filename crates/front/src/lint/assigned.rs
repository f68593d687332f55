//! Definite assignment: which components of a global every way through `main` assigns.
//!
//! *In:* a shader and a global. *Out:* sets of components in the global's flat layout. *Holds:* what cannot be decided
//! counts as assigned: an element with an index that is not a literal, the body of a loop. A way that returns after it has
//! put `gl_Position` at a constant place does not count, because nothing of such a vertex is seen.

use crate::builtin::BuiltinVariable;
use crate::hir::written_by;
use crate::hir::{
    ArraySize, ExprId, ExprKind, FunctionId, GlobalId, ScalarValue, Shader, Stmt, StmtKind, Type, TypeId, Types, VarRef,
};
use std::collections::BTreeSet;
use std::ops::Range;

/// Components by their index in the flat layout.
pub(super) type Components = BTreeSet<u32>;

/// The components of a variable that an expression stands for, if it is an l-value or a part of a variable.
pub(super) fn components_of(types: &Types, shader: &Shader, expr: ExprId) -> Option<(VarRef, Components)> {
    let mut swizzle = None;
    let mut at = expr;
    if let ExprKind::Swizzle(inner, picked) = &shader.expr(at).kind {
        (swizzle, at) = (Some(*picked), *inner);
    }
    let (root, range) = range_of(types, shader, at)?;
    let all: Components = match swizzle {
        Some(picked) => picked.as_slice().iter().map(|component| range.start + u32::from(*component)).collect(),
        None => range.collect(),
    };
    Some((root, all))
}

/// The range of a path of members and indices. An index that is not a literal selects all elements.
fn range_of(types: &Types, shader: &Shader, expr: ExprId) -> Option<(VarRef, Range<u32>)> {
    let ty = shader.expr(expr).ty;
    match &shader.expr(expr).kind {
        ExprKind::Var(root) => Some((*root, 0..types.flat_len(ty))),
        ExprKind::Member(inner, member) => {
            let (root, range) = range_of(types, shader, *inner)?;
            let Type::Struct(id) = types.get(shader.expr(*inner).ty) else { return Some((root, range)) };
            let before = types.structure(id).members.iter().take(*member as usize);
            let start = range.start + before.map(|member| types.flat_len(member.ty)).sum::<u32>();
            // Elements of an array with an unknown index lie apart.
            let whole = range.end - range.start > types.flat_len(shader.expr(*inner).ty);
            Some((root, if whole { range } else { start..start + types.flat_len(ty) }))
        }
        ExprKind::Index(inner, index) => {
            let (root, range) = range_of(types, shader, *inner)?;
            let whole = range.end - range.start > types.flat_len(shader.expr(*inner).ty);
            let ExprKind::Literal(ScalarValue::Int(_) | ScalarValue::Uint(_)) = shader.expr(*index).kind else {
                return Some((root, range));
            };
            let start = range.start + literal(shader, *index) * types.flat_len(ty);
            let inside = start + types.flat_len(ty) <= range.end;
            Some((root, if whole || !inside { range } else { start..start + types.flat_len(ty) }))
        }
        _ => None,
    }
}

fn literal(shader: &Shader, index: ExprId) -> u32 {
    match shader.expr(index).kind {
        ExprKind::Literal(ScalarValue::Int(value)) => {
            u32::try_from(value).unwrap_or(u32::MAX / 4096).min(u32::MAX / 4096)
        }
        ExprKind::Literal(ScalarValue::Uint(value)) => value.min(u32::MAX / 4096),
        _ => 0,
    }
}

/// The name of components within a vector, or nothing for all of it: `.zw`.
pub(super) fn suffix(types: &Types, ty: TypeId, components: &Components) -> Option<String> {
    let size = match types.get(ty) {
        Type::Vector(_, size) => u32::from(size),
        _ => return None,
    };
    let letters: String = ["x", "y", "z", "w"]
        .iter()
        .zip(0..size)
        .filter(|(_, at)| components.contains(at))
        .map(|(letter, _)| *letter)
        .collect();
    (components.len() < size as usize).then(|| format!(".{letters}"))
}

/// The number of components of a type, if that is moderate.
pub(super) fn moderate_len(types: &Types, ty: TypeId) -> Option<u32> {
    let sized = !matches!(types.get(ty), Type::Array(_, size) if !matches!(size, ArraySize::Sized(_)));
    Some(types.flat_len(ty)).filter(|len| sized && *len <= 1024)
}

/// The components of a global that are assigned on every way through `main`, and on any.
pub(super) struct Assigned {
    pub(super) always: Components,
    pub(super) ever: Components,
}

/// Follows all ways through a shader.
pub(super) fn assigned(types: &Types, shader: &Shader, global: GlobalId) -> Assigned {
    let mut walk = Walk {
        types,
        shader,
        global,
        summaries: vec![Components::new(); shader.functions.len()],
        ever: Components::new(),
    };
    let order = shader.main.map(|main| shader.callees_first(main)).unwrap_or_default();
    for id in order {
        let summary = walk.function(id);
        if let Some(known) = walk.summaries.get_mut(id.index()) {
            *known = summary;
        }
    }
    let always = shader.main.and_then(|main| walk.summaries.get(main.index())).cloned().unwrap_or_default();
    Assigned { always, ever: walk.ever }
}

/// The components that every way to a place assigns; `None` if no way leads there.
type State = Option<Components>;

/// The ways that leave a statement other than at its end.
#[derive(Default)]
struct Exits {
    returns: Vec<Components>,
    breaks: Vec<Components>,
    continues: Vec<Components>,
}

struct Walk<'a> {
    types: &'a Types,
    shader: &'a Shader,
    global: GlobalId,
    /// For each function, the components that it has assigned when it returns.
    summaries: Vec<Components>,
    ever: Components,
}

/// The components that both of two ways assign.
fn join(a: State, b: State) -> State {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.intersection(&b).copied().collect()),
        (a, b) => a.or(b),
    }
}

impl Walk<'_> {
    fn function(&mut self, id: FunctionId) -> Components {
        let shader = self.shader;
        let body = shader.function(id).body.as_deref().unwrap_or(&[]);
        let mut exits = Exits::default();
        let end = self.body(body, Some(Components::new()), &mut exits);
        let all = exits.returns.into_iter().fold(end, |state, way| join(state, Some(way)));
        // A function that never returns leaves nothing undone.
        all.unwrap_or_else(|| self.everything())
    }

    fn everything(&self) -> Components {
        (0..self.types.flat_len(self.shader.global(self.global).ty)).collect()
    }

    fn body(&mut self, body: &[Stmt], mut state: State, exits: &mut Exits) -> State {
        for (index, statement) in body.iter().enumerate() {
            state.as_ref()?;
            let hidden = matches!(statement.kind, StmtKind::Return(_)) && self.hides(body.get(..index).unwrap_or(&[]));
            state = self.statement(statement, state, exits);
            if hidden {
                exits.returns.pop();
            }
        }
        state
    }

    /// Whether one of these statements puts `gl_Position` at a constant place.
    fn hides(&self, before: &[Stmt]) -> bool {
        let position = |target: ExprId| match self.shader.root_variable(target) {
            Some(VarRef::Global(id)) => self.shader.global(id).builtin == Some(BuiltinVariable::Position),
            _ => false,
        };
        before.iter().any(|statement| match statement.kind {
            StmtKind::Expr(expr) => match self.shader.expr(expr).kind {
                ExprKind::Assign(None, target, value) => position(target) && self.is_constant(value),
                _ => false,
            },
            _ => false,
        })
    }

    fn is_constant(&self, root: ExprId) -> bool {
        let mut constant = true;
        self.shader.visit_expr(root, &mut |expr| {
            constant &= !matches!(self.shader.expr(expr).kind, ExprKind::Var(_) | ExprKind::Call(..));
        });
        constant
    }

    fn statement(&mut self, statement: &Stmt, state: State, exits: &mut Exits) -> State {
        let mut state = state;
        match &statement.kind {
            StmtKind::If { arms, otherwise } => {
                let mut after = None;
                for (condition, body) in arms {
                    self.expr(*condition, &mut state);
                    let end = self.body(body, state.clone(), exits);
                    after = join(after, end);
                }
                let end = self.body(otherwise, state, exits);
                join(after, end)
            }
            StmtKind::Switch { selector, cases } => {
                self.expr(*selector, &mut state);
                self.switch(cases, state, exits)
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let mut inner = Exits::default();
                condition.iter().for_each(|condition| self.expr(condition.expr, &mut state));
                let end = self.body(body, state, &mut inner);
                let mut end = inner.continues.into_iter().fold(end, |state, way| join(state, Some(way)));
                step.iter().for_each(|step| self.expr(*step, &mut end));
                exits.returns.extend(inner.returns);
                inner.breaks.into_iter().fold(end, |state, way| join(state, Some(way)))
            }
            StmtKind::Block(body) => self.body(body, state, exits),
            StmtKind::Break => {
                exits.breaks.extend(state);
                None
            }
            StmtKind::Continue => {
                exits.continues.extend(state);
                None
            }
            StmtKind::Return(value) => {
                value.iter().for_each(|value| self.expr(*value, &mut state));
                exits.returns.extend(state);
                None
            }
            StmtKind::Discard => None,
            StmtKind::Expr(expr) | StmtKind::Local(_, Some(expr)) => {
                self.expr(*expr, &mut state);
                state
            }
            StmtKind::Local(_, None) => state,
        }
    }

    fn switch(&mut self, cases: &[crate::hir::Case], state: State, exits: &mut Exits) -> State {
        let mut inner = Exits::default();
        let mut falls = None;
        let mut has_default = false;
        for case in cases {
            has_default |= case.labels.contains(&crate::hir::CaseLabel::Default);
            falls = self.body(&case.body, join(state.clone(), falls), &mut inner);
        }
        exits.returns.extend(inner.returns);
        exits.continues.extend(inner.continues);
        let end = if has_default { falls } else { join(falls, state) };
        inner.breaks.into_iter().fold(end, |state, way| join(state, Some(way)))
    }

    /// Evaluates an expression: what it assigns on every way.
    fn expr(&mut self, id: ExprId, state: &mut State) {
        let shader = self.shader;
        match &shader.expr(id).kind {
            ExprKind::Logical(_, left, right) => {
                self.expr(*left, state);
                self.expr(*right, &mut state.clone());
            }
            ExprKind::Ternary(condition, yes, no) => {
                self.expr(*condition, state);
                let (mut one, mut other) = (state.clone(), state.clone());
                self.expr(*yes, &mut one);
                self.expr(*no, &mut other);
                *state = join(one, other);
            }
            kind => {
                kind.children().into_iter().for_each(|child| self.expr(child, state));
                if let ExprKind::Call(callee, _) = kind {
                    let summary = self.summaries.get(callee.index()).cloned().unwrap_or_default();
                    state.iter_mut().for_each(|state| state.extend(&summary));
                }
                let (types, global) = (self.types, self.global);
                let mut written = Components::new();
                written_by(shader, id, &mut |target| {
                    if let Some((VarRef::Global(named), components)) = components_of(types, shader, target)
                        && named == global
                    {
                        written.extend(components);
                    }
                });
                self.ever.extend(&written);
                state.iter_mut().for_each(|state| state.extend(&written));
            }
        }
    }
}
