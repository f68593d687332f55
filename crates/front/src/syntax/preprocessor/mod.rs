//! [`Preprocessor`] runs directives, expands macros, and hands finished tokens to the parser (GLSL 1.50 §3.3).
//!
//! *In:* the main file, macros defined from outside, and a resolver for `#include`. *Out:* tokens through
//! [`TokenSource`], each with the position where it was written and the macro use that put it where it is; at the
//! end, an [`PreprocessorOutcome`].
//!
//! Tokens come from a stack of files, and before those from a stack of macro bodies that are being read. Both stacks
//! are on the heap. A macro is disabled while its body is on the stack, and its name found there is marked so that it
//! is never expanded again, as in C.
//!
//! *Holds:* exceeding a budget ends the token stream with one error ([`Preprocessor::stop`]), and the parser then
//! reports nothing more.

mod condition;
mod define;
mod definition;
mod directive;
mod expand;
pub(super) mod extension;
mod finish;
mod include;
pub(super) mod predefined;
mod prelude;
#[cfg(test)]
mod tests;
mod unroll;
mod version;

pub(super) use version::announced;

use super::ast::{Allow, Behavior, Extensions, Profile, Version};
use super::directives::{Directives, MacroMention};
use super::keywords;
use super::kind;
use super::lexer::{Lexer, Mode, Trivia};
use super::names::Names;
use super::session::{ParseSession, TokenSource};
use super::token::{Symbol, Token, TokenFlags, TokenKind};
use crate::diagnostic::codes::preprocess as codes;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Fix, Key, Place, codes::general};
use crate::language::Feature;
use crate::source::{FileId, IncludeForm, IncludeResolver, Inclusion, Span, Unrolled};
use definition::Macro;
use expand::TokenRun;
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;

/// The largest total size of all texts of a shader in bytes, with includes counted each time: 8 MiB.
pub(super) const MAX_BYTES: usize = 8 << 20;

/// Whether a text with this many control characters among `all` is none: a few are illegal characters, each at its place
/// (GLSL 1.50 §3.1), and allowed in comments.
pub fn is_no_text(controls: usize, all: usize) -> bool {
    controls > 4 && controls > all / 16
}

/// The outcome after the last token has been read.
#[derive(Debug)]
pub(super) struct PreprocessorOutcome {
    pub(super) version: Version,
    /// Whether the parser understands the language, and the text does not reject itself by `#error`.
    pub(super) supported: bool,
    pub(super) late_version: Option<Span>,
    pub(super) invariant_all: Option<Span>,
    pub(super) allows: Vec<Allow>,
    pub(super) extension_lines: Vec<(String, Behavior, Span)>,
    pub(super) inclusions: Vec<Inclusion>,
    pub(super) unrolled: Vec<Unrolled>,
    /// The texts of an engine that were read before the source.
    pub(super) preludes: Vec<FileId>,
    pub(super) macros: Vec<Arc<str>>,
    pub(super) macros_with_parameters: Vec<Arc<str>>,
    /// For each word by its symbol, whether the result depends on what macro it names.
    pub(super) asked: Vec<bool>,
    pub(super) directives: Directives,
}

/// A file that is being read.
struct FileFrame {
    file: FileId,
    lexer: Lexer,
    /// The value of `__FILE__` here: the depth of the include, or what `#line` said.
    number: u32,
    conditionals: Vec<directive::Conditional>,
    /// The copy of an unrolled loop that this reads, if it is no file.
    copy: Option<unroll::Copy>,
}

/// Facts about a word.
#[derive(Clone, Copy)]
struct Word {
    /// The number of its macro + 1, or 0.
    definition: u32,
    kind: TokenKind,
    /// Whether its spelling has been checked for a double underscore.
    checked: bool,
    /// Whether anything depended on what macro it names.
    asked: bool,
}

