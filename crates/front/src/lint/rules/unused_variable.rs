//! `unused-variable`: a local that is never read.

use super::super::unused::is_all_of;
use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{LocalId, LocalKind, is_pure};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in &subject.places {
        for (index, (local, uses)) in place.function.locals.iter().zip(&place.locals).enumerate() {
            let is_variable = matches!(local.kind, LocalKind::Variable | LocalKind::Const) && uses.is_declared;
            if !is_variable || uses.reads > 0 || !is_all_of(subject, place, LocalId::new(index)) {
                continue;
            }
            if uses.writes > 0 {
                findings.push(findings.at(local.span, format!("`{}` is assigned and never read", local.name)));
                continue;
            }
            let is_removable = uses.initializer.is_none_or(|value| is_pure(place.shader, value));
            let whole = subject.texts.simple_statement(local.span).filter(|_| is_removable);
            let fix = whole.and_then(|whole| subject.texts.remove(Applicability::Safe, whole, "remove it"));
            let finding = findings.at(local.span, format!("`{}` is never used", local.name));
            findings.push(finding.help("remove it").maybe_fix(fix));
        }
    }
}
