//! Expressions and statements that a link adds to a stage.
//!
//! *In:* a shader. *Out:* handles of new expressions. *Holds:* they have no place in the text.

use crate::hir::{BinaryOp, ExprId, ExprKind, GlobalId, ScalarValue, Shader, Stmt, StmtKind, TypeId, VarRef};
use crate::source::Span;

/// A use of a variable.
pub(super) fn variable(shader: &mut Shader, id: GlobalId) -> ExprId {
    let ty = shader.global(id).ty;
    shader.push(ExprKind::Var(VarRef::Global(id)), ty, Span::default())
}

/// A number.
pub(super) fn literal(shader: &mut Shader, value: ScalarValue, ty: TypeId) -> ExprId {
    shader.push(ExprKind::Literal(value), ty, Span::default())
}

/// A statement without a place in the text.
pub(super) fn statement(kind: StmtKind) -> Stmt {
    Stmt { kind, span: Span::default() }
}

/// The statement `target = value;`.
pub(super) fn assignment(shader: &mut Shader, target: ExprId, value: ExprId) -> Stmt {
    let ty = shader.expr(target).ty;
    let no_operator: Option<BinaryOp> = None;
    let assigned = shader.push(ExprKind::Assign(no_operator, target, value), ty, Span::default());
    statement(StmtKind::Expr(assigned))
}
