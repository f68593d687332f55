//! `unused-struct`: a struct of the shader's own file whose name nothing uses.

use super::super::{Findings, Subject};
use crate::hir::{Shader, TypeId};
use rustc_hash::{FxHashMap, FxHashSet};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        let Some(own) = shader.origin.file else { continue };
        let lexemes = subject.texts.lexemes(own);
        let (structs, variables) = (declared(subject), of_variables(subject, shader));
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
            let is_type = structs.get(spelling).is_some_and(|start| *start <= name.span.start);
            let following = variables.partition_point(|variable| variable.as_str() < spelling);
            let has_variable = variables.get(following).is_some_and(|variable| variable.starts_with(spelling));
            if is_type && !has_variable && subject.texts.are_whole(shader) && subject.texts.is_own(shader, name.span) {
                findings
                    .push(findings.at(name.span, format!("nothing uses the struct `{spelling}`")).help("remove it"));
            }
        }
    }
}

/// The names of all structs, each with the first place where one is declared.
fn declared<'a>(subject: &Subject<'a>) -> FxHashMap<&'a str, u32> {
    let types = &subject.program.types;
    let mut first = FxHashMap::default();
    for structure in types.structures().filter(|structure| !structure.is_block) {
        let start = first.entry(structure.name.as_str()).or_insert(u32::MAX);
        *start = structure.span.start.min(*start);
    }
    first
}

/// The names of the types of all globals, sorted.
fn of_variables(subject: &Subject<'_>, shader: &Shader) -> Vec<String> {
    let types: FxHashSet<TypeId> = shader.globals.iter().map(|global| global.ty).collect();
    let mut names: Vec<String> = types.into_iter().map(|ty| subject.program.types.name(ty)).collect();
    names.sort_unstable();
    names
}
