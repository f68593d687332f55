//! Turns preprocessing tokens into tokens: distinguishes keywords from names, converts numbers to values, and reports
//! and drops what is not a token (GLSL 1.50 §3.1, §3.6, §4.1).

use super::directive::is_directive;
use super::{Feature, ParseSession, Preprocessor, Span, Token, TokenKind, codes, kind};
use crate::diagnostic::codes::syntax;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::syntax::lexer::QUOTES;
use crate::syntax::number::{self, Malformed, Numeral, NumeralWarning};
use crate::syntax::token::TokenFlags;

/// The most characters of a name in GLSL ES 3.00 (§3.9).
const LONGEST_NAME: usize = 1024;

impl Preprocessor<'_> {
    /// The token as the parser sees it; `None` if it is dropped.
    pub(super) fn finish_token(&mut self, session: &mut ParseSession<'_>, mut token: Token) -> Option<Token> {
        match token.kind {
            TokenKind::Word => {
                let word = self.word(token.symbol());
                token.kind = word.kind;
                if !std::mem::replace(&mut word.checked, true) {
                    self.check_word(session, token);
                }
            }
            TokenKind::Number => number(session, &mut token),
            TokenKind::Invalid if !token.flags.contains(TokenFlags::REPORTED) => {
                invalid_token(session, token);
                token.flags.insert(TokenFlags::REPORTED);
            }
            TokenKind::Unknown => {
                // A character that looks like one of the language replaces it, so that this is one error and not
                // many.
                let Some(kind) = illegal_character(session, token.span) else {
                    // Blanks of word processors leave nothing out.
                    self.dropped = !is_blank(session.sources.snippet(token.span));
                    return None;
                };
                token.kind = kind;
            }
            TokenKind::Hash | TokenKind::HashHash => {
                self.misplaced_hash(session, token);
                return None;
            }
            TokenKind::Eof => {
                self.at_end(session);
                return Some(self.end(token.span));
            }
            TokenKind::LeftBrace => {
                // Of all constructs with a brace at global scope, only a function has a `)` before it.
                self.in_function |= self.braces == 0 && self.last_kind == TokenKind::RightParen;
                self.braces += 1;
            }
            TokenKind::RightBrace => {
                self.braces = self.braces.saturating_sub(1);
                self.in_function &= self.braces > 0;
            }
            _ => {}
        }
        token
            .flags
            .set(TokenFlags::REPORTED, std::mem::take(&mut self.dropped) || token.flags.contains(TokenFlags::REPORTED));
        self.last_kind = token.kind;
        self.first_token.get_or_insert(token.span);
        token.extensions = self.extension_set;
        Some(token)
    }
}

impl Preprocessor<'_> {
    /// Reports a `#` inside of a line. The words behind it are a comment of another language, or a directive: they are no code.
    fn misplaced_hash(&mut self, session: &mut ParseSession<'_>, token: Token) {
        let message = format!("`{}` where no directive can be", token.kind.spelling());
        let diagnostic = Diagnostic::new(&codes::MISPLACED_HASH, token.span, message)
            .here("neither first on its line nor an operator");
        let help = words_help(rest_of_line(session, token));
        // In a macro's text or arguments, the rest of the line is not what follows.
        if help.is_some() && self.contexts.is_empty() {
            self.skip_line(session);
        }
        session.report(diagnostic.maybe_help(help));
        self.dropped = true;
    }

    /// Warns, once, about a reserved name, and reports one that is too long.
    fn check_word(&self, session: &mut ParseSession<'_>, token: Token) {
        self.check_length(session, token);
        let name = session.spelling(token);
        if name.contains("__") {
            let message = format!("the name `{name}` is reserved: it holds two underscores in a row");
            kind::RESERVED_NAME.report(session, self.strict, token.span, message);
        }
    }

    /// Reports a name, or that of a macro, that is longer than the language allows (GLSL ES 3.00 §3.5, §3.9).
    pub(super) fn check_length(&self, session: &mut ParseSession<'_>, name: Token) {
        let length = session.spelling(name).len();
        if length > LONGEST_NAME && self.version.has(Feature::ShortNames) {
            let message = format!("the name has {length} characters");
            let here = "a name has at most 1,024 characters";
            session.report(Diagnostic::new(&codes::NAME_TOO_LONG, name.span, message).here(here));
        }
    }
}

