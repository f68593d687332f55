//! `missing-default`: a `switch` without `default`.

use super::super::{Findings, Subject};
use crate::hir::{CaseLabel, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements() {
        let StmtKind::Switch { selector, cases } = &statement.kind else { continue };
        if !cases.iter().any(|case| case.labels.contains(&CaseLabel::Default)) {
            let finding = findings.at(place.expr(*selector).span, "this `switch` has no `default`");
            findings.push(finding.help("say what happens for all other values"));
        }
    }
}
