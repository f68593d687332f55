//! The comments that make tests of functions, as they are written.
//!
//! *In:* a text. *Out:* a [`Block`] for each comment that begins with `//! test` or `//! test: title`, with its lines. *Holds:* lines are those of the text, from
//! 1. *Not done here:* what the lines mean ([`super::table`]).

use super::source::comments;

/// A comment that makes a test of the function below it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Block {
    /// The line of `//! test`.
    pub(super) line: u32,
    /// The last line of the comment.
    pub(super) last: u32,
    /// The text that follows `test`, and the lines below, each with its number; empty ones are left out.
    pub(super) lines: Vec<(u32, String)>,
}

impl Block {
    /// The line that ends the conditional group (GLSL 1.50 §3.3) of the text that the comment is in, if it is in one.
    pub(super) fn group(&self, text: &str) -> Option<u32> {
        let mut depth = 0_usize;
        for (index, line) in text.lines().enumerate().skip(self.last as usize) {
            let Some(directive) = line.trim_start().strip_prefix('#').map(str::trim_start) else { continue };
            if directive.starts_with("if") {
                depth += 1;
            } else if depth > 0 && directive.starts_with("endif") {
                depth -= 1;
            } else if depth == 0 && (directive.starts_with("el") || directive.starts_with("endif")) {
                return u32::try_from(index + 1).ok();
            }
        }
        None
    }
}

/// The word that begins a test.
const TEST: &str = "test";

/// Whether a text may have tests.
pub fn has_tests(text: &str) -> bool {
    text.contains("//!") && !blocks(text).is_empty()
}

/// All tests of a text.
pub(super) fn blocks(text: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    let comments = comments(text);
    let mut start = 0;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let number = u32::try_from(index + 1).unwrap_or(u32::MAX);
        let at = start + line.len() - line.trim_start().len();
        start += line.len();
        // In a block comment, the signs are those of its text.
        let begins = || comments.binary_search_by_key(&at, |comment| comment.start).is_ok();
        let Some(comment) = line.trim_start().strip_prefix("//!").filter(|_| begins()) else {
            open = false;
            continue;
        };
        let comment = comment.trim();
        let first = comment.strip_prefix(TEST).filter(|rest| rest.is_empty() || rest.starts_with([' ', '\t', ':']));
        let told = match first {
            Some(rest) if !open => {
                blocks.push(Block { line: number, last: number, lines: Vec::new() });
                open = true;
                // A title is for people.
                if rest.starts_with(':') { "" } else { rest.trim() }
            }
            _ => comment,
        };
        if let Some(block) = blocks.last_mut().filter(|_| open) {
            block.last = number;
            if !told.is_empty() {
                block.lines.push((number, told.to_owned()));
            }
        }
    }
    blocks
}

#[cfg(test)]
mod tests {
    use super::{blocks, has_tests};

    #[test]
    fn a_group_ends_with_its_own_directive() {
        let text = "//! test\n#ifdef A\nfloat f();\n#else\n# if B\n//! test\n#endif\n#endif\nfloat g();\n";
        let ends: Vec<Option<u32>> = blocks(text).iter().map(|block| block.group(text)).collect();
        assert_eq!(ends, [None, Some(7)]);
    }

    #[test]
    fn comments_are_found_with_their_lines() {
        let text = "// a\n//! test x = 0..1\n//!   tolerance 1e-3\n//!\nfloat f(float x)\n{\n}\n\n//! testing\n//! test\nvoid g() {}\n";
        let found = blocks(text);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].line, found[0].last), (2, 4));
        assert_eq!(found[0].lines, [(2, "x = 0..1".to_owned()), (3, "tolerance 1e-3".to_owned())]);
        assert_eq!((found[1].line, found[1].lines.len()), (10, 0));
        assert!(!has_tests("/* as in\n//! test\nfloat f();\n*/") && has_tests("/* */\n//! test"));
        assert!(has_tests(text) && !has_tests("//! tests are below\nvoid f() {}"));
    }
}
