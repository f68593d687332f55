//! Splits a text into words, numbers, operators and what is between them.

/// The kind of a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A keyword or a name.
    Word,
    /// A number.
    Number,
    /// An operator or another sign.
    Sign,
    /// Blanks, a comment, a directive: nothing that is changed.
    Between,
}

/// Operators of several characters, longer ones first.
const LONG: &[&str] = &[
    "<<=", ">>=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "==", "!=", "<=", ">=", "++", "--", "&&", "||", "^^",
    "<<", ">>",
];

/// The pieces of a text, which joined are the text.
pub(super) fn pieces(text: &str) -> Vec<(Kind, &str)> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let (kind, length) = piece(rest, first);
        let (piece, later) = rest.split_at(length.max(first.len_utf8()));
        found.push((kind, piece));
        rest = later;
    }
    found
}

fn piece(rest: &str, first: char) -> (Kind, usize) {
    let until = |ends: &dyn Fn(char) -> bool| rest.find(ends).unwrap_or(rest.len());
    let starts = |sign: &&&str| rest.starts_with(**sign);
    let second = rest.get(first.len_utf8()..).and_then(|rest| rest.chars().next());
    match first {
        '#' => (Kind::Between, until(&|c| c == '\n')),
        '/' if second == Some('/') => (Kind::Between, until(&|c| c == '\n')),
        '/' if second == Some('*') => (Kind::Between, rest.find("*/").map_or(rest.len(), |end| end + 2)),
        c if c.is_whitespace() => (Kind::Between, until(&|c| !c.is_whitespace())),
        c if c.is_ascii_alphabetic() || c == '_' => (Kind::Word, until(&|c| !(c.is_ascii_alphanumeric() || c == '_'))),
        c if c.is_ascii_digit() || c == '.' && second.is_some_and(|c| c.is_ascii_digit()) => {
            (Kind::Number, until(&|c| !(c.is_ascii_alphanumeric() || c == '.')))
        }
        _ => (Kind::Sign, LONG.iter().find(starts).map_or(first.len_utf8(), |sign| sign.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::{Kind, pieces};

    #[test]
    fn pieces_are_the_text() {
        let text = "#version 150\nfloat x1 = .5e3f; // c\n/* d */ a <<= b++ . c;\u{fc}";
        let all = pieces(text);
        assert_eq!(all.iter().map(|piece| piece.1).collect::<String>(), text);
        let of = |kind| all.iter().filter(|piece| piece.0 == kind).map(|piece| piece.1).collect::<Vec<_>>();
        assert_eq!(of(Kind::Word), ["float", "x1", "a", "b", "c"]);
        assert_eq!(of(Kind::Number), [".5e3f"]);
        assert_eq!(of(Kind::Sign), ["=", ";", "<<=", "++", ".", ";", "\u{fc}"]);
    }
}