/// The preprocessor of one shader.
pub(super) struct Preprocessor<'a> {
    includes: &'a (dyn IncludeResolver + Sync + 'a),
    strict: bool,
    frames: Vec<FileFrame>,
    contexts: Vec<TokenRun>,
    macros: Vec<Macro>,
    words: Vec<Word>,
    kinds: Vec<TokenKind>,
    trivia: Vec<Trivia>,
    version: Version,
    version_seen: bool,
    /// The language that a `#version` line further down states.
    announced: Option<Version>,
    /// The first directive before `#version`.
    before_version: Option<Span>,
    extensions: Extensions,
    /// Their number in the session.
    extension_set: u16,
    /// The first token handed to the parser.
    first_token: Option<Span>,
    stopped: bool,
    /// Whether a comment without an end took the rest of a file. That has been reported.
    is_cut: bool,
    /// Whether what was just read is no token, and was reported and dropped.
    dropped: bool,
    bytes: usize,
    steps: usize,
    argument_depth: usize,
    /// The number of open braces after the last token handed to the parser, and whether a function's body is the
    /// outermost.
    braces: usize,
    in_function: bool,
    /// The kind of that token.
    last_kind: TokenKind,
    /// Whether the arguments of a macro use are being read.
    in_arguments: bool,
    /// Whether the text behind a macro use without an end has been read again.
    read_again: bool,
    /// Whether a macro use on the line of a directive has no end. That was reported, and the line has no meaning.
    broken_line: bool,
    once: FxHashSet<FileId>,
    /// The files in which joined lines have been reported.
    continued: FxHashSet<FileId>,
    resolved: FxHashMap<(FileId, IncludeForm, String), FileId>,
    engine: prelude::Engine,
    outcome: PreprocessorOutcome,
}

