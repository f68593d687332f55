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
use rustc_hash::{FxHashMap, FxHashSet};

/// Words whose effect does not depend on a name.
const WITH_EFFECT: &[&str] = &["layout", "precision", "invariant", "main", "pragma", "extension", "version"];

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    for shader in subject.program.stages.iter().filter(|shader| shader.main.is_some()) {
        let mut own =
            shader.origin.inclusions.iter().filter(|one| subject.texts.is_own(shader, one.directive)).peekable();
        if own.peek().is_none() || !subject.texts.are_whole(shader) {
            continue;
        }
        let graph = Graph::of(subject, shader);
        // A file may be included often.
        let mut used: FxHashMap<FileId, bool> = FxHashMap::default();
        for inclusion in own {
            let Some(file) = inclusion.file else { continue };
            if !*used.entry(file).or_insert_with(|| graph.is_used(subject, file)) {
                tell(subject, findings, inclusion.directive, file);
            }
        }
    }
}

fn tell(subject: &Subject<'_>, findings: &mut Findings<'_>, directive: Span, file: FileId) {
    let sources = subject.texts.sources();
    let text = sources.file(file).name().rsplit('/').next().unwrap_or_default().to_owned();
    let line = sources.line(directive).and_then(|line| {
        let own = sources.file(sources.file_of(directive)?);
        let range = own.line_range(line)?;
        Some(Span::new(own.base() + range.start as u32, own.base() + range.end as u32))
    });
    let fix = line.and_then(|line| subject.texts.remove(Applicability::Unsafe, line, "remove the line"));
    let finding = findings.at(directive, format!("the shader uses nothing of `{text}`"));
    findings.push(finding.help("remove the line").maybe_fix(fix));
}

/// The files of a shader: which include which, and which words they have.
struct Graph {
    included: FxHashMap<FileId, Vec<FileId>>,
    /// In how many files a word is.
    named: FxHashMap<String, usize>,
}

impl Graph {
    fn of(subject: &Subject<'_>, shader: &Shader) -> Self {
        let mut graph = Self { included: FxHashMap::default(), named: FxHashMap::default() };
        let mut seen: FxHashSet<(FileId, FileId)> = FxHashSet::default();
        for inclusion in &shader.origin.inclusions {
            let by = subject.texts.sources().file_of(inclusion.directive);
            if let (Some(by), Some(file)) = (by, inclusion.file)
                && seen.insert((by, file))
            {
                graph.included.entry(by).or_default().push(file);
            }
        }
        for file in subject.texts.files(shader).iter() {
            for word in words(&subject.texts.lexemes(*file)) {
                *graph.named.entry(word).or_default() += 1;
            }
        }
        graph
    }

    /// Whether the shader names something that a file brings.
    fn is_used(&self, subject: &Subject<'_>, file: FileId) -> bool {
        let brought = self.brought(file);
        let mut own: FxHashMap<String, usize> = FxHashMap::default();
        for word in brought.iter().flat_map(|file| words(&subject.texts.lexemes(*file))) {
            *own.entry(word).or_default() += 1;
        }
        let is_named_elsewhere = |word: &str| self.named.get(word) > own.get(word);
        let counts = |word: &str| WITH_EFFECT.contains(&word) || is_named_elsewhere(word) && !is_of_language(word);
        brought.iter().any(|file| names(&subject.texts.lexemes(*file)).into_iter().any(counts))
    }

    /// A file, and the files that it includes in turn.
    fn brought(&self, file: FileId) -> Vec<FileId> {
        let mut files = vec![file];
        let mut seen = FxHashSet::from_iter([file]);
        let mut index = 0;
        while let Some(next) = files.get(index) {
            index += 1;
            let included = self.included.get(next).into_iter().flatten();
            files.extend(included.filter(|file| seen.insert(**file)));
        }
        files
    }
}

/// The words of a file, but for those of its includes, each once.
fn words(lexemes: &Lexemes) -> Vec<String> {
    let (mut words, mut seen, mut in_include) = (Vec::new(), FxHashSet::default(), false);
    for (index, token) in lexemes.tokens().iter().enumerate() {
        if token.flags.contains(TokenFlags::LINE_START) {
            let directive = lexemes.tokens().get(index + 1).map_or("", |word| lexemes.spelling(word));
            in_include = Lexemes::begins_directive(token) && matches!(directive, "include" | "import" | "moj_import");
        }
        let word = lexemes.spelling(token);
        let is_component = is_swizzle(word) && is_after_dot(lexemes, index);
        if !in_include && !is_component && seen.insert(word) {
            words.push(word.to_owned());
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
            TokenKind::Word if parentheses == 0 && !in_function && !is_after_dot(lexemes, index) => names.push(at(0)),
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
}

/// Whether a word may select components, which names nothing.
fn is_swizzle(word: &str) -> bool {
    word.len() <= 4 && word.bytes().all(|byte| b"xyzwrgbastpq".contains(&byte))
}

fn is_after_dot(lexemes: &Lexemes, index: usize) -> bool {
    let before = index.checked_sub(1).and_then(|index| lexemes.tokens().get(index));
    before.is_some_and(|token| token.kind == TokenKind::Dot)
}
