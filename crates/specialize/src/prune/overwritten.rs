//! Stores that are overwritten before anybody reads them.
//!
//! *In:* a body. *Out:* the body without them. *Holds:* only whole locals that nothing else can name are followed; what a
//! loop reads anywhere is taken to be read at its end and wherever it is left.

use glisten_front::hir::{ExprId, ExprKind, Function, LocalId, ParamMode, Shader, Stmt, StmtKind, VarRef, may_act};

/// Locals that are read later, a bit each: a set is copied for each branch.
#[derive(Clone, Debug, Default)]
struct Live(Vec<u64>);

impl Live {
    fn contains(&self, local: LocalId) -> bool {
        self.0.get(local.index() / 64).is_some_and(|word| word >> (local.index() % 64) & 1 == 1)
    }

    fn insert(&mut self, local: LocalId) {
        let word = local.index() / 64;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        if let Some(word) = self.0.get_mut(word) {
            *word |= 1 << (local.index() % 64);
        }
    }

    /// Whether it was there.
    fn remove(&mut self, local: LocalId) -> bool {
        let was = self.contains(local);
        if let Some(word) = self.0.get_mut(local.index() / 64) {
            *word &= !(1 << (local.index() % 64));
        }
        was
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
    /// The live locals where a `break` or `continue` leads, innermost last.
    jumps: Vec<Live>,
    /// The live locals where the function is left.
    end: Live,
    changed: bool,
}

/// Removes such stores from a function's body; whether there were any.
pub(super) fn remove(shader: &Shader, function: &Function, body: Vec<Stmt>) -> (Vec<Stmt>, bool) {
    let params = function.params().iter().enumerate();
    let given_back = params.filter(|(_, param)| {
        matches!(param.kind, glisten_front::hir::LocalKind::Param(ParamMode::Out | ParamMode::Inout))
    });
    let mut end = Live::default();
    given_back.for_each(|(index, _)| end.insert(LocalId::new(index)));
    let mut walk = Walk { shader, jumps: Vec::new(), end: end.clone(), changed: false };
    let mut live = end;
    let body = walk.body(body, &mut live);
    (body, walk.changed)
}

impl Walk<'_> {
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
                if let ExprKind::Assign(None, target, value) = self.shader.expr(expr).kind
                    && let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(target).kind
                {
                    if !live.contains(local) && self.is_plain(value) {
                        self.changed = true;
                        return None;
                    }
                    live.remove(local);
                    self.read(value, live);
                } else {
                    self.read(expr, live);
                }
                StmtKind::Expr(expr)
            }
            StmtKind::Local(local, initializer) => {
                let dead = !live.remove(local);
                let initializer = match initializer {
                    Some(expr) if dead && self.is_plain(expr) => {
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

    /// All locals that an expression names are taken to be read.
    fn read(&self, root: ExprId, live: &mut Live) {
        self.shader.visit_expr(root, &mut |expr| {
            if let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(expr).kind {
                live.insert(local);
            }
        });
    }

    fn read_all(&self, kind: &StmtKind, live: &mut Live) {
        for expr in kind.exprs() {
            self.read(expr, live);
        }
        for body in kind.bodies() {
            self.shader.visit_body(body, &mut |expr| {
                if let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(expr).kind {
                    live.insert(local);
                }
            });
        }
        if let StmtKind::Loop { condition: Some(condition), .. } = kind {
            condition.local.into_iter().for_each(|local| live.insert(local));
        }
    }

    /// Whether evaluating it does nothing else.
    fn is_plain(&self, root: ExprId) -> bool {
        let mut plain = true;
        self.shader.visit_expr(root, &mut |expr| {
            plain &= !may_act(&self.shader.expr(expr).kind);
        });
        plain
    }
}
