//! Where constructs begin and end in the text, also where macros put their tokens together.
//!
//! *In:* the tokens as they are read. *Out:* the [`Span`] from a [`Start`] to the last token, and the place behind a token, where something is
//! missing. *Holds:* a span whose text is not what was read is [scattered](Span::scattered): in `#define REV(a, b) b - a`, no text of
//! `REV(n, 1)` is the difference alone, and in `#define SUM 1 + 2`, none of `SUM * 3` is the product.

use super::{Parser, TokenSource};
use crate::source::Span;

/// The beginning of a construct.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// Its first token.
    pub(super) span: Span,
    /// The token before it.
    before: Span,
    /// The number of seams up to it.
    seams: u32,
}

/// The places where the next token does not follow in the text: another macro or argument begins there, or a comment is between.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Seams {
    /// How many there are before the next token.
    here: u32,
    /// How many there are before the last token read.
    before: u32,
}

impl<T: TokenSource> Parser<'_, '_, T> {
    /// The beginning of the construct whose first token is the next one.
    pub(super) fn start(&self) -> Start {
        Start { span: self.current.span, before: self.previous.span, seams: self.seams.here }
    }

    /// Notes whether there is a seam before the next token.
    pub(super) fn note_seam(&mut self) {
        self.seams.before = self.seams.here;
        let sources = &self.session.sources;
        let (last, next) = (self.previous.span, self.current.span);
        let follows = || {
            let gap = Span { start: last.end, end: next.start, ..next };
            let is_blank = || sources.snippet(gap).bytes().all(|byte| byte.is_ascii_whitespace());
            last.expansion == next.expansion && last.end <= next.start && (last.end == next.start || is_blank())
        };
        if sources.has_uses() && !follows() {
            self.seams.here += 1;
        }
    }

    /// The span from a beginning to the last token read.
    pub(super) fn since(&self, start: Start) -> Span {
        let sources = &self.session.sources;
        let (first, last) = (start.span, self.previous.span);
        let is_in_body = first.expansion.is_some() && first.expansion == last.expansion;
        if start.seams == self.seams.before || is_in_body && first.start <= last.start {
            return sources.join(first, last);
        }
        let (from, to) = (sources.use_around(first), sources.use_around(last));
        if from.is_some() && from == to {
            let are_arguments = !first.expansion.is_some() && !last.expansion.is_some() && first.start <= last.start;
            let span = if are_arguments { sources.join(first, last) } else { from.unwrap_or(first) };
            return span.scattered();
        }
        let begins = from.is_none() || sources.use_around(start.before) != from;
        let ends = to.is_none() || sources.use_around(self.current.span) != to;
        let span = sources.join(from.unwrap_or(first), to.unwrap_or(last));
        if begins && ends { span } else { span.scattered() }
    }

    /// The place behind the last token read, where something is missing: behind the macro use that ends with it.
    pub(super) fn behind(&self) -> Span {
        self.between(self.previous.span, self.current.span)
    }

    /// The place behind a token, before the one that follows it.
    pub(super) fn between(&self, token: Span, next: Span) -> Span {
        let sources = &self.session.sources;
        match sources.use_around(token) {
            None => token.after(),
            Some(whole) if sources.use_around(next) != Some(whole) => whole.after(),
            Some(_) => token.after().scattered(),
        }
    }
}
