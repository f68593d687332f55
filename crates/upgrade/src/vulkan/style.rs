//! How a text is laid out, for lines that are added to it: indentation, braces, columns of comments.
//!
//! *In:* a text. *Out:* white space, and lines in the style of the text.

use super::conditions::Open;
use super::declarations::Line;

/// The indentation where a text has none.
const INDENT: &str = "    ";

/// The white space in front of the first line inside of braces.
pub(super) fn indent_of(text: &str) -> &str {
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let inner = lines().zip(lines().skip(1)).find_map(|(before, line)| {
        let indent = line.get(..line.len() - line.trim_start().len()).unwrap_or("");
        (before.trim_end() == "{" || before.trim_end().ends_with('{') && !before.starts_with([' ', '\t']))
            .then_some(indent)
            .filter(|indent| !indent.is_empty())
    });
    inner.unwrap_or(INDENT)
}

/// Whether the braces of functions are on lines of their own.
pub(super) fn has_braces_below(text: &str) -> bool {
    let lines = || text.lines().map(str::trim_end);
    lines().zip(lines().skip(1)).any(|(before, line)| line == "{" && before.ends_with(')'))
}

/// The lines of a member of a block, with its offset and its conditions.
type Member = (u32, Vec<String>, Vec<Open>);

/// Puts the comments behind members in one column, if they were in one.
pub(super) fn align_comments(text: &str, lines: &[Line], members: &mut [Member]) {
    let columns: Vec<usize> = lines.iter().filter_map(|line| column(text, line)).collect();
    if columns.len() < 2 || columns.iter().any(|column| Some(column) != columns.first()) {
        return;
    }
    let code = |line: &Line, rows: &[String]| {
        let comment = line.comment()?;
        let row = rows.last()?;
        Some((row.strip_suffix(comment.as_str())?.trim_end().to_owned(), comment))
    };
    let all: Vec<_> = lines.iter().zip(members.iter()).map(|(line, (_, rows, _))| code(line, rows)).collect();
    let width = all.iter().flatten().map(|(code, _)| code.chars().count()).max().unwrap_or(0);
    for (new, (_, rows, _)) in all.into_iter().zip(members) {
        if let (Some((code, comment)), Some(row)) = (new, rows.last_mut()) {
            *row = format!("{code:width$}  {comment}");
        }
    }
}

/// The column in which the comment behind a declaration begins, in characters.
fn column(text: &str, line: &Line) -> Option<usize> {
    let comment = line.behind.as_deref()?;
    let start = text.get(..line.place)?.rfind('\n').map_or(0, |at| at + 1);
    let whole = text.get(start..)?.lines().next()?;
    Some(whole.get(..whole.find(comment)?)?.chars().count())
}

#[cfg(test)]
mod tests {
    use super::{has_braces_below, indent_of};

    #[test]
    fn the_style_of_a_text_is_seen() {
        assert_eq!(indent_of("void main() {\n\tx;\n}\n"), "\t");
        assert_eq!(indent_of("void main()\n{\n  if (a) {\n      x;\n  }\n}\n"), "  ");
        assert_eq!(indent_of("in vec4 a;\n"), "    ");
        assert!(has_braces_below("void main()\n{\n}\n") && !has_braces_below("void main() {\n}\n"));
    }
}
