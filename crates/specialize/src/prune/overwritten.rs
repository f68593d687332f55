//! Stores that are overwritten before anybody reads them.
//!
//! *In:* a body. *Out:* the body without them. *Holds:* locals are followed, vectors component by component and all others as a whole, and in
//! `main` globals that no other function names; what a loop reads anywhere is taken to be read at its end and wherever it is left.

use crate::forward::Effects;
use glisten_front::hir::{
    ExprId, ExprKind, FunctionId, ParamMode, ScalarValue, Shader, Stage, Stmt, StmtKind, Storage, Type, TypeId, Types,
    VarRef, may_act,
};
use smallvec::SmallVec;

/// Parts of variables that are read later, a bit each: a set is copied for each branch. The locals come first, then the globals.
#[derive(Clone, Debug, Default)]
struct Live(Vec<u64>);

/// The bits of the parts of a variable.
type Slots = SmallVec<[usize; 4]>;

impl Live {
    fn contains(&self, slot: usize) -> bool {
        self.0.get(slot / 64).is_some_and(|word| word >> (slot % 64) & 1 == 1)
    }

    fn insert(&mut self, slot: usize) {
        let word = slot / 64;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        if let Some(word) = self.0.get_mut(word) {
            *word |= 1 << (slot % 64);
        }
    }

    fn remove(&mut self, slot: usize) {
        if let Some(word) = self.0.get_mut(slot / 64) {
            *word &= !(1 << (slot % 64));
        }
    }

    fn contains_any(&self, slots: &[usize]) -> bool {
        slots.iter().any(|slot| self.contains(*slot))
    }

    fn extend(&mut self, other: &Self) {
        if self.0.len() < other.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        self.0.iter_mut().zip(&other.0).for_each(|(word, other)| *word |= other);
    }
}

struct Walk<'a> {
    shader: &'a Shader,
    effects: &'a Effects,
    /// The first bit of each local, and how many there are.
    locals: Vec<(usize, usize)>,
    /// The same of each global; none where it is not followed.
    globals: Vec<(usize, usize)>,
    /// The live variables where a `break` or `continue` leads, innermost last.
    jumps: Vec<Live>,
    /// The live variables where the function is left.
    end: Live,
    changed: bool,
}

/// The globals that may be followed in `main`: those that it alone names. What a geometry stage emits it reads.
pub(super) fn globals_of_main(shader: &Shader) -> Vec<bool> {
    let own = |global: &glisten_front::hir::Global| {
        matches!(global.storage, Storage::Out | Storage::Private) && global.block.is_none()
    };
    let mut followed: Vec<bool> = shader.globals.iter().map(own).collect();
    if shader.stage == Stage::Geometry {
        followed.fill(false);
    }
    let mut see = |expr: ExprId| {
        if let ExprKind::Var(VarRef::Global(global)) = shader.expr(expr).kind
            && let Some(followed) = followed.get_mut(global.index())
        {
            *followed = false;
        }
    };
    for (id, function) in shader.functions() {
        if Some(id) != shader.main {
            shader.visit_body(function.body.as_deref().unwrap_or(&[]), &mut see);
        }
    }
    for initializer in shader.globals.iter().filter_map(|global| global.initializer) {
        shader.visit_expr(initializer, &mut see);
    }
    followed
}

/// How many parts of a variable are followed.
fn parts(types: &Types, ty: TypeId) -> usize {
    if let Type::Vector(_, size) = types.get(ty) { usize::from(size) } else { 1 }
}

/// Removes such stores from a function's body; whether there were any. `globals` says which globals are followed.
pub(super) fn remove(
    types: &Types,
    (shader, effects): (&Shader, &Effects),
    function: FunctionId,
    globals: &[bool],
    body: Vec<Stmt>,
) -> (Vec<Stmt>, bool) {
    let function = shader.function(function);
    let mut next = 0;
    let mut place = |count: usize| {
        next += count;
        (next - count, count)
    };
    let locals = function.locals.iter().map(|local| place(parts(types, local.ty))).collect();
    let followed = shader.globals.iter().zip(globals.iter().chain(std::iter::repeat(&false)));
    let globals =
        followed.map(|(global, followed)| place(if *followed { parts(types, global.ty) } else { 0 })).collect();
    let mut walk = Walk { shader, effects, locals, globals, jumps: Vec::new(), end: Live::default(), changed: false };
    for (index, param) in function.params().iter().enumerate() {
        if matches!(param.kind, glisten_front::hir::LocalKind::Param(ParamMode::Out | ParamMode::Inout)) {
            let slots = walk.whole(VarRef::Local(glisten_front::hir::LocalId::new(index)));
            slots.into_iter().for_each(|slot| walk.end.insert(slot));
        }
    }
    for (id, _) in shader.globals().filter(|(_, global)| global.storage == Storage::Out) {
        let slots = walk.whole(VarRef::Global(id));
        slots.into_iter().for_each(|slot| walk.end.insert(slot));
    }
    let mut live = walk.end.clone();
    let body = walk.body(body, &mut live);
    (body, walk.changed)
}

