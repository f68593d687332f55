//! `uniform-branch`: a condition that is the same in the whole draw.

use super::super::rate::{Rate, rate};
use super::super::{Findings, Subject};
use crate::hir::{Stage, StmtKind};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for (place, statement) in subject.statements().filter(|(place, _)| place.shader.stage == Stage::Fragment) {
        let StmtKind::If { arms, .. } = &statement.kind else { continue };
        let Some((condition, _)) = arms.first() else { continue };
        if rate(place, *condition) == Rate::Draw {
            let finding = findings.at(place.expr(*condition).span, "this condition is the same in the whole draw");
            findings
                .push(finding.help("`glisten specialize` removes it from programs of scenes that fix its uniforms"));
        }
    }
}