impl<'a> Preprocessor<'a> {
    /// A preprocessor that will read `file`, with `defines` defined before its first line.
    pub(super) fn new(
        session: &mut ParseSession<'_>,
        file: FileId,
        defines: &[(String, String)],
        strict: bool,
        includes: &'a (dyn IncludeResolver + Sync + 'a),
    ) -> Self {
        let mut this = Self {
            includes,
            strict,
            frames: Vec::new(),
            contexts: Vec::new(),
            macros: Vec::new(),
            words: Vec::new(),
            kinds: keywords::kinds_in(version::UNWRITTEN, Extensions::empty()),
            trivia: Vec::new(),
            version: version::UNWRITTEN,
            version_seen: false,
            announced: None,
            before_version: None,
            extensions: Extensions::empty(),
            extension_set: 0,
            first_token: None,
            stopped: false,
            is_cut: false,
            dropped: false,
            bytes: 0,
            steps: 0,
            argument_depth: 0,
            braces: 0,
            in_function: false,
            last_kind: TokenKind::Eof,
            in_arguments: false,
            read_again: false,
            broken_line: false,
            once: FxHashSet::default(),
            continued: FxHashSet::default(),
            resolved: FxHashMap::default(),
            engine: prelude::Engine::default(),
            outcome: PreprocessorOutcome {
                version: version::UNWRITTEN,
                supported: true,
                late_version: None,
                invariant_all: None,
                allows: Vec::new(),
                extension_lines: Vec::new(),
                inclusions: Vec::new(),
                unrolled: Vec::new(),
                preludes: Vec::new(),
                macros: Vec::new(),
                macros_with_parameters: Vec::new(),
                asked: Vec::new(),
                directives: Directives::default(),
            },
        };
        this.define_predefined(session);
        this.define_from_outside(session, defines);
        // To define a macro from outside is no use of it.
        this.words.iter_mut().for_each(|word| word.asked = false);
        this.announced = announced(session.sources.file(file).text());
        this.enter(session, file, Span::default());
        this.check_is_text(session, file);
        this
    }

    /// The outcome, after the parser has read the last token.
    pub(super) fn finish(mut self) -> PreprocessorOutcome {
        self.outcome.version = self.version;
        let names = |has_parameters: bool| {
            let own = self.macros.iter().filter(|definition| !definition.is_predefined());
            let wanted = own.filter(|definition| definition.params.is_some() == has_parameters);
            wanted.take(condition::MAX_COMPARED).map(|definition| Arc::clone(&definition.name)).collect::<Vec<_>>()
        };
        let (plain, with_parameters) = (names(false), names(true));
        (self.outcome.macros, self.outcome.macros_with_parameters) = (plain, with_parameters);
        let defined = self.words.iter().filter_map(|word| (word.definition as usize).checked_sub(1));
        let spans = defined.filter_map(|index| self.macros.get(index)).map(|definition| definition.span);
        self.outcome.directives.defined = spans.filter(|span| span.is_known()).collect();
        self.outcome.asked = self.words.iter().map(|word| word.asked).collect();
        self.outcome
    }

    /// Ends the token stream. The error has been reported, and going on would only repeat it.
    fn stop(&mut self) {
        self.stopped = true;
    }

    /// The token after the last.
    fn end(&self, span: Span) -> Token {
        Token { payload: u32::from(self.stopped || self.is_cut), ..Token::new(TokenKind::Eof, span) }
    }

    /// Begins to read a file, unless that exceeds the limit of bytes.
    fn enter(&mut self, session: &mut ParseSession<'_>, file: FileId, include: Span) {
        let source = session.sources.file(file);
        self.bytes += source.text().len();
        if self.bytes > MAX_BYTES {
            let span = if include.is_known() { include } else { Span::new(source.base(), source.base() + 1) };
            let message = format!("the source has more than {} MiB after its includes", MAX_BYTES >> 20);
            session.report(Diagnostic::new(&general::TOO_LARGE, span, message));
            self.stop();
            return;
        }
        if source.text().starts_with('\u{feff}') {
            let span = Span::new(source.base(), source.base() + '\u{feff}'.len_utf8() as u32);
            let diagnostic = kind::BYTE_ORDER_MARK
                .diagnostic(self.strict, span, "a byte order mark before the text")
                .help(Advice::new(
                    Applicability::Safe,
                    "save the file as UTF-8 without a byte order mark",
                    Place::Over,
                    "",
                ));
            session.report(diagnostic);
        }
        let source = session.sources.file(file);
        let mut lexer = Lexer::new(source.text().clone(), source.base());
        lexer.joins_comments = self.joins_lines();
        let number = self.frames.len() as u32;
        self.frames.push(FileFrame { file, lexer, number, conditionals: Vec::new(), copy: None });
    }

    /// Reports a file that is not text with one error instead of one for each byte.
    fn check_is_text(&mut self, session: &mut ParseSession<'_>, file: FileId) {
        let source = session.sources.file(file);
        let (mut odd, mut all) = (0, 0);
        for character in source.text().chars().take(1024) {
            all += 1;
            // U+FFFD does not count: comments in other encodings are legal.
            odd += usize::from(character.is_control() && !character.is_whitespace());
        }
        if is_no_text(odd, all) {
            let span = Span::new(source.base(), source.base());
            let diagnostic = Diagnostic::new(&general::BINARY_SOURCE, span, "the source is not text")
                .here(format!("{odd} of the first {all} characters are not text"));
            session.report(diagnostic);
            self.stop();
        }
    }

    /// Whether the version allows a backslash to join lines, rather than glisten forgiving it.
    fn joins_lines(&self) -> bool {
        let joins = |version: Version| version.has_with(Feature::LineContinuation, self.extensions);
        joins(self.version) || !self.version_seen && self.announced.is_some_and(joins)
    }

    /// Facts about a word.
    fn word(&mut self, symbol: Symbol) -> &mut Word {
        let index = symbol.index();
        if index >= self.words.len() {
            let kinds = &self.kinds;
            let from = self.words.len();
            self.words.extend((from..=index).map(|index| Word {
                definition: 0,
                kind: kinds.get(index).copied().unwrap_or(TokenKind::Ident),
                checked: false,
                asked: false,
            }));
        }
        // The resize above made room for it.
        &mut self.words[index]
    }

    /// The number of the macro that a word names.
    fn macro_of(&mut self, symbol: Symbol) -> Option<usize> {
        let word = self.word(symbol);
        word.asked = true;
        (word.definition as usize).checked_sub(1)
    }

    /// Notes that a directive names a macro.
    fn mention(&mut self, name: Token) {
        let definition = self.macro_of(name.symbol()).and_then(|index| self.macros.get(index));
        let definition = definition.map(|definition| definition.span);
        self.outcome.directives.mentions.push(MacroMention { span: name.span, definition });
    }

    /// The next token of the topmost file, after directives. With `collecting`, it does not go past the end of an
    /// included file: a macro use must be complete within one file.
    fn next_from_file(&mut self, session: &mut ParseSession<'_>, collecting: bool) -> Token {
        loop {
            if self.stopped {
                return self.end(Span::default());
            }
            let Some(frame) = self.frames.last_mut() else { return self.end(Span::default()) };
            let token = frame.lexer.next(Mode::Text, &mut session.names, &mut self.trivia);
            if !self.trivia.is_empty() {
                self.note_trivia(session);
            }
            match token.kind {
                TokenKind::Hash if token.starts_line() => self.directive(session, token),
                TokenKind::Word if self.is_bare_version(session, token) => self.bare_version(session, token),
                TokenKind::Eof if collecting => return token,
                TokenKind::Eof => {
                    if !self.leave(session) {
                        return self.end(token.span);
                    }
                }
                _ => return self.in_copy(session, token),
            }
        }
    }

    /// Leaves a file at its end. Returns false if it is the main file.
    fn leave(&mut self, session: &mut ParseSession<'_>) -> bool {
        let Some(frame) = self.frames.last_mut() else { return false };
        let open = std::mem::take(&mut frame.conditionals);
        if !self.is_cut {
            open.iter().for_each(|conditional| conditional.report_unterminated(session));
            // What is missing at the end of the text may be in a group that was skipped.
            self.is_cut = !open.is_empty();
        }
        if self.frames.len() == 1 {
            return false;
        }
        if !self.next_copy() {
            self.frames.pop();
        }
        true
    }

    /// Handles what the lexer recorded while skipping.
    fn note_trivia(&mut self, session: &mut ParseSession<'_>) {
        let mut trivia = std::mem::take(&mut self.trivia);
        for item in trivia.drain(..) {
            match item {
                Trivia::Pragma(span) => self.comment_pragma(session, span),
                Trivia::Continuation(span, in_comment) if !self.joins_lines() => {
                    // Once a file: who joins lines joins many.
                    let file = session.sources.file_of(span);
                    if file.is_some_and(|file| !self.continued.insert(file)) {
                        continue;
                    }
                    let message = if in_comment {
                        "a comment ends in `\\`; compilers differ on whether it continues on the next line"
                    } else {
                        "the lines are joined by `\\`"
                    };
                    let help = "write it on one line, or enable GL_ARB_shading_language_420pack";
                    let diagnostic = kind::LINE_CONTINUATION.diagnostic(self.strict, span, message);
                    session.report(diagnostic.help(help));
                }
                Trivia::Crossed(span) if !self.version.has(Feature::CommentsAreSpaces) => {
                    let message = "a comment in a directive goes on after the end of its line";
                    let diagnostic = kind::COMMENT_ACROSS_LINES.diagnostic(self.strict, span, message);
                    session.report(diagnostic.help("end it on the line where it begins"));
                }
                Trivia::Crossed(_) => {}
                Trivia::Continuation(span, _) => {
                    let bringing = Feature::LineContinuation.row().extensions;
                    if !self.version.has(Feature::LineContinuation)
                        && let Some(warning) = extension::warning_of_use(self.extensions, bringing, span)
                    {
                        session.report(warning);
                    }
                }
                Trivia::Unterminated(span) => {
                    let message = "the comment has no end";
                    let diagnostic = Diagnostic::new(&codes::UNTERMINATED_COMMENT, span, message)
                        .here("`/*` without a `*/` after it");
                    session.report(diagnostic);
                    self.is_cut = true;
                }
            }
        }
        self.trivia = trivia;
    }

    /// `// glisten: allow(CODE, ...)`; `// glisten: range(low, high)` is understood, too.
    fn comment_pragma(&mut self, session: &mut ParseSession<'_>, span: Span) {
        let text = session.sources.snippet(span);
        // The comment's sign, and white space, precede it.
        let words =
            text.get(2..).unwrap_or("").trim_start().get(crate::syntax::lexer::PRAGMA.len()..).unwrap_or("").trim();
        // The range of an input is read where it is declared.
        if words.strip_prefix("range").is_some_and(|rest| rest.trim_start().starts_with('(')) {
            return;
        }
        let list = words.strip_prefix("allow").map(str::trim_start);
        let list = list.and_then(|list| list.strip_prefix('(')?.split_once(')')).map(|(list, _)| list);
        let list: Option<Vec<String>> = list
            .map(|list| list.split(',').map(|code| code.trim().to_owned()).filter(|code| !code.is_empty()).collect());
        let Some(wanted) = list else {
            let diagnostic = Diagnostic::new(&codes::UNKNOWN_ALLOW, span, "the comment for glisten is not understood")
                .help("write `// glisten: allow(CODE)` with a code or its name");
            session.report(diagnostic);
            return;
        };
        for code in &wanted {
            if Key::find(code).is_none() {
                let near =
                    if session.may_suggest() { crate::diagnostic::did_you_mean(code, Key::words()) } else { None };
                let message = format!("there is no code `{code}` to allow");
                let mut diagnostic = Diagnostic::new(&codes::UNKNOWN_ALLOW, span, message);
                if let (Some(near), Some(at)) = (near, session.sources.snippet(span).find(code.as_str())) {
                    let start = span.start + at as u32;
                    let word = Span { start, end: start + code.len() as u32, ..span };
                    let fix = Fix::new(Applicability::Unsafe, format!("write `{near}`"), word, near);
                    diagnostic = diagnostic.help(format!("did you mean `{near}`?")).fix(fix);
                }
                session.report(diagnostic);
            }
        }
        self.outcome.allows.push(Allow { span, codes: wanted });
    }

    /// The next token, without macro expansion.
    fn next_unexpanded(&mut self, session: &mut ParseSession<'_>, collecting: bool) -> Token {
        while let Some(context) = self.contexts.last_mut() {
            if let Some(mut token) = context.next() {
                if token.kind == TokenKind::Word {
                    let definition = self.macro_of(token.symbol());
                    if definition.and_then(|index| self.macros.get(index)).is_some_and(|definition| definition.disabled)
                    {
                        token.flags.insert(TokenFlags::NO_EXPAND);
                    }
                }
                return token;
            }
            if context.is_barrier() {
                return Token::new(TokenKind::Eof, Span::default());
            }
            self.pop_context();
        }
        self.next_from_file(session, collecting)
    }

    fn pop_context(&mut self) {
        let ended = self.contexts.pop().and_then(|context| context.definition());
        if let Some(definition) = ended.and_then(|index| self.macros.get_mut(index)) {
            definition.disabled = false;
        }
    }
}

impl TokenSource for Preprocessor<'_> {
    fn next(&mut self, session: &mut ParseSession<'_>) -> Token {
        loop {
            if self.stopped {
                return self.end(Span::default());
            }
            let token = self.next_expanded(session);
            if let Some(token) = self.finish_token(session, token) {
                return token;
            }
        }
    }
}
