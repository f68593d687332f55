//! `legacy-output`: `gl_FragColor`, in place of which 1.30 has outputs that the shader declares.

use super::super::{Findings, Subject};
use crate::builtin::BuiltinVariable;
use crate::diagnostic::{Applicability, Fix};
use crate::hir::{Shader, Stage};
use crate::link::usage::first_use;
use crate::source::Span;
use crate::syntax::Lexemes;
use crate::syntax::token::TokenFlags;

/// The names for the output, of which the first that is free is taken.
const NAMES: &[&str] = &["fragColor", "outColor", "outFragColor"];

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let Some(fragment) = subject.program.stage(Stage::Fragment) else { return };
    if !subject.texts.chooses_modern(fragment) {
        return;
    }
    let color = fragment.globals().find(|(_, global)| global.builtin == Some(BuiltinVariable::FragColor));
    let Some(span) = color.filter(|(_, global)| global.used).and_then(|(id, _)| first_use(fragment, id)) else {
        return;
    };
    let finding = findings.at(span, "`gl_FragColor` is the output of before GLSL 1.30");
    findings.push(finding.help("declare an output, and assign to it").maybe_fix(fix(subject, fragment)));
}

/// Declares an output before everything but directives, and names it everywhere.
fn fix(subject: &Subject<'_>, fragment: &Shader) -> Option<Fix> {
    let own = fragment.origin.file?;
    let lexemes = subject.texts.lexemes(own);
    if lexemes.count("gl_FragColor") != subject.texts.mentions(fragment, "gl_FragColor") {
        return None;
    }
    let name = NAMES.iter().find(|name| subject.texts.mentions(fragment, name) == 0)?;
    let start = behind_directives(&lexemes)?;
    let mut edits = vec![(Span::new(start, start), format!("out vec4 {name};\n"))];
    edits.extend(lexemes.places("gl_FragColor").map(|span| (span, (*name).to_owned())));
    subject.texts.edits(Applicability::Unsafe, format!("declare `out vec4 {name};`"), edits)
}

/// The start of the first line that is no directive and under no condition.
fn behind_directives(lexemes: &Lexemes) -> Option<u32> {
    let mut depth = 0_usize;
    for (index, token) in lexemes.tokens().iter().enumerate() {
        if Lexemes::begins_directive(token) {
            match lexemes.tokens().get(index + 1).map_or("", |word| lexemes.spelling(word)) {
                "if" | "ifdef" | "ifndef" => depth += 1,
                "endif" => depth = depth.checked_sub(1)?,
                _ => {}
            }
        } else if token.flags.contains(TokenFlags::LINE_START) {
            return (depth == 0).then_some(token.span.start);
        }
    }
    None
}
