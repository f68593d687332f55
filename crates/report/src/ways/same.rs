//! Whether two expressions have the same form.

use glisten_front::hir::{ExprId, ExprKind, FunctionId, Shader};

/// All that an expression is, as a text. The expressions in `instead` are written as `x`: what is left is a function of it.
pub(super) fn form(shader: &Shader, id: ExprId, instead: Option<&dyn Fn(ExprId) -> bool>) -> String {
    use std::fmt::Write;
    let mut text = String::new();
    // A `None` closes a bracket.
    let mut pending = vec![Some(id)];
    while let Some(next) = pending.pop() {
        let Some(id) = next else {
            text.push(')');
            continue;
        };
        if instead.is_some_and(|is_instead| is_instead(id)) {
            text.push_str("x,");
            continue;
        }
        let expr = shader.expr(id);
        let _ = match &expr.kind {
            ExprKind::Literal(value) => write!(text, "{value:?}"),
            ExprKind::Var(variable) => write!(text, "{variable:?}"),
            ExprKind::Member(_, member) => write!(text, ".{member}"),
            ExprKind::Swizzle(_, swizzle) => write!(text, "{:?}", swizzle.as_slice()),
            ExprKind::Construct(kind, _) => write!(text, "{:?}{kind:?}", expr.ty),
            ExprKind::Convert(_) => write!(text, "to{:?}", expr.ty),
            ExprKind::Unary(op, _) => write!(text, "{op:?}"),
            ExprKind::IncDec(op, _) => write!(text, "{op:?}"),
            ExprKind::Binary(op, ..) => write!(text, "{op:?}"),
            ExprKind::Logical(op, ..) => write!(text, "{op:?}"),
            ExprKind::Assign(op, ..) => write!(text, "={op:?}"),
            ExprKind::Call(function, _) => write!(text, "call{function:?}"),
            ExprKind::BuiltinCall(function, _) => write!(text, "{function:?}"),
            ExprKind::Error | ExprKind::Index(..) | ExprKind::Ternary(..) | ExprKind::Comma(..) => {
                write!(text, "{}", name(&expr.kind))
            }
        };
        text.push('(');
        pending.push(None);
        pending.extend(expr.kind.children().into_iter().rev().map(Some));
    }
    text
}

fn name(kind: &ExprKind) -> &'static str {
    match kind {
        ExprKind::Index(..) => "index",
        ExprKind::Ternary(..) => "choice",
        ExprKind::Comma(..) => "comma",
        _ => "error",
    }
}

/// An expression and the function that it is in.
pub(super) type Located = (FunctionId, ExprId);
