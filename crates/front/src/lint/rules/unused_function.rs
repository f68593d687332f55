//! `unused-function`: a function of the shader's own file that nothing calls.

use super::super::unused::{body, declares_function};
use super::super::{Findings, Subject};
use crate::hir::{Function, Shader};
use rustc_hash::FxHashMap;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        let mut named: FxHashMap<&str, Vec<&Function>> = FxHashMap::default();
        shader.functions.iter().for_each(|one| named.entry(&one.name).or_default().push(one));
        let is_unused = |function: &&Function| {
            let is_own = !function.reachable && function.body.is_some() && subject.texts.is_own(shader, function.span);
            is_own
                && !is_named(subject, shader, (&function.name, named.get(&*function.name)))
                && subject.texts.are_whole(shader)
        };
        // Functions that nobody calls come together, from a file that was copied whole, so they are one finding.
        let unused: Vec<&Function> = shader.functions.iter().filter(is_unused).collect();
        let [first, others @ ..] = unused.as_slice() else { continue };
        let message = match others {
            [] => format!("nothing calls `{}`", first.name),
            [second] => format!("nothing calls `{}` and `{}`", first.name, second.name),
            _ => format!("nothing calls `{}` and {} more functions", first.name, others.len()),
        };
        let mut finding = findings.at(first.span, message).help("remove what is not called");
        for other in others.iter().take(MOST_LABELS) {
            finding = finding.label(other.span, "not called, either");
        }
        findings.push(finding);
    }
}

/// The number of other functions that a finding shows.
const MOST_LABELS: usize = 3;

/// Whether a name is used anywhere, other than in declarations of functions and inside of functions of that name.
fn is_named(subject: &Subject<'_>, shader: &Shader, (name, all): (&str, Option<&Vec<&Function>>)) -> bool {
    let own: Vec<_> = all.into_iter().flatten().filter_map(|one| body(subject, one)).collect();
    subject.texts.files(shader).iter().any(|file| {
        let lexemes = subject.texts.lexemes(*file);
        lexemes.places(name).any(|span| {
            let within = own.iter().any(|(_, body)| body.start < span.start && span.end < body.end);
            !within && !declares_function(&lexemes, lexemes.from(span.start))
        })
    })
}
