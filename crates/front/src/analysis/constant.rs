//! Constant expressions (§4.3.3): which expressions are constant, and their values.

use super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::types;
use crate::fold;
use crate::hir::{ExprId, ExprKind, ScalarValue, Value, VarRef};

impl Analyzer<'_> {
    /// The value of a constant expression; `None` for any other expression.
    pub(super) fn evaluate(&self, id: ExprId) -> Option<Value> {
        if !self.is_constant(id) || self.budget.is_exhausted() {
            return None;
        }
        let local = |var| match var {
            VarRef::Global(_) => None,
            VarRef::Local(id) => self.local(id)?.value.as_ref(),
        };
        let value = fold::evaluate_within(&self.shader, self.types, id, &local, self.budget.steps())?;
        // Stored values take memory, so the longer ones cost more than the steps that made them.
        let weight = 16 * value.scalars.len() as u64;
        if value.scalars.len() > 16 {
            self.budget.spend(weight);
        }
        Some(value)
    }

    /// The value of a constant expression of type `int` or `uint`.
    pub(super) fn evaluate_integer(&self, id: ExprId) -> Option<i64> {
        match self.evaluate(id)?.scalars.first()? {
            ScalarValue::Int(value) => Some(i64::from(*value)),
            ScalarValue::Uint(value) => Some(i64::from(*value)),
            ScalarValue::Bool(_) | ScalarValue::Float(_) => None,
        }
    }

    /// The diagnostic for an initializer whose value is not known at compile time.
    pub(super) fn not_constant_value(&self, id: ExprId, what: &str) -> Diagnostic {
        if self.budget.is_exhausted() {
            let message = "the constants of the shader take too long to compute";
            return Diagnostic::new(&types::TOO_LARGE, self.span(id), message).here("given up here");
        }
        if self.is_constant(id) {
            return Diagnostic::new(
                &crate::diagnostic::codes::general::NOT_SUPPORTED_YET,
                self.span(id),
                "this constant expression cannot be evaluated yet",
            )
            .here(super::decisive::UNKNOWN_VALUE);
        }
        self.not_constant(id, what)
    }

    /// The diagnostic for an expression that is not constant where `what` must be; it points at the part to blame.
    pub(super) fn not_constant(&self, id: ExprId, what: &str) -> Diagnostic {
        let culprit = self.culprit(id);
        let reason = match &self.expr_at(culprit).kind {
            ExprKind::Var(_) => "this variable is not `const`",
            ExprKind::Call(..) => "a call of a function of the shader is never constant",
            ExprKind::Comma(..) => "a comma makes no constant expression in this version",
            ExprKind::Assign(..) | ExprKind::IncDec(..) => "an assignment is never constant",
            _ => "this is not known before the shader runs",
        };
        Diagnostic::new(&types::NOT_CONSTANT, self.span(id), format!("{what} must be a constant expression"))
            .here("not a constant expression")
            .label(self.span(culprit), reason)
    }

    /// The innermost part that makes an expression non-constant.
    fn culprit(&self, id: ExprId) -> ExprId {
        let mut at = id;
        while let Some(child) = self.shader.children(at).into_iter().find(|&child| !self.is_constant(child)) {
            at = child;
        }
        at
    }
}
