//! How texts use words that later versions have: as keywords, as macros, in layouts, as variables.
//!
//! *In:* texts. *Out:* the words. *Holds:* nothing is preprocessed, so all branches of conditions count.

use super::names::{FUNCTIONS, lookup};
use super::tokens::{Token, closing, tokens};
use std::collections::BTreeSet;

/// Macros that would replace the words of the layouts that Vulkan wants.
pub(super) fn layout_macros<'t>(texts: impl Iterator<Item = &'t str>) -> BTreeSet<&'t str> {
    static WORDS: &[&str] = &["set", "binding", "location", "component", "index", "offset", "std140"];
    let mut found = BTreeSet::new();
    for text in texts {
        let all = tokens(text);
        let words = all
            .windows(3)
            .filter(|words| matches!(words, [sign, word, _] if sign.text == "#" && word.text == "define"));
        found.extend(words.filter_map(|words| words.last()).map(|name| name.text).filter(|name| WORDS.contains(name)));
    }
    found
}

/// The words that a text uses as no name is used: before another word or a number (`precision mediump float`, `flat in`, `case 1`).
/// They then mean what later versions mean by them, behind a condition on the version.
pub(super) fn keyword_uses<'t>(texts: impl Iterator<Item = &'t str>) -> BTreeSet<&'t str> {
    let mut found = BTreeSet::new();
    for text in texts {
        let all = tokens(text);
        for (index, token) in all.iter().enumerate().filter(|(_, token)| token.is_word()) {
            let Some(next) = all.get(index + 1) else { continue };
            let is_operand = next.text.starts_with(|first: char| first.is_ascii_alphanumeric() || first == '_');
            let follows = match token.text {
                "layout" => next.text == "(",
                "default" => next.text == ":",
                // A keyword since 4.30, and still the word of a layout (GLSL 4.60 §4.4.5).
                "shared" => is_in_layout(&all, index),
                "switch" => {
                    closing(&all, index + 1).and_then(|end| all.get(end + 1)).is_some_and(|one| one.text == "{")
                }
                _ => false,
            };
            if is_operand || follows {
                found.insert(token.text);
            }
        }
    }
    found
}

/// The names of macros that the texts give to nothing else. A macro may have the name of a keyword.
pub(super) fn macros_alone<'t>(texts: impl Iterator<Item = &'t str>) -> BTreeSet<&'t str> {
    /// Words that are before the name of a macro, and not before that of a variable.
    static BEFORE: &[&str] = &["define", "undef", "ifdef", "ifndef", "defined", "if", "elif", "return", "else"];
    let (mut macros, mut others) = (BTreeSet::new(), BTreeSet::new());
    for text in texts {
        let all = tokens(text);
        for (before, token) in all.iter().zip(all.iter().skip(1)).filter(|(before, _)| before.is_word()) {
            if before.text == "define" {
                macros.insert(token.text);
            } else if !BEFORE.contains(&before.text) {
                others.insert(token.text);
            }
        }
    }
    &macros - &others
}

/// Whether a word is between the parentheses of a layout.
fn is_in_layout(all: &[Token<'_>], index: usize) -> bool {
    let before = all.get(..index).unwrap_or_default();
    before.iter().rposition(|one| matches!(one.text, "(" | ")" | ";" | "{")).is_some_and(|open| {
        let opens = before.get(open).is_some_and(|one| one.text == "(");
        let word = open.checked_sub(1).and_then(|word| before.get(word));
        opens && word.is_some_and(|word| word.text == "layout")
    })
}

/// The names of old lookups under which the texts declare variables.
pub(super) fn declared_variables<'t>(texts: impl Iterator<Item = &'t str>) -> BTreeSet<&'t str> {
    declared(texts, |name| lookup(name).is_some())
}

/// The variables that would hide a function that is called in place of an old lookup. Texts of 1.30 and later may call both
/// `texture2D` and `texture`, so a name that a text calls stays, as does one that members have.
pub(super) fn hiding_variables<'t, I: Iterator<Item = &'t str>>(texts: impl Fn() -> I) -> BTreeSet<&'t str> {
    let (mut kept, mut new) = (BTreeSet::new(), BTreeSet::new());
    for text in texts() {
        let all = tokens(text);
        for (token, next) in all.iter().zip(all.iter().skip(1)) {
            if next.text == "(" {
                kept.insert(token.text);
                new.extend(lookup(token.text).map(|lookup| lookup.name));
            } else if token.text == "." {
                kept.insert(next.text);
            }
        }
    }
    declared(texts(), |name| FUNCTIONS.contains(&name) && new.contains(name) && !kept.contains(name))
}

/// The names of a kind under which the texts declare variables: after a word, and not before arguments.
fn declared<'t>(texts: impl Iterator<Item = &'t str>, is_of_kind: impl Fn(&str) -> bool) -> BTreeSet<&'t str> {
    let mut found = BTreeSet::new();
    for text in texts {
        let all = tokens(text);
        let pairs = all.iter().zip(all.iter().skip(1)).zip(all.iter().skip(2));
        let declared = pairs.filter(|((before, token), after)| {
            let is_type = before.is_word()
                && !["return", "else", "define", "defined", "ifdef", "ifndef", "undef"].contains(&before.text);
            is_type && is_of_kind(token.text) && [";", ",", ")", "=", "["].contains(&after.text)
        });
        found.extend(declared.map(|((_, token), _)| token.text));
    }
    found
}
