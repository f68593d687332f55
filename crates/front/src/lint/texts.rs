//! [`Texts`]: the texts of a program as rules see them.
//!
//! *In:* the source map. *Out:* for a span: whether it is written in the shader's own file, and its text; for a name: where it is
//! written, also in text that the preprocessor skips. *Holds:* a span in a macro's body has no text here, so that no fix
//! changes it.

use crate::diagnostic::{Advice, Applicability, Diagnostic, Edit, Fix};
use crate::hir::{ExprId, Shader, Stage};
use crate::language::Since;
use crate::source::{FileId, SourceMap, Span};
use crate::syntax::Lexemes;
use crate::syntax::token::{Token, TokenFlags, TokenKind};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::RefCell;
use std::rc::Rc;

/// The texts of a program.
pub(super) struct Texts<'a> {
    sources: &'a SourceMap,
    lexemes: RefCell<FxHashMap<FileId, Rc<Lexemes>>>,
    /// Whether all files that the texts of a stage name were read.
    whole: RefCell<FxHashMap<Stage, bool>>,
    /// The files of a stage.
    files: RefCell<FxHashMap<Stage, Rc<[FileId]>>>,
}

/// The words of directives that bring in another file.
const INCLUDES: &[&str] = &["include", "import", "moj_import"];

impl<'a> Texts<'a> {
    pub(super) fn new(sources: &'a SourceMap) -> Self {
        Self { sources, lexemes: RefCell::default(), whole: RefCell::default(), files: RefCell::default() }
    }

