//! Texts as strings of TOML.
//!
//! *In:* any text. *Out:* a basic string (TOML 1.0), which may also be a key. *Holds:* it stays on one line, and reads back as the text.

use std::fmt::Write;

/// A text as a basic string of TOML.
pub fn toml_string(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            control if control.is_control() => {
                let _ = write!(out, "\\u{:04x}", u32::from(control));
            }
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::toml_string;

    #[test]
    fn any_text_reads_back() {
        for text in ["", "a b", "it's \"so\"", "C:\\x", "a\nb\t\u{1}\u{7f}\u{85}", "日本"] {
            let table: toml::Table = format!("{0} = {0}", toml_string(text)).parse().expect("TOML");
            assert_eq!(table.get(text).and_then(toml::Value::as_str), Some(text), "{text:?}");
        }
    }
}
