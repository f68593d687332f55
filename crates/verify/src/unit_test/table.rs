//! The lines of a test: the values of parameters, rows with expected results, tolerances.
//!
//! ```text
//! x = -1..1, t in 0.0 0.5 1.0        ranges and lists by the names of parameters; `n = unit` is a direction
//! 0.0, 10.0, 0.25 => 2.5             arguments in order, and the result that is expected
//! vec3(1, 0, 0), 2.0 => vec3(2, 0, 0)
//! cases 1000                         how many rows are made of ranges
//! tolerance 1e-6                     absolute, besides the envelope
//! ```
//!
//! *In:* lines. *Out:* a [`Table`]. *Holds:* a line that means nothing is an error with its number.

use super::value::{Value, number, values};

/// The values that a parameter takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Values {
    /// Each component is a number between these.
    Range([f64; 2]),
    /// These; a single number stands for all components.
    List(Vec<Value>),
    /// Directions of length 1.
    Unit,
}

/// A row with an expected result.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) line: u32,
    pub(super) inputs: Vec<Value>,
    pub(super) expected: Vec<Value>,
}

/// Inputs and results as a test states them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Table {
    /// Parameters and their values, each with its line.
    pub(super) values: Vec<(u32, String, Values)>,
    pub(super) rows: Vec<Row>,
    pub(super) cases: Option<usize>,
    pub(super) tolerance: Option<f64>,
}

/// A line that cannot be read, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Unread {
    pub(super) line: u32,
    pub(super) message: String,
}

/// The most rows of a test.
pub(super) const MOST_CASES: usize = 65_536;

impl Table {
    pub(super) fn read(lines: &[(u32, String)]) -> Result<Self, Unread> {
        let mut table = Self::default();
        for (line, text) in lines {
            table.line(*line, text).map_err(|message| Unread { line: *line, message })?;
        }
        Ok(table)
    }

    fn line(&mut self, line: u32, text: &str) -> Result<(), String> {
        if let Some((inputs, expected)) = text.split_once("=>") {
            let inputs = values(inputs)?;
            let expected = values(expected)?;
            if expected.is_empty() {
                return Err("a number is missing".to_owned());
            }
            self.rows.push(Row { line, inputs, expected });
            return Ok(());
        }
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        match word {
            "cases" => {
                let count = rest.trim().parse().ok().filter(|count| (1..=MOST_CASES).contains(count));
                self.cases = Some(count.ok_or_else(|| format!("`cases` takes a number from 1 to {MOST_CASES}"))?);
            }
            "tolerance" => {
                let size = rest.trim().parse().ok().filter(|size: &f64| size.is_finite() && *size >= 0.0);
                self.tolerance = Some(size.ok_or("`tolerance` takes a number that is not negative")?);
            }
            _ => {
                for part in assignments(text) {
                    let (name, values) = assignment(part)?;
                    if self.values.iter().any(|(_, known, _)| *known == name) {
                        return Err(format!("`{name}` has values already"));
                    }
                    self.values.push((line, name, values));
                }
            }
        }
        Ok(())
    }
}

/// The parts of a line between commas or semicolons, at which a name begins.
fn assignments(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    for (at, _) in text.match_indices([',', ';']) {
        let rest = text.get(at + 1..).unwrap_or("").trim_start();
        let name: usize = rest.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count();
        let behind = rest.get(name..).unwrap_or("").trim_start();
        let begins = rest.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
        if begins && (behind.starts_with('=') || behind.starts_with("in ")) {
            parts.push(text.get(start..at).unwrap_or(""));
            start = at + 1;
        }
    }
    parts.push(text.get(start..).unwrap_or(""));
    parts
}

fn assignment(text: &str) -> Result<(String, Values), String> {
    let text = text.trim();
    let split = text.split_once('=').or_else(|| text.split_once(" in "));
    let Some((name, listed)) = split else {
        return Err(format!("`{text}` is no `name = values`, no `arguments => result`, no `cases` and no `tolerance`"));
    };
    let (name, listed) = (name.trim(), listed.trim());
    if name.is_empty() || !name.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
        return Err(format!("`{name}` is not the name of a parameter"));
    }
    if listed == "unit" {
        return Ok((name.to_owned(), Values::Unit));
    }
    if let Some((low, high)) = listed.split_once("..") {
        return match (number(low.trim()), number(high.trim())) {
            (Some(low), Some(high)) if low <= high => Ok((name.to_owned(), Values::Range([low, high]))),
            _ => Err(format!("`{listed}` is no range: write `low..high`")),
        };
    }
    let inner = listed.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(listed);
    let list = values(inner)?;
    if list.is_empty() {
        return Err(format!("`{name}` has no values"));
    }
    Ok((name.to_owned(), Values::List(list)))
}

#[cfg(test)]
mod tests {
    use super::{Row, Table, Values, values};

    fn read(lines: &[&str]) -> Result<Table, String> {
        let lines: Vec<(u32, String)> = (1..).zip(lines.iter().map(|line| (*line).to_owned())).collect();
        Table::read(&lines).map_err(|unread| format!("{}: {}", unread.line, unread.message))
    }

    #[test]
    fn ranges_lists_and_rows_are_read() {
        let table =
            read(&["x = -1..1, t in 0.0, 0.5 1.0; n = unit", "cases 10", "tolerance 1e-6"]).expect("it is right");
        let list = Values::List(values("0.0 0.5 1.0").expect("they are numbers"));
        let found: Vec<_> = table.values.iter().map(|(_, name, values)| (name.as_str(), values.clone())).collect();
        assert_eq!(found, [("x", Values::Range([-1.0, 1.0])), ("t", list), ("n", Values::Unit)]);
        assert_eq!((table.cases, table.tolerance), (Some(10), Some(1e-6)));
        let table = read(&["vec3(1, 0, 0), 2.0 => vec3(2.0, 0, 0)", "=> true"]).expect("it is right");
        let read = |text| values(text).expect("they are values");
        let row = Row { line: 1, inputs: read("vec3(1, 0, 0) 2.0"), expected: read("vec3(2.0, 0, 0)") };
        assert_eq!(table.rows, [row, Row { line: 2, inputs: Vec::new(), expected: read("true") }]);
    }

    #[test]
    fn what_means_nothing_is_told_with_its_line() {
        for (line, message) in [
            ("x", "1: `x` is no `name = values`"),
            ("x = 1..a", "1: `1..a` is no range"),
            ("x = ", "1: `x` has no values"),
            ("cases 0", "1: `cases` takes"),
            ("1.0 => y", "1: `y` is not a number"),
            ("x = 1, x = 2", "1: `x` has values already"),
        ] {
            let told = read(&[line]).expect_err(line);
            assert!(told.starts_with(message), "{told}");
        }
    }
}
