//! Directives by name, conditional groups, `#line`, `#error` and `#pragma` (GLSL 1.50 §3.3).

use super::{Extensions, Feature, Mode, ParseSession, Preprocessor, Span, Token, TokenKind, codes, kind};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};

/// An open conditional group.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conditional {
    /// The directive that opened it.
    opening: Span,
    name: &'static str,
    /// The position of its `#else`.
    else_at: Option<Span>,
    /// The first directive in a skipped group of it that looks like a misspelled one, and that one.
    misspelled: Option<(Span, &'static str)>,
}

impl Conditional {
    fn new(opening: Span, name: &'static str) -> Self {
        Self { opening, name, else_at: None, misspelled: None }
    }

    /// Records an `#else`, and reports it, or an `#elif`, behind another one.
    fn check_order(&mut self, session: &mut ParseSession<'_>, span: Span, name: &str) {
        if let Some(first) = self.else_at {
            let diagnostic = Diagnostic::new(&codes::STRAY_CONDITIONAL, span, format!("`{name}` after an `#else`"))
                .label(first, "only `#endif` may follow this")
                .label(self.opening, "the group begins here");
            session.report(diagnostic);
        } else if name == "#else" {
            self.else_at = Some(span);
        }
    }

    pub(super) fn report_unterminated(&self, session: &mut ParseSession<'_>) {
        let message = format!("the `{}` has no `#endif`", self.name);
        let diagnostic = Diagnostic::new(&codes::UNTERMINATED_CONDITIONAL, self.opening, message)
            .here("opened here and never closed");
        let diagnostic = match self.misspelled {
            Some((place, meant)) => diagnostic.label(place, "skipped").help(format!("did you mean `#{meant}` there?")),
            None => diagnostic,
        };
        session.report(diagnostic);
    }
}

/// The directives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Directive {
    Define,
    Undef,
    If,
    Ifdef,
    Ifndef,
    Elif,
    Else,
    Endif,
    Error,
    Pragma,
    Extension,
    Version,
    Line,
    Include,
    /// The engine's own word for it.
    Import,
}

/// All directives by name.
static DIRECTIVES: &[(&str, Directive)] = &[
    ("define", Directive::Define),
    ("undef", Directive::Undef),
    ("if", Directive::If),
    ("ifdef", Directive::Ifdef),
    ("ifndef", Directive::Ifndef),
    ("elif", Directive::Elif),
    ("else", Directive::Else),
    ("endif", Directive::Endif),
    ("error", Directive::Error),
    ("pragma", Directive::Pragma),
    ("extension", Directive::Extension),
    ("version", Directive::Version),
    ("line", Directive::Line),
    ("include", Directive::Include),
];

/// The directives that end a group.
const ENDS: &[&str] = &["elif", "else", "endif"];

/// Directives of engines, with the help on how to read them.
static ENGINES: &[(&str, &str)] =
    &[("moj_import", "Minecraft replaces it: `--engine minecraft` or `--include-style moj` does the same")];

/// Whether this is the name of a directive.
pub(super) fn is_directive(name: &str) -> bool {
    directive_named(name).is_some()
}

fn directive_named(name: &str) -> Option<Directive> {
    DIRECTIVES.iter().find(|row| row.0 == name).map(|row| row.1)
}

