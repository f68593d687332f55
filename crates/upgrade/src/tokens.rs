//! The words and signs of a text, with their places. Comments and white space are between them.
//!
//! *In:* a text. *Out:* [`Token`]s. *Holds:* the lines of directives are cut like all others, so macros are rewritten, too; the name of an
//! include is one token, whatever words it has.

use glisten_sources::engines::code::{is_name, without_comments};
use std::ops::Range;

/// A word, a number, a sign or the name of an include with its quotation marks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Token<'t> {
    pub(super) text: &'t str,
    pub(super) range: Range<usize>,
}

impl Token<'_> {
    /// Whether it is a name or a keyword.
    pub(super) fn is_word(&self) -> bool {
        self.text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
    }
}

/// The tokens of a text.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let code = without_comments(text);
    let mut found: Vec<Token<'_>> = Vec::new();
    let mut at = 0;
    while let Some(first) = code.get(at..).and_then(|rest| rest.chars().next()) {
        let rest = code.get(at..).unwrap_or("");
        let length = if is_name(first) {
            let is_number = first.is_ascii_digit();
            rest.find(|next: char| !(is_name(next) || is_number && next == '.')).unwrap_or(rest.len())
        } else {
            quoted(rest, &found).unwrap_or(first.len_utf8())
        };
        if !first.is_whitespace() {
            let range = at..at + length;
            // Comments alone are blank in `code`, so the places are those of the text.
            found.push(Token { text: text.get(range.clone()).unwrap_or(""), range });
        }
        at += length;
    }
    found
}

/// The length of the name of an include, if one begins here: between quotation marks, or behind `#include` between `<` and `>`.
fn quoted(rest: &str, before: &[Token<'_>]) -> Option<usize> {
    let end = match rest.chars().next()? {
        '"' => '"',
        '<' if matches!(before, [.., hash, word] if hash.text == "#" && matches!(word.text, "include" | "moj_import")) => {
            '>'
        }
        _ => return None,
    };
    let line = rest.lines().next()?;
    line.get(1..)?.find(end).map(|length| length + 2)
}

/// The largest number of tokens in the arguments of a call.
const MAX_ARGUMENTS: usize = 4096;

/// The index of the bracket that closes the one at `open`.
pub(super) fn closing(tokens: &[Token<'_>], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (index, token) in tokens.iter().enumerate().skip(open).take(MAX_ARGUMENTS) {
        match token.text {
            "(" | "[" => depth += 1,
            ")" | "]" => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(index);
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{closing, tokens};

    #[test]
    fn words_and_signs() {
        let texts: Vec<&str> = tokens("a1/*b*/+ 1.5e // c\n#x(y)").iter().map(|token| token.text).collect();
        assert_eq!(texts, ["a1", "+", "1.5e", "#", "x", "(", "y", ")"]);
        let texts: Vec<&str> = tokens("#include \"a/common.glsl\"\n#include <b/sample>\na < b > c \" d")
            .iter()
            .map(|token| token.text)
            .collect();
        assert_eq!(
            texts,
            ["#", "include", "\"a/common.glsl\"", "#", "include", "<b/sample>", "a", "<", "b", ">", "c", "\"", "d"]
        );
        let call = tokens("f(a[1], (b)) )");
        assert_eq!(closing(&call, 1), Some(10));
        assert_eq!(closing(&tokens("(["), 0), None);
    }
}
