//! Clones that came out alike become one function again, and those that did not get names of their own.
//!
//! *In:* a rebuilt stage. *Out:* the stage.

use glisten_front::hir::{
    ExprId, ExprKind, Function, FunctionId, Shader, Stmt, StmtKind, TypeId, Types, fresh_name, global_names,
};
use rustc_hash::{FxHashMap, FxHashSet};
use smallvec::SmallVec;
use std::fmt::Write;

/// Calls of equal functions become calls of one.
pub(super) fn merge(shader: &mut Shader) {
    let Some(main) = shader.main else { return };
    let mut known: FxHashMap<String, FunctionId> = FxHashMap::default();
    let mut same: FxHashMap<FunctionId, FunctionId> = FxHashMap::default();
    for id in shader.callees_first(main) {
        let text = text(shader, id, &same);
        let first = *known.entry(text).or_insert(id);
        if first != id {
            same.insert(id, first);
        }
    }
    for expr in &mut shader.exprs {
        if let ExprKind::Call(callee, _) = &mut expr.kind
            && let Some(first) = same.get(callee)
        {
            *callee = *first;
        }
    }
}

/// All that a function is, as text.
fn text(shader: &Shader, id: FunctionId, same: &FxHashMap<FunctionId, FunctionId>) -> String {
    let function = shader.function(id);
    let mut text = format!("{} {:?} ", function.name, function.ret);
    for local in &function.locals {
        let _ = write!(
            text,
            "{:?} {:?} {} {:?};",
            local.ty,
            local.kind,
            local.name,
            local.value.as_ref().map(|v| &v.scalars)
        );
    }
    for stmt in function.body.iter().flatten() {
        statement(shader, stmt, same, &mut text);
    }
    text
}

fn statement(shader: &Shader, stmt: &Stmt, same: &FxHashMap<FunctionId, FunctionId>, text: &mut String) {
    match &stmt.kind {
        StmtKind::Local(local, initializer) => {
            let _ = write!(text, "local {local:?} {} ", initializer.is_some());
        }
        StmtKind::Switch { cases, .. } => {
            let labels: Vec<_> = cases.iter().map(|case| &case.labels).collect();
            let _ = write!(text, "switch {labels:?} ");
        }
        StmtKind::Loop { kind, condition, step, .. } => {
            let local = condition.as_ref().map(|condition| condition.local);
            let _ = write!(text, "loop {kind:?} {local:?} {} ", step.is_some());
        }
        StmtKind::If { arms, .. } => {
            let _ = write!(text, "if {} ", arms.len());
        }
        StmtKind::Return(value) => {
            let _ = write!(text, "return {} ", value.is_some());
        }
        StmtKind::Expr(_) => text.push_str("expr "),
        StmtKind::Block(_) => text.push_str("block "),
        StmtKind::Break => text.push_str("break "),
        StmtKind::Continue => text.push_str("continue "),
        StmtKind::Discard => text.push_str("discard "),
    }
    for expr in stmt.kind.exprs() {
        self::expr(shader, expr, same, text);
    }
    for body in stmt.kind.bodies() {
        text.push('{');
        for stmt in body {
            statement(shader, stmt, same, text);
        }
        text.push('}');
    }
}

fn expr(shader: &Shader, root: ExprId, same: &FxHashMap<FunctionId, FunctionId>, text: &mut String) {
    shader.visit_expr(root, &mut |id| {
        let expr = shader.expr(id);
        let _ = write!(text, "{:?}", expr.ty);
        let _ = match &expr.kind {
            ExprKind::Literal(value) => write!(text, "{value:?}"),
            ExprKind::Var(variable) => write!(text, "{variable:?}"),
            ExprKind::Member(_, member) => write!(text, ".{member}"),
            ExprKind::Swizzle(_, swizzle) => write!(text, "{swizzle:?}"),
            ExprKind::Construct(kind, list) => write!(text, "{kind:?}{}", list.len()),
            ExprKind::Unary(op, _) => write!(text, "{op:?}"),
            ExprKind::IncDec(op, _) => write!(text, "{op:?}"),
            ExprKind::Binary(op, ..) => write!(text, "{op:?}"),
            ExprKind::Logical(op, ..) => write!(text, "{op:?}"),
            ExprKind::Assign(op, ..) => write!(text, "assign {op:?}"),
            ExprKind::Call(callee, list) => {
                write!(text, "call {:?} {}", same.get(callee).unwrap_or(callee), list.len())
            }
            ExprKind::BuiltinCall(function, list) => write!(text, "{function:?}{}", list.len()),
            ExprKind::Index(..) => write!(text, "index"),
            ExprKind::Convert(_) => write!(text, "convert"),
            ExprKind::Ternary(..) => write!(text, "?"),
            ExprKind::Comma(..) => write!(text, ","),
            ExprKind::Error => write!(text, "error"),
        };
    });
}

/// Functions of one name and the same parameters are told apart by a number.
pub(super) fn name(types: &Types, shader: &mut Shader) {
    let types_of =
        |function: &Function| -> SmallVec<[TypeId; 8]> { function.param_types().map(|(ty, _)| ty).collect() };
    let mut taken: FxHashSet<(&str, SmallVec<[TypeId; 8]>)> = FxHashSet::default();
    let again: Vec<FunctionId> = shader
        .functions()
        .filter(|(_, function)| !taken.insert((&function.name, types_of(function))))
        .map(|(id, _)| id)
        .collect();
    if again.is_empty() {
        return;
    }
    let mut names = global_names(types, shader, |_| false);
    for id in again {
        let Some(function) = shader.functions.get_mut(id.index()) else { continue };
        function.name = fresh_name(&function.name, |name| names.contains(name));
        names.insert(function.name.clone());
    }
}
