//! WGSL as tokens, as far as faults need it (WGSL §3): words, numbers, marks, and which parentheses belong together.
//!
//! *In:* emitted text. *Out:* its tokens with their places; the text after edits. *Not done here:* parsing. An edit that
//! makes no sense is found by naga's validator.

use std::ops::Range;

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sort {
    Word,
    Number,
    Mark,
}

/// A token.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub(super) sort: Sort,
    pub(super) text: &'a str,
    /// The place of its first byte.
    pub(super) at: usize,
}

impl Token<'_> {
    pub(super) fn range(&self) -> Range<usize> {
        self.at..self.at + self.text.len()
    }
}

/// Marks of several characters, the longest first.
const MARKS: [&str; 20] = [
    "<<=", ">>=", "->", "<<", ">>", "<=", ">=", "==", "!=", "&&", "||", "++", "--", "+=", "-=", "*=", "/=", "%=", "&=",
    "|=",
];

/// The tokens of a text, without comments.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut list = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let while_word = |from: usize| {
            let is_part = |c: char| c.is_alphanumeric() || c == '_';
            rest[from..].find(|c: char| !is_part(c)).map_or(rest.len(), |end| from + end)
        };
        let (sort, len) = match first {
            _ if first.is_whitespace() => (None, first.len_utf8()),
            '/' if rest.starts_with("//") => (None, rest.find('\n').unwrap_or(rest.len())),
            '0'..='9' => (Some(Sort::Number), number(rest)),
            _ if first.is_alphabetic() || first == '_' => (Some(Sort::Word), while_word(0)),
            _ => {
                let mark = MARKS.iter().find(|mark| rest.starts_with(**mark));
                (Some(Sort::Mark), mark.map_or(first.len_utf8(), |mark| mark.len()))
            }
        };
        list.extend(sort.map(|sort| Token { sort, text: &rest[..len], at }));
        at += len;
    }
    list
}

/// The length of the number at the beginning of a text: `1`, `0.5f`, `1e-3f`, `0xffu`.
fn number(text: &str) -> usize {
    let mut before = ' ';
    let is_hexadecimal = text.starts_with("0x");
    let ends = |c: char, before: char| {
        let is_sign = !is_hexadecimal && matches!(before, 'e' | 'E') && matches!(c, '+' | '-');
        !(c.is_alphanumeric() || c == '.' || is_sign)
    };
    for (at, c) in text.char_indices() {
        if ends(c, before) {
            return at;
        }
        before = c;
    }
    text.len()
}

/// The text after edits, which are sorted and do not overlap.
pub(super) fn edited(text: &str, edits: &[(Range<usize>, String)]) -> String {
    let mut out = String::with_capacity(text.len() + 64);
    let mut done = 0;
    for (range, new) in edits {
        out.push_str(&text[done..range.start]);
        out.push_str(new);
        done = range.end;
    }
    out.push_str(&text[done..]);
    out
}

/// The token that closes what a token opens.
pub(super) fn closing(list: &[Token<'_>], open: usize) -> Option<usize> {
    let mut depth = 0_usize;
    for (place, token) in list.iter().enumerate().skip(open) {
        match token.text {
            "(" | "{" | "[" => depth += 1,
            ")" | "}" | "]" => {
                depth = depth.checked_sub(1)?;
                if depth == 0 {
                    return Some(place);
                }
            }
            _ => {}
        }
    }
    None
}

/// The brace that begins the body of the statement at a token.
pub(super) fn body(list: &[Token<'_>], statement: usize) -> Option<usize> {
    (statement..list.len()).find(|place| list[*place].text == "{")
}

/// A call: `function(argument, argument)`.
pub(super) struct Call<'a> {
    pub(super) name: Token<'a>,
    /// The ranges of the arguments.
    pub(super) arguments: Vec<Range<usize>>,
    /// The whole call.
    pub(super) range: Range<usize>,
}

/// The call whose name is at a token; template arguments, such as those of `vec2<f32>`, belong to the name.
pub(super) fn call<'a>(list: &[Token<'a>], place: usize) -> Option<Call<'a>> {
    let name = *list.get(place).filter(|token| token.sort == Sort::Word)?;
    let mut open = place + 1;
    if list.get(open)?.text == "<" {
        open = (open..list.len().min(open + 4)).find(|at| list[*at].text == ">")? + 1;
    }
    if list.get(open)?.text != "(" {
        return None;
    }
    let close = closing(list, open)?;
    let mut arguments = Vec::new();
    let (mut depth, mut from) = (0_usize, list[open].at + 1);
    for token in &list[open + 1..close] {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 0 && !is_in_template(list, token) => {
                arguments.push(from..token.at);
                from = token.at + 1;
            }
            _ => {}
        }
    }
    arguments.push(from..list[close].at);
    Some(Call { name, arguments, range: name.at..list[close].at + 1 })
}

/// Whether a comma is between the arguments of a template, as in `array<f32, 4>`.
fn is_in_template(list: &[Token<'_>], comma: &Token<'_>) -> bool {
    let place = list.iter().position(|token| token.at == comma.at).unwrap_or(0);
    let opens = |at: usize| list.get(at).is_some_and(|token| token.text == "<");
    let is_array = |at: usize| list.get(at).is_some_and(|token| token.text == "array");
    place >= 3 && (opens(place - 2) && is_array(place - 3) || place >= 6 && opens(place - 5) && is_array(place - 6))
}

/// Whether a mark is between blanks, as glisten writes binary operators, other than the marks of templates.
pub(super) fn is_binary(text: &str, token: &Token<'_>) -> bool {
    let range = token.range();
    token.sort == Sort::Mark
        && text[..range.start].ends_with(' ')
        && text[range.end..].starts_with(' ')
        && !text[..range.start].trim_end().ends_with(['(', ',', '='])
}