/// The text of a token's line behind it.
fn rest_of_line<'s>(session: &'s ParseSession<'_>, token: Token) -> &'s str {
    let line = session.sources.line_of(token.span).unwrap_or(token.span);
    session.sources.snippet(Span { start: token.span.end, end: line.end.max(token.span.end), ..token.span })
}

/// The help for a `#`, if words follow it.
fn words_help(rest: &str) -> Option<&'static str> {
    let word: String = rest.trim_start().chars().take_while(|letter| letter.is_alphanumeric()).collect();
    if is_directive(&word) {
        return Some("put the directive on a line of its own");
    }
    let is_apart = rest.starts_with([' ', '\t', '#']);
    let is_word = word.len() > 1 && word.starts_with(char::is_alphabetic);
    (is_word && (is_apart || !is_color(&word))).then_some("`//` begins a comment in GLSL")
}

/// Whether a word behind a `#` may be a color of a page.
fn is_color(word: &str) -> bool {
    matches!(word.len(), 3 | 4 | 6 | 8) && word.chars().all(|digit| digit.is_ascii_hexdigit())
}

fn number(session: &mut ParseSession<'_>, token: &mut Token) {
    match number::read(session.spelling(*token)) {
        Ok(Numeral { kind, bits, warning }) => {
            if let Some(warning) = warning {
                let text = session.spelling(*token).to_owned();
                let message = match warning {
                    NumeralWarning::Negative => {
                        format!("`{text}` is too large for an `int` and becomes {}", bits as i32)
                    }
                    NumeralWarning::Infinite => format!("`{text}` is too large for a `float` and becomes infinite"),
                };
                let help = (warning == NumeralWarning::Negative).then(|| match bits as i32 {
                    i32::MIN => format!("write `{text}u` for a `uint`"),
                    same => format!("write `{same}` for the same `int`, or `{text}u` for a `uint`"),
                });
                session.report(Diagnostic::new(&syntax::LITERAL_WRAPS, token.span, message).maybe_help(help));
            }
            (token.kind, token.payload) = (kind, bits);
        }
        Err(malformed) => {
            let text = session.spelling(*token).to_owned();
            session.report(malformed_number(&text, malformed, token.span));
            // It is a value of no known type.
            token.kind = TokenKind::Invalid;
            token.flags.insert(TokenFlags::REPORTED);
        }
    }
}

fn malformed_number(text: &str, malformed: Malformed, span: Span) -> Diagnostic {
    let wrong = |message: String| Diagnostic::new(&syntax::MALFORMED_NUMBER, span, message);
    match malformed {
        Malformed::TooLarge => {
            let message = format!("the integer `{text}` has more than 32 bits");
            Diagnostic::new(&syntax::INTEGER_TOO_LARGE, span, message).here("at most 4294967295")
        }
        Malformed::OctalDigit => wrong(format!("`{text}` is octal because of its leading 0 and cannot hold 8 or 9"))
            .help(decimal(text.trim_start_matches('0'))),
        Malformed::NoDigits => wrong(format!("`{text}` has no digits after its prefix")),
        Malformed::NoExponent => wrong(format!("`{text}` has no digits in its exponent")),
        Malformed::Suffix(at) => {
            let (number, suffix) = text.split_at_checked(at).unwrap_or((text, ""));
            let help = match suffix {
                "f" | "F" => {
                    let sentence = format!("write `{number}.0f` or `{number}.0`");
                    Some(Advice::new(Applicability::Safe, sentence, Place::Over, format!("{number}.0")))
                }
                "lf" | "LF" => {
                    let sentence = "doubles belong to GLSL 4.00; omit the suffix";
                    Some(Advice::new(Applicability::Unsafe, sentence, Place::Over, number))
                }
                _ => None,
            };
            wrong(format!("`{suffix}` is not a suffix of a number")).here(format!("in `{text}`")).maybe_help(help)
        }
    }
}

fn decimal(digits: &str) -> Advice {
    let sentence = format!("write `{digits}` for the decimal number");
    Advice::new(Applicability::Unsafe, sentence, Place::Over, digits)
}

