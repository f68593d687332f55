//! Loops: written out where that pays, else kept.
//!
//! A loop with a `break` under an open condition becomes one run of a loop, which the `break` leaves:
//! `do { first; second; } while (false);`. With such a `continue` each iteration becomes one. A loop with both is kept.

use super::effects::Assigned;
use super::{Extent, Forward, Jump, Reason, Target};
use crate::facts::{Fact, What, at};
use glisten_front::hir::{
    BinaryOp, Condition, ExprId, ExprKind, IncDec, LoopKind, ScalarValue, Stmt, StmtKind, TypeId, VarRef,
};
use glisten_front::source::Span;

/// A loop.
pub(super) struct Parts<'s> {
    pub(super) kind: LoopKind,
    pub(super) condition: Option<&'s Condition>,
    pub(super) step: Option<ExprId>,
    pub(super) body: &'s [Stmt],
    pub(super) span: Span,
}

/// A loop is written out at most so often.
const MOST_ROUNDS: u32 = 64;
/// Expressions of which something is open that a loop may always be written out to.
const ALWAYS: u64 = 160;

impl Forward<'_> {
    pub(super) fn iteration(&mut self, parts: &Parts<'_>, out: &mut Vec<Stmt>) {
        let mut blocked = None;
        let (weight, outside) = (self.weight, std::mem::take(&mut self.inner));
        let written = self.unroll(parts, None, &mut blocked);
        let open = blocked.filter(|_| written.is_none());
        let written = written.or_else(|| self.unroll(parts, Some(open?), &mut blocked));
        let grown = self.weight - weight;
        let own = grown.saturating_sub(std::mem::replace(&mut self.inner, outside.saturating_add(grown)));
        if let Some((body, rounds)) = written {
            if rounds > 1 {
                *self.written_out.entry(parts.span).or_default() += own - own / u64::from(rounds);
            }
            let reason = if open.is_some() { Reason::UnrolledUpTo(rounds) } else { Reason::Unrolled(rounds) };
            self.tell(parts.span, reason);
            out.extend(body);
            return;
        }
        self.keep(parts, out);
    }

    /// The iterations one after the other; `None` where their number depends on what is open, or they would be too many.
    /// `open` is the jump that may stay where its condition is open; `blocked` tells which jump was in the way.
    fn unroll(
        &mut self,
        parts: &Parts<'_>,
        open: Option<Jump>,
        blocked: &mut Option<Jump>,
    ) -> Option<(Vec<Stmt>, u32)> {
        if !self.may_grow() || parts.condition.is_some_and(|condition| condition.local.is_some()) {
            return None;
        }
        let mark = self.store.mark();
        let exits = self.frames.last().map_or(0, |frame| frame.exits.len());
        let weight = self.weight;
        let outside = (std::mem::take(&mut self.leaving), std::mem::replace(&mut self.leaving_since, mark));
        self.targets.push(Target::Flat { is_loop: true, forks: self.forks, open });
        let result = self.rounds(parts, open, weight);
        self.targets.pop();
        let leaving = std::mem::replace(&mut self.leaving, outside.0);
        self.leaving_since = outside.1;
        if result.is_none() || self.failed {
            *blocked = self.blocked;
            self.forget_attempt(mark, exits);
            return None;
        }
        let (body, rounds) = result?;
        if leaving.is_empty() {
            return Some((body, rounds));
        }
        for changes in &leaving {
            self.store.meet(changes, mark);
        }
        Some((vec![self.once(body, parts.span)], rounds))
    }

    /// A loop that runs once, for jumps to leave.
    fn once(&mut self, body: Vec<Stmt>, span: Span) -> Stmt {
        let fact = Fact::literal(ScalarValue::Bool(false));
        let expr = self.push(ExprKind::Literal(ScalarValue::Bool(false)), TypeId::BOOL, span, &[fact]);
        let condition = Some(Condition { local: None, expr });
        Self::statement(StmtKind::Loop { kind: LoopKind::DoWhile, condition, step: None, body }, span)
    }

    /// An iteration. Where a `continue` stays in it, it is a loop that runs once.
    fn one_iteration(&mut self, parts: &Parts<'_>, open: Option<Jump>) -> Stmt {
        if open != Some(Jump::Continue) {
            let body = self.statements(parts.body);
            return Self::statement(StmtKind::Block(body), parts.span);
        }
        let mark = self.store.mark();
        let outside = std::mem::replace(&mut self.leaving_since, mark);
        let body = self.statements(parts.body);
        self.leaving_since = outside;
        let leaving = std::mem::take(&mut self.leaving);
        if leaving.is_empty() || self.failed {
            return Self::statement(StmtKind::Block(body), parts.span);
        }
        match self.jump.take() {
            // It is sure only where no `continue` was before it.
            Some(Jump::Break) => {
                self.failed = true;
                self.blocked = None;
            }
            Some(Jump::Continue) => self.store.live = true,
            None => {}
        }
        for changes in &leaving {
            self.store.meet(changes, mark);
        }
        self.once(body, parts.span)
    }

    fn rounds(&mut self, parts: &Parts<'_>, open: Option<Jump>, weight: u64) -> Option<(Vec<Stmt>, u32)> {
        let mut out = Vec::new();
        let mut rounds = 0;
        let mut first = 0;
        loop {
            let tested = parts.kind != LoopKind::DoWhile || rounds > 0;
            if tested && !self.another(parts, &mut out)? {
                return Some((out, rounds));
            }
            rounds += 1;
            let iteration = self.one_iteration(parts, open);
            if self.failed {
                return None;
            }
            out.push(iteration);
            match self.jump.take() {
                Some(Jump::Break) => {
                    self.store.live = true;
                    return Some((out, rounds));
                }
                Some(Jump::Continue) => self.store.live = true,
                None => {}
            }
            if !self.store.live {
                return Some((out, rounds));
            }
            if let Some(step) = parts.step {
                let value = self.eval(step);
                out.push(Self::statement(StmtKind::Expr(value.id), parts.span));
            }
            let grown = self.weight - weight;
            if rounds == 1 {
                first = grown;
            }
            // What gains nothing by being written out stays a loop.
            let most = if open.is_some() { ALWAYS } else { self.most(first) };
            let repeats = (self.extent > Extent::All || self.kept.contains(&parts.span)) && rounds > 1;
            let too_long = repeats || (grown > ALWAYS && grown > most);
            if rounds >= MOST_ROUNDS || too_long || !self.may_grow() {
                return None;
            }
        }
    }

    /// How long a loop whose first iteration leaves so many expressions may become.
    fn most(&self, first: u64) -> u64 {
        (first * 8).min(2400)
    }

    /// Whether there is another iteration; `None` if that is open.
    fn another(&mut self, parts: &Parts<'_>, out: &mut Vec<Stmt>) -> Option<bool> {
        let Some(condition) = parts.condition else { return Some(true) };
        let value = self.eval(condition.expr);
        let truth = at(&value.facts, 0).truth()?;
        if !self.is_pure(value.id) {
            out.push(Self::statement(StmtKind::Expr(value.id), parts.span));
        }
        Some(truth)
    }

    fn keep(&mut self, parts: &Parts<'_>, out: &mut Vec<Stmt>) {
        let exprs: Vec<ExprId> =
            parts.condition.map(|condition| condition.expr).into_iter().chain(parts.step).collect();
        let counter = self.counter(parts);
        let tallies = self.tallies(parts);
        let assigned = self.effects.assigned(self.shader, parts.body, &exprs);
        self.forget_assigned(&assigned);
        if let Some((local, low)) = counter {
            let key = self.local_key(local);
            self.store.change(key, |cell| {
                if let Some(fact) = cell.first_mut() {
                    *fact = Fact::of(What::Int(low, i32::MAX), false, true);
                }
            });
        }
        self.targets.push(Target::Kept { is_loop: true });
        self.forks += 1;
        let mark = self.store.mark();
        let (condition, step, body) = self.kept_round(parts);
        self.store.roll_back(mark);
        self.forks -= 1;
        self.targets.pop();
        self.store.live = !self.failed;
        for (local, count) in tallies {
            let key = self.local_key(local);
            self.store.change(key, |cell| {
                if let Some(fact) = cell.first_mut() {
                    *fact = Fact::bound(ScalarValue::Int(count));
                }
            });
        }
        out.push(Self::statement(StmtKind::Loop { kind: parts.kind, condition, step, body }, parts.span));
    }

    fn kept_round(&mut self, parts: &Parts<'_>) -> (Option<Condition>, Option<ExprId>, Vec<Stmt>) {
        let test = |this: &mut Self| {
            parts.condition.map(|condition| {
                let expr = this.eval(condition.expr).id;
                Condition { local: condition.local, expr }
            })
        };
        let before = if parts.kind == LoopKind::DoWhile { None } else { test(self) };
        let mark = self.store.mark();
        if let (Some(condition), Some(written)) = (parts.condition, before.as_ref()) {
            self.refine(condition.expr, written.expr, true);
        }
        let body = self.statements(parts.body);
        // Whatever path an iteration took, the variables that it assigns to were forgotten.
        let failed = self.failed;
        self.store.roll_back(mark);
        let after = if parts.kind == LoopKind::DoWhile { test(self) } else { None };
        let step = parts.step.map(|step| self.eval(step).id);
        self.store.live = !failed;
        (before.or(after), step, body)
    }

    /// All that is known of these variables is forgotten.
    pub(super) fn forget_assigned(&mut self, assigned: &Assigned) {
        for local in &assigned.locals {
            let key = self.local_key(*local);
            self.store.forget(key);
        }
        for global in &assigned.globals {
            let key = self.key(VarRef::Global(*global));
            self.store.forget(key);
        }
    }

    /// The counter of `for (int i = low; i < n; ++i)`, which nothing else changes, and where it starts: it grows to below
    /// `n`, so it never wraps.
    fn counter(&self, parts: &Parts<'_>) -> Option<(glisten_front::hir::LocalId, i32)> {
        if parts.kind == LoopKind::DoWhile {
            return None;
        }
        let ExprKind::Binary(BinaryOp::Less, left, _) = self.shader.expr(parts.condition?.expr).kind else {
            return None;
        };
        let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(left).kind else { return None };
        let ExprKind::IncDec(IncDec::PreIncrement | IncDec::PostIncrement, target) = self.shader.expr(parts.step?).kind
        else {
            return None;
        };
        let steps = matches!(self.shader.expr(target).kind, ExprKind::Var(VarRef::Local(stepped)) if stepped == local);
        let condition = parts.condition.map(|condition| condition.expr);
        let elsewhere = self.effects.assigned(self.shader, parts.body, condition.as_slice());
        if !steps || elsewhere.locals.contains(&local) {
            return None;
        }
        let facts: &[Fact] = self.store.get(self.local_key(local));
        let low = match at(facts, 0).what {
            What::Value(ScalarValue::Int(value)) => value,
            What::Int(low, _) => low,
            _ => return None,
        };
        Some((local, low))
    }
}
