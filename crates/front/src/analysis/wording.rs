//! The wording that diagnostics share: articles before names, and short quotes of the source.

use crate::diagnostic::Diagnostic;

/// The longest text that is quoted in a message.
pub(super) const LONGEST_QUOTE: usize = 40;

/// Writes `an` before quoted names whose pronunciation begins with a vowel (`int`, `in`, `out`), and `a` before the
/// others (`uint`, `uniform`). The names come from tables and sources, the text before them from the messages.
pub(super) fn with_articles(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 4);
    let mut rest = text;
    while let Some(at) = rest.find(" `").or_else(|| rest.find("(`")) {
        let (before, after) = rest.split_at(at);
        let word = before.rsplit([' ', '(']).next().unwrap_or(before);
        if matches!(word, "a" | "an") {
            out.push_str(before.strip_suffix(word).unwrap_or(before));
            let vowel = after.chars().nth(2).is_some_and(|letter| "aeioAEIO".contains(letter));
            out.push_str(if vowel { "an" } else { "a" });
        } else {
            out.push_str(before);
        }
        let (mark, behind) = after.split_at(2);
        out.push_str(mark);
        rest = behind;
    }
    out.push_str(rest);
    out
}

/// A diagnostic with its articles corrected.
pub(super) fn worded(mut finding: Diagnostic) -> Diagnostic {
    finding.message = with_articles(&finding.message);
    for label in std::iter::once(&mut finding.primary).chain(&mut finding.secondary) {
        label.message = with_articles(&label.message);
    }
    finding
}

#[cfg(test)]
mod tests {
    use super::with_articles;

    #[test]
    fn articles_follow_the_sound() {
        assert_eq!(with_articles("a `int` and a `uint`"), "an `int` and a `uint`");
        assert_eq!(with_articles("this is a `float`"), "this is a `float`");
        assert_eq!(with_articles("an `uniform` block (a `out`)"), "a `uniform` block (an `out`)");
        assert_eq!(with_articles("`a` is a `S`, `b`"), "`a` is a `S`, `b`");
    }
}
