//! [`shortened`]: what a source says is quoted in messages, and a source may say a megabyte.
//!
//! *In:* the text of a message. *Out:* the same text, in which words of more than [`LONGEST_WORD`] bytes are cut, and which ends with an
//! ellipsis where it is longer than [`LONGEST`]. *Holds:* each text of a [`Diagnostic`](super::Diagnostic) passes through here; changes
//! of the text ([`Fix`](super::Fix)) do not.

/// The longest word that is told whole: identifiers, numbers, strings without blanks. Names of files may well have 200 bytes.
pub const LONGEST_WORD: usize = 256;
/// How many characters of a longer one are told.
const KEPT: usize = 64;
/// The longest text in bytes.
pub const LONGEST: usize = 4096;

/// A message without overlong words, and of a bounded length.
pub fn shortened(text: impl Into<String>) -> String {
    let text = text.into();
    if text.len() <= LONGEST_WORD {
        return text;
    }
    let mut short = String::new();
    for part in text.split_inclusive(is_border) {
        let word = part.strip_suffix(is_border).unwrap_or(part);
        let border = part.strip_prefix(word).unwrap_or_default();
        match word.char_indices().nth(KEPT).and_then(|(end, _)| word.get(..end)) {
            Some(begin) if word.len() > LONGEST_WORD => {
                short.push_str(begin);
                short.push('…');
            }
            _ => short.push_str(word),
        }
        short.push_str(border);
        if short.len() > LONGEST {
            while short.len() > LONGEST {
                short.pop();
            }
            short.push('…');
            break;
        }
    }
    short
}

/// Whether a character ends a word: white space, and the quotes of messages.
fn is_border(character: char) -> bool {
    character.is_whitespace() || character == '`'
}

#[cfg(test)]
mod tests {
    use super::{LONGEST, LONGEST_WORD, shortened};

    #[test]
    fn long_words_and_texts_are_cut() {
        let name = "a".repeat(LONGEST_WORD);
        assert_eq!(shortened(format!("`{name}` is unknown")), format!("`{name}` is unknown"));
        let told = shortened(format!("`{name}a` is no `{name}é` at all"));
        let begin = "a".repeat(64);
        assert_eq!(told, format!("`{begin}…` is no `{begin}…` at all"));
        let long = shortened("ä b ".repeat(LONGEST));
        assert!(long.len() <= LONGEST + '…'.len_utf8() && long.ends_with('…'), "{}", long.len());
    }
}
