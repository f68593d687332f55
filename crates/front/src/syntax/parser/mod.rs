//! [`Parser`] turns tokens into a tree by recursive descent, by the grammar of GLSL 1.50 §9 and
//! ARB_shading_language_420pack.
//!
//! *In:* a [`TokenSource`]. *Out:* an [`Ast`] of what was understood, and diagnostics.
//!
//! The parser keeps no table of type names: two names in a row begin a declaration, and `S(x)` is a call of something
//! named `S`. An error ends the statement, member or declaration around it ([`recover`]), at the latest before a line that begins another
//! one ([`layout`]). What was read of it is kept ([`fragment`]), and parsing goes on after that.
//!
//! *Holds:* every error is reported once, where it is found, and then propagated as [`Reported`]. [`MAX_NESTING`]
//! bounds the nesting, both of the parser's own calls and of the expressions that it builds. A chain of left operands
//! counts as one level.

mod declaration;
mod expr;
mod foreign;
mod fragment;
mod head;
mod keyword_names;
mod layout;
mod misspelled;
mod place;
mod recover;
mod statement;
#[cfg(test)]
mod tests;
mod types;

use super::ast::{Ast, BinaryOp, ExprId, Ident, VariableDecl};
use super::keywords::TABLE;
use super::of_later_word;
use super::session::{ParseSession, TokenSource};
use super::token::{Token, TokenFlags, TokenKind};
use crate::diagnostic::codes::{general, syntax as codes};
use crate::diagnostic::{Advice, Applicability, Code, Diagnostic, Place};
use crate::language::NEVER;
use crate::source::Span;
use crate::stack::with_stack;
use place::{Seams, Start};
use rustc_hash::FxHashSet;
use std::collections::VecDeque;

/// The deepest nesting of expressions, blocks, lists and types.
pub(super) const MAX_NESTING: u32 = 256;

/// How deep the stack of [`Parser::translation_unit`] is used; deeper nesting gets a stack of its own.
const SHALLOW: u32 = 96;

/// The error type of an error that has been reported.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reported;

/// The result of a production.
type Parse<T> = Result<T, Reported>;

/// The start of a statement, member or declaration, for recovery.
#[derive(Clone, Copy, Debug)]
struct Mark {
    consumed: usize,
    braces: i32,
    /// The number of expressions.
    exprs: usize,
}

/// The text up to a `}` that closes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Between {
    /// Declarations alone, if anything.
    Declarations,
    /// A statement that is no declaration, among others.
    Statements,
}

/// The state of a parse.
pub(super) struct Parser<'p, 's, T: TokenSource> {
    source: &'p mut T,
    session: &'p mut ParseSession<'s>,
    ast: Ast,
    current: Token,
    ahead: VecDeque<Token>,
    previous: Token,
    /// The number of tokens read so far, to make sure that recovery advances.
    consumed: usize,
    /// The number of braces that are open.
    braces: i32,
    nesting: u32,
    /// The depth of each expression (see the module's documentation).
    depths: Vec<u16>,
    /// The beginning of each expression.
    starts: Vec<Start>,
    seams: Seams,
    /// Operators that wait for their right operand.
    operators: Vec<(BinaryOp, Span, ExprId)>,
    /// Reserved words that were used as names. That was reported; from then on they are names.
    renamed: FxHashSet<u32>,
    /// Keywords that were declared as names ([`keyword_names`]).
    keyword_names: FxHashSet<u32>,
    /// Whether the declaration that was just read ends at a comma, as if that were its `;`.
    assumed_semicolon: bool,
    /// Whether an unexpected end of file has been reported.
    end_reported: bool,
    /// Whether a function begins inside a function: the outer body ends as if its brace were there.
    leaving_function: bool,
    /// Whether each brace of the file has its partner, once they have been counted.
    paired: Option<bool>,
    /// How many tokens were looked at to find braces that close nothing.
    sought: usize,
    /// Whether the error that is being propagated leaves nothing to skip.
    recovered: bool,
    /// The tokens to which the parser went back. It goes back to none twice, so it ends.
    returned_to: FxHashSet<Span>,
    /// Whether something nests too deeply: the rest of the block around it is skipped.
    overdeep: bool,
    /// Whether a closing brace was assumed for that reason.
    assumed_brace: bool,
    /// The number of braces around the last `case` that is in no `switch`.
    labelled: Option<i32>,
    /// The variables that the current declaration has named so far.
    declaring: Vec<Ident>,
    /// The current declaration of variables, if it is broken.
    unfinished: Option<VariableDecl>,
    /// The tokens of the current statement or declaration that have been read, back to the last statement inside of it.
    taken: Vec<Token>,
    /// How many expressions there were when the last statement ended.
    settled: usize,
    /// Whether the parameters of a function are read.
    in_parameters: bool,
    /// The opening brace of the current function.
    function_brace: Span,
    strict: bool,
}

