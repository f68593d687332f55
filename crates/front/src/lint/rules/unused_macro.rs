//! `unused-macro`: a macro of the shader's own file that nothing names.

use super::super::{Findings, Subject};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in &subject.program.stages {
        let Some(own) = shader.origin.file else { continue };
        let lexemes = subject.texts.lexemes(own);
        for (_, index) in lexemes.directives().filter(|(word, _)| *word == "define") {
            let Some(name) = lexemes.tokens().get(index + 2) else { continue };
            let spelling = lexemes.spelling(name);
            let is_alone = !spelling.is_empty() && subject.texts.mentions(shader, spelling) == 1;
            if is_alone && subject.texts.are_whole(shader) && subject.texts.is_own(shader, name.span) {
                findings.push(findings.at(name.span, format!("nothing uses the macro `{spelling}`")).help("remove it"));
            }
        }
    }
}
