//! Effects of an expression besides the value that it gives.
//!
//! *In:* a stage and an expression. *Out:* the l-values that the expression itself writes. *Holds:* who asks what is written asks here,
//! so that a built-in function with a result in an argument is known everywhere.

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use super::{ExprId, ExprKind, ParamMode, Shader};

/// Calls `f` with every l-value that an expression itself writes: the target of an assignment, of `++` or `--`, and
/// the arguments for `out` and `inout` parameters.
pub fn written_by(shader: &Shader, expr: ExprId, f: &mut dyn FnMut(ExprId)) {
    match &shader.expr(expr).kind {
        ExprKind::Assign(_, target, _) | ExprKind::IncDec(_, target) => f(*target),
        ExprKind::Call(callee, arguments) => {
            let callee = shader.function(*callee);
            for (index, &argument) in arguments.iter().enumerate() {
                if matches!(callee.param_mode(index), ParamMode::Out | ParamMode::Inout) {
                    f(argument);
                }
            }
        }
        ExprKind::BuiltinCall(function, arguments) => {
            if let Some(&argument) = function.written_argument().and_then(|index| arguments.get(index)) {
                f(argument);
            }
        }
        ExprKind::Error
        | ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Member(..)
        | ExprKind::Index(..)
        | ExprKind::Swizzle(..)
        | ExprKind::Convert(_)
        | ExprKind::Construct(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::Logical(..)
        | ExprKind::Ternary(..)
        | ExprKind::Comma(..) => {}
    }
}

/// Whether evaluating an expression, with all its operands, does nothing but give a value.
pub fn is_pure(shader: &Shader, root: ExprId) -> bool {
    let mut pure = true;
    shader.visit_expr(root, &mut |expr| pure &= !may_act(&shader.expr(expr).kind));
    pure
}

/// Whether an expression itself does more than give a value: it writes, emits, or calls a function of the shader, which may. One that has an
/// error may do anything.
pub fn may_act(kind: &ExprKind) -> bool {
    match kind {
        ExprKind::Error | ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Call(..) => true,
        ExprKind::BuiltinCall(function, _) => function.has_effects(),
        ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Member(..)
        | ExprKind::Index(..)
        | ExprKind::Swizzle(..)
        | ExprKind::Convert(_)
        | ExprKind::Construct(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::Logical(..)
        | ExprKind::Ternary(..)
        | ExprKind::Comma(..) => false,
    }
}
