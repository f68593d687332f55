//! [`Remarks`]: the comments `// glisten: allow(CODE, CODE)` of a text, in any case and with any white space, in either kind of comment.
//!
//! *In:* a text by its lines. *Out:* the words of each line, and the comments above a line. *Holds:* the text is read once, however many
//! findings are on one of its lines.

use std::ops::RangeInclusive;

/// The comments of a text that allow findings.
#[derive(Clone, Debug, Default)]
pub(crate) struct Remarks {
    /// The words in the parentheses with their lines, in order.
    words: Vec<(u32, String)>,
    /// The runs of lines that are nothing but comments, in order: the first line of each, and the last one.
    comments: Vec<(u32, u32)>,
}

impl Remarks {
    /// Those of a text with these lines, which count from 1.
    pub(super) fn of<'t>(lines: impl Iterator<Item = &'t str>) -> Self {
        let mut remarks = Self::default();
        for (number, line) in (1..).zip(lines) {
            remarks.words.extend(allowed(line).map(|word| (number, word.to_owned())));
            if is_comment(line) {
                remarks.add_comment(number);
            }
        }
        remarks
    }

    fn add_comment(&mut self, line: u32) {
        match self.comments.last_mut().filter(|(_, last)| *last + 1 == line) {
            Some((_, last)) => *last = line,
            None => self.comments.push((line, line)),
        }
    }

    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// The first of the lines directly above this one that are nothing but comments, or the line itself.
    pub(crate) fn first_comment_above(&self, line: u32) -> u32 {
        let above = self.comments.partition_point(|(first, _)| *first < line);
        // A run that goes on below the line has its beginning above it.
        let run = self.comments.iter().take(above).next_back();
        run.filter(|(_, last)| *last + 1 >= line).map_or(line, |(first, _)| *first)
    }

    /// The words in these lines.
    pub(crate) fn words(&self, lines: RangeInclusive<u32>) -> impl Iterator<Item = &str> {
        let from = self.words.partition_point(|(line, _)| line < lines.start());
        let rest = self.words.iter().skip(from);
        rest.take_while(move |(line, _)| line <= lines.end()).map(|(_, word)| word.as_str())
    }
}

/// The codes in a line's `// glisten: allow(CODE, CODE)`.
fn allowed(line: &str) -> impl Iterator<Item = &str> {
    let comment = line.find("//").into_iter().chain(line.find("/*")).min();
    comment
        .and_then(|comment| line.get(comment..))
        .and_then(|comment| after_word(comment, "glisten:"))
        .and_then(|rest| rest.trim_start().strip_prefix("allow"))
        .and_then(|rest| rest.trim_start().strip_prefix('('))
        .and_then(|rest| rest.split_once(')'))
        .map(|(list, _)| list)
        .into_iter()
        .flat_map(|list| list.split(','))
        .map(str::trim)
}

/// The text after the first occurrence of a word of ASCII letters, in any case.
fn after_word<'t>(text: &'t str, word: &str) -> Option<&'t str> {
    let start = text.as_bytes().windows(word.len()).position(|part| part.eq_ignore_ascii_case(word.as_bytes()))?;
    text.get(start + word.len()..)
}

/// Whether a line is nothing but a comment.
pub(crate) fn is_comment(line: &str) -> bool {
    let line = line.trim();
    line.starts_with("//") || line.starts_with("/*") && line.ends_with("*/")
}

#[cfg(test)]
mod tests {
    use super::Remarks;

    #[test]
    fn comments_above_a_line_are_a_run() {
        let text = "// a\n// glisten: allow(A, B)\nx // glisten: allow(C)\n// b\ny\n";
        let remarks = Remarks::of(text.lines());
        let above: Vec<u32> = (1..=6).map(|line| remarks.first_comment_above(line)).collect();
        assert_eq!(above, [1, 1, 1, 4, 4, 6]);
        assert_eq!(remarks.words(1..=5).collect::<Vec<_>>(), ["A", "B", "C"]);
        assert_eq!(remarks.words(3..=5).collect::<Vec<_>>(), ["C"]);
        assert!(Remarks::of("// allow(A)\n".lines()).is_empty());
    }
}