impl<'p, 's, T: TokenSource> Parser<'p, 's, T> {
    /// A parser that reads from `source` into `ast`.
    pub(super) fn new(source: &'p mut T, session: &'p mut ParseSession<'s>, ast: Ast, strict: bool) -> Self {
        let current = source.next(session);
        Self {
            source,
            session,
            ast,
            current,
            ahead: VecDeque::new(),
            previous: Token::new(TokenKind::Eof, Span::default()),
            consumed: 0,
            braces: 0,
            nesting: 0,
            depths: Vec::new(),
            starts: Vec::new(),
            seams: Seams::default(),
            operators: Vec::new(),
            renamed: FxHashSet::default(),
            keyword_names: FxHashSet::default(),
            assumed_semicolon: false,
            end_reported: false,
            leaving_function: false,
            paired: None,
            sought: 0,
            recovered: false,
            returned_to: FxHashSet::default(),
            overdeep: false,
            assumed_brace: false,
            labelled: None,
            declaring: Vec::new(),
            unfinished: None,
            taken: Vec::new(),
            settled: 0,
            in_parameters: false,
            function_brace: Span::default(),
            strict,
        }
    }

    /// translation_unit: parses everything.
    pub(super) fn translation_unit(mut self) -> Ast {
        with_stack(SHALLOW, || {
            while self.current.kind != TokenKind::Eof && !self.session.diagnostics.is_full() {
                self.external_declaration();
            }
        });
        self.ast
    }

    /// The kind of the next token.
    fn kind(&self) -> TokenKind {
        self.current.kind
    }

    fn fetch(&mut self) -> Token {
        let mut token = self.source.next(self.session);
        if !self.renamed.is_empty() {
            self.rename(&mut token);
        }
        token
    }

    fn rename(&self, token: &mut Token) {
        if is_word(token.kind) && self.renamed.contains(&token.payload) {
            token.kind = TokenKind::Ident;
        }
    }

    /// The token `n` places after the next one.
    fn ahead(&mut self, n: usize) -> Token {
        if n == 0 {
            return self.current;
        }
        while self.ahead.len() < n {
            let token = self.fetch();
            self.ahead.push_back(token);
        }
        self.ahead.get(n - 1).copied().unwrap_or(self.current)
    }

    /// Reads the next token.
    fn bump(&mut self) -> Token {
        let token = self.current;
        self.taken.push(token);
        self.previous = token;
        self.consumed += 1;
        match token.kind {
            TokenKind::LeftBrace => self.braces += 1,
            TokenKind::RightBrace => self.braces -= 1,
            _ => {}
        }
        self.current = match self.ahead.pop_front() {
            Some(token) => token,
            None => self.fetch(),
        };
        self.note_seam();
        if !self.keyword_names.is_empty() {
            self.name_keyword();
        }
        token
    }

    /// Reads the next token if it has this kind.
    fn eat(&mut self, kind: TokenKind) -> Option<Token> {
        (self.kind() == kind).then(|| self.bump())
    }

    /// Reads a token of this kind, or reports what was expected.
    fn expect(&mut self, kind: TokenKind) -> Parse<Token> {
        if self.kind() == kind { Ok(self.bump()) } else { Err(self.unexpected(&format!("`{}`", kind.spelling()))) }
    }

