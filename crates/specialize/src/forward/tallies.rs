//! What a loop that is kept counts: `int c = 0; for (int i = 0; i < 9; i++) c++;` leaves 9 in `c`.
//!
//! *In:* a loop and what is known before it. *Out:* the values of `int`s after it. *Holds:* a loop counts only where its rounds are
//! known, and where nothing leaves it or a round early; a variable counts only where every assignment to it in the loop adds a
//! constant in every round. Loops in loops count, too.

use super::Forward;
use super::effects::Assigned;
use super::loops::Parts;
use crate::facts::{What, at};
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, IncDec, LocalId, LoopKind, ScalarValue, Stmt, StmtKind, UnaryOp, VarRef,
};
use std::collections::BTreeMap;

/// What a round adds to each variable; `None` where that is open.
type Sums = BTreeMap<LocalId, Option<i64>>;

impl Forward<'_> {
    /// The values that variables have after a loop.
    pub(super) fn tallies(&self, parts: &Parts<'_>) -> Vec<(LocalId, i32)> {
        let exprs: Vec<ExprId> =
            parts.condition.map(|condition| condition.expr).into_iter().chain(parts.step).collect();
        let changing = self.effects.assigned(self.shader, parts.body, &exprs);
        let counts = self.sums_of_loop(parts, None, &changing).unwrap_or_default();
        let after = |(local, sum): (LocalId, Option<i64>)| {
            let before = self.number_of(VarRef::Local(local))?;
            Some((local, i32::try_from(before.checked_add(sum?)?).ok()?))
        };
        counts.into_iter().filter_map(after).collect()
    }

    /// What a loop adds to variables. `start` is the statement before it, which may declare its counter; `changing` is what an
    /// outer loop changes.
    fn sums_of_loop(&self, parts: &Parts<'_>, start: Option<&Stmt>, changing: &Assigned) -> Option<Sums> {
        let mut jumps = false;
        self.shader.visit_statements(parts.body, &mut |stmt| {
            jumps |=
                matches!(stmt.kind, StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard);
        });
        let condition = parts.condition.filter(|condition| condition.local.is_none() && !jumps)?;
        let (counter, step) = self.addition(parts.step?)?;
        let own = self.effects.assigned(self.shader, parts.body, &[condition.expr]);
        if parts.kind != LoopKind::For || own.locals.contains(&counter) {
            return None;
        }
        let first = match start {
            Some(start) => self.start(start, counter, changing)?,
            None => self.number_of(VarRef::Local(counter))?,
        };
        let ExprKind::Binary(operator, left, right) = self.shader.expr(condition.expr).kind else { return None };
        let is_counter = matches!(self.shader.expr(left).kind, ExprKind::Var(VarRef::Local(local)) if local == counter);
        let rounds = rounds(operator, first, self.number(right, changing)?, step).filter(|_| is_counter)?;
        let mut sums = Sums::new();
        self.sums(parts.body, changing, &mut sums);
        sums.insert(counter, Some(step));
        Some(sums.into_iter().map(|(local, sum)| (local, sum.and_then(|sum| sum.checked_mul(rounds)))).collect())
    }

    /// Adds what statements add to variables.
    fn sums(&self, body: &[Stmt], changing: &Assigned, sums: &mut Sums) {
        let mut before = None;
        for stmt in body {
            match self.sums_of(stmt, before, changing) {
                Some(found) => found.into_iter().for_each(|(local, sum)| add(sums, local, sum)),
                None => {
                    let assigned = self.effects.assigned(self.shader, std::slice::from_ref(stmt), &[]);
                    assigned.locals.into_iter().for_each(|local| add(sums, local, None));
                }
            }
            before = Some(stmt);
        }
    }

    /// What a statement adds; `None` where it does something else.
    fn sums_of(&self, stmt: &Stmt, before: Option<&Stmt>, changing: &Assigned) -> Option<Sums> {
        match &stmt.kind {
            StmtKind::Expr(expr) => {
                let (local, sum) = self.addition(*expr)?;
                Some(Sums::from([(local, Some(sum))]))
            }
            StmtKind::Block(body) => {
                let mut sums = Sums::new();
                self.sums(body, changing, &mut sums);
                Some(sums)
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let parts = Parts { kind: *kind, condition: condition.as_ref(), step: *step, body, span: stmt.span };
                self.sums_of_loop(&parts, Some(before?), changing)
            }
            _ => None,
        }
    }

    /// The variable of `c++`, `c--`, `c += 2` or `c -= 2`, and what is added.
    fn addition(&self, expr: ExprId) -> Option<(LocalId, i64)> {
        let (target, sum) = match &self.shader.expr(expr).kind {
            ExprKind::IncDec(IncDec::PreIncrement | IncDec::PostIncrement, target) => (*target, 1),
            ExprKind::IncDec(IncDec::PreDecrement | IncDec::PostDecrement, target) => (*target, -1),
            ExprKind::Assign(Some(operator @ (BinaryOp::Add | BinaryOp::Sub)), target, value) => {
                let ExprKind::Literal(ScalarValue::Int(value)) = self.shader.expr(*value).kind else { return None };
                (*target, if *operator == BinaryOp::Add { i64::from(value) } else { -i64::from(value) })
            }
            _ => return None,
        };
        let is_int = self.shader.expr(target).ty == glisten_front::hir::TypeId::INT;
        match self.shader.expr(target).kind {
            ExprKind::Var(VarRef::Local(local)) if is_int => Some((local, sum)),
            _ => None,
        }
    }

    /// The number that the statement before a loop gives its counter.
    fn start(&self, stmt: &Stmt, counter: LocalId, changing: &Assigned) -> Option<i64> {
        match stmt.kind {
            StmtKind::Local(local, Some(value)) if local == counter => self.number(value, changing),
            StmtKind::Expr(expr) => match self.shader.expr(expr).kind {
                ExprKind::Assign(None, target, value) => {
                    let target = &self.shader.expr(target).kind;
                    let is_counter = matches!(target, ExprKind::Var(VarRef::Local(local)) if *local == counter);
                    self.number(value, changing).filter(|_| is_counter)
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The value of an `int` that is made of literals and of known variables that the loop does not change.
    fn number(&self, expr: ExprId, changing: &Assigned) -> Option<i64> {
        match self.shader.expr(expr).kind {
            ExprKind::Literal(ScalarValue::Int(value)) => Some(i64::from(value)),
            ExprKind::Var(VarRef::Local(local)) if changing.locals.contains(&local) => None,
            ExprKind::Var(VarRef::Global(global)) if changing.globals.contains(&global) => None,
            ExprKind::Var(variable) => self.number_of(variable),
            ExprKind::Unary(UnaryOp::Negate, value) => self.number(value, changing)?.checked_neg(),
            ExprKind::Binary(operator @ (BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul), a, b) => {
                let (a, b) = (self.number(a, changing)?, self.number(b, changing)?);
                let value = match operator {
                    BinaryOp::Add => a.checked_add(b)?,
                    BinaryOp::Sub => a.checked_sub(b)?,
                    _ => a.checked_mul(b)?,
                };
                i32::try_from(value).ok().map(i64::from)
            }
            _ => None,
        }
    }

    /// The value of an `int` that is known now.
    fn number_of(&self, variable: VarRef) -> Option<i64> {
        let key = match variable {
            VarRef::Local(local) => self.local_key(local),
            VarRef::Global(_) => self.key(variable),
        };
        match at(self.store.get(key), 0).what {
            What::Value(ScalarValue::Int(value)) => Some(i64::from(value)),
            _ => None,
        }
    }
}

/// Adds a sum to that of a variable, which is open if one of them is.
fn add(sums: &mut Sums, local: LocalId, sum: Option<i64>) {
    let slot = sums.entry(local).or_insert(Some(0));
    *slot = slot.zip(sum).and_then(|(a, b)| a.checked_add(b));
}

/// How often a counter passes its test, from its first value on; `None` if it never ends or wraps.
fn rounds(operator: BinaryOp, first: i64, bound: i64, step: i64) -> Option<i64> {
    // Down is up with the signs changed; `<=` is `<` of the next number.
    let (first, bound, step) = match operator {
        BinaryOp::Less => (first, bound, step),
        BinaryOp::LessEqual => (first, bound + 1, step),
        BinaryOp::Greater => (-first, -bound, -step),
        BinaryOp::GreaterEqual => (-first, 1 - bound, -step),
        _ => return None,
    };
    if step <= 0 || bound + step > i64::from(i32::MAX) {
        return None;
    }
    Some(((bound - first).max(0) + step - 1) / step)
}

#[cfg(test)]
mod tests {
    use super::rounds;
    use glisten_front::hir::BinaryOp;

    #[test]
    fn rounds_are_counted() {
        for (operator, first, bound, step, wanted) in [
            (BinaryOp::Less, 0, 9, 1, Some(9)),
            (BinaryOp::Less, 0, 9, 2, Some(5)),
            (BinaryOp::LessEqual, -1, 1, 1, Some(3)),
            (BinaryOp::Greater, 4, 0, -1, Some(4)),
            (BinaryOp::GreaterEqual, 4, 0, -2, Some(3)),
            (BinaryOp::Less, 9, 0, 1, Some(0)),
            (BinaryOp::Less, 0, 9, -1, None),
            (BinaryOp::LessEqual, 0, i64::from(i32::MAX), 1, None),
            (BinaryOp::NotEqual, 0, 9, 1, None),
        ] {
            assert_eq!(rounds(operator, first, bound, step), wanted, "{operator:?} {first} {bound} {step}");
        }
    }
}
