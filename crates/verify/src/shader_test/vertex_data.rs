//! `[vertex data]`: a table whose columns are columns of attributes.

use super::known::{self, DATA};
use super::words::{Line, parse_integer, parse_number};
use super::{TestResult, fail, skip};
use crate::numeric::TYPES;

/// A column of the table: components of an attribute, or of one of its matrix columns or array elements.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// The attribute's name, without an index.
    pub(super) attribute: String,
    /// The location within the attribute: the array index times the columns of an element, plus the column.
    pub(super) element: u32,
    /// The matrix column.
    pub(super) column: u32,
    /// The number of components.
    pub(super) size: u32,
    /// Whether the numbers are integers, so that hexadecimal ones are not the bits of floats.
    pub(super) is_integer: bool,
    /// All rows, `size` numbers each.
    pub(super) values: Vec<f64>,
}

/// The whole table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct VertexData {
    /// The line of the header.
    pub(super) line: u32,
    pub(super) columns: Vec<Column>,
    pub(super) rows: u32,
}

/// Parses the table.
pub(super) fn parse(lines: &[Line]) -> Result<VertexData, TestResult> {
    let Some((head, rows)) = lines.split_first() else { return Ok(VertexData::default()) };
    let mut columns =
        head.text.split_whitespace().map(|word| header(head.number, word)).collect::<Result<Vec<Column>, _>>()?;
    for line in rows {
        let mut words = line.text.split_whitespace();
        for column in &mut columns {
            for _ in 0..column.size {
                let Some(word) = words.next() else { return fail(line.number, "the row is shorter than its header") };
                match if column.is_integer { parse_integer(word) } else { parse_number(word) } {
                    Some(value) => column.values.push(value),
                    None => return fail(line.number, format_args!("`{word}` is not a number")),
                }
            }
        }
        if words.next().is_some() {
            return fail(line.number, "the row is longer than its header");
        }
    }
    Ok(VertexData { line: head.number, columns, rows: rows.len() as u32 })
}

/// `name[1]/float/vec3`, or `name/float/mat3/2`.
fn header(line: u32, word: &str) -> Result<Column, TestResult> {
    let mut parts = word.split('/');
    let (Some(name), Some(data), Some(shape)) = (parts.next(), parts.next(), parts.next()) else {
        return fail(line, format_args!("`{word}` is not name/type/type"));
    };
    if !matches!(data, "float" | "int" | "uint") {
        return known::unsupported(line, data, "a type of vertex data", DATA);
    }
    let index = |text: &str, what: &str| match text.parse::<u32>() {
        Ok(index) => Ok(index),
        Err(_) => fail(line, format_args!("`{text}` of `{word}` is not the number of {what}")),
    };
    let column = parts.next().map_or(Ok(0), |text| index(text, "a column"))?;
    if parts.next().is_some() {
        return fail(line, format_args!("`{word}` is not name/type/type/column"));
    }
    let (attribute, element) = match name.strip_suffix(']').and_then(|name| name.rsplit_once('[')) {
        Some((attribute, text)) => (attribute, index(text, "an element")?),
        None => (name, 0),
    };
    let Some(size) = components(shape) else { return other_shape(line, shape) };
    Ok(Column { attribute: attribute.into(), element, column, size, is_integer: data != "float", values: Vec::new() })
}

/// Skips attributes of doubles, and fails for what is no type.
fn other_shape<T>(line: u32, shape: &str) -> Result<T, TestResult> {
    match shape.starts_with('d') {
        true => skip(line, format_args!("attributes of type `{shape}`")),
        false => known::mistake(line, shape, "a type of an attribute", TYPES.iter().map(|row| row.0)),
    }
}

/// How many numbers a type has (for a matrix, per column): `vec3`, `mat2x3`, or just `3`.
fn components(shape: &str) -> Option<u32> {
    if let Ok(count) = shape.parse() {
        return (1..=4).contains(&count).then_some(count);
    }
    if let Some(matrix) = shape.strip_prefix("mat") {
        return matrix.rsplit('x').next().and_then(|rows| rows.parse().ok()).filter(|rows| (2..=4).contains(rows));
    }
    if let Some(size) = ["vec", "ivec", "uvec"].iter().find_map(|prefix| shape.strip_prefix(prefix)) {
        return size.parse().ok().filter(|size| (2..=4).contains(size));
    }
    matches!(shape, "float" | "int" | "uint").then_some(1)
}

#[cfg(test)]
mod unit {
    use super::*;

    fn lines(texts: &[&str]) -> Vec<Line> {
        (1..).zip(texts).map(|(number, text)| Line { number, text: (*text).into() }).collect()
    }

    #[test]
    fn headers_of_both_syntaxes() {
        let data =
            parse(&lines(&["piglit_vertex/float/2 m/float/mat2x3/1 a[1]/int/int", "1 2 3 4 5 6", "0 0 0 0 0 0x0"]))
                .expect("a table");
        assert_eq!(data.rows, 2);
        let shapes: Vec<_> = data.columns.iter().map(|c| (c.attribute.as_str(), c.element, c.column, c.size)).collect();
        assert_eq!(shapes, [("piglit_vertex", 0, 0, 2), ("m", 0, 1, 3), ("a", 1, 0, 1)]);
        assert_eq!(data.columns[1].values, [3.0, 4.0, 5.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn hexadecimal_integers_are_integers() {
        let data = parse(&lines(&["i/int/2 f/float/1", "-0x10 7 0x3f800000"])).expect("a table");
        assert_eq!(data.columns[0].values, [-16.0, 7.0]);
        assert_eq!(data.columns[1].values, [1.0]);
    }

    #[test]
    fn numbers_of_a_header_are_numbers() {
        for header in ["m/float/mat2/x", "m/float/mat2/0/1", "a[b]/float/float"] {
            assert!(matches!(parse(&lines(&[header])), Err(TestResult::Fail(_))), "{header}");
        }
    }

    #[test]
    fn ragged_rows_fail() {
        assert!(matches!(parse(&lines(&["p/float/2", "1"])), Err(TestResult::Fail(_))));
        assert!(matches!(parse(&lines(&["p/float/2", "1 2 3"])), Err(TestResult::Fail(_))));
        assert!(matches!(parse(&lines(&["p/double/2", "1 2"])), Err(TestResult::Skip(_))));
        assert!(matches!(parse(&lines(&["p/flaot/2", "1 2"])), Err(TestResult::Fail(_))));
        assert!(matches!(parse(&lines(&["p/float/vecc2", "1 2"])), Err(TestResult::Fail(_))));
    }
}