/// Reports the first character of a token that GLSL does not have.
fn invalid_token(session: &mut ParseSession<'_>, token: Token) {
    let text = session.spelling(token);
    if text.starts_with(|first| QUOTES.iter().any(|pair| pair.0 == first)) {
        let diagnostic = Diagnostic::new(&codes::ILLEGAL_CHARACTER, token.span, "a string, and GLSL has none");
        session.report(diagnostic);
        return;
    }
    let at = text.find(|character: char| !character.is_ascii()).unwrap_or(0);
    let length = text.get(at..).and_then(|rest| rest.chars().next()).map_or(1, char::len_utf8);
    let start = token.span.start + at as u32;
    illegal_character(session, Span { start, end: start + length as u32, ..token.span });
}

/// Characters that word processors substitute for ASCII, and the tokens that they resemble.
static LOOK_ALIKES: &[(char, TokenKind)] = &[
    ('\u{2010}', TokenKind::Dash),
    ('\u{2011}', TokenKind::Dash),
    ('\u{2012}', TokenKind::Dash),
    ('\u{2013}', TokenKind::Dash),
    ('\u{2014}', TokenKind::Dash),
    ('\u{2212}', TokenKind::Dash),
    ('\u{00d7}', TokenKind::Star),
    ('\u{00f7}', TokenKind::Slash),
    ('\u{2264}', TokenKind::LessEqual),
    ('\u{2265}', TokenKind::GreaterEqual),
    ('\u{2260}', TokenKind::NotEqual),
    ('\u{037e}', TokenKind::Semicolon),
    ('\u{ff1b}', TokenKind::Semicolon),
    ('\u{ff0c}', TokenKind::Comma),
    ('\u{ff08}', TokenKind::LeftParen),
    ('\u{ff09}', TokenKind::RightParen),
];

/// Blanks that word processors and editors substitute for spaces, or put between characters, with what stands for them.
static BLANKS: &[(char, &str, &str)] = &[
    ('\u{00a0}', "a no-break space", " "),
    ('\u{2007}', "a figure space", " "),
    ('\u{2009}', "a thin space", " "),
    ('\u{202f}', "a narrow no-break space", " "),
    ('\u{3000}', "an ideographic space", " "),
    ('\u{200b}', "a zero width space", ""),
    ('\u{2060}', "a word joiner", ""),
    ('\u{feff}', "a byte order mark inside the source", ""),
];

fn is_blank(text: &str) -> bool {
    BLANKS.iter().any(|row| text.starts_with(row.0))
}

/// Reports a character. Returns the token that it resembles, if any.
fn illegal_character(session: &mut ParseSession<'_>, span: Span) -> Option<TokenKind> {
    let character = session.sources.snippet(span).chars().next().unwrap_or(char::REPLACEMENT_CHARACTER);
    if let Some((_, name, instead)) = BLANKS.iter().find(|row| row.0 == character) {
        let sentence = if instead.is_empty() { "leave it out" } else { "write a space" };
        let help = Advice::new(Applicability::Safe, sentence, Place::Over, *instead);
        let message = format!("{name} (U+{:04X})", character as u32);
        session.report(Diagnostic::new(&codes::ILLEGAL_CHARACTER, span, message).help(help));
        return None;
    }
    let (message, help) = match character {
        char::REPLACEMENT_CHARACTER => ("the source is not UTF-8 here".to_owned(), None),
        _ if QUOTES.iter().any(|pair| character == pair.0 || character == pair.1) => {
            (format!("`{character}` is not a character of GLSL"), Some("there are no strings in GLSL"))
        }
        '\\' => {
            ("`\\` is not a character of GLSL".to_owned(), Some("a backslash is only allowed at the end of a line"))
        }
        _ if character.is_control() => {
            (format!("the control character {:#04x} is not a character of GLSL", character as u32), None)
        }
        _ if character.is_ascii() => (format!("`{character}` is not a character of GLSL"), None),
        _ => (
            format!("`{character}` (U+{:04X}) is not a character of GLSL", character as u32),
            Some("outside comments, the language is ASCII"),
        ),
    };
    let meant = LOOK_ALIKES.iter().find(|row| row.0 == character).map(|row| row.1);
    let help = meant.map(|kind| Advice::write(Applicability::Safe, kind.spelling())).or(help.map(Advice::from));
    session.report(Diagnostic::new(&codes::ILLEGAL_CHARACTER, span, message).maybe_help(help));
    meant
}
