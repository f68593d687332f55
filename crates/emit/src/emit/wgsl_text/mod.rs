//! Makes naga's WGSL what a person would have written: `for`, `while` and `+=` where they are meant, declarations at the
//! first use, no parentheses that nothing needs, no trailing blanks; with the comments of the source.
//!
//! ```text
//!  text of naga ──► parse ──► loops ──► scopes ──► print ──► comments
//! ```
//!
//! *In:* WGSL as naga writes it, after `naga_repairs`. *Out:* the same program. *Holds:* a function whose text is not what
//! naga writes stays as it is. For every fixture, naga reads the text before `scopes` as the very module that naga wrote.

mod comments;
mod loops;
mod parse;
mod print;
mod scopes;
#[cfg(test)]
mod tests;
mod tree;

pub(super) use comments::{commented, header};

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Style {
    /// Only what naga reads as the same module.
    #[cfg(test)]
    Same,
    /// Declarations at the first use, too.
    Full,
}

/// The longest line of a function's head.
const WIDTH: usize = 110;

/// The tidied text.
pub(super) fn tidied(text: &str, style: Style) -> String {
    let mut result = String::with_capacity(text.len());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.starts_with("fn ") && line.ends_with('{') {
            let body: Vec<&str> = lines.by_ref().take_while(|line| *line != "}").collect();
            function(line, &body.join("\n"), style, &mut result);
        } else if line.starts_with("@group(") {
            // The variable is on the next line.
            result.push_str(line.trim_end());
            result.push(' ');
        } else {
            result.push_str(line.trim_end());
            result.push('\n');
        }
    }
    result
}

fn function(head: &str, body: &str, style: Style, result: &mut String) {
    result.push_str(&broken(head));
    match parse::body(body) {
        Some(mut block) => {
            loops::rewrite(&mut block);
            if style == Style::Full {
                scopes::sink(&mut block);
            }
            print::block(&block, 1, result);
        }
        None => {
            body.lines().for_each(|line| {
                result.push_str(line.trim_end());
                result.push('\n');
            });
        }
    }
    result.push_str("}\n");
}

/// The head of a function; if it is long, with a line for each parameter.
fn broken(head: &str) -> String {
    let parts = (head.len() > WIDTH).then(|| {
        let open = head.find('(')?;
        let close = closing(head, open)?;
        Some((head.get(..=open)?, head.get(open + 1..close)?, head.get(close..)?))
    });
    let Some(Some((name, parameters, rest))) = parts else { return format!("{head}\n") };
    let lines: String = split(parameters).iter().map(|parameter| format!("    {parameter},\n")).collect();
    format!("{name}\n{lines}{rest}\n")
}

/// The place of the parenthesis that closes the one at `open`.
fn closing(text: &str, open: usize) -> Option<usize> {
    let mut depth = 0;
    for (at, byte) in text.bytes().enumerate().skip(open) {
        match byte {
            b'(' => depth += 1,
            b')' => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// The parts between the commas that are in no brackets.
fn split(text: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'(' | b'<' | b'[' => depth += 1,
            b')' | b'>' | b']' => depth -= 1,
            b',' if depth == 0 => {
                parts.push(text.get(start..at).unwrap_or("").trim());
                start = at + 1;
            }
            _ => {}
        }
    }
    let last = text.get(start..).unwrap_or("").trim();
    if !last.is_empty() {
        parts.push(last);
    }
    parts
}
