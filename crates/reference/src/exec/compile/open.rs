//! Constants whose value the language leaves open: `const int a = 7 / 0` is undefined (GLSL 1.50 §5.9), and implementations choose
//! the direction of `round(0.5)` (§8.3).
//!
//! *In:* the initializer of a constant. *Out:* whether to compile it, as any other expression, in place of its folded value.
//! *Holds:* folding gives such an operation one value; only the operation itself tells a domain which others would do.

use super::Compiler;
use glisten_front::builtin::BuiltinFunction;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, Scalar, ScalarValue};

impl Compiler<'_> {
    /// Whether an initializer contains an operation on integers that may be undefined, a `round`, or a constant of such a value.
    pub(super) fn is_open(&self, init: ExprId) -> bool {
        let mut left = vec![init];
        while let Some(id) = left.pop() {
            let kind = &self.shader.expr(id).kind;
            let opens = match kind {
                ExprKind::Var(place) => self.var_of(*place).is_some_and(|var| self.open.contains(&var)),
                ExprKind::Binary(operator, a, b) => self.is_on_integers(*a) && self.may_be_undefined(*operator, *b),
                ExprKind::BuiltinCall(function, _) => *function == BuiltinFunction::Round,
                _ => false,
            };
            if opens {
                return true;
            }
            left.extend(kind.children());
        }
        false
    }

    fn is_on_integers(&self, operand: ExprId) -> bool {
        let scalar = self.types.scalar_of(self.shader.expr(operand).ty);
        matches!(scalar, Some(Scalar::Int | Scalar::Uint))
    }

    /// Whether an operation on integers is undefined for some left operand. It is not if the right one is a suitable literal.
    fn may_be_undefined(&self, operator: BinaryOp, right: ExprId) -> bool {
        let literal = match self.shader.expr(right).kind {
            ExprKind::Literal(ScalarValue::Int(value)) => Some(i64::from(value)),
            ExprKind::Literal(ScalarValue::Uint(value)) => Some(i64::from(value)),
            _ => None,
        };
        match operator {
            BinaryOp::Div => literal.is_none_or(|divisor| divisor <= 0),
            BinaryOp::Rem => true,
            BinaryOp::Shl | BinaryOp::Shr => literal.is_none_or(|bits| !(0..32).contains(&bits)),
            _ => false,
        }
    }
}
