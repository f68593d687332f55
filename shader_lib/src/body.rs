//! The text of a module as programs include it: without its header, which describes the module to people.
//!
//! *In:* a module's text. *Out:* the same with an empty line for each line of its header, so that all else stays on its line.
//! *Holds:* a module for the web has the texts in this form alone; programs become the same there, byte for byte.

/// How long the comment at the beginning of a text is, and how many lines it has.
const fn header(text: &str) -> (usize, usize) {
    let bytes = text.as_bytes();
    let (mut at, mut lines) = (0, 0);
    while at + 1 < bytes.len() && bytes[at] == b'/' && bytes[at + 1] == b'/' {
        while at < bytes.len() && bytes[at] != b'\n' {
            at += 1;
        }
        if at < bytes.len() {
            at += 1;
            lines += 1;
        }
    }
    (at, lines)
}

/// The text without its header.
pub(super) fn body(text: &str) -> String {
    let (end, lines) = header(text);
    "\n".repeat(lines) + text.get(end..).unwrap_or("")
}

/// The length of [`body`] in bytes.
#[cfg(any(test, target_arch = "wasm32"))]
pub(super) const fn body_len(text: &str) -> usize {
    let (end, lines) = header(text);
    text.len() - end + lines
}

/// [`body`] at compile time, so that no header is in the program. `N` is [`body_len`].
#[cfg(any(test, target_arch = "wasm32"))]
pub(super) const fn body_bytes<const N: usize>(text: &str) -> [u8; N] {
    let (end, lines) = header(text);
    let mut bytes = [b'\n'; N];
    let mut at = lines;
    while at < N {
        bytes[at] = text.as_bytes()[end + at - lines];
        at += 1;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::{body, body_bytes, body_len};
    use crate::modules;

    const TEXT: &str = "// name: a\n// kind: b\n#ifndef A // c\n#define A\n// d\n#endif\n";

    #[test]
    fn headers_become_empty_lines() {
        assert_eq!(body(TEXT), "\n\n#ifndef A // c\n#define A\n// d\n#endif\n");
        const BYTES: [u8; body_len(TEXT)] = body_bytes(TEXT);
        assert_eq!(BYTES, body(TEXT).as_bytes());
        for text in ["", "// a", "// a\n", "float a;"] {
            assert_eq!(body(&body(text)), body(text), "{text}");
            assert_eq!(body_len(text), body(text).len(), "{text}");
        }
    }

    #[test]
    fn modules_keep_their_lines() {
        for module in modules() {
            let body = body(module.text);
            assert_eq!(body.lines().count(), module.text.lines().count(), "{}", module.name);
            assert!(body.trim_start().starts_with("#ifndef GLISTEN_"), "{}", module.name);
        }
    }
}