    /// Reads the bracket that closes `opening`; `expected` names what else could follow here.
    fn close(&mut self, opening: Token, kind: TokenKind, expected: &str) -> Parse<Token> {
        if self.kind() == kind {
            return Ok(self.bump());
        }
        let ends =
            matches!(self.kind(), TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace | TokenKind::Eof);
        if !ends {
            return Err(self.unexpected(expected));
        }
        if let Some(reported) = self.left_unfinished(expected) {
            return Err(reported);
        }
        let diagnostic = layout::unclosed(opening, self.behind());
        let diagnostic = match self.open_in_macro() {
            Some((span, name)) => diagnostic.label(span, format!("the macro `{name}` does not close this")),
            None => diagnostic,
        };
        Err(self.report_found(diagnostic))
    }

    /// Reads the `;` after `what`. A missing one at the end of a line is reported and assumed.
    fn semicolon(&mut self, what: &str) -> Parse<()> {
        if std::mem::take(&mut self.assumed_semicolon) || self.eat(TokenKind::Semicolon).is_some() {
            return Ok(());
        }
        let forgotten = self.current.starts_line() || matches!(self.kind(), TokenKind::RightBrace | TokenKind::Eof);
        if !forgotten {
            return Err(self.unexpected(&format!("`;` after {what}")));
        }
        // An operator may be what is missing: `x = a * b`, and the next line is `d * a;`.
        let is_sure = !self.current.starts_line()
            || matches!(self.kind(), TokenKind::RightBrace | TokenKind::Eof)
            || self.begins_another(self.taken.len());
        let applicability = if is_sure { Applicability::Safe } else { Applicability::Unsafe };
        let message = format!("`;` is missing after {what}");
        let diagnostic = Diagnostic::new(&codes::MISSING_SEMICOLON, self.behind(), message)
            .here("expected `;`")
            .help(Advice::new(applicability, "write `;` here", Place::Before, ";"));
        // A brace that is missing, too, at the end of the file is another error.
        let end_reported = self.end_reported;
        let _: Reported = self.report_found(diagnostic);
        self.end_reported = end_reported;
        Ok(())
    }

    /// identifier, called `what` in messages. A keyword or reserved word in its place is reported and taken as a
    /// name.
    fn ident(&mut self, what: &str) -> Parse<Ident> {
        let token = self.current;
        match token.kind {
            // A malformed number is a value.
            TokenKind::Invalid if self.session.spelling(token).starts_with(|first: char| first.is_ascii_digit()) => {
                return Err(self.unexpected(what));
            }
            TokenKind::Ident | TokenKind::Invalid => {}
            TokenKind::Reserved => self.report_reserved(token, what),
            kind if is_word(kind) && !(token.starts_line() && self.consumed > 0) => self.keyword_as_name(token, what),
            _ => return Err(self.unexpected(what)),
        }
        self.bump();
        Ok(Ident { symbol: token.symbol(), span: token.span })
    }

    fn report_reserved(&mut self, token: Token, what: &str) {
        let name = self.session.spelling(token).to_owned();
        let message = format!("the reserved word `{name}` cannot be {what}");
        let since = TABLE.iter().find(|row| row.spelling == name).map_or(NEVER, |row| row.keyword.desktop);
        let mut diagnostic =
            Diagnostic::new(&codes::RESERVED_WORD, token.span, message).here("reserved for later versions");
        if since != NEVER {
            diagnostic =
                diagnostic.note(format!("`{name}` is a keyword from GLSL {}.{:02} on", since / 100, since % 100));
        }
        self.session.report(diagnostic);
        self.take_as_name(token);
    }

    /// Makes a word a name from here on, so that it is reported only once.
    fn take_as_name(&mut self, token: Token) {
        self.renamed.insert(token.payload);
        let mut ahead = std::mem::take(&mut self.ahead);
        for token in &mut ahead {
            self.rename(token);
        }
        self.ahead = ahead;
    }

