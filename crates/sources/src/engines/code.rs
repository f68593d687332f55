//! The code of a text, without its comments.
//!
//! *In:* a text. *Out:* the same text with spaces for its comments, so that offsets stay; its words. *Holds:* nothing is
//! preprocessed: code in a conditional group counts.

use glisten_front::source::blanked;
use glisten_front::source::comments::comment_len;
use std::sync::Arc;

/// The text with spaces for its comments.
pub fn without_comments(text: &str) -> Arc<str> {
    let mut ranges = Vec::new();
    let mut at = 0;
    while let Some(found) = text.get(at..).and_then(|rest| rest.find('/')).map(|found| at + found) {
        let rest = text.get(found..).unwrap_or("");
        let comment = comment_len(rest);
        if comment > 0 {
            ranges.push(found..found + comment);
        }
        at = found + comment.max(1);
    }
    blanked(text, &ranges)
}

/// Whether a character can be part of a name.
pub fn is_name(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

/// The names in a text, with their offsets.
pub fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut at = 0;
    text.split(|character: char| !is_name(character)).filter_map(move |word| {
        let start = at;
        // Splitting at a character leaves out all its bytes.
        at += word.len() + text.get(at + word.len()..).and_then(|rest| rest.chars().next()).map_or(0, char::len_utf8);
        (!word.is_empty()).then_some((start, word))
    })
}

/// The end of a text, at most this many bytes: declarations are short, and hostile texts are not.
pub fn tail(text: &str, most: usize) -> &str {
    let mut start = text.len().saturating_sub(most);
    while !text.is_char_boundary(start) {
        start += 1;
    }
    text.get(start..).unwrap_or("")
}

/// The beginning of a text, at most this many bytes.
pub fn head(text: &str, most: usize) -> &str {
    let mut end = text.len().min(most);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.get(..end).unwrap_or("")
}

/// The largest length of the head of a function.
const MAX_HEAD: usize = 2048;

/// How often a text without comments defines the function `name`.
pub fn count_definitions(code: &str, name: &str) -> usize {
    let is_definition = |(at, word): &(usize, &str)| {
        let rest = head(code.get(at + word.len()..).unwrap_or(""), MAX_HEAD).trim_start();
        let Some(end) = rest.strip_prefix('(').and_then(|rest| rest.find(')')) else { return false };
        rest.get(end + 2..).is_some_and(|rest| rest.trim_start().starts_with('{'))
    };
    words(code).filter(|(_, word)| *word == name).filter(is_definition).count()
}

/// Whether a text without comments names a function: it has the word, with a parenthesis after it.
pub fn names_function(code: &str, name: &str) -> bool {
    let is_followed = |at: usize| code.get(at..).is_some_and(|rest| rest.trim_start().starts_with('('));
    words(code).any(|(at, word)| word == name && is_followed(at + word.len()))
}

#[cfg(test)]
mod tests {
    use super::{count_definitions, names_function, without_comments, words};

    #[test]
    fn comments_are_blank() {
        assert_eq!(without_comments("a/b // c\n/* d\n*/ e /*").as_ref(), "a/b     \n    \n   e   ");
        assert_eq!(without_comments("/**/x//").as_ref(), "    x  ");
    }

    #[test]
    fn words_have_places() {
        assert_eq!(words("é a_1+(b").collect::<Vec<_>>(), [(3, "a_1"), (8, "b")]);
    }

    #[test]
    fn definitions_have_bodies() {
        assert_eq!(count_definitions("void main();\nvoid main( void )\n{ domain(); } void main(){}", "main"), 2);
    }

    #[test]
    fn functions_are_words_before_parentheses() {
        let code =
            without_comments("void mainImage(); // main()\nfloat domain(float x) { return remainder(x); } int main;");
        assert!(!names_function(&code, "main") && names_function(&code, "mainImage"));
        assert!(names_function(&without_comments("void main /* here */ ()"), "main"));
    }
}
