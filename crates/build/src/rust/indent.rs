//! Indents generated Rust.
//!
//! *In:* lines without indentation. *Out:* the same lines, four spaces deeper for each bracket that is open. *Holds:* what is in
//! raw strings stays as it is.

/// The text, indented.
pub(super) fn indented(text: &str) -> String {
    let mut result = String::with_capacity(text.len() + text.len() / 4);
    let mut depth = 0usize;
    let mut end_of_string: Option<String> = None;
    for line in text.lines() {
        if let Some(end) = &end_of_string {
            let ends = line.contains(end.as_str());
            result.push_str(line);
            result.push('\n');
            if ends {
                end_of_string = None;
            }
            continue;
        }
        let is_comment = line.starts_with("//");
        let code = line.split("r#").next().unwrap_or(line);
        let count = |signs: [char; 3]| if is_comment { 0 } else { code.matches(signs).count() };
        let (opened, closed) = (count(['{', '[', '(']), count(['}', ']', ')']));
        let first = code.chars().take_while(|one| ['}', ']', ')'].contains(one)).count();
        if !line.is_empty() {
            result.push_str(&"    ".repeat(depth.saturating_sub(first)));
            result.push_str(line);
        }
        result.push('\n');
        depth = (depth + opened).saturating_sub(closed);
        end_of_string = if is_comment { None } else { open_string(line) };
    }
    result
}

/// The end of the raw string that a line opens and does not close.
fn open_string(line: &str) -> Option<String> {
    let start = line.find("r#")?;
    let signs: String = line.get(start + 1..)?.chars().take_while(|one| *one == '#').collect();
    let after = line.get(start + 1 + signs.len()..)?.strip_prefix('"')?;
    let end = format!("\"{signs}");
    (!after.contains(&end)).then_some(end)
}

#[cfg(test)]
mod tests {
    use super::indented;

    #[test]
    fn brackets_indent_and_strings_stay() {
        let text = "mod a {\n/// A { is no bracket here.\nconst T: &str = r##\"\nfn {\n\"#\n\"##;\nfn f() {\ng(\nX { y: 1 },\n);\n}\n}\n";
        let expected = "mod a {\n    /// A { is no bracket here.\n    const T: &str = r##\"\nfn {\n\"#\n\"##;\n    fn f() {\n        g(\n            X { y: 1 },\n        );\n    }\n}\n";
        assert_eq!(indented(text), expected);
    }
}
