//! `unused-struct`: a struct of the shader's own file whose name nothing uses.

use super::super::{Findings, Subject};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        let Some(own) = shader.origin.file else { continue };
        let lexemes = subject.texts.lexemes(own);
        for pair in lexemes.tokens().windows(2) {
            let [word, name] = pair else { continue };
            let spelling = lexemes.spelling(name);
            if lexemes.spelling(word) != "struct"
                || spelling.is_empty()
                || subject.texts.mentions(shader, spelling) != 1
            {
                continue;
            }
            // In text that is skipped, there is no such type. A variable may be declared with it.
            let types = &subject.program.types;
            let mut is_type = false;
            for id in types.ids() {
                types.for_each_struct(id, &mut |id| {
                    let structure = types.structure(id);
                    is_type |=
                        structure.name == spelling && !structure.is_block && structure.span.start <= name.span.start;
                    false
                });
            }
            let has_variable = shader.globals.iter().any(|global| types.name(global.ty).starts_with(spelling));
            if is_type && !has_variable && subject.texts.are_whole(shader) && subject.texts.is_own(shader, name.span) {
                findings
                    .push(findings.at(name.span, format!("nothing uses the struct `{spelling}`")).help("remove it"));
            }
        }
    }
}
