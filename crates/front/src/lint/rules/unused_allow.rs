//! `unused-allow`: a comment `glisten: allow(..)` for a lint rule that finds nothing there.
//!
//! It runs last, over what the other rules found. Comments for codes that are no lint rules are left out, since a rule does not see
//! the findings of other phases.

use super::super::{Findings, Subject};
use crate::diagnostic::{Applicability, Key, allows};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let sources = subject.texts.sources();
    for shader in &subject.program.stages {
        for (span, keys) in &shader.origin.allows {
            if !subject.texts.is_own(shader, *span) {
                continue;
            }
            let idle = keys.iter().filter(|key| match Key::find(key) {
                Some(Key::Code(code)) => code.lint.is_some() && code.id != findings.code.id,
                Some(Key::Group(_)) => true,
                None => false,
            });
            let idle: Vec<&str> = idle
                .filter(|key| !findings.list.iter().any(|found| allows(sources, *span, key, found)))
                .map(String::as_str)
                .collect();
            if idle.is_empty() {
                continue;
            }
            let names = idle.iter().map(|key| format!("`{key}`")).collect::<Vec<_>>().join(", ");
            let all = idle.len() == keys.len();
            let fix = subject.texts.remove(Applicability::Safe, *span, "remove the comment").filter(|_| all);
            let finding = findings.at(*span, format!("this comment silences nothing: {names}"));
            findings.push(
                finding.help(if all { "remove the comment" } else { "remove what is not needed" }).maybe_fix(fix),
            );
        }
    }
}
