//! [`Text`]: a source on the disk that a command rewrites.
//!
//! *In:* bytes. *Out:* a text, and the bytes of a changed one. *Holds:* bytes that are not UTF-8 come back as they were.

use similar::TextDiff;

/// The bytes of a file as a text, and back.
pub(crate) struct Text {
    /// The text.
    pub(crate) text: String,
    is_utf8: bool,
}

impl Text {
    /// The text of these bytes.
    pub(crate) fn new(bytes: Vec<u8>) -> Self {
        match String::from_utf8(bytes) {
            Ok(text) => Self { text, is_utf8: true },
            // A character for each byte: comments may be in any encoding, tokens are in ASCII.
            Err(error) => Self { text: error.into_bytes().into_iter().map(char::from).collect(), is_utf8: false },
        }
    }

    /// The bytes of another text of the file.
    pub(crate) fn bytes(&self, text: &str) -> Vec<u8> {
        if self.is_utf8 { text.as_bytes().to_vec() } else { text.chars().map(|byte| byte as u8).collect() }
    }
}

/// The changes of a file, as a unified diff.
pub(crate) fn diff(name: &str, before: &str, after: &str) -> String {
    TextDiff::from_lines(before, after).unified_diff().header(name, name).to_string()
}
