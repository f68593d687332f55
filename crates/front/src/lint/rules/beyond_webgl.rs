//! `beyond-webgl`: what GLSL ES 1.00 has and OpenGL ES 2.0 need not support (ES 1.00 appendix A, §4 and §5). WebGL 1.0 refuses it.
//!
//! *Holds:* each loop and each index is told once. An index of a `for` counts as one even if its loop is told.

use super::super::{Findings, Place, Subject};
use crate::hir::written_by;
use crate::hir::{BinaryOp, Condition, ExprId, ExprKind, LocalId, LoopKind, Stage, Stmt, StmtKind, Storage, VarRef};
use crate::source::Span;
use rustc_hash::FxHashSet;

const WEBGL: &str = "WebGL 1.0 refuses it, and OpenGL ES 2.0 may (GLSL ES 1.00 appendix A)";

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let es100 = |place: &&Place<'_>| place.shader.version.is_es() && place.shader.version.number == 100;
    for place in subject.places.iter().filter(es100) {
        let mut indices = FxHashSet::default();
        for statement in &place.statements {
            match &statement.kind {
                StmtKind::Block(list) => indices.extend(index_of(list)),
                StmtKind::Loop { kind: LoopKind::While | LoopKind::DoWhile, .. } => {
                    let finding = findings.at(statement.span, "a loop that is no `for`");
                    findings
                        .push(finding.here(WEBGL).help("write a `for` with a constant bound, and leave it by `break`"));
                }
                _ => {}
            }
        }
        check_loops(place, findings);
        check_indices(place, &indices, findings);
    }
}

/// The variable of a `for`, which is declared in front of its loop.
fn index_of(block: &[Stmt]) -> Option<LocalId> {
    match block {
        [
            Stmt { kind: StmtKind::Local(index, _), .. },
            Stmt { kind: StmtKind::Loop { kind: LoopKind::For, .. }, .. },
        ] => Some(*index),
        _ => None,
    }
}

/// Reports loops that are not `for (int i = constant; i < constant; i += constant)`.
fn check_loops(place: &Place<'_>, findings: &mut Findings<'_>) {
    let mut proper: FxHashSet<Span> = FxHashSet::default();
    for statement in &place.statements {
        let StmtKind::Block(list) = &statement.kind else { continue };
        let (Some(index), [Stmt { kind: StmtKind::Local(_, first), .. }, whole]) = (index_of(list), list.as_slice())
        else {
            continue;
        };
        proper.insert(whole.span);
        let StmtKind::Loop { condition, step, body, .. } = &whole.kind else { continue };
        let name = &place.function.local(index).name;
        let problem = match (first, condition, step) {
            (Some(first), _, _) if place.value(*first).is_none() => {
                Some((place.expr(*first).span, format!("`{name}` begins with a value that is not constant")))
            }
            (_, Some(condition), _) if !is_bound(place, condition, index) => {
                Some((place.expr(condition.expr).span, format!("`{name}` is not compared with a constant")))
            }
            (_, _, Some(step)) if !is_step(place, *step, index) => {
                Some((place.expr(*step).span, format!("`{name}` does not change by a constant")))
            }
            (None, ..) | (_, None, _) | (_, _, None) => {
                Some((whole.span, format!("the `for` of `{name}` lacks a part")))
            }
            _ => written(place, body, index).map(|span| (span, format!("`{name}` is changed inside of its loop"))),
        };
        if let Some((span, message)) = problem {
            let help = "write `for (int i = 0; i < MOST; i++)` with a constant, and leave it by `break`";
            findings.push(findings.at(span, message).here(WEBGL).help(help));
        }
    }
    for statement in &place.statements {
        let is_for = matches!(statement.kind, StmtKind::Loop { kind: LoopKind::For, .. });
        if is_for && !proper.contains(&statement.span) {
            let finding = findings.at(statement.span, "a `for` that declares no index, or several");
            findings.push(finding.here(WEBGL).help("write `for (int i = 0; ..)`"));
        }
    }
}

/// `index < constant`
fn is_bound(place: &Place<'_>, condition: &Condition, index: LocalId) -> bool {
    use BinaryOp::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    let ExprKind::Binary(operator, a, b) = place.kind(condition.expr) else { return false };
    matches!(operator, Less | LessEqual | Greater | GreaterEqual | Equal | NotEqual)
        && is_index(place, *a, index)
        && place.value(*b).is_some()
}

/// `index++`, `index--`, `index += constant`, `index -= constant`
fn is_step(place: &Place<'_>, step: ExprId, index: LocalId) -> bool {
    match place.kind(step) {
        ExprKind::IncDec(_, target) => is_index(place, *target, index),
        ExprKind::Assign(Some(BinaryOp::Add | BinaryOp::Sub), target, value) => {
            is_index(place, *target, index) && place.value(*value).is_some()
        }
        _ => false,
    }
}

fn is_index(place: &Place<'_>, expr: ExprId, index: LocalId) -> bool {
    matches!(place.kind(expr), ExprKind::Var(VarRef::Local(local)) if *local == index)
}

/// Where a body writes to the index.
fn written(place: &Place<'_>, body: &[Stmt], index: LocalId) -> Option<Span> {
    let mut found = None;
    place.shader.visit_body(body, &mut |expr| {
        written_by(place.shader, expr, &mut |target| {
            if place.shader.root_variable(target) == Some(VarRef::Local(index)) {
                found = found.or(Some(place.expr(target).span));
            }
        });
    });
    found
}

/// Reports indices that are neither constant nor made of constants and the indices of loops.
fn check_indices(place: &Place<'_>, indices: &FxHashSet<LocalId>, findings: &mut Findings<'_>) {
    for &expr in &place.exprs {
        let ExprKind::Index(base, index) = place.kind(expr) else { continue };
        if !is_free(place, *base) && !is_constant_index(place, *index, indices) {
            let finding = findings.at(place.expr(*index).span, "an index that is neither constant nor of a loop");
            findings.push(finding.here(WEBGL).help("compare the index with each constant in a `for`"));
        }
    }
}

/// Whether any index is allowed: a uniform of a vertex shader that is no sampler.
fn is_free(place: &Place<'_>, base: ExprId) -> bool {
    let Some(VarRef::Global(id)) = place.shader.root_variable(base) else { return false };
    let global = place.shader.global(id);
    place.shader.stage == Stage::Vertex
        && global.storage == Storage::Uniform
        && !place.types.contains_sampler(global.ty)
}

/// A constant-index-expression.
fn is_constant_index(place: &Place<'_>, expr: ExprId, indices: &FxHashSet<LocalId>) -> bool {
    let mut pending = vec![expr];
    while let Some(expr) = pending.pop() {
        let kind = place.kind(expr);
        let is_whole = place.value(expr).is_some()
            || matches!(kind, ExprKind::Var(VarRef::Local(local)) if indices.contains(local));
        if is_whole {
            continue;
        }
        let is_composed = matches!(
            kind,
            ExprKind::Unary(..)
                | ExprKind::Binary(..)
                | ExprKind::Convert(_)
                | ExprKind::Construct(..)
                | ExprKind::BuiltinCall(..)
        );
        if !is_composed {
            return false;
        }
        pending.extend(kind.children());
    }
    true
}
