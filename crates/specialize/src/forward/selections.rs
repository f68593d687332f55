//! `if` and `switch`: what is decided goes, what is open stays with each of its ways walked on its own.

use super::store::{Changes, Mark};
use super::{Forward, Jump, Reason, Target};
use crate::facts::at;
use glisten_front::hir::{Case, CaseLabel, ExprId, LocalId, LocalKind, ScalarValue, Stmt, StmtKind};
use glisten_front::source::Span;

impl Forward<'_> {
    pub(super) fn selection(
        &mut self,
        arms: &[(ExprId, Vec<Stmt>)],
        otherwise: &[Stmt],
        span: Span,
        out: &mut Vec<Stmt>,
    ) {
        let mut kept: Vec<(ExprId, Vec<Stmt>)> = Vec::new();
        let mut ways: Vec<(Mark, Changes)> = Vec::new();
        let mut last = otherwise;
        let mut decided = None;
        let forks = self.forks;
        for (condition, body) in arms {
            let c = self.eval(*condition);
            let truth = at(&c.facts, 0).truth();
            self.tell_truth(*condition, truth);
            if truth.is_some() && !self.is_pure(c.id) {
                // It is decided, and does something all the same.
                if kept.is_empty() {
                    out.push(Self::statement(StmtKind::Expr(c.id), span));
                } else if truth == Some(true) {
                    let body = self.statements(body);
                    kept.push((c.id, body));
                    self.close(kept, Vec::new(), ways, span, out, forks);
                    return;
                } else {
                    kept.push((c.id, Vec::new()));
                }
            }
            match truth {
                Some(false) => {}
                Some(true) => {
                    last = body;
                    decided = Some(self.shader.expr(*condition).span);
                    break;
                }
                None => {
                    let mark = self.store.mark();
                    self.forks = forks + 1;
                    self.refine(*condition, c.id, true);
                    let body = self.statements(body);
                    if self.store.live {
                        ways.push((mark, self.store.changes(mark)));
                    }
                    self.store.roll_back(mark);
                    if self.failed {
                        self.store.live = false;
                        self.forks = forks;
                        return;
                    }
                    self.refine(*condition, c.id, false);
                    kept.push((c.id, body));
                }
            }
        }
        let rest = self.statements(last);
        let is_sure = kept.is_empty();
        self.close(kept, rest, ways, span, out, forks);
        if is_sure && !self.store.live {
            self.left_by = decided;
        }
    }

    /// The ways meet.
    fn close(
        &mut self,
        arms: Vec<(ExprId, Vec<Stmt>)>,
        otherwise: Vec<Stmt>,
        ways: Vec<(Mark, Changes)>,
        span: Span,
        out: &mut Vec<Stmt>,
        forks: usize,
    ) {
        self.forks = forks;
        if arms.is_empty() {
            take_in(out, otherwise, span);
            return;
        }
        for (mark, changes) in ways.into_iter().rev() {
            self.store.meet(&changes, mark);
        }
        out.push(Self::statement(StmtKind::If { arms, otherwise }, span));
    }

    pub(super) fn switch(&mut self, selector: ExprId, cases: &[Case], span: Span, out: &mut Vec<Stmt>) {
        let value = self.eval(selector);
        let bits = match at(&value.facts, 0).value() {
            Some(ScalarValue::Int(value)) => Some(value as u32),
            Some(ScalarValue::Uint(value)) => Some(value),
            _ => None,
        };
        if let Some(bits) = bits {
            let place = self.shader.expr(selector).span;
            self.tell(place, Reason::Selector);
            if let Some(body) = self.flat_switch(bits, cases) {
                if !self.is_pure(value.id) {
                    out.push(Self::statement(StmtKind::Expr(value.id), span));
                }
                out.extend(body);
                return;
            }
        }
        self.kept_switch(value.id, cases, span, out);
    }

    /// The statements from the label that is hit to the `break`; `None` if a `break` depends on what is open.
    fn flat_switch(&mut self, bits: u32, cases: &[Case]) -> Option<Vec<Stmt>> {
        let labelled = |label: CaseLabel| cases.iter().position(|case| case.labels.contains(&label));
        let Some(start) = labelled(CaseLabel::Value(bits)).or_else(|| labelled(CaseLabel::Default)) else {
            return Some(Vec::new());
        };
        let mark = self.store.mark();
        let exits = self.frames.last().map_or(0, |frame| frame.exits.len());
        self.targets.push(Target::Flat { is_loop: false, forks: self.forks, open: None });
        let mut body = Vec::new();
        // The scope of what a case declares is the whole switch (§6.2): a case that is jumped to knows it, without its value.
        for stmt in cases.iter().take(start).flat_map(|case| &case.body) {
            if let StmtKind::Local(local, initializer) = stmt.kind {
                let initializer = initializer.filter(|_| self.is_constant(local));
                body.extend(self.statements(&[Self::statement(StmtKind::Local(local, initializer), stmt.span)]));
            }
        }
        for case in cases.iter().skip(start) {
            body.extend(self.statements(&case.body));
            if !self.store.live {
                break;
            }
        }
        self.targets.pop();
        if self.failed {
            self.forget_attempt(mark, exits);
            return None;
        }
        if self.jump == Some(Jump::Break) {
            self.jump = None;
            self.store.live = true;
        }
        Some(body)
    }

    fn is_constant(&self, local: LocalId) -> bool {
        let function = self.frames.last().map(|frame| self.shader.function(frame.function));
        function.is_some_and(|function| function.local(local).kind == LocalKind::Const)
    }

    /// Back to before something was written out that could not be.
    pub(super) fn forget_attempt(&mut self, mark: Mark, exits: usize) {
        self.failed = false;
        self.blocked = None;
        self.jump = None;
        self.store.roll_back(mark);
        if let Some(frame) = self.frames.last_mut() {
            frame.exits.truncate(exits);
        }
    }

    fn kept_switch(&mut self, selector: ExprId, cases: &[Case], span: Span, out: &mut Vec<Stmt>) {
        for case in cases {
            let assigned = self.effects.assigned(self.shader, &case.body, &[]);
            self.forget_assigned(&assigned);
        }
        self.targets.push(Target::Kept { is_loop: false });
        self.forks += 1;
        let mut walked = Vec::with_capacity(cases.len());
        for case in cases {
            let mark = self.store.mark();
            let body = self.statements(&case.body);
            // What locals of one case hold is nothing that the next may count on.
            self.store.roll_back(mark);
            walked.push(Case { labels: case.labels.clone(), body });
            if self.failed {
                break;
            }
        }
        self.forks -= 1;
        self.targets.pop();
        self.store.live = !self.failed;
        out.push(Self::statement(StmtKind::Switch { selector, cases: walked }, span));
    }
}

/// Appends the body of a branch that is taken. Iterations declare the same locals: one that is declared already gets a scope of its own.
fn take_in(out: &mut Vec<Stmt>, body: Vec<Stmt>, span: Span) {
    let local = |stmt: &Stmt| if let StmtKind::Local(local, _) = stmt.kind { Some(local) } else { None };
    let is_again = body.iter().filter_map(local).any(|own| out.iter().filter_map(local).any(|other| other == own));
    if is_again {
        out.push(Stmt { kind: StmtKind::Block(body), span });
    } else {
        out.extend(body);
    }
}
