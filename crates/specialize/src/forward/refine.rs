//! What a condition says of the variables in it, where it holds or does not.
//!
//! *In:* a condition that was just evaluated. *Out:* narrower facts of locals. *Holds:* a comparison of floats that holds
//! says that neither is NaN; one that does not hold says nothing, since a NaN may be the reason. Of a variable that the
//! condition assigns to a comparison says nothing: it may have seen an earlier value.

use super::Forward;
use super::effects::Assigned;
use crate::facts::{Fact, Range, What, at};
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, LogicalOp, Scalar, ScalarValue, UnaryOp, VarRef};

impl Forward<'_> {
    /// Takes it that a condition is so, which was evaluated as `written`.
    pub(super) fn refine(&mut self, condition: ExprId, written: ExprId, holds: bool) {
        let assigned = if self.is_pure(written) {
            Assigned::default()
        } else {
            self.effects.assigned(self.shader, &[], &[condition])
        };
        let mut pending = vec![(condition, holds)];
        while let Some((condition, holds)) = pending.pop() {
            match self.shader.expr(condition).kind {
                ExprKind::Unary(UnaryOp::Not, inner) => pending.push((inner, !holds)),
                ExprKind::Logical(LogicalOp::And, a, b) if holds => pending.extend([(a, true), (b, true)]),
                ExprKind::Logical(LogicalOp::Or, a, b) if !holds => pending.extend([(a, false), (b, false)]),
                ExprKind::Binary(op, left, right) => self.compared(op, (left, right), holds, &assigned),
                _ => {}
            }
        }
    }

    fn compared(&mut self, op: BinaryOp, (left, right): (ExprId, ExprId), holds: bool, assigned: &Assigned) {
        let changes = |id: ExprId| match self.shader.root_variable(id) {
            Some(VarRef::Local(local)) => assigned.locals.contains(&local),
            Some(VarRef::Global(global)) => assigned.globals.contains(&global),
            None => false,
        };
        if changes(left) || changes(right) {
            return;
        }
        let scalar = match self.types.get(self.shader.expr(left).ty) {
            glisten_front::hir::Type::Scalar(scalar) => scalar,
            _ => return,
        };
        let (a, b) = (self.simple(left), self.simple(right));
        let op = match (op, holds) {
            (op, true) => op,
            _ if scalar == Scalar::Float => return,
            (BinaryOp::Less, false) => BinaryOp::GreaterEqual,
            (BinaryOp::LessEqual, false) => BinaryOp::Greater,
            (BinaryOp::Greater, false) => BinaryOp::LessEqual,
            (BinaryOp::GreaterEqual, false) => BinaryOp::Less,
            _ => return,
        };
        let mirrored = match op {
            BinaryOp::Less => BinaryOp::Greater,
            BinaryOp::LessEqual => BinaryOp::GreaterEqual,
            BinaryOp::Greater => BinaryOp::Less,
            BinaryOp::GreaterEqual => BinaryOp::LessEqual,
            _ => return,
        };
        self.limit(left, op, scalar, b);
        self.limit(right, mirrored, scalar, a);
    }

    /// What is known of a literal or a variable.
    fn simple(&self, id: ExprId) -> Fact {
        match self.shader.expr(id).kind {
            ExprKind::Literal(value) => Fact::literal(value),
            ExprKind::Var(variable) => at(self.store.get(self.key(variable)), 0),
            _ => Fact::ANY,
        }
    }

    /// A local is less than something, or the like.
    fn limit(&mut self, id: ExprId, op: BinaryOp, scalar: Scalar, other: Fact) {
        let ExprKind::Var(VarRef::Local(local)) = self.shader.expr(id).kind else { return };
        let key = self.local_key(local);
        let [fact] = self.store.get(key) else { return };
        let fact = *fact;
        let what = match scalar {
            Scalar::Float => {
                let (range, limit) = (fact.range(), other.range());
                // Where a target flushes, a number just above 0 may be taken for 0.
                let bounds = match op {
                    BinaryOp::Less | BinaryOp::LessEqual => Range::between(f64::NEG_INFINITY, limit.high),
                    _ => Range::between(limit.low, f64::INFINITY),
                };
                let narrow = range.within(bounds);
                // 0 is not above 0: what is above or below has no -0.
                let strict = matches!(op, BinaryOp::Less | BinaryOp::Greater);
                let zero = match op {
                    BinaryOp::Greater => limit.low >= 0.0,
                    _ => limit.high <= 0.0,
                };
                What::Float(Range { negative_zero: narrow.negative_zero && !(strict && zero), ..narrow })
            }
            Scalar::Int => {
                let (low, high) = fact.integers(scalar);
                let limit = other.integers(scalar);
                let (low, high) = match op {
                    BinaryOp::Less => (low, high.min(limit.1 - 1)),
                    BinaryOp::LessEqual => (low, high.min(limit.1)),
                    BinaryOp::Greater => (low.max(limit.0 + 1), high),
                    _ => (low.max(limit.0), high),
                };
                if low > high { return } else { Fact::int(low, high).what }
            }
            Scalar::Uint | Scalar::Bool => return,
        };
        if matches!(fact.what, What::Value(ScalarValue::Float(_) | ScalarValue::Int(_))) {
            return;
        }
        self.store.change(key, |cell| {
            if let Some(slot) = cell.first_mut() {
                slot.what = what;
            }
        });
    }
}
