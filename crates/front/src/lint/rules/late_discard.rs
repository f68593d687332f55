//! `late-discard`: `discard` behind lookups that it does not depend on, and that the shader makes for nothing then.

use super::super::rate::is_lookup;
use super::super::{Findings, Place, Subject};
use crate::hir::written_by;
use crate::hir::{ExprId, ExprKind, Stage, Stmt, StmtKind, VarRef};
use rustc_hash::FxHashSet;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in subject.places.iter().filter(|place| place.shader.stage == Stage::Fragment) {
        for (index, statement) in place.body.iter().enumerate() {
            let StmtKind::If { arms, .. } = &statement.kind else { continue };
            let [(condition, body)] = arms.as_slice() else { continue };
            let [Stmt { kind: StmtKind::Discard, .. }] = body.as_slice() else { continue };
            if let Some(lookup) = unneeded(place, place.body.get(..index).unwrap_or(&[]), *condition) {
                let finding =
                    findings.at(place.expr(*condition).span, "what was looked up before is lost where this discards");
                let finding = finding.label(place.expr(lookup).span, "the condition does not depend on this");
                findings.push(finding.help("discard as soon as the condition is known"));
            }
        }
    }
}

/// The first lookup before a condition whose value the condition does not depend on.
fn unneeded(place: &Place<'_>, before: &[Stmt], condition: ExprId) -> Option<ExprId> {
    let mut needed: FxHashSet<VarRef> = FxHashSet::default();
    let variables = |id: ExprId, needed: &mut FxHashSet<VarRef>| {
        place.shader.visit_expr(id, &mut |expr| {
            if let ExprKind::Var(variable) = place.kind(expr) {
                needed.insert(*variable);
            }
        });
    };
    variables(condition, &mut needed);
    let mut unneeded = None;
    for statement in before.iter().rev() {
        let target = match &statement.kind {
            StmtKind::Local(local, Some(value)) => Some((VarRef::Local(*local), *value)),
            StmtKind::Expr(expr) => {
                let mut target = None;
                written_by(place.shader, *expr, &mut |written| target = place.shader.root_variable(written));
                target.map(|target| (target, *expr))
            }
            StmtKind::Local(_, None) => continue,
            // What branches do is not followed.
            _ => return unneeded,
        };
        let (target, value) = target?;
        if needed.contains(&target) {
            variables(value, &mut needed);
            continue;
        }
        place.shader.visit_expr(value, &mut |expr| {
            if matches!(place.kind(expr), ExprKind::BuiltinCall(function, _) if is_lookup(*function)) {
                unneeded = Some(expr);
            }
        });
    }
    unneeded
}
