//! Characters of a source that must not reach a terminal: it would obey them.
//!
//! *In:* texts that quote a source. *Out:* the same for people ([`clean`]), or for JSON ([`escaped`]).

/// The text, with replacements for control characters that a terminal would obey.
pub fn clean(text: &str) -> String {
    text.chars().map(|character| if keeps(character) { character } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// The same JSON, in which such characters are escaped. They occur in its strings alone.
pub(super) fn escaped(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for character in json.chars() {
        if keeps(character) {
            text.push(character);
        } else {
            text.push_str(&format!("\\u{:04x}", u32::from(character)));
        }
    }
    text
}

fn keeps(character: char) -> bool {
    character == '\n' || character == '\t' || !is_hostile(character)
}

/// Whether a character controls the terminal, changes the writing direction, or has no width.
pub(super) fn is_hostile(character: char) -> bool {
    character.is_control() || matches!(character, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{feff}')
}
