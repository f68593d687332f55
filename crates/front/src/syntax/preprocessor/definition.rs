//! [`Macro`]: a macro and what it expands to (GLSL 1.50 §3.3).

use super::{Names, ParseSession, Span, Symbol, Token, TokenFlags, TokenKind};
use std::sync::Arc;

/// The expansion of a macro.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// Its body.
    Body,
    /// `__LINE__`
    Line,
    /// `__FILE__`
    File,
}

/// A macro.
#[derive(Clone)]
pub(super) struct Macro {
    pub(super) name: Arc<str>,
    /// The name in its `#define`; unknown for predefined macros.
    pub(super) span: Span,
    pub(super) meaning: Meaning,
    /// The parameters of a function-like macro.
    pub(super) params: Option<Vec<Symbol>>,
    /// The body, in which uses of parameters have the kind [`TokenKind::Param`].
    pub(super) body: Arc<[Token]>,
    /// Whether `##` is in the body.
    pub(super) pastes: bool,
    /// Whether the body is being read.
    pub(super) disabled: bool,
}

impl Macro {
    /// A predefined macro that stands for a number.
    pub(super) fn number(names: &mut Names, name: &str, value: &str) -> Self {
        let mut token = Token::new(TokenKind::Number, Span::default());
        token.payload = names.intern(value).bits();
        Self {
            name: name.into(),
            span: Span::default(),
            meaning: Meaning::Body,
            params: None,
            body: Arc::new([token]),
            pastes: false,
            disabled: false,
        }
    }

    pub(super) fn is_predefined(&self) -> bool {
        !self.span.is_known()
    }

    /// Whether two definitions are the same by C's rule: equal tokens, with white space between the same ones.
    pub(super) fn same(&self, other: &Self, session: &ParseSession<'_>) -> bool {
        let spaced = |token: &Token, first: bool| !first && token.flags.contains(TokenFlags::SPACE);
        let text = |token: &Token| match token.kind {
            TokenKind::Unknown => session.sources.snippet(token.span).to_owned(),
            _ => String::new(),
        };
        self.params == other.params
            && self.body.len() == other.body.len()
            && self.body.iter().zip(other.body.iter()).enumerate().all(|(index, (a, b))| {
                a.kind == b.kind
                    && a.payload == b.payload
                    && spaced(a, index == 0) == spaced(b, index == 0)
                    && text(a) == text(b)
            })
    }
}
