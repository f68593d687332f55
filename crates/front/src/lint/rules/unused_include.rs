//! `unused-include`: an include of which the shader names nothing.
//!
//! The names that an included file brings are all of its words that are not of the language. So the rule is silent where the file and
//! the shader happen to share one.

use super::super::{Findings, Subject};
use crate::builtin::functions;
use crate::diagnostic::Applicability;
use crate::hir::Shader;
use crate::source::{FileId, Span};
use crate::syntax::keywords;
use crate::syntax::token::TokenKind;
use rustc_hash::FxHashSet;

/// Words whose effect does not depend on a name.
const WITH_EFFECT: &[&str] = &["layout", "precision", "invariant", "main", "pragma", "extension", "version"];

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        let sources = subject.texts.sources();
        let inclusions = &shader.origin.inclusions;
        for inclusion in inclusions.iter().filter(|one| subject.texts.is_own(shader, one.directive)) {
            let Some(file) = inclusion.file else { continue };
            let brought = brought(subject, shader, file);
            let others = subject.texts.files(shader).into_iter().filter(|other| !brought.contains(other));
            let mut named: FxHashSet<String> = FxHashSet::default();
            for other in others {
                let lexemes = subject.texts.lexemes(other);
                named.extend(lexemes.tokens().iter().map(|token| lexemes.spelling(token).to_owned()));
            }
            let is_used = brought.iter().any(|file| {
                let lexemes = subject.texts.lexemes(*file);
                lexemes.tokens().iter().filter(|token| token.kind == TokenKind::Word).any(|token| {
                    let word = lexemes.spelling(token);
                    WITH_EFFECT.contains(&word) || !is_of_language(word) && named.contains(word)
                })
            });
            if is_used || !subject.texts.are_whole(shader) {
                continue;
            }
            let text = sources.file(file).name().rsplit('/').next().unwrap_or_default().to_owned();
            let line = sources.line(inclusion.directive).and_then(|line| {
                let own = sources.file(sources.file_of(inclusion.directive)?);
                let range = own.line_range(line)?;
                Some(Span::new(own.base() + range.start as u32, own.base() + range.end as u32))
            });
            let fix = line.and_then(|line| subject.texts.remove(Applicability::Unsafe, line, "remove the line"));
            let finding = findings.at(inclusion.directive, format!("the shader uses nothing of `{text}`"));
            findings.push(finding.help("remove the line").maybe_fix(fix));
        }
    }
}

/// A file, and the files that it includes in turn.
fn brought(subject: &Subject<'_>, shader: &Shader, file: FileId) -> Vec<FileId> {
    let mut files = vec![file];
    let mut index = 0;
    while let Some(&next) = files.get(index) {
        index += 1;
        for inclusion in &shader.origin.inclusions {
            let is_there = subject.texts.sources().file_of(inclusion.directive) == Some(next);
            files.extend(inclusion.file.filter(|file| is_there && !files.contains(file)));
        }
    }
    files
}

fn is_of_language(word: &str) -> bool {
    const DIRECTIVES: &[&str] =
        &["define", "undef", "if", "ifdef", "ifndef", "else", "elif", "endif", "include", "defined", "error", "line"];
    DIRECTIVES.contains(&word)
        || word.starts_with("gl_")
        || word.starts_with("GL_")
        || keywords::TABLE.iter().any(|row| row.spelling == word)
        || !functions::named(word).is_empty()
        // Components and one-letter names say nothing.
        || word.len() <= 4 && word.bytes().all(|byte| b"xyzwrgbastpq".contains(&byte))
}
