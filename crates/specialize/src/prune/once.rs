//! Loops that run once become selections: `do { if (c) break; rest } while (false);` is `if (!c) { rest }`.
//!
//! *In:* the body of such a loop. *Out:* the same without jumps. *Holds:* only a jump that ends the first branch of an `if`
//! without `else if` is taken apart; with any other, or with too many, the loop stays.

use glisten_front::hir::{Condition, ExprId, ExprKind, LoopKind, ScalarValue, Shader, Stmt, StmtKind, TypeId, UnaryOp};

/// Selections in one another.
const DEEPEST: usize = 12;

/// Whether a loop is `do { ... } while (false)`.
pub(super) fn runs_once(shader: &Shader, kind: LoopKind, condition: Option<&Condition>) -> bool {
    let Some(Condition { expr, .. }) = condition.filter(|_| kind == LoopKind::DoWhile) else { return false };
    matches!(shader.expr(*expr).kind, ExprKind::Literal(ScalarValue::Bool(false)))
}

/// The body of a loop that runs once, without jumps; the body as it was where that cannot be.
pub(super) fn without_jumps(shader: &mut Shader, body: Vec<Stmt>) -> Result<Vec<Stmt>, Vec<Stmt>> {
    if !can(shader, &body) {
        return Err(body);
    }
    Ok(apart(shader, body))
}

fn is_jump(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Break | StmtKind::Continue)
}

fn jumps(shader: &Shader, body: &[Stmt]) -> bool {
    let mut any = false;
    shader.visit_statements(body, &mut |stmt| any |= is_jump(stmt));
    any
}

/// The number of the first statement with a jump.
fn first(shader: &Shader, body: &[Stmt]) -> Option<usize> {
    body.iter().position(|stmt| jumps(shader, std::slice::from_ref(stmt)))
}

/// Whether all jumps end the first branch of an `if`.
fn can(shader: &Shader, body: &[Stmt]) -> bool {
    let mut rest = body.to_vec();
    for _ in 0..2 * DEEPEST {
        let Some(place) = first(shader, &rest) else { return true };
        let after = rest.split_off(place + 1);
        let (arms, otherwise) = match rest.pop().map(|stmt| stmt.kind) {
            Some(StmtKind::If { arms, otherwise }) => (arms, otherwise),
            // An iteration: what follows it goes to its end.
            Some(StmtKind::Block(inner)) => {
                rest = inner;
                rest.extend(after);
                continue;
            }
            _ => return false,
        };
        let [(_, arm)] = arms.as_slice() else { return false };
        let Some((last, before)) = arm.split_last() else { return false };
        if !is_jump(last) || jumps(shader, before) || jumps(shader, &otherwise) {
            return false;
        }
        rest = after;
    }
    false
}

fn apart(shader: &mut Shader, mut body: Vec<Stmt>) -> Vec<Stmt> {
    let Some(place) = first(shader, &body) else { return body };
    let rest = body.split_off(place + 1);
    let Some(Stmt { kind, span }) = body.pop() else { return body };
    let (mut arms, mut otherwise) = match kind {
        StmtKind::If { arms, otherwise } => (arms, otherwise),
        StmtKind::Block(mut inner) => {
            inner.extend(rest);
            let inner = apart(shader, inner);
            body.push(Stmt { kind: StmtKind::Block(inner), span });
            return body;
        }
        kind => {
            body.push(Stmt { kind, span });
            body.extend(rest);
            return body;
        }
    };
    let rest = apart(shader, rest);
    otherwise.extend(rest);
    if let [(condition, arm)] = arms.as_mut_slice() {
        arm.pop();
        if arm.is_empty() {
            *condition = not(shader, *condition);
            *arm = std::mem::take(&mut otherwise);
        }
    }
    body.push(Stmt { kind: StmtKind::If { arms, otherwise }, span });
    body
}

fn not(shader: &mut Shader, condition: ExprId) -> ExprId {
    let expr = shader.expr(condition);
    let span = expr.span;
    match expr.kind {
        ExprKind::Unary(UnaryOp::Not, inner) => inner,
        _ => shader.push(ExprKind::Unary(UnaryOp::Not, condition), TypeId::BOOL, span),
    }
}
