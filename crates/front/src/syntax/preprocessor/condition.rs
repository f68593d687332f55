//! Evaluates the expressions of `#if` and `#elif` (GLSL 1.50 §3.3), with C++'s 64-bit integers.

use super::definition::Macro;
use super::{ParseSession, Preprocessor, Span, Token, TokenKind, codes, kind};
use crate::diagnostic::{Advice, Applicability, Code, Diagnostic, did_you_mean};

/// How deep parentheses and unary operators may nest in an `#if`.
const MAX_NESTING: usize = 64;

/// How many macros are compared with an undefined name, to suggest one.
pub(super) const MAX_COMPARED: usize = 4096;

/// The binding strength of a binary operator.
fn precedence(kind: TokenKind) -> Option<u8> {
    use TokenKind::*;
    Some(match kind {
        OrOr => 1,
        AndAnd => 2,
        VerticalBar => 3,
        Caret => 4,
        Ampersand => 5,
        EqualEqual | NotEqual => 6,
        LeftAngle | RightAngle | LessEqual | GreaterEqual => 7,
        LeftOp | RightOp => 8,
        Plus | Dash => 9,
        Star | Slash | Percent => 10,
        _ => return None,
    })
}

/// The error type of an expression whose error has been reported.
struct Malformed;

/// The directive that an expression belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Purpose {
    /// `#if`, `#elif`
    Condition,
    /// `#line`
    Line,
}

impl Purpose {
    fn code(self) -> &'static Code {
        match self {
            Self::Condition => &codes::MALFORMED_CONDITION,
            Self::Line => &codes::MALFORMED_DIRECTIVE,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Condition => "the condition",
            Self::Line => "the `#line`",
        }
    }
}

struct Evaluator<'t> {
    tokens: &'t [Token],
    next: usize,
    purpose: Purpose,
    /// The end of the line, where something may be missing.
    end: Span,
    strict: bool,
    nesting: usize,
    /// Greater than zero inside an operand whose value does not matter: undefined names and divisions by zero are not
    /// reported.
    unevaluated: usize,
    /// All macros, for "did you mean".
    macros: &'t [Macro],
}

impl Preprocessor<'_> {
    /// Reads and evaluates the rest of an `#if` or `#elif` line. Returns false if it is malformed.
    pub(super) fn condition(&mut self, session: &mut ParseSession<'_>, directive: Span) -> bool {
        let mut line = Vec::new();
        self.rest_of_line(session, &mut line);
        let end = line.last().map_or(directive, |token| token.span).after();
        let Some(tokens) = self.expand_condition(session, line) else { return false };
        if std::mem::take(&mut self.broken_line) {
            return false;
        }
        if tokens.is_empty() {
            if !self.stopped {
                let diagnostic = Diagnostic::new(&codes::MALFORMED_CONDITION, directive, "the condition is empty")
                    .here("an expression must follow this");
                session.report(diagnostic);
            }
            return false;
        }
        match self.evaluator(&tokens, end, Purpose::Condition).whole(session) {
            Ok(value) => value != 0,
            Err(Malformed) => false,
        }
    }

    /// The constant expressions of a `#line`, one after the other; `None` after an error.
    pub(super) fn line_numbers(&self, session: &mut ParseSession<'_>, tokens: &[Token], end: Span) -> Option<Vec<i64>> {
        let mut evaluator = self.evaluator(tokens, end, Purpose::Line);
        let mut numbers = Vec::new();
        while evaluator.peek().is_some() && numbers.len() < 2 {
            numbers.push(evaluator.binary(session, 1).ok()?);
        }
        match evaluator.peek() {
            None => Some(numbers),
            other => evaluator.fail(session, other, "`#line` takes a line and a number of the source").ok(),
        }
    }

    fn evaluator<'t>(&'t self, tokens: &'t [Token], end: Span, purpose: Purpose) -> Evaluator<'t> {
        let strict = self.strict;
        Evaluator { tokens, next: 0, end, purpose, strict, nesting: 0, unevaluated: 0, macros: &self.macros }
    }

    /// Expands the macros of the line and replaces `defined`.
    fn expand_condition(&mut self, session: &mut ParseSession<'_>, line: Vec<Token>) -> Option<Vec<Token>> {
        let floor = self.contexts.len();
        self.contexts.push(super::expand::TokenRun::barrier(line));
        let mut tokens = Vec::new();
        let mut result = Some(());
        while !self.stopped && result.is_some() {
            let token = self.next_expanded(session);
            match token.kind {
                TokenKind::Eof => break,
                TokenKind::Word if session.spelling(token) == "defined" => {
                    result = self.defined(session, token).map(|number| tokens.push(number));
                }
                _ => tokens.push(token),
            }
        }
        while self.contexts.len() > floor {
            self.pop_context();
        }
        result.map(|()| tokens)
    }

    /// `defined NAME` or `defined(NAME)`, as a number.
    fn defined(&mut self, session: &mut ParseSession<'_>, operator: Token) -> Option<Token> {
        let mut token = self.next_unexpanded(session, true);
        let bracket = token.kind == TokenKind::LeftParen;
        if bracket {
            token = self.next_unexpanded(session, true);
        }
        let name = token;
        let closed = !bracket || self.next_unexpanded(session, true).kind == TokenKind::RightParen;
        if name.kind != TokenKind::Word || !closed {
            let diagnostic = Diagnostic::new(&codes::MALFORMED_CONDITION, operator.span, "`defined` needs a name")
                .help("write `defined(NAME)` or `defined NAME`");
            session.report(diagnostic);
            return None;
        }
        self.mention(name);
        let value = if self.macro_of(name.symbol()).is_some() { "1" } else { "0" };
        let mut number = Token::new(TokenKind::Number, operator.span);
        number.payload = session.names.intern(value).bits();
        Some(number)
    }
}

