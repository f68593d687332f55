//! Statements that are no branches and no loops.

use super::{Forward, Jump, Target};
use crate::facts::{self, Fact, Facts};
use glisten_front::hir::{ExprId, LocalId, Stmt, StmtKind};
use glisten_front::source::Span;
use std::rc::Rc;

impl Forward<'_> {
    /// Walks statements until nothing gets past one.
    pub(super) fn statements(&mut self, body: &[Stmt]) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(body.len());
        for (index, stmt) in body.iter().enumerate() {
            // Once something cannot be written out, whoever tried goes back to before: nothing on the way may try again.
            if self.failed {
                break;
            }
            if !self.store.live {
                let rest = body.get(index..).unwrap_or_default();
                rest.iter().for_each(|stmt| self.reasons.pass_over(stmt.span, self.left_by));
                break;
            }
            self.left_by = None;
            self.reasons.reach(stmt.span);
            self.one(stmt, &mut out);
        }
        out
    }

    fn one(&mut self, stmt: &Stmt, out: &mut Vec<Stmt>) {
        let span = stmt.span;
        match &stmt.kind {
            StmtKind::Expr(expr) => {
                let value = self.eval(*expr);
                out.push(Self::statement(StmtKind::Expr(value.id), span));
            }
            StmtKind::Local(local, initializer) => self.local(*local, *initializer, span, out),
            StmtKind::Block(body) => {
                let body = self.statements(body);
                out.push(Self::statement(StmtKind::Block(body), span));
            }
            StmtKind::If { arms, otherwise } => self.selection(arms, otherwise, span, out),
            StmtKind::Switch { selector, cases } => self.switch(*selector, cases, span, out),
            StmtKind::Loop { kind, condition, step, body } => {
                let step = *step;
                let parts = super::loops::Parts { kind: *kind, condition: condition.as_ref(), step, body, span };
                self.iteration(&parts, out);
            }
            StmtKind::Break => self.leave(Jump::Break, span, out),
            StmtKind::Continue => self.leave(Jump::Continue, span, out),
            StmtKind::Return(value) => self.give_back(*value, span, out),
            StmtKind::Discard => {
                out.push(Self::statement(StmtKind::Discard, span));
                self.store.live = false;
            }
        }
    }

    fn local(&mut self, local: LocalId, initializer: Option<ExprId>, span: Span, out: &mut Vec<Stmt>) {
        let Some(frame) = self.frames.last() else { return };
        let declared = self.shader.function(frame.function).local(local);
        let len = self.types.flat_len(declared.ty);
        let constant: Option<Facts> =
            declared.value.as_ref().map(|value| value.scalars.iter().map(|scalar| Fact::literal(*scalar)).collect());
        let value = initializer.map(|initializer| self.eval(initializer));
        let facts = match (constant, &value) {
            (Some(facts), _) => facts,
            (None, Some(value)) => value.facts.clone(),
            (None, None) => Facts::new(),
        };
        let key = self.local_key(local);
        let cell = if len > super::FOLLOWED {
            Vec::new()
        } else {
            (0..len as usize).map(|index| facts::at(&facts, index)).collect()
        };
        self.store.set(key, Rc::new(cell));
        out.push(Self::statement(StmtKind::Local(local, value.map(|value| value.id)), span));
    }

    fn give_back(&mut self, value: Option<ExprId>, span: Span, out: &mut Vec<Stmt>) {
        let value = value.map(|value| self.eval(value));
        let id = value.as_ref().map(|value| value.id);
        if let Some(frame) = self.frames.last() {
            let changes = self.store.changes(frame.mark);
            let facts = value.map_or_else(Facts::new, |value| value.facts);
            if let Some(frame) = self.frames.last_mut() {
                frame.exits.push(changes);
                frame.result = Some(match frame.result.take() {
                    Some(known) => facts::join(&known, &facts),
                    None => facts,
                });
            }
        }
        out.push(Self::statement(StmtKind::Return(id), span));
        self.store.live = false;
    }

    /// `break` and `continue`.
    fn leave(&mut self, jump: Jump, span: Span, out: &mut Vec<Stmt>) {
        let led_out_of = |target: &&Target| {
            let (Target::Kept { is_loop } | Target::Flat { is_loop, .. }) = target;
            jump == Jump::Break || *is_loop
        };
        let kind = if jump == Jump::Break { StmtKind::Break } else { StmtKind::Continue };
        match self.targets.iter().rev().find(led_out_of).copied() {
            Some(Target::Flat { forks, .. }) if forks == self.forks => self.jump = Some(jump),
            Some(Target::Flat { open: Some(open), .. }) if open == jump => {
                self.leaving.push(self.store.changes(self.leaving_since));
                out.push(Self::statement(kind, span));
            }
            Some(Target::Flat { .. }) => {
                self.failed = true;
                self.blocked = Some(jump);
            }
            Some(Target::Kept { .. }) | None => out.push(Self::statement(kind, span)),
        }
        self.store.live = false;
    }
}