    /// Reports that something else was expected.
    fn unexpected(&mut self, expected: &str) -> Reported {
        if self.current.flags.contains(TokenFlags::REPORTED) {
            return Reported;
        }
        let found = self.describe(self.current);
        let diagnostic =
            Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, format!("expected {expected}, found {found}"))
                .here(format!("expected {expected}"));
        let word = self.session.spelling(self.current);
        let diagnostic = of_later_word(diagnostic, word, self.session.version);
        let diagnostic = self.blame_macro(diagnostic);
        if diagnostic.code.id == codes::UNEXPECTED_TOKEN.id
            && let Some(reported) = self.left_unfinished(expected)
        {
            return reported;
        }
        self.report_found(diagnostic)
    }

    /// Names the macro that is the reason: its `;` ended a statement, as in `#define PI 3.14;`, or a blank before its `(` took its
    /// parameters away, as in `#define SQ (x) x * x`.
    fn blame_macro(&self, diagnostic: Diagnostic) -> Diagnostic {
        let span = self.previous.span;
        let is_elsewhere = self.previous.kind == TokenKind::Semicolon && self.current.span.expansion != span.expansion;
        let Some(expansion) = self.session.sources.expansion(span.expansion).filter(|_| is_elsewhere) else {
            return self.blame_blank(diagnostic);
        };
        let written = Span::new(span.start, span.end);
        diagnostic
            .label(written, format!("the macro `{}` has this `;`", expansion.name))
            .help("leave the `;` out of the macro")
    }

    fn blame_blank(&self, diagnostic: Diagnostic) -> Diagnostic {
        let sources = &self.session.sources;
        let Some(expansion) = sources.expansion(self.current.span.expansion) else { return diagnostic };
        let behind = |span: Span, text: &str| {
            sources.snippet(Span { start: span.end, end: span.end + text.len() as u32, ..span }) == text
        };
        let (name, call, definition) = (&expansion.name, expansion.call, expansion.definition);
        let is_plain = sources.snippet(call) == &**name;
        if self.previous.kind == TokenKind::RightParen && is_plain && behind(call, "(") && behind(definition, " (") {
            return diagnostic.help(format!("`{name}` has no parameters: write their `(` right behind its name"));
        }
        diagnostic
    }

    /// Reports an error at the next token, unless the tokens ended because of an error that has been reported. The
    /// end of the file is reported once.
    fn report_found(&mut self, diagnostic: Diagnostic) -> Reported {
        if self.kind() == TokenKind::Eof {
            if self.end_reported || self.current.payload != 0 {
                return Reported;
            }
            self.end_reported = true;
        }
        self.session.report(diagnostic);
        Reported
    }

    fn report(&mut self, code: &'static Code, span: Span, message: impl Into<String>) {
        self.session.report(Diagnostic::new(code, span, message));
    }

    /// A token in words, for a message.
    fn describe(&self, token: Token) -> String {
        match token.kind {
            TokenKind::Eof => "the end of the file".to_owned(),
            kind if is_word(kind) => {
                let name = self.session.spelling(token).to_owned();
                match kind {
                    TokenKind::Ident | TokenKind::Invalid => format!("`{name}`"),
                    TokenKind::Reserved => format!("the reserved word `{name}`"),
                    _ => format!("the keyword `{name}`"),
                }
            }
            TokenKind::Int | TokenKind::Uint | TokenKind::Float => {
                format!("`{}`", self.session.sources.snippet(token.span))
            }
            kind => format!("`{}`", kind.spelling()),
        }
    }

    /// The position before the next token.
    fn mark(&self) -> Mark {
        Mark { consumed: self.consumed, braces: self.braces, exprs: self.n_exprs() }
    }

    /// Runs a production one level deeper.
    fn nested<R: Send>(&mut self, production: impl FnOnce(&mut Self) -> Parse<R> + Send) -> Parse<R> {
        if self.nesting >= MAX_NESTING {
            return Err(self.too_deep(self.current.span));
        }
        self.nesting += 1;
        let result =
            if self.nesting == SHALLOW { with_stack(MAX_NESTING, || production(self)) } else { production(self) };
        self.nesting -= 1;
        result
    }

    fn too_deep(&mut self, span: Span) -> Reported {
        self.overdeep = true;
        self.report(&general::TOO_DEEP, span, format!("the source nests more than {MAX_NESTING} levels deep"));
        Reported
    }
}

/// Whether tokens of a kind are words, whose payload is a symbol.
fn is_word(kind: TokenKind) -> bool {
    use TokenKind::*;
    (matches!(kind, Ident | Invalid | Reserved | Type | True | False | Void) || kind as u8 >= Attribute as u8)
        && (kind as u8) < LeftParen as u8
}
