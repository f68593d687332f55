//! `unused-include`: an include of which the shader names nothing.
//!
//! The names that an included file brings are all words outside of its functions that are not of the language, whether an `#if` skips
//! them or not. So the rule is silent where the file and the shader happen to share one.

use super::super::{Findings, Subject};
use crate::builtin::functions;
use crate::diagnostic::Applicability;
use crate::hir::Shader;
use crate::source::{FileId, Span};
use crate::syntax::Lexemes;
use crate::syntax::keywords;
use crate::syntax::token::{TokenFlags, TokenKind};
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
            let files = subject.texts.files(shader);
            let others = files.iter().copied().filter(|other| !brought.contains(other));
            let mut named: FxHashSet<String> = FxHashSet::default();
            for other in others {
                let lexemes = subject.texts.lexemes(other);
                named.extend(words(&lexemes));
            }
            let is_used = brought.iter().any(|file| {
                let lexemes = subject.texts.lexemes(*file);
                names(&lexemes)
                    .into_iter()
                    .any(|word| WITH_EFFECT.contains(&word) || !is_of_language(word) && named.contains(word))
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

/// The words of a file, but for those of its includes.
fn words(lexemes: &Lexemes) -> Vec<String> {
    let (mut words, mut in_include) = (Vec::new(), false);
    for (index, token) in lexemes.tokens().iter().enumerate() {
        if token.flags.contains(TokenFlags::LINE_START) {
            let directive = lexemes.tokens().get(index + 1).map_or("", |word| lexemes.spelling(word));
            in_include = Lexemes::begins_directive(token) && matches!(directive, "include" | "import" | "moj_import");
        }
        if !in_include {
            words.push(lexemes.spelling(token).to_owned());
        }
    }
    words
}

/// The words of a file outside of functions and parentheses, and the names of its macros.
fn names(lexemes: &Lexemes) -> Vec<&str> {
    let tokens = lexemes.tokens();
    let (mut names, mut parentheses, mut braces, mut in_function) = (Vec::new(), 0_i32, 0_i32, false);
    let mut index = 0;
    while let Some(token) = tokens.get(index) {
        let at = |offset: usize| tokens.get(index + offset).map_or("", |token| lexemes.spelling(token));
        if Lexemes::begins_directive(token) {
            names.extend(WITH_EFFECT.contains(&at(1)).then(|| at(1)));
            names.extend((at(1) == "define").then(|| at(2)));
            let line = tokens.get(index + 1..).unwrap_or(&[]);
            let length = line.iter().position(|token| token.flags.contains(TokenFlags::LINE_START));
            index += 1 + length.unwrap_or(line.len());
            continue;
        }
        match token.kind {
            TokenKind::LeftParen => parentheses += 1,
            TokenKind::RightParen => parentheses -= 1,
            TokenKind::LeftBrace => {
                let behind = index.checked_sub(1).and_then(|index| tokens.get(index));
                in_function |= braces == 0 && behind.is_some_and(|token| token.kind == TokenKind::RightParen);
                braces += 1;
            }
            TokenKind::RightBrace => {
                braces -= 1;
                in_function &= braces > 0;
            }
            TokenKind::Word if parentheses == 0 && !in_function => names.push(at(0)),
            _ => {}
        }
        index += 1;
    }
    names
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