impl Evaluator<'_> {
    fn peek(&self) -> Option<Token> {
        self.tokens.get(self.next).copied()
    }

    fn fail<T>(&self, session: &mut ParseSession<'_>, token: Option<Token>, message: &str) -> Result<T, Malformed> {
        let span = token.map_or(self.end, |token| token.span);
        let found = token.map_or("the line ends here".to_owned(), |token| {
            format!("found `{}`", session.sources.snippet(token.span))
        });
        let mut diagnostic = Diagnostic::new(self.purpose.code(), span, message).here(found);
        if self.purpose == Purpose::Line {
            diagnostic = diagnostic.help("write `#line LINE` or `#line LINE SOURCE_STRING_NUMBER`");
        }
        session.report(diagnostic);
        Err(Malformed)
    }

    fn whole(&mut self, session: &mut ParseSession<'_>) -> Result<i64, Malformed> {
        let value = self.binary(session, 1)?;
        match self.peek() {
            None => Ok(value),
            Some(token) if token.kind == TokenKind::LeftParen => self.fail(
                session,
                Some(token),
                "a condition cannot call: the name before the parenthesis is not a macro",
            ),
            other => self.fail(session, other, "expected an operator in the condition"),
        }
    }

    /// Operands joined by operators that bind at least as strongly as `least`.
    fn binary(&mut self, session: &mut ParseSession<'_>, least: u8) -> Result<i64, Malformed> {
        let mut left = self.unary(session)?;
        while let Some(operator) = self.peek() {
            let Some(strength) = precedence(operator.kind).filter(|&strength| strength >= least) else { break };
            self.next += 1;
            let skip = matches!((operator.kind, left), (TokenKind::AndAnd, 0))
                || (operator.kind == TokenKind::OrOr && left != 0);
            self.unevaluated += usize::from(skip);
            let right = self.binary(session, strength + 1);
            self.unevaluated -= usize::from(skip);
            left = self.apply(session, operator, left, right?)?;
        }
        Ok(left)
    }

    fn apply(&self, session: &mut ParseSession<'_>, operator: Token, a: i64, b: i64) -> Result<i64, Malformed> {
        use TokenKind::*;
        if matches!(operator.kind, Slash | Percent) && b == 0 {
            if self.unevaluated == 0 {
                let message = format!("{} divides by zero", self.purpose.name());
                session.report(Diagnostic::new(&codes::DIVISION_BY_ZERO_IN_CONDITION, operator.span, message));
                return Err(Malformed);
            }
            return Ok(0);
        }
        // In C++ a shift by more than the width has no value; here the low bits of the distance count.
        let shift = (b & 63) as u32;
        Ok(match operator.kind {
            OrOr => i64::from(a != 0 || b != 0),
            AndAnd => i64::from(a != 0 && b != 0),
            VerticalBar => a | b,
            Caret => a ^ b,
            Ampersand => a & b,
            EqualEqual => i64::from(a == b),
            NotEqual => i64::from(a != b),
            LeftAngle => i64::from(a < b),
            RightAngle => i64::from(a > b),
            LessEqual => i64::from(a <= b),
            GreaterEqual => i64::from(a >= b),
            LeftOp => a.wrapping_shl(shift),
            RightOp => a.wrapping_shr(shift),
            Plus => a.wrapping_add(b),
            Dash => a.wrapping_sub(b),
            Star => a.wrapping_mul(b),
            Slash => a.wrapping_div(b),
            _ => a.wrapping_rem(b),
        })
    }

    fn unary(&mut self, session: &mut ParseSession<'_>) -> Result<i64, Malformed> {
        let Some(token) = self.peek() else {
            return self.fail(session, None, &format!("expected an operand in {}", self.purpose.name()));
        };
        self.next += 1;
        match token.kind {
            TokenKind::Plus => self.nested(session, token, Self::unary),
            TokenKind::Dash => Ok(self.nested(session, token, Self::unary)?.wrapping_neg()),
            TokenKind::Tilde => Ok(!self.nested(session, token, Self::unary)?),
            TokenKind::Bang => Ok(i64::from(self.nested(session, token, Self::unary)? == 0)),
            TokenKind::LeftParen => {
                let value = self.nested(session, token, |this, session| this.binary(session, 1))?;
                match self.peek() {
                    Some(closing) if closing.kind == TokenKind::RightParen => self.next += 1,
                    other => return self.fail(session, other, &format!("expected `)` in {}", self.purpose.name())),
                }
                Ok(value)
            }
            TokenKind::Number => self.number(session, token),
            TokenKind::Word => self.undefined(session, token),
            _ => self.fail(session, Some(token), &format!("expected an operand in {}", self.purpose.name())),
        }
    }

    fn nested(
        &mut self,
        session: &mut ParseSession<'_>,
        token: Token,
        inner: impl FnOnce(&mut Self, &mut ParseSession<'_>) -> Result<i64, Malformed>,
    ) -> Result<i64, Malformed> {
        if self.nesting >= MAX_NESTING {
            let message = format!("{} nests more than {MAX_NESTING} levels deep", self.purpose.name());
            session.report(Diagnostic::new(&crate::diagnostic::codes::general::TOO_DEEP, token.span, message));
            return Err(Malformed);
        }
        self.nesting += 1;
        let value = inner(self, session);
        self.nesting -= 1;
        value
    }

    fn number(&self, session: &mut ParseSession<'_>, token: Token) -> Result<i64, Malformed> {
        let text = session.spelling(token);
        let digits = text.trim_end_matches(['u', 'U', 'l', 'L']);
        let (radix, digits) = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
            Some(digits) => (16, digits),
            None if digits.len() > 1 && digits.starts_with('0') => (8, digits),
            None => (10, digits),
        };
        match u64::from_str_radix(digits, radix) {
            Ok(value) => Ok(value as i64),
            Err(_) => self.fail(session, Some(token), &format!("{} is made of integers", self.purpose.name())),
        }
    }

    /// The help text for an undefined name, the last token read: the text to write in its place, if there it is only true
    /// or false; otherwise a definition that gives it the value that it has now.
    fn guarded(&self, name: &str) -> Advice {
        let at = self.next.saturating_sub(1);
        let before = at.checked_sub(1).and_then(|before| self.tokens.get(before)).map(|token| token.kind);
        let after = self.tokens.get(self.next).map(|token| token.kind);
        let starts = matches!(before, None | Some(TokenKind::LeftParen | TokenKind::AndAnd | TokenKind::OrOr));
        let ends = matches!(after, None | Some(TokenKind::RightParen | TokenKind::AndAnd | TokenKind::OrOr));
        // `(NAME) > 2`: the parentheses belong to the operand.
        let alone = before == Some(TokenKind::LeftParen) && after == Some(TokenKind::RightParen);
        let outside = |index: Option<usize>| index.and_then(|index| self.tokens.get(index)).map(|token| token.kind);
        let compared = [outside(at.checked_sub(2)), outside(Some(self.next + 1))];
        let is_value = |kind: &Option<TokenKind>| {
            kind.is_some_and(|kind| precedence(kind).is_some_and(|strength| strength > 2) || kind == TokenKind::Tilde)
        };
        if ends && before == Some(TokenKind::Bang) {
            Advice::write(Applicability::Safe, format!("(defined({name}) && {name})"))
        } else if starts && ends && !(alone && compared.iter().any(is_value)) {
            Advice::write(Applicability::Safe, format!("defined({name}) && {name}"))
        } else {
            format!("define it before, as `#ifndef {name}`, `#define {name} 0`, `#endif` on lines of their own").into()
        }
    }

    /// Handles a name that is not a macro.
    fn undefined(&self, session: &mut ParseSession<'_>, token: Token) -> Result<i64, Malformed> {
        let name = session.spelling(token).to_owned();
        if self.purpose == Purpose::Line {
            return self.fail(session, Some(token), &format!("`{name}` is not a number"));
        }
        if self.peek().is_some_and(|next| next.kind == TokenKind::LeftParen) {
            return self.fail(session, Some(token), &format!("`{name}` is not a macro with arguments"));
        }
        if self.unevaluated == 0 {
            // A macro with arguments does not stand alone, and two short names are similar by chance.
            let similar = |definition: &&Macro| definition.params.is_none() && definition.name.len() > 2;
            let names = self.macros.iter().filter(similar).map(|definition| &*definition.name);
            let few = self.macros.len() <= MAX_COMPARED;
            let near = if few && session.may_suggest() { did_you_mean(&name, names) } else { None };
            // "Undefined identifiers .. do not default to '0'. Use of such identifiers causes an error" (GLSL ES 1.00 §3.4).
            let version = session.version;
            let message = match kind::UNDEFINED_IN_CONDITION.is_refused(version) {
                true => format!("`{name}` is not defined, and a condition in {} has no value for it", version.name()),
                false => format!("`{name}` is not defined and counts as 0"),
            };
            let help = match near {
                Some(near) => Advice::meant(near),
                None => self.guarded(&name),
            };
            let diagnostic = kind::UNDEFINED_IN_CONDITION.judged(version, self.strict, token.span, message);
            session.report(diagnostic.help(help));
        }
        Ok(0)
    }
}
