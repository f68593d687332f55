//! `maybe-uninitialized-read`: reads a local or an `out` parameter that some path before it does not assign.
//!
//! Any part that is assigned counts as the whole, all that a loop assigns counts from its start, and a read behind a condition of its own says
//! nothing, since the condition may be that of the assignment. A variable that no path assigns is the business of
//! `uninitialized-read`.

use super::super::uses::written_by_parts;
use super::super::{Findings, Place, Subject};
use crate::hir::written_by;
use crate::hir::{CaseLabel, ExprId, ExprKind, LocalId, LocalKind, ParamMode, Stmt, StmtKind, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in &subject.places {
        let is_given = |(index, local): (usize, &crate::hir::Local)| {
            index < place.function.param_count && local.kind != LocalKind::Param(ParamMode::Out)
                || local.kind == LocalKind::Const
        };
        let start: State = place.function.locals.iter().enumerate().map(is_given).collect();
        let ever = start.clone();
        let depth = vec![0; start.len()];
        let mut walk = Walk { place, ever, depth, conditions: 0, told: start.clone(), reads: Vec::new() };
        walk.body(place.body, Some(start), &mut Vec::new());
        for (id, read) in walk.reads {
            let local = place.function.local(id);
            let message = format!("`{}` may be read before anything is assigned to it", local.name);
            let finding = findings.at(place.expr(read).span, message).here("some path to here assigns nothing");
            findings.push(finding.label(local.span, "declared here without a value"));
        }
    }
}

/// For each local, whether every path assigns it.
type State = Vec<bool>;

struct Walk<'a> {
    place: &'a Place<'a>,
    /// For each local, whether any path so far assigns it.
    ever: Vec<bool>,
    /// For each local, how many conditions are around its declaration.
    depth: Vec<u32>,
    conditions: u32,
    told: Vec<bool>,
    reads: Vec<(LocalId, ExprId)>,
}

fn join(a: Option<State>, b: Option<State>) -> Option<State> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.into_iter().zip(b).map(|(a, b)| a && b).collect()),
        (a, b) => a.or(b),
    }
}

impl Walk<'_> {
    /// Follows a body; `leaves` collects the states of the ways out of the loop or switch around it.
    fn body(&mut self, body: &[Stmt], mut state: Option<State>, leaves: &mut Vec<State>) -> Option<State> {
        for statement in body {
            state = self.statement(statement, state?, leaves);
        }
        state
    }

    fn under(&mut self, body: &[Stmt], state: State, leaves: &mut Vec<State>) -> Option<State> {
        self.conditions += 1;
        let after = self.body(body, Some(state), leaves);
        self.conditions -= 1;
        after
    }

    fn statement(&mut self, statement: &Stmt, mut state: State, leaves: &mut Vec<State>) -> Option<State> {
        match &statement.kind {
            StmtKind::Expr(expr) => self.expr(*expr, &mut state),
            StmtKind::Local(id, value) => {
                value.iter().for_each(|value| self.expr(*value, &mut state));
                self.depth.iter_mut().skip(id.index()).take(1).for_each(|depth| *depth = self.conditions);
                // A loop declares it again.
                state.iter_mut().skip(id.index()).take(1).for_each(|one| *one = value.is_some());
                self.ever.iter_mut().skip(id.index()).take(1).for_each(|one| *one |= value.is_some());
            }
            StmtKind::Block(body) => return self.body(body, Some(state), leaves),
            StmtKind::If { arms, otherwise } => {
                let mut after = None;
                for (condition, body) in arms {
                    self.expr(*condition, &mut state);
                    after = join(after, self.under(body, state.clone(), leaves));
                }
                return join(after, self.under(otherwise, state, leaves));
            }
            StmtKind::Switch { selector, cases } => {
                self.expr(*selector, &mut state);
                let (mut falls, mut ways) = (None, Vec::new());
                for case in cases {
                    let entry = join(Some(state.clone()), falls)?;
                    falls = self.under(&case.body, entry, &mut ways);
                }
                if !cases.iter().any(|case| case.labels.contains(&CaseLabel::Default)) {
                    ways.push(state);
                }
                return ways.into_iter().fold(falls, |all, way| join(all, Some(way)));
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let mut ways = Vec::new();
                condition.iter().for_each(|condition| self.expr(condition.expr, &mut state));
                for id in condition.iter().filter_map(|condition| condition.local) {
                    state.iter_mut().skip(id.index()).take(1).for_each(|one| *one = true);
                }
                self.assign_all(body, &mut state);
                let mut end = self.body(body, Some(state), &mut ways);
                if let Some(end) = &mut end {
                    step.iter().for_each(|step| self.expr(*step, end));
                }
                let mut after = ways.into_iter().fold(end, |all, way| join(all, Some(way)));
                // A later iteration may assign what the first one does not.
                after.iter_mut().for_each(|after| self.assign_all(body, after));
                return after;
            }
            StmtKind::Break | StmtKind::Continue => {
                leaves.push(state);
                return None;
            }
            StmtKind::Return(value) => {
                value.iter().for_each(|value| self.expr(*value, &mut state));
                return None;
            }
            StmtKind::Discard => return None,
        }
        Some(state)
    }

    /// Counts all that a loop's body assigns as assigned, but for the locals that it declares itself.
    fn assign_all(&self, body: &[Stmt], state: &mut State) {
        let place = self.place;
        place.shader.visit_body(body, &mut |expr| {
            written_by(place.shader, expr, &mut |target| {
                if let Some(VarRef::Local(local)) = place.shader.root_variable(target) {
                    state.iter_mut().skip(local.index()).take(1).for_each(|one| *one = true);
                }
            });
        });
    }

    /// The reads of an expression in their order, then what it assigns.
    fn expr(&mut self, id: ExprId, state: &mut State) {
        let place = self.place;
        match place.kind(id) {
            ExprKind::Var(VarRef::Local(local)) => self.read(*local, id, state),
            ExprKind::Logical(_, first, _) => self.expr(*first, state),
            ExprKind::Ternary(condition, ..) => self.expr(*condition, state),
            kind => {
                let (written, read) = written_by_parts(place.shader, id);
                let targets: Vec<ExprId> = written.iter().map(|(target, _)| *target).collect();
                kind.children()
                    .iter()
                    .filter(|child| !targets.contains(child))
                    .for_each(|child| self.expr(*child, state));
                read.iter().for_each(|child| self.expr(*child, state));
                for (target, is_read) in written {
                    let Some(VarRef::Local(local)) = place.shader.root_variable(target) else { continue };
                    if is_read {
                        self.read(local, target, state);
                    }
                    for all in [&mut *state, &mut self.ever] {
                        all.iter_mut().skip(local.index()).take(1).for_each(|one| *one = true);
                    }
                }
            }
        }
    }

    fn read(&mut self, local: LocalId, expr: ExprId, state: &State) {
        let at = local.index();
        let get = |all: &[bool]| all.get(at).copied().unwrap_or(true);
        let unconditional = self.depth.get(at).is_some_and(|depth| *depth == self.conditions);
        if get(state) || !get(&self.ever) || get(&self.told) || !unconditional {
            return;
        }
        self.told.iter_mut().skip(at).take(1).for_each(|told| *told = true);
        if !self.place.function.local(local).name.is_empty() {
            self.reads.push((local, expr));
        }
    }
}
