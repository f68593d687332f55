//! Misspelled keywords: `unifrom vec4 a`, `whlie (true) {`, `retrun 1.0`.
//!
//! *In:* a name where no program has one. *Out:* a report with the keyword that is meant, which is then read in its place.
//! *Holds:* a text that could be valid is left as it is. *Not done here:* names that make a valid statement by themselves, such as
//! `retrun;`; the analysis knows that nobody declares them.

use super::keyword_names::is_operator;
use super::types::{is_qualifier, qualifier};
use super::{Parser, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};
use crate::syntax::ast::QualifierKind;
use crate::syntax::keywords::{Keyword, TABLE};
use crate::syntax::of_later_word;

/// Words that are names in 1.50 and qualifiers in a later version, with that version.
static LATER_QUALIFIERS: &[(&str, u16)] = &[
    ("patch", 400),
    ("sample", 400),
    ("subroutine", 400),
    ("coherent", 420),
    ("restrict", 420),
    ("readonly", 420),
    ("writeonly", 420),
    ("buffer", 430),
];

/// The keywords of statements with a condition in parentheses.
const WITH_CONDITION: &[TokenKind] = &[TokenKind::If, TokenKind::While, TokenKind::For, TokenKind::Switch];

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Reads a name where only a qualifier makes sense, and returns the qualifier that is meant.
    pub(super) fn unknown_qualifier(&mut self) -> Option<QualifierKind> {
        let name = self.session.spelling(self.current).to_owned();
        let message = format!("`{name}` is not a qualifier in this version");
        let finding = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, message)
            .here("expected a qualifier or a type");
        let later = LATER_QUALIFIERS.iter().find(|row| row.0 == name).map(|row| row.1);
        let help = later.map(|since| format!("`{name}` came with GLSL {}.{:02}", since / 100, since % 100));
        let precedes = |kind| is_qualifier(kind) && kind != TokenKind::Layout || kind == TokenKind::Precision;
        let meant = if later.is_some() { None } else { self.similar(precedes) };
        let advice = help.map(Advice::from).or_else(|| meant.map(|row| Advice::meant(row.spelling)));
        self.session.report(of_later_word(finding.maybe_help(advice), &name, self.session.version));
        self.bump();
        meant.and_then(|row| qualifier(row.kind))
    }

    /// Makes a name the keyword of a statement if nothing else can be meant.
    pub(super) fn correct_statement(&mut self) {
        let next = self.ahead(1);
        let behind_number = matches!(next.kind, TokenKind::Int | TokenKind::Uint | TokenKind::Float);
        let behind_constructor = next.kind == TokenKind::Type && self.ahead(2).kind == TokenKind::LeftParen;
        if next.kind == TokenKind::LeftParen {
            if self.has_condition() {
                self.correct(|kind| WITH_CONDITION.contains(&kind));
            }
        } else if (behind_number || behind_constructor || self.is_value_behind()) && !next.starts_line() {
            self.correct(|kind| kind == TokenKind::Return);
        } else if self.is_declaration_behind() && !next.starts_line() {
            self.correct_to("expected a qualifier or a type", |kind| is_qualifier(kind) && kind != TokenKind::Layout);
        }
    }

    /// Whether a name is next and behind it a declaration: `cosnt float a`.
    fn is_declaration_behind(&mut self) -> bool {
        let ty = self.ahead(1).kind;
        matches!(ty, TokenKind::Type | TokenKind::Ident) && self.ahead(2).kind == TokenKind::Ident
    }

    /// Makes a name in the braces of a `switch` the label that is meant: `csae 1:`, `defualt:`.
    pub(super) fn correct_label(&mut self) {
        use TokenKind::{Case, Colon, Default, Ident, Int, Uint};
        if self.kind() != Ident {
            return;
        }
        match (self.ahead(1).kind, self.ahead(2).kind) {
            (Int | Uint | Ident, Colon) => self.correct_to("expected a label or a statement", |kind| kind == Case),
            (Colon, _) => self.correct_to("expected a label or a statement", |kind| kind == Default),
            _ => {}
        }
    }

    /// Whether a name is next and behind it what can only be a value: `retrun x * 0.5`, `retrun a.b`, `retrun f(2.0)`, `retrun true`.
    fn is_value_behind(&mut self) -> bool {
        use TokenKind::*;
        match (self.ahead(1).kind, self.ahead(2).kind) {
            (True | False, _) | (Ident, Dot) => true,
            (Ident, LeftParen) => {
                let behind = self.past_bracket(2, LeftParen, RightParen);
                // Between the parentheses of a prototype there are names and types alone.
                let mut inner = (3..behind - 1).map(|at| self.ahead(at).kind);
                let computes = |kind| matches!(kind, Int | Uint | Float | Dot | LeftParen) || is_operator(kind);
                inner.any(computes) || is_operator(self.ahead(behind).kind)
            }
            (Ident, after) => is_operator(after) && after != Equal,
            _ => false,
        }
    }

    /// Makes a name after an `if` an `else` if nothing else can be meant.
    pub(super) fn correct_else(&mut self) {
        if self.kind() == TokenKind::Ident && matches!(self.ahead(1).kind, TokenKind::LeftBrace | TokenKind::If) {
            self.correct(|kind| kind == TokenKind::Else);
        }
    }

    /// Whether `name (..) {` or `name (int i ..` is next, which is no call.
    fn has_condition(&mut self) -> bool {
        let begins_loop = match self.ahead(2).kind {
            TokenKind::Semicolon => true,
            TokenKind::Type => self.ahead(3).kind == TokenKind::Ident,
            TokenKind::Ident => self.ahead(3).kind == TokenKind::Equal,
            _ => false,
        };
        let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
        let (last, next) = (self.ahead(behind - 1).kind, self.ahead(behind).kind);
        let is_header = last == TokenKind::RightParen && next == TokenKind::LeftBrace;
        is_header || begins_loop && next == TokenKind::Semicolon
    }

    /// Makes a name the keyword that begins `unifrom Light {` or `strcut Light {`, which nothing else does at global scope.
    pub(super) fn correct_block(&mut self) {
        use TokenKind::{Ident, In, LeftBrace, Out, Struct, Uniform};
        let is_outside = self.braces == 0 && !self.in_parameters;
        if is_outside && self.kind() == Ident && self.ahead(1).kind == Ident && self.ahead(2).kind == LeftBrace {
            self.correct_to("expected a qualifier or `struct`", |kind| matches!(kind, Uniform | In | Out | Struct));
        }
    }

    /// Makes a name the `layout` that begins `layot(location = 0) out vec4 a;`.
    pub(super) fn correct_layout(&mut self) {
        if self.braces == 0 && self.kind() == TokenKind::Ident && self.ahead(1).kind == TokenKind::LeftParen {
            let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
            if is_qualifier(self.ahead(behind).kind) {
                self.correct_to("expected a qualifier or a type", |kind| kind == TokenKind::Layout);
            }
        }
    }

    /// Reports a name that is similar to a keyword of a statement, and makes it that keyword.
    fn correct(&mut self, is_wanted: impl Fn(TokenKind) -> bool) {
        self.correct_to("expected a statement", is_wanted);
    }

    /// Reports a name that is similar to a keyword, and makes it that keyword.
    fn correct_to(&mut self, expected: &str, is_wanted: impl Fn(TokenKind) -> bool) {
        let Some(meant) = self.similar(is_wanted) else { return };
        let name = self.session.spelling(self.current).to_owned();
        let message = format!("`{name}` is not a keyword of GLSL");
        let finding = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, message)
            .here(expected)
            .help(Advice::meant(meant.spelling));
        self.session.report(finding);
        self.current = Token { kind: meant.kind, ..self.current };
    }

    /// The keyword of this version that is most similar to the next token.
    fn similar(&self, is_wanted: impl Fn(TokenKind) -> bool) -> Option<&'static Keyword> {
        let (version, extensions) = (self.session.version, self.session.extensions_at(self.current));
        let is_there = |row: &&Keyword| is_wanted(row.kind) && row.kind_in(version, extensions) == row.kind;
        if !self.session.may_suggest() {
            return None;
        }
        let words = TABLE.iter().filter(is_there).map(|row| row.spelling);
        let meant = did_you_mean(self.session.spelling(self.current), words)?;
        TABLE.iter().find(|row| row.spelling == meant)
    }
}
