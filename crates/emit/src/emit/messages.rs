//! Turns naga's errors into glisten's messages.
//!
//! *In:* errors of naga. *Out:* one line, without handles.

/// An error and its causes in one line.
pub(super) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

/// Removes handles (`Expression [12]`, `[3]`) from a message of naga, since they mean nothing to a user.
pub(super) fn without_handles(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(open) = rest.find('[') {
        let digits = rest[open + 1..].bytes().take_while(u8::is_ascii_digit).count();
        let close = open + 1 + digits;
        if digits > 0 && rest[close..].starts_with(']') {
            shown.push_str(rest[..open].trim_end());
            rest = &rest[close + 1..];
        } else {
            shown.push_str(&rest[..=open]);
            rest = &rest[open + 1..];
        }
    }
    shown.push_str(rest);
    shown
}

#[cfg(test)]
mod tests {
    use super::without_handles;

    #[test]
    fn handles_of_naga_are_not_shown() {
        assert_eq!(without_handles("Expression [12] is invalid"), "Expression is invalid");
        assert_eq!(without_handles("[3]: The array [f32; 4] of type [7]"), ": The array [f32; 4] of type");
        assert_eq!(without_handles("no handle [ here"), "no handle [ here");
    }
}
