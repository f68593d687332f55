//! `legacy-qualifier`: `attribute` and `varying`, which 1.30 replaced by `in` and `out`.

use super::super::{Findings, Subject};
use crate::diagnostic::Applicability;
use crate::hir::{Stage, Storage};
use crate::syntax::token::TokenKind;
use std::collections::BTreeSet;

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| subject.texts.chooses_modern(shader)) {
        let mut told = BTreeSet::new();
        for global in shader.globals.iter().filter(|global| matches!(global.storage, Storage::In | Storage::Out)) {
            if !subject.texts.is_own(shader, global.span) {
                continue;
            }
            let Some((lexemes, at)) = subject.texts.token_at(global.span) else { continue };
            // Qualifiers come before the type, which comes before the name; several names may share them.
            let before = lexemes.tokens().get(..at).unwrap_or(&[]);
            let start = before.iter().rposition(|token| {
                use TokenKind::{Hash, LeftBrace, RightBrace, Semicolon};
                matches!(token.kind, Semicolon | RightBrace | LeftBrace | Hash)
            });
            let own = before.get(start.map_or(0, |start| start + 1)..).unwrap_or(&[]);
            let old = own.iter().find(|token| matches!(lexemes.spelling(token), "attribute" | "varying"));
            // A macro of this name is what a header makes of the old word: it is not the keyword.
            let Some(old) = old.filter(|token| !lexemes.defines(lexemes.spelling(token))) else { continue };
            if !told.insert(old.span.start) {
                continue;
            }
            let new = if global.storage == Storage::In { "in" } else { "out" };
            let fix =
                subject.texts.replace(Applicability::Safe, old.span, new).filter(|_| shader.stage != Stage::Geometry);
            let finding = findings.at(old.span, format!("`{}` is the word of before GLSL 1.30", lexemes.spelling(old)));
            findings.push(finding.help(format!("write `{new}`")).maybe_fix(fix));
        }
    }
}
