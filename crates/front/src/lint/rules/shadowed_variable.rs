//! `shadowed-variable`: a local with the name of a global, a parameter, or a local of an outer block, which it hides.

use super::super::{Findings, Place, Subject};
use crate::hir::{ExprId, ExprKind, LocalId, Stmt, StmtKind, VarRef};
use crate::source::Span;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in &subject.places {
        let mut seen = Vec::new();
        let params = (0..place.function.param_count).map(LocalId::new).collect();
        walk(place, place.body, params, &mut seen);
        for (local, hidden) in seen {
            let local = place.function.local(local);
            if subject.texts.text(local.span).is_none() || local.name.is_empty() {
                continue;
            }
            let (what, span) = match hidden {
                Some(hidden) if hidden.index() < place.function.param_count => {
                    ("a parameter", place.function.local(hidden).span)
                }
                Some(hidden) => ("a variable of an outer block", place.function.local(hidden).span),
                None => match global(place, &local.name) {
                    Some(span) => ("a global", span),
                    None => continue,
                },
            };
            // Parts that are included into a function are written without each other.
            let file = |span| subject.texts.sources().file_of(span);
            if file(span) != file(local.span) {
                continue;
            }
            let finding = findings.at(local.span, format!("`{}` hides {what} of the same name", local.name));
            findings.push(finding.label(span, "hidden"));
        }
    }
}

/// The declaration of a global with a name, if the function uses it.
fn global(place: &Place<'_>, name: &str) -> Option<Span> {
    let mut globals = place.shader.globals.iter().filter(|global| global.builtin.is_none() && global.block.is_none());
    let global = globals.find(|global| global.name == name && global.span.is_known())?;
    // Only a function that names both can mistake one for the other.
    let is_named = |expr: &ExprId| matches!(place.kind(*expr), ExprKind::Var(VarRef::Global(id)) if place.shader.global(*id).span == global.span);
    place.exprs.iter().any(is_named).then_some(global.span)
}

/// Finds each local with the local that it hides, if it is one, and the scope that is open. The parser limits the nesting.
fn walk(place: &Place<'_>, body: &[Stmt], open: Vec<LocalId>, found: &mut Vec<(LocalId, Option<LocalId>)>) {
    let mut open = open;
    for statement in body {
        if let StmtKind::Local(id, _) = statement.kind {
            let name = &place.function.local(id).name;
            found.push((id, open.iter().rev().copied().find(|other| place.function.local(*other).name == *name)));
            open.push(id);
        }
        for inner in statement.kind.bodies() {
            walk(place, inner, open.clone(), found);
        }
    }
}