impl Preprocessor<'_> {
    /// Runs the directive whose `#` was just read.
    pub(super) fn directive(&mut self, session: &mut ParseSession<'_>, hash: Token) {
        let token = self.line_token(session);
        let span = session.sources.join(hash.span, token.span);
        if self.in_arguments && token.kind == TokenKind::Word {
            let message = "a directive in the arguments of a macro use";
            kind::DIRECTIVE_IN_ARGUMENTS.report(session, self.strict, span, message);
        }
        let directive = match token.kind {
            TokenKind::Newline | TokenKind::Eof => return,
            TokenKind::Word if self.is_import(session.spelling(token)) => Some(Directive::Import),
            TokenKind::Word => directive_named(session.spelling(token)),
            _ => None,
        };
        let Some(directive) = directive.or_else(|| unknown_directive(session, token, span)) else {
            return self.skip_line(session);
        };
        if !self.version_seen && directive != Directive::Version {
            self.before_version.get_or_insert(span);
        }
        match directive {
            Directive::Define => self.define(session),
            Directive::Undef => self.undef(session),
            Directive::If => self.if_directive(session, span),
            Directive::Ifdef => self.ifdef(session, span, "#ifdef", true),
            Directive::Ifndef => self.ifdef(session, span, "#ifndef", false),
            // The group that was taken ends here; everything up to `#endif` is skipped.
            Directive::Elif => self.end_group(session, span, "#elif"),
            Directive::Else => self.end_group(session, span, "#else"),
            Directive::Endif => self.endif(session, span),
            Directive::Error => self.error_directive(session, span),
            Directive::Pragma => self.pragma(session, span),
            Directive::Extension => self.extension(session, span),
            Directive::Version => {
                self.version(session, span);
                self.enter_preludes(session);
            }
            Directive::Line => self.line(session, span),
            Directive::Include => self.include(session, span, false),
            Directive::Import => self.include(session, span, true),
        }
    }

    /// The next token of the directive's line, without macro expansion.
    pub(super) fn line_token(&mut self, session: &mut ParseSession<'_>) -> Token {
        let Some(frame) = self.frames.last_mut() else { return Token::new(TokenKind::Eof, Span::default()) };
        let token = frame.lexer.next(Mode::Directive, &mut session.names, &mut self.trivia);
        if !self.trivia.is_empty() {
            self.note_trivia(session);
        }
        self.in_copy(session, token)
    }

    /// The rest of the directive's line.
    pub(super) fn rest_of_line(&mut self, session: &mut ParseSession<'_>, tokens: &mut Vec<Token>) {
        loop {
            let token = self.line_token(session);
            if matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
                return;
            }
            tokens.push(token);
        }
    }

    pub(super) fn skip_line(&mut self, session: &mut ParseSession<'_>) {
        if let Some(frame) = self.frames.last_mut() {
            frame.lexer.skip_line(&mut session.names, &mut self.trivia);
        }
        self.note_trivia(session);
    }

    /// Skips the rest of the line after `token`, which may itself be the line end.
    pub(super) fn end_line(&mut self, session: &mut ParseSession<'_>, token: Token) {
        if !matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
            self.skip_line(session);
        }
    }

    /// Reports a directive that makes no sense at `token`, and skips its line.
    pub(super) fn malformed(&mut self, session: &mut ParseSession<'_>, token: Token, message: &str) {
        let here = match token.kind {
            TokenKind::Newline | TokenKind::Eof => "the line ends here".to_owned(),
            _ => format!("found `{}`", session.sources.snippet(token.span)),
        };
        session.report(Diagnostic::new(&codes::MALFORMED_DIRECTIVE, token.span, message).here(here));
        self.end_line(session, token);
    }

    /// Reports text after a complete directive.
    pub(super) fn expect_line_end(&mut self, session: &mut ParseSession<'_>, directive: &str) {
        let token = self.line_token(session);
        if matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
            return;
        }
        let message = format!("there is text after the complete `{directive}`");
        kind::EXTRA_TEXT.report(session, self.strict, token.span, message);
        self.skip_line(session);
    }

    fn open(&mut self, opening: Span, name: &'static str) {
        if let Some(frame) = self.frames.last_mut() {
            frame.conditionals.push(Conditional::new(opening, name));
        }
    }

    fn if_directive(&mut self, session: &mut ParseSession<'_>, span: Span) {
        self.open(span, "#if");
        if !self.condition(session, span) {
            self.skip_groups(session);
        }
    }

    fn ifdef(&mut self, session: &mut ParseSession<'_>, span: Span, name: &'static str, wanted: bool) {
        self.open(span, name);
        let token = self.line_token(session);
        if token.kind != TokenKind::Word {
            self.malformed(session, token, &format!("`{name}` needs the name of a macro"));
            return self.skip_groups(session);
        }
        self.mention(token);
        let defined = self.macro_of(token.symbol()).is_some();
        self.expect_line_end(session, name);
        if defined != wanted {
            self.skip_groups(session);
        }
    }

    /// Handles `#elif` or `#else` after a group that was taken.
    fn end_group(&mut self, session: &mut ParseSession<'_>, span: Span, name: &'static str) {
        if self.check_order(session, span, name) {
            if name == "#else" {
                self.expect_line_end(session, name);
            } else {
                self.skip_line(session);
            }
            self.skip_to_endif(session);
        } else {
            self.skip_line(session);
        }
    }

    /// Whether `#elif` or `#else` is allowed here; records an `#else`.
    fn check_order(&mut self, session: &mut ParseSession<'_>, span: Span, name: &'static str) -> bool {
        let open = self.frames.last_mut().and_then(|frame| frame.conditionals.last_mut());
        let Some(open) = open else {
            self.stray(session, span, name);
            return false;
        };
        open.check_order(session, span, name);
        true
    }

    fn stray(&mut self, session: &mut ParseSession<'_>, span: Span, name: &str) {
        let diagnostic = Diagnostic::new(&codes::STRAY_CONDITIONAL, span, format!("`{name}` has no `#if` before it"))
            .here("no group is open in this file");
        session.report(diagnostic);
    }

    fn endif(&mut self, session: &mut ParseSession<'_>, span: Span) {
        if self.frames.last_mut().and_then(|frame| frame.conditionals.pop()).is_none() {
            self.stray(session, span, "#endif");
        }
        self.expect_line_end(session, "#endif");
    }

    /// Skips groups of the innermost conditional until one is to be taken or the conditional ends.
    fn skip_groups(&mut self, session: &mut ParseSession<'_>) {
        while let Some((span, directive)) = self.skip_group(session) {
            match directive {
                Directive::Endif => return self.endif(session, span),
                Directive::Else => {
                    let again = self
                        .frames
                        .last()
                        .and_then(|frame| frame.conditionals.last())
                        .is_some_and(|open| open.else_at.is_some());
                    self.check_order(session, span, "#else");
                    self.expect_line_end(session, "#else");
                    if !again {
                        return;
                    }
                }
                _ => {
                    let behind_else = self
                        .frames
                        .last()
                        .and_then(|frame| frame.conditionals.last())
                        .is_some_and(|open| open.else_at.is_some());
                    self.check_order(session, span, "#elif");
                    if behind_else {
                        self.skip_line(session);
                    } else if self.condition(session, span) {
                        return;
                    }
                }
            }
        }
    }

    /// Skips everything up to the `#endif` of the innermost conditional.
    fn skip_to_endif(&mut self, session: &mut ParseSession<'_>) {
        while let Some((span, directive)) = self.skip_group(session) {
            match directive {
                Directive::Endif => return self.endif(session, span),
                Directive::Else => {
                    self.check_order(session, span, "#else");
                    self.skip_line(session);
                }
                _ => {
                    self.check_order(session, span, "#elif");
                    self.skip_line(session);
                }
            }
        }
    }

    /// Skips to the next `#elif`, `#else` or `#endif` of the innermost conditional, and reads its name.
    fn skip_group(&mut self, session: &mut ParseSession<'_>) -> Option<(Span, Directive)> {
        // The conditionals inside of the group.
        let mut inner: Vec<Conditional> = Vec::new();
        let from = self.frames.last()?.lexer.offset();
        loop {
            // Skipped text need only consist of lines: continuations and `glisten:` comments in it mean nothing.
            let frame = self.frames.last_mut()?;
            let found = frame.lexer.skip_to_directive(&mut self.trivia);
            self.trivia.retain(|item| matches!(item, super::Trivia::Unterminated(_)));
            self.note_trivia(session);
            if !found {
                let to = self.frames.last().map_or(from, |frame| frame.lexer.offset());
                self.note_inactive(from, to);
                return None;
            }
            let hash = self.line_token(session);
            let token = self.line_token(session);
            let name = if token.kind == TokenKind::Word { session.spelling(token) } else { "" };
            let directive = directive_named(name);
            let span = session.sources.join(hash.span, token.span);
            match (directive, inner.last_mut()) {
                (Some(Directive::If), _) => inner.push(Conditional::new(span, "#if")),
                (Some(Directive::Ifdef), _) => inner.push(Conditional::new(span, "#ifdef")),
                (Some(Directive::Ifndef), _) => inner.push(Conditional::new(span, "#ifndef")),
                (Some(Directive::Endif), Some(_)) => drop(inner.pop()),
                // The order of groups counts in skipped text, too.
                (Some(Directive::Elif), Some(open)) => open.check_order(session, span, "#elif"),
                (Some(Directive::Else), Some(open)) => open.check_order(session, span, "#else"),
                (Some(directive @ (Directive::Elif | Directive::Else | Directive::Endif)), None) => {
                    self.note_inactive(from, hash.span.start);
                    return Some((span, directive));
                }
                (None, open) if token.kind == TokenKind::Word && session.may_suggest() => {
                    let meant = did_you_mean(session.spelling(token), ENDS.iter().copied());
                    let meant = meant.and_then(|meant| ENDS.iter().find(|end| **end == meant));
                    let frame = self.frames.last_mut();
                    let open = open.or(frame.and_then(|frame| frame.conditionals.last_mut()));
                    if let (Some(open), Some(meant)) = (open, meant) {
                        open.misspelled.get_or_insert((span, meant));
                    }
                }
                _ => {}
            }
        }
    }

    fn note_inactive(&mut self, from: u32, to: u32) {
        // The copies of an unrolled loop are no text of their own.
        if from < to && self.frames.last().is_some_and(|frame| frame.copy.is_none()) {
            self.outcome.directives.inactive.push(Span::new(from, to));
        }
    }

    /// `#error text`
    fn error_directive(&mut self, session: &mut ParseSession<'_>, span: Span) {
        let mut tokens = Vec::new();
        self.rest_of_line(session, &mut tokens);
        let rest = match tokens.as_slice() {
            [first, .., last] => session.sources.join(first.span, last.span),
            [only] => only.span,
            [] => span,
        };
        let text = if tokens.is_empty() { "" } else { session.sources.snippet(rest) };
        let message = if text.is_empty() { "#error".to_owned() } else { format!("#error: {text}") };
        session.report(Diagnostic::new(&codes::ERROR_DIRECTIVE, session.sources.join(span, rest), message));
        // The text says itself that it makes no sense this way: what it declares would only add errors.
        self.outcome.supported = false;
    }

    /// `#pragma`: its macros are not expanded, and unknown pragmas are ignored.
    fn pragma(&mut self, session: &mut ParseSession<'_>, directive: Span) {
        let mut tokens = Vec::new();
        self.rest_of_line(session, &mut tokens);
        let includes = self.engine.resolves_includes
            && tokens.first().is_some_and(|token| session.sources.snippet(token.span) == "include");
        if includes && self.pragma_include(session, directive, tokens.get(1..).unwrap_or_default()) {
            return;
        }
        let text: Vec<&str> = tokens.iter().map(|token| session.sources.snippet(token.span)).collect();
        let understood = match text.as_slice() {
            ["STDGL", "invariant", "(", "all", ")"] => {
                let end = tokens.last().map_or(directive, |token| token.span);
                self.outcome.invariant_all.get_or_insert(session.sources.join(directive, end));
                true
            }
            [name @ ("optimize" | "debug"), "(", "on" | "off", ")"] => {
                if self.in_function {
                    let message = format!("`#pragma {name}` inside a function");
                    let end = tokens.last().map_or(directive, |token| token.span);
                    let span = session.sources.join(directive, end);
                    let diagnostic = kind::PRAGMA_IN_FUNCTION.diagnostic(self.strict, span, message);
                    session.report(diagnostic.help("move it before the function"));
                }
                true
            }
            ["once"] => {
                self.once.extend(self.frames.last().map(|frame| frame.file));
                true
            }
            ["unroll_loop_start"] => {
                self.unroll(session, directive);
                true
            }
            ["STDGL" | "optimize" | "debug", ..] => false,
            _ => true,
        };
        if let (false, Some(first), Some(last)) = (understood, tokens.first(), tokens.last()) {
            let span = session.sources.join(first.span, last.span);
            let message = format!("the pragma `{}` is not understood and ignored", session.sources.snippet(span));
            session.report(Diagnostic::new(&codes::UNKNOWN_STDGL_PRAGMA, span, message));
        }
    }

    /// `#line line`, `#line line source-string-number`, macros expanded; both are constant expressions.
    fn line(&mut self, session: &mut ParseSession<'_>, span: Span) {
        let mut tokens = Vec::new();
        self.rest_of_line(session, &mut tokens);
        let end = tokens.last().map_or(span, |token| token.span).after();
        let tokens = self.expand_all(session, tokens);
        if std::mem::take(&mut self.broken_line) || self.stopped {
            return;
        }
        // `#line 7 "file"` is GL_GOOGLE_cpp_style_line_directive's; the name is not used.
        let named = self.extensions.contains(Extensions::INCLUDE)
            && tokens.last().is_some_and(|token| token.kind == TokenKind::Invalid);
        let numbers = tokens.split_last().filter(|_| named).map_or(tokens.as_slice(), |(_, numbers)| numbers);
        let Some(numbers) = self.line_numbers(session, numbers, end) else { return };
        let Some(&line) = numbers.first() else {
            let diagnostic = Diagnostic::new(&codes::MALFORMED_DIRECTIVE, span, "`#line` needs one or two integers")
                .help("write `#line LINE` or `#line LINE SOURCE_STRING_NUMBER`");
            session.report(diagnostic);
            return;
        };
        let small = |number: i64| u32::try_from(number.max(0)).unwrap_or(u32::MAX);
        // After the directive, the line number is one more than it says (§3.3); 3.30 says otherwise.
        let next = small(line).saturating_add(u32::from(!self.version.has(Feature::LineNumbersNext)));
        session.sources.renumber(span, next);
        if let (Some(&string), Some(frame)) = (numbers.get(1), self.frames.last_mut()) {
            frame.number = small(string);
        }
    }
}

/// Reports a directive that there is not. A misspelled one is read as the one that is meant.
fn unknown_directive(session: &mut ParseSession<'_>, token: Token, span: Span) -> Option<Directive> {
    let name = session.sources.snippet(token.span).to_owned();
    let near = did_you_mean(&name, DIRECTIVES.iter().map(|row| row.0));
    let of_engine = ENGINES.iter().find(|row| row.0 == name).map(|row| Advice::from(row.1));
    let help = of_engine.clone().or(near.map(|near| Advice::meant(format!("#{near}"))));
    let diagnostic =
        Diagnostic::new(&codes::UNKNOWN_DIRECTIVE, span, format!("there is no directive `#{name}`")).maybe_help(help);
    session.report(diagnostic);
    near.filter(|_| of_engine.is_none()).and_then(directive_named)
}
