//! The rows of inputs of a test.
//!
//! *In:* the parameters of a function, and what a test says about them. *Out:* rows of numbers. *Holds:* the rows are the same on every run.
//! The corners of ranges come first, then numbers by chance; every combination of listed values occurs.

use super::table::{MOST_CASES, Table, Values};
use glisten_scene::random::SplitMix64;

/// The rows that are made of ranges, if a test does not say how many.
const CASES: usize = 256;
/// The most ranges of which all corners are tried.
const MOST_CORNERS: usize = 8;
/// The seed of the numbers.
const SEED: u64 = 1;

/// A parameter of a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Parameter {
    pub(super) name: String,
    /// The number of its components.
    pub(super) size: usize,
    /// Whether they are whole numbers.
    pub(super) is_whole: bool,
    pub(super) is_bool: bool,
    /// Whether it is a vector of floats.
    pub(super) is_vector: bool,
}

/// The rows of a table for these parameters.
pub(super) fn rows(table: &Table, parameters: &[Parameter]) -> Result<Vec<Vec<f32>>, (u32, String)> {
    for (line, name, _) in &table.values {
        if !parameters.iter().any(|parameter| parameter.name == *name) {
            return Err((*line, format!("the function has no parameter `{name}`")));
        }
    }
    let width: usize = parameters.iter().map(|parameter| parameter.size).sum();
    for row in &table.rows {
        if row.inputs.len() != width {
            let message = format!("the arguments are {} numbers, and the parameters have {width}", row.inputs.len());
            return Err((row.line, message));
        }
    }
    if !table.rows.is_empty() {
        if let Some((line, name, _)) = table.values.first() {
            return Err((*line, format!("`{name}` has values by rows already")));
        }
        return Ok(table.rows.iter().map(|row| row.inputs.iter().map(|number| *number as f32).collect()).collect());
    }
    let mut columns = Vec::new();
    for parameter in parameters {
        columns.push(column(table, parameter)?);
    }
    Ok(made(&columns, parameters, table.cases.unwrap_or(CASES)))
}

/// The values of a parameter.
fn column(table: &Table, parameter: &Parameter) -> Result<Values, (u32, String)> {
    let name = &parameter.name;
    let Some((line, _, values)) = table.values.iter().find(|(_, known, _)| known == name) else {
        if parameter.is_bool && parameter.size == 1 {
            return Ok(Values::List(vec![vec![0.0], vec![1.0]]));
        }
        return Err((0, format!("the parameter `{name}` has no values: write `//! {name} = 0..1`, or a list")));
    };
    let wrong = |message: String| Err((*line, message));
    match values {
        Values::Unit if !parameter.is_vector => wrong(format!("`{name}` is not a vector, so it has no direction")),
        Values::List(list) => {
            let mut whole = Vec::new();
            for value in list {
                whole.push(match value.as_slice() {
                    [one] => vec![*one; parameter.size],
                    all if all.len() == parameter.size => all.to_vec(),
                    all => return wrong(format!("`{name}` has {} components, not {}", parameter.size, all.len())),
                });
            }
            Ok(Values::List(whole))
        }
        values => Ok(values.clone()),
    }
}

/// The rows of columns.
fn made(columns: &[Values], parameters: &[Parameter], cases: usize) -> Vec<Vec<f32>> {
    let mut random = SplitMix64::new(SEED);
    let combinations = columns.iter().fold(1_usize, |count, column| match column {
        Values::List(list) => count.saturating_mul(list.len()),
        _ => count,
    });
    let ranges = columns.iter().filter(|column| matches!(column, Values::Range(_))).count();
    let all_listed = columns.iter().all(|column| matches!(column, Values::List(_)));
    let corners = if ranges <= MOST_CORNERS { 1_usize << ranges } else { 0 };
    let count = if all_listed { combinations } else { cases.max(combinations) }.min(MOST_CASES);
    let mut rows = Vec::new();
    for number in 0..count {
        let (mut row, mut left, mut corner) = (Vec::new(), number, number);
        for (column, parameter) in columns.iter().zip(parameters) {
            match column {
                Values::List(list) => {
                    let value = list.get(left % list.len().max(1)).map_or(&[][..], Vec::as_slice);
                    left /= list.len().max(1);
                    row.extend(value.iter().map(|number| *number as f32));
                }
                Values::Range([low, high]) => {
                    let at_high = corner % 2 == 1;
                    corner /= 2;
                    for _ in 0..parameter.size {
                        let by_chance = random.unit();
                        let value = match number < corners {
                            true if at_high => *high,
                            true => *low,
                            false if parameter.is_whole => {
                                low.ceil() + (by_chance * (high.floor() - low.ceil() + 1.0)).floor()
                            }
                            false => low + by_chance * (high - low),
                        };
                        row.push((value as f32).clamp(*low as f32, *high as f32));
                    }
                }
                Values::Unit => row.extend(direction(number, parameter.size, &mut random)),
            }
        }
        rows.push(row);
    }
    rows
}

/// A direction: those of the axes first, then by chance.
fn direction(number: usize, size: usize, random: &mut SplitMix64) -> Vec<f32> {
    if number < 2 * size {
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        return (0..size).map(|index| if index == number / 2 { sign } else { 0.0 }).collect();
    }
    loop {
        let vector: Vec<f64> = (0..size).map(|_| 2.0 * random.unit() - 1.0).collect();
        let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length > 0.1 && (length <= 1.0 || size == 1) {
            return vector.iter().map(|part| (part / length) as f32).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Parameter, rows};
    use crate::unit_test::table::Table;

    fn parameter(name: &str, size: usize) -> Parameter {
        Parameter { name: name.to_owned(), size, is_whole: false, is_bool: false, is_vector: size > 1 }
    }

    fn made(line: &str, parameters: &[Parameter]) -> Vec<Vec<f32>> {
        let table = Table::read(&[(1, line.to_owned())]).expect("it is right");
        rows(&table, parameters).expect("they fit")
    }

    #[test]
    fn every_combination_and_every_corner_occurs() {
        let both = [parameter("a", 1), parameter("b", 1)];
        let all = made("a = 1 2, b = 3 4 5", &both);
        assert_eq!(all.len(), 6);
        assert!(all.contains(&vec![2.0, 5.0]) && all.contains(&vec![1.0, 4.0]));
        let corners = made("a = 0..1, b = -2..2", &both);
        assert_eq!(corners.len(), 256);
        assert_eq!(corners[..4], [[0.0, -2.0], [1.0, -2.0], [0.0, 2.0], [1.0, 2.0]]);
        assert!(corners.iter().all(|row| (0.0..=1.0).contains(&row[0]) && row[1].abs() <= 2.0));
    }

    #[test]
    fn directions_have_the_length_one() {
        let all = made("n = unit", &[parameter("n", 3)]);
        assert_eq!(all[0], [1.0, 0.0, 0.0]);
        for row in all {
            assert!((row.iter().map(|part| part * part).sum::<f32>() - 1.0).abs() < 1e-6, "{row:?}");
        }
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let one = [parameter("a", 1)];
        let told = |line: &str| {
            let table = Table::read(&[(1, line.to_owned())]).expect("it is read");
            rows(&table, &one).expect_err(line).1
        };
        assert!(told("b = 1").contains("no parameter `b`"));
        assert!(told("a = unit").contains("not a vector"));
        assert!(told("a = vec2(1, 2)").contains("has 1 components, not 2"));
        assert!(told("1, 2 => 3").contains("2 numbers"));
        assert!(told("cases 3").contains("has no values"));
    }
}
