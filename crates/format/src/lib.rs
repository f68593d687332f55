//! Formats GLSL: one style for blanks, indentation and the places where lines end.
//!
//! *In:* the text of a source of any version, an include or a fragment. *Out:* [`Formatted`]: its new text.
//!
//! ```text
//!  text ──► scan ──────► chunks ───────► layout ──► text
//!           lexemes      what is kept    lines
//! ```
//!
//! *Holds:* the tokens, the comments and the directives are the same before and after, in the same order: if a comparison finds a
//! difference, the text stays as it was. Formatting twice gives the same text. Each branch of an `#if` is laid out from the state
//! at the `#if`, so that it may open or close brackets. Nothing is expanded, so that a source needs no includes.

mod branches;
mod broken;
mod chunks;
mod layout;
pub mod scan;
mod state;

pub use broken::formatted;
use scan::{Kind, scan};
use std::ops::Range;

/// The least and the greatest width of a line.
pub const WIDTHS: [usize; 2] = [40, 400];
/// The greatest number of columns of a level.
pub const MAX_INDENT: usize = 16;

/// The columns of a tab in the width of a line.
const TAB: usize = 4;

/// The choices that a project has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// The blanks of a level; none for tabs.
    pub indent: Option<usize>,
    /// The greatest number of columns of a line, where it can be broken.
    pub width: usize,
    /// Whether the `{` of a function and of a statement has a line of its own.
    pub braces_below: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { indent: Some(4), width: 100, braces_below: false }
    }
}

impl Options {
    fn columns(&self) -> usize {
        self.indent.unwrap_or(TAB)
    }

    fn indent(&self, text: &mut String, level: usize) {
        match self.indent {
            Some(blanks) => text.extend(std::iter::repeat_n(' ', blanks * level)),
            None => text.extend(std::iter::repeat_n('\t', level)),
        }
    }
}

/// A text in the style of a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formatted {
    /// The text.
    pub text: String,
    /// The number of lines of the text before.
    pub lines: usize,
    /// How many of them were kept as they were, because their brackets do not match or they do not parse.
    pub kept: usize,
}

/// How often a text with errors is formatted until it stays the same.
const MOST_PASSES: usize = 6;

/// Formats a text. Declarations around `broken`, the places of errors, are kept as they are. Where something is kept, it depends on the
/// lines what is, so the text is formatted until it stays the same, and kept if it never does. Lines end as most of the text's do.
pub fn format(text: &str, broken: &[Range<usize>], options: &Options) -> Formatted {
    // Offsets stay, so the places of errors do.
    let read = with_line_feeds(text);
    let lines = read.lines().count();
    let end = line_end(text);
    let Some((once, kept)) = pass(&read, broken, options) else {
        return Formatted { text: text.to_owned(), lines, kept: lines };
    };
    let formatted = |text: &str, kept| Formatted { text: text.replace('\n', end), lines, kept };
    // The places are those of this text alone: who has them formats again with those of the new text.
    if kept == 0 || !broken.is_empty() {
        return formatted(&once, kept);
    }
    let mut done = once;
    for _ in 0..MOST_PASSES {
        match pass(&done, &[], options) {
            Some((again, kept)) if again == done => return formatted(&done, kept),
            Some((again, _)) => done = again,
            None => return formatted(&done, lines),
        }
    }
    Formatted { text: text.to_owned(), lines, kept: lines }
}

/// Formats a text once: its lines end with `\n` alone then. Also the number of lines that are kept. `None` if it would have other lexemes.
fn pass(text: &str, broken: &[Range<usize>], options: &Options) -> Option<(String, usize)> {
    let lexemes = chunks::keep(text, scan(text), broken);
    let kept = lexemes.iter().filter(|lexeme| lexeme.kind == Kind::Other);
    let kept = kept.map(|lexeme| 1 + lexeme.text.matches('\n').count()).sum();
    let mut formatted = layout::layout(&lexemes, options).replace("\r\n", "\n");
    if text.starts_with(BYTE_ORDER_MARK) {
        formatted.insert(0, BYTE_ORDER_MARK);
    }
    has_same_lexemes(text, &formatted).then_some((formatted, kept))
}

/// The text with a line feed for each carriage return that ends a line alone. Offsets stay.
fn with_line_feeds(text: &str) -> String {
    let next = text.chars().skip(1).map(Some).chain([None]);
    let end = |(letter, next)| if letter == '\r' && next != Some('\n') { '\n' } else { letter };
    text.chars().zip(next).map(end).collect()
}

/// The kind of end that most lines of a text have (GLSL 1.50 §3.1).
fn line_end(text: &str) -> &'static str {
    let both = text.matches("\r\n").count();
    let feeds = text.matches('\n').count() - both;
    let returns = text.matches('\r').count() - both;
    match () {
        () if both > feeds.max(returns) => "\r\n",
        () if returns > feeds.max(both) => "\r",
        () => "\n",
    }
}

const BYTE_ORDER_MARK: char = '\u{feff}';

/// Whether two texts have the same tokens, comments and directives.
pub fn has_same_lexemes(left: &str, right: &str) -> bool {
    let (left, right) = (scan(left), scan(right));
    // The ends of lines inside of a comment may be of another kind.
    let plain = |text: &str| text.replace("\r\n", "\n").replace('\r', "\n");
    let is_same = |(a, b): (&scan::Lexeme<'_>, &scan::Lexeme<'_>)| {
        a.kind == b.kind && (a.text == b.text || plain(a.text) == plain(b.text))
    };
    left.len() == right.len() && left.iter().zip(&right).all(is_same)
}

#[cfg(test)]
mod tests;
