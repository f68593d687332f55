//! `unused-parameter`: a parameter that its function does not name.

use super::super::unused::is_all_of;
use super::super::{Findings, Subject};
use crate::hir::LocalId;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for place in &subject.places {
        for (index, (local, uses)) in place.function.params().iter().zip(&place.locals).enumerate() {
            if uses.mentions == 0 && is_all_of(subject, place, LocalId::new(index)) {
                let message = format!("`{}` does not use its parameter `{}`", place.function.name, local.name);
                findings.push(findings.at(local.span, message).help("remove it, or leave out its name"));
            }
        }
    }
}