    pub(super) fn sources(&self) -> &'a SourceMap {
        self.sources
    }

    /// The tokens of a file, which are read once.
    pub(super) fn lexemes(&self, file: FileId) -> Rc<Lexemes> {
        let mut all = self.lexemes.borrow_mut();
        Rc::clone(all.entry(file).or_insert_with(|| Rc::new(Lexemes::new(self.sources.file(file)))))
    }

    /// Whether a span is written in the file of the shader itself, outside of macros.
    pub(super) fn is_own(&self, shader: &Shader, span: Span) -> bool {
        let is_edited = |name: &str| !name.starts_with('<') || name == SourceMap::STDIN;
        let own = shader.origin.file.filter(|file| is_edited(self.sources.file(*file).name()));
        span.is_known() && !span.expansion.is_some() && own.is_some() && self.sources.file_of(span) == own
    }

    /// Whether a shader chooses a version of 1.30 or later (or ES 3.00) by a line of its own. Where an engine or a flag adds the line, the
    /// author may have written for an older one.
    pub(super) fn chooses_modern(&self, shader: &Shader) -> bool {
        let span = shader.version.span;
        // A line that is added has an empty place.
        shader.version.reaches(Since::new(130, 300)) && span.start < span.end
    }

    /// The text of a span, if it is written in place.
    pub(super) fn text(&self, span: Span) -> Option<&'a str> {
        let text = if span.is_known() && !span.expansion.is_some() { self.sources.snippet(span) } else { "" };
        Some(text).filter(|text| !text.is_empty())
    }

    /// Whether an expression and all of its operands are written in place.
    pub(super) fn is_plain(&self, shader: &Shader, root: ExprId) -> bool {
        let mut plain = true;
        shader.visit_expr(root, &mut |expr| plain &= self.text(shader.expr(expr).span).is_some());
        plain
    }

    /// The text of an operand, in parentheses unless it is one name, one number, one call or one selection.
    pub(super) fn operand(&self, span: Span) -> Option<String> {
        let text = self.text(span)?;
        let tokens = self.lexemes(self.sources.file_of(span)?);
        let (mut depth, mut bare) = (0_i32, true);
        for token in tokens.within(span) {
            match token.kind {
                TokenKind::LeftParen | TokenKind::LeftBracket => depth += 1,
                TokenKind::RightParen | TokenKind::RightBracket => depth -= 1,
                TokenKind::Word | TokenKind::Number | TokenKind::Dot => {}
                _ => bare &= depth > 0,
            }
            bare &= depth >= 0;
        }
        Some(if bare && depth == 0 { text.to_owned() } else { format!("({text})") })
    }

    /// The files of a shader: its own, then those that it includes.
    pub(super) fn files(&self, shader: &Shader) -> Rc<[FileId]> {
        let mut all = self.files.borrow_mut();
        let files = all.entry(shader.stage).or_insert_with(|| {
            let included = shader.origin.inclusions.iter().filter_map(|inclusion| inclusion.file);
            let mut seen = FxHashSet::default();
            shader.origin.file.into_iter().chain(included).filter(|file| seen.insert(*file)).collect()
        });
        Rc::clone(files)
    }

    /// How often a word is written in the texts of a shader, also where it is skipped.
    pub(super) fn mentions(&self, shader: &Shader, word: &str) -> usize {
        self.files(shader).iter().map(|file| self.lexemes(*file).count(word)).sum()
    }

    /// Whether all files that the texts name were read: none is included in text that is skipped.
    pub(super) fn are_whole(&self, shader: &Shader) -> bool {
        let known = self.whole.borrow().get(&shader.stage).copied();
        known.unwrap_or_else(|| {
            let whole = self.names_only_what_was_read(shader);
            self.whole.borrow_mut().insert(shader.stage, whole);
            whole
        })
    }

    fn names_only_what_was_read(&self, shader: &Shader) -> bool {
        let mut read: FxHashMap<FileId, Vec<u32>> = FxHashMap::default();
        for inclusion in &shader.origin.inclusions {
            if let Some(file) = self.sources.file_of(inclusion.directive) {
                read.entry(file).or_default().push(inclusion.directive.start);
            }
        }
        read.values_mut().for_each(Vec::dedup);
        self.files(shader).iter().all(|file| {
            let lexemes = self.lexemes(*file);
            let named = lexemes.directives().filter(|(word, index)| {
                let next = lexemes.tokens().get(index + 2);
                INCLUDES.contains(word)
                    || *word == "pragma" && next.is_some_and(|next| INCLUDES.contains(&lexemes.spelling(next)))
            });
            named.count() <= read.get(file).map_or(0, Vec::len)
        })
    }

    /// The file of a span, and the index of the token that begins there.
    pub(super) fn token_at(&self, span: Span) -> Option<(Rc<Lexemes>, usize)> {
        let lexemes = self.lexemes(self.sources.file_of(span).filter(|_| !span.expansion.is_some())?);
        let index = lexemes.from(span.start);
        Some((lexemes, index))
    }

    /// The statement around a span: from behind the last `;`, `{` or `}` to its own `;`, if no other declarator, directive or
    /// bracket is in it. One of thousands of tokens is not simple.
    pub(super) fn simple_statement(&self, span: Span) -> Option<Span> {
        const MOST: usize = 1024;
        let (lexemes, index) = self.token_at(span)?;
        let tokens = lexemes.tokens();
        let ends =
            |token: &Token| matches!(token.kind, TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace);
        let near = index.saturating_sub(MOST);
        let first = tokens.get(near..index)?.iter().rposition(ends).map(|end| near + end + 1);
        let first = first.or((near == 0).then_some(0))?;
        // A directive ends with its line.
        let hash = tokens.get(first..index)?.iter().rposition(Lexemes::begins_directive).map(|hash| first + hash);
        let next_line = |from: usize| {
            tokens.iter().skip(from + 1).take(MOST).position(|token| token.flags.contains(TokenFlags::LINE_START))
        };
        let first = hash.and_then(|hash| Some(hash + 1 + next_line(hash)?)).unwrap_or(first);
        if ends_struct(&lexemes, tokens.get(near..first)?) {
            return None;
        }
        let length = tokens.get(index..)?.iter().take(MOST).position(ends)?;
        let last = tokens.get(index + length).filter(|token| token.kind == TokenKind::Semicolon)?;
        let inside = tokens.get(first..index + length)?;
        let mut depth = 0_i32;
        for token in inside {
            match token.kind {
                TokenKind::LeftParen | TokenKind::LeftBracket => depth += 1,
                TokenKind::RightParen | TokenKind::RightBracket => depth -= 1,
                TokenKind::Comma if depth == 0 => return None,
                TokenKind::Hash | TokenKind::Colon => return None,
                TokenKind::Word
                    if matches!(lexemes.spelling(token), "for" | "if" | "else" | "while" | "do" | "struct") =>
                {
                    return None;
                }
                _ => {}
            }
        }
        let start = inside.first()?.span.start;
        (depth == 0).then(|| Span::new(start, last.span.end))
    }

    /// The span with the white space around it that goes with it: the whole line, if there is nothing else on it.
    pub(super) fn with_line(&self, span: Span) -> Span {
        let Some(file) = self.sources.file_of(span).map(|id| self.sources.file(id)) else { return span };
        let (text, base) = (file.text(), file.base());
        let before = text.get(..(span.start - base) as usize).unwrap_or("");
        let after = text.get((span.end - base) as usize..).unwrap_or("");
        let indent = before.len() - before.trim_end_matches([' ', '\t']).len();
        let tail = after.len() - after.trim_start_matches([' ', '\t']).len();
        let starts_line =
            indent == before.len() || before.get(..before.len() - indent).is_some_and(|text| text.ends_with('\n'));
        let rest = after.get(tail..).unwrap_or("");
        let line_end = if rest.starts_with("\r\n") { 2 } else { usize::from(rest.starts_with('\n')) };
        if starts_line && line_end > 0 {
            return Span::new(span.start - indent as u32, span.end + (tail + line_end) as u32);
        }
        if starts_line { span } else { Span::new(span.start - indent as u32, span.end) }
    }

    /// A fix of one replacement, if the span is written in place.
    pub(super) fn replace(&self, applicability: Applicability, span: Span, text: impl Into<String>) -> Option<Fix> {
        let text = text.into();
        self.text(span)?;
        Some(Fix::new(applicability, format!("write `{text}`"), span, text))
    }

    /// The finding with the advice to write a text in place of its span, if the span is written in place.
    pub(super) fn advised(
        &self,
        finding: Diagnostic,
        applicability: Applicability,
        text: Option<String>,
    ) -> Diagnostic {
        match text.filter(|_| self.text(finding.primary.span).is_some()) {
            Some(text) => finding.help(Advice::write(applicability, text)),
            None => finding,
        }
    }

    /// A fix that removes a span, and its line if nothing else is on it.
    pub(super) fn remove(&self, applicability: Applicability, span: Span, title: &str) -> Option<Fix> {
        self.text(span)?;
        Some(Fix::new(applicability, title, self.with_line(span), ""))
    }

    /// A fix of several edits, if all of them are written in place.
    pub(super) fn edits(&self, applicability: Applicability, title: String, edits: Vec<(Span, String)>) -> Option<Fix> {
        let is_written = |span: Span| span.is_known() && !span.expansion.is_some();
        let edits = edits.into_iter().map(|(span, text)| is_written(span).then_some(Edit { span, text }));
        Some(Fix { title, applicability, edits: edits.collect::<Option<_>>()? })
    }
}

/// Whether tokens end with the members of a struct, which are of the statement that goes on behind them: `struct { float a; } s;`.
fn ends_struct(lexemes: &Lexemes, tokens: &[Token]) -> bool {
    let mut depth = 0_i32;
    let opens = |token: &Token| {
        match token.kind {
            TokenKind::RightBrace => depth += 1,
            TokenKind::LeftBrace => depth -= 1,
            _ => {}
        }
        depth == 0
    };
    if tokens.last().is_none_or(|token| token.kind != TokenKind::RightBrace) {
        return false;
    }
    let before = tokens.iter().rposition(opens).and_then(|opening| tokens.get(..opening)).unwrap_or_default();
    before.iter().rev().take(2).any(|token| lexemes.spelling(token) == "struct")
}