impl Walk<'_> {
    /// The bits of a variable; none if it is not followed.
    fn whole(&self, variable: VarRef) -> Slots {
        let place = match variable {
            VarRef::Local(local) => self.locals.get(local.index()),
            VarRef::Global(global) => self.globals.get(global.index()),
        };
        let (first, count) = place.copied().unwrap_or_default();
        (first..first + count).collect()
    }

    /// The bits of a variable or of some components of one, if an expression names these and nothing else.
    fn named_by(&self, expr: ExprId) -> Option<Slots> {
        match self.shader.expr(expr).kind {
            ExprKind::Var(variable) => Some(self.whole(variable)),
            ExprKind::Swizzle(base, swizzle) => {
                let slots = self.vector(base)?;
                swizzle.as_slice().iter().map(|component| slots.get(usize::from(*component)).copied()).collect()
            }
            ExprKind::Index(base, index) => {
                let slots = self.vector(base)?;
                let index = match self.shader.expr(index).kind {
                    ExprKind::Literal(ScalarValue::Int(index)) => usize::try_from(index).ok()?,
                    ExprKind::Literal(ScalarValue::Uint(index)) => usize::try_from(index).ok()?,
                    _ => return None,
                };
                slots.get(index).map(|slot| SmallVec::from_slice(&[*slot]))
            }
            _ => None,
        }
    }

    /// The bits of a vector that is a variable.
    fn vector(&self, base: ExprId) -> Option<Slots> {
        match self.shader.expr(base).kind {
            ExprKind::Var(variable) => Some(self.whole(variable)).filter(|slots| slots.len() > 1),
            _ => None,
        }
    }

    /// Whether evaluating it does nothing.
    fn is_idle(&self, root: ExprId) -> bool {
        let mut idle = true;
        self.shader.visit_expr(root, &mut |expr| {
            idle &= match &self.shader.expr(expr).kind {
                ExprKind::Call(callee, arguments) => {
                    let (effect, function) = (self.effects.function(*callee), self.shader.function(*callee));
                    let gives = (0..arguments.len()).any(|index| !crate::forward::is_in(function.param_mode(index)));
                    !effect.ends && effect.writes.is_empty() && !gives
                }
                kind => !may_act(kind),
            };
        });
        idle
    }

    /// What a statement stores to, and the value, if that is all that it does. A compound one reads what it stores to.
    fn store(&self, expr: ExprId) -> Option<(Slots, Option<ExprId>, bool)> {
        let (target, value, reads) = match self.shader.expr(expr).kind {
            ExprKind::Assign(op, target, value) => (target, Some(value), op.is_some()),
            ExprKind::IncDec(_, target) => (target, None, true),
            _ => return None,
        };
        self.named_by(target).filter(|slots| !slots.is_empty()).map(|slots| (slots, value, reads))
    }

    fn body(&mut self, body: Vec<Stmt>, live: &mut Live) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(body.len());
        for stmt in body.into_iter().rev() {
            if let Some(stmt) = self.statement(stmt, live) {
                out.push(stmt);
            }
        }
        out.reverse();
        out
    }

    fn statement(&mut self, stmt: Stmt, live: &mut Live) -> Option<Stmt> {
        let Stmt { kind, span } = stmt;
        let kind = match kind {
            StmtKind::Expr(expr) => {
                if let Some((slots, value, reads)) = self.store(expr) {
                    if !live.contains_any(&slots) && value.is_none_or(|value| self.is_idle(value)) {
                        self.changed = true;
                        return None;
                    }
                    if !reads {
                        slots.iter().for_each(|slot| live.remove(*slot));
                    }
                    value.into_iter().for_each(|value| self.read(value, live));
                } else {
                    self.read(expr, live);
                }
                StmtKind::Expr(expr)
            }
            StmtKind::Local(local, initializer) => {
                let slots = self.whole(VarRef::Local(local));
                let dead = !live.contains_any(&slots);
                slots.iter().for_each(|slot| live.remove(*slot));
                let initializer = match initializer {
                    Some(expr) if dead && self.is_idle(expr) => {
                        self.changed = true;
                        None
                    }
                    initializer => initializer,
                };
                if let Some(expr) = initializer {
                    self.read(expr, live);
                }
                StmtKind::Local(local, initializer)
            }
            StmtKind::Block(body) => StmtKind::Block(self.body(body, live)),
            StmtKind::If { arms, otherwise } => {
                let after = live.clone();
                let otherwise = self.body(otherwise, live);
                let mut walked = Vec::with_capacity(arms.len());
                for (condition, body) in arms.into_iter().rev() {
                    let mut way = after.clone();
                    let body = self.body(body, &mut way);
                    live.extend(&way);
                    self.read(condition, live);
                    walked.push((condition, body));
                }
                walked.reverse();
                StmtKind::If { arms: walked, otherwise }
            }
            StmtKind::Switch { selector, cases } => {
                let whole = StmtKind::Switch { selector, cases };
                self.read_all(&whole, live);
                let StmtKind::Switch { selector, cases } = whole else { return None };
                self.jumps.push(live.clone());
                let cases = cases.into_iter().map(|case| {
                    let mut way = live.clone();
                    let body = self.body(case.body, &mut way);
                    glisten_front::hir::Case { labels: case.labels, body }
                });
                let cases = cases.collect();
                self.jumps.pop();
                StmtKind::Switch { selector, cases }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let whole = StmtKind::Loop { kind, condition, step, body };
                self.read_all(&whole, live);
                let StmtKind::Loop { kind, condition, step, body } = whole else { return None };
                self.jumps.push(live.clone());
                let mut way = live.clone();
                let body = self.body(body, &mut way);
                self.jumps.pop();
                StmtKind::Loop { kind, condition, step, body }
            }
            StmtKind::Return(value) => {
                *live = self.end.clone();
                if let Some(value) = value {
                    self.read(value, live);
                }
                StmtKind::Return(value)
            }
            StmtKind::Break | StmtKind::Continue => {
                if let Some(target) = self.jumps.last() {
                    // A `continue` in a switch leads further than its end: what either wants is live.
                    *live = self.jumps.iter().fold(target.clone(), |mut all, one| {
                        all.extend(one);
                        all
                    });
                }
                kind
            }
            StmtKind::Discard => {
                *live = Live::default();
                kind
            }
        };
        Some(Stmt { kind, span })
    }

    /// All that an expression names is taken to be read.
    fn read(&self, root: ExprId, live: &mut Live) {
        let mut pending = vec![root];
        while let Some(expr) = pending.pop() {
            match self.named_by(expr) {
                Some(slots) => slots.into_iter().for_each(|slot| live.insert(slot)),
                None => pending.extend(self.shader.expr(expr).kind.children()),
            }
        }
    }

    fn read_all(&self, kind: &StmtKind, live: &mut Live) {
        for expr in kind.exprs() {
            self.read(expr, live);
        }
        for body in kind.bodies() {
            self.shader.visit_statements(body, &mut |stmt| {
                stmt.kind.exprs().into_iter().for_each(|expr| self.read(expr, live));
            });
        }
        if let StmtKind::Loop { condition: Some(condition), .. } = kind {
            let slots = condition.local.map(|local| self.whole(VarRef::Local(local))).unwrap_or_default();
            slots.into_iter().for_each(|slot| live.insert(slot));
        }
        // Any round, or any case, may leave the function.
        if returns(kind) {
            live.extend(&self.end);
        }
    }
}

/// Whether a statement may leave the function.
fn returns(kind: &StmtKind) -> bool {
    let mut pending = vec![kind];
    while let Some(kind) = pending.pop() {
        if matches!(kind, StmtKind::Return(_)) {
            return true;
        }
        pending.extend(kind.bodies().into_iter().flatten().map(|stmt| &stmt.kind));
    }
    false
}
