//! How the text of a help is applied.
//!
//! *In:* a help, the text of the file, and the primary place in it. *Out:* the texts that follow the help, one for each of its
//! alternatives. *Holds:* a help whose form is not in the table, or which leaves something open (`..`), has none.

use std::ops::Range;

/// Where the code that a help quotes goes.
#[derive(Clone, Copy)]
enum Place {
    /// In place of the primary span. A directive is a line of its own.
    Replace,
    /// In place of the primary span; each `return` in the body behind it becomes the next quoted code.
    ReplaceReturning,
    /// Before the primary span; a directive on a line before.
    Before,
    /// Behind the primary span.
    After,
    /// Around the primary span, which its `...` are.
    Around,
    /// On the line before that of the primary span.
    LineBefore,
    /// Behind the `#version` line.
    Top,
    /// In place of the `#version` line.
    Version,
    /// Before the nearest word before the primary span; the word is the next quoted code.
    BeforeWord,
    /// In place of the name in the whole file.
    Rename,
    /// The name is renamed to the next quoted code.
    RenameTo,
    /// In place of the end of the block: from the next `}` to the semicolon.
    Close,
}

/// The forms: the help with `_` for each quoted code, and for its alternatives the number of the code and where it goes.
static FORMS: &[(&str, &[(usize, Place)])] = &[
    ("did you mean `_`?", &[(0, Place::Replace)]),
    ("did you mean `_` to be `_`?", &[(0, Place::RenameTo)]),
    ("write `_`", &[(0, Place::Replace)]),
    ("write `_`, and `_` without a value", &[(0, Place::ReplaceReturning)]),
    ("write `_` for the decimal number", &[(0, Place::Replace)]),
    ("write `_` for the same `_`, or `_` for a `_`", &[(0, Place::Replace)]),
    ("write `_` here", &[(0, Place::Before)]),
    ("write `_` before it", &[(0, Place::Before)]),
    ("write `_` after it", &[(0, Place::After)]),
    ("write `_` after the name", &[(0, Place::After)]),
    ("write `_` around it", &[(0, Place::Around)]),
    ("compare it: `_`", &[(0, Place::Around)]),
    ("write `_` first", &[(0, Place::LineBefore)]),
    ("write `_` before `_`, on both sides", &[(0, Place::BeforeWord)]),
    ("write `_` at its end", &[(0, Place::Close)]),
    ("call it `_`", &[(0, Place::Rename)]),
    ("call it: `_`", &[(0, Place::Replace)]),
    ("begin the shader with `_`", &[(0, Place::Top)]),
    ("declare `_`", &[(0, Place::Top)]),
    ("`_` has it, or put `_` at the top", &[(0, Place::Version), (1, Place::Top)]),
    ("write a constructor, or `_`", &[(0, Place::Top)]),
    (
        "the order is: layout, invariant, interpolation, centroid or sample, storage, precision (or `_`)",
        &[(0, Place::Top)],
    ),
];

/// The texts that follow a help.
pub(super) fn applied(help: &str, text: &str, at: &Range<usize>) -> Vec<String> {
    let parts: Vec<&str> = help.split('`').collect();
    let skeleton: Vec<&str> = parts.iter().enumerate().map(|(i, part)| if i % 2 == 1 { "_" } else { part }).collect();
    let codes: Vec<&str> = parts.iter().copied().skip(1).step_by(2).collect();
    let skeleton = skeleton.join("`");
    let Some((_, alternatives)) = FORMS.iter().find(|form| form.0 == skeleton) else { return Vec::new() };
    let apply = |&(index, place): &(usize, Place)| put(place, codes.get(index..)?, text, at);
    alternatives.iter().filter_map(apply).collect()
}

/// The text with a quoted code at its place; the codes behind it are at hand.
fn put(place: Place, codes: &[&str], text: &str, at: &Range<usize>) -> Option<String> {
    let (new, old) = (*codes.first()?, text.get(at.clone())?);
    let is_open = (new.contains("..") && !matches!(place, Place::Around)) || new.contains("NAME");
    let line_start = text[..at.start].rfind('\n').map_or(0, |at| at + 1);
    let line_end = |from: usize| text[from..].find('\n').map_or(text.len(), |end| from + end);
    let splice = |range: Range<usize>, new: &str| format!("{}{new}{}", &text[..range.start], &text[range.end..]);
    let version = || text.find("#version").map(|start| start..line_end(start));
    let changed = match place {
        Place::Replace if new.starts_with('#') && !old.starts_with('#') => splice(line_start..line_end(at.end), new),
        Place::Replace => splice(at.clone(), new),
        Place::ReplaceReturning => {
            let body = at.end..body_end(text, at.end)?;
            let is_return = |word: &Range<usize>| body.contains(&word.start) && &text[word.clone()] == "return";
            let mut changed_text = text.to_owned();
            for word in words(text).into_iter().rev().filter(is_return) {
                let end = word.end + text[word.end..].find(';')? + 1;
                changed_text.replace_range(word.start..end, codes.get(1)?);
            }
            changed_text.replace_range(at.clone(), new);
            changed_text
        }
        Place::Before if !new.starts_with('#') => splice(at.start..at.start, &format!("{new} ")),
        Place::Before | Place::LineBefore => splice(line_start..line_start, &format!("{new}\n")),
        Place::After => splice(at.end..at.end, &format!(" {new}")),
        Place::Around => splice(at.clone(), &new.replace("...", old)),
        Place::Top => {
            let end = version()?.end;
            splice(end..end, &format!("\n{new}"))
        }
        Place::Version => splice(version()?, new),
        Place::BeforeWord => {
            let wanted = *codes.get(1)?;
            let word = words(&text[..at.start]).into_iter().rfind(|word| &text[word.clone()] == wanted)?;
            splice(word.start..word.start, &format!("{new} "))
        }
        Place::Rename => renamed(text, old, new),
        Place::RenameTo => renamed(text, new, codes.get(1)?),
        Place::Close => {
            let close = at.end + text[at.end..].find('}')?;
            splice(close..close + text[close..].find(';')? + 1, new)
        }
    };
    (!is_open).then_some(changed)
}

/// The end of the braces that follow a place.
fn body_end(text: &str, from: usize) -> Option<usize> {
    let mut depth = 0;
    text[from..].char_indices().find_map(|(at, letter)| {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        (letter == '}' && depth == 0).then_some(from + at)
    })
}

/// The places of the words of a text.
fn words(text: &str) -> Vec<Range<usize>> {
    let is_word = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut words: Vec<Range<usize>> = Vec::new();
    for (at, letter) in text.char_indices().filter(|(_, letter)| is_word(*letter)) {
        match words.last_mut().filter(|word| word.end == at) {
            Some(word) => word.end = at + letter.len_utf8(),
            None => words.push(at..at + letter.len_utf8()),
        }
    }
    words
}

/// The text with another name for everything of this name.
pub(super) fn renamed(text: &str, old: &str, new: &str) -> String {
    let mut renamed = text.to_owned();
    for word in words(text).into_iter().rev().filter(|word| &text[word.clone()] == old) {
        renamed.replace_range(word, new);
    }
    renamed
}
