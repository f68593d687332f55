//! The rows of inputs of a test.
//!
//! *In:* the parameters of a function, and what a test says about them. *Out:* rows of numbers. *Holds:* the rows are the same on every run.
//! Every combination of listed values occurs, with each corner of the ranges if there are as many rows; numbers by chance come after these.

use super::table::{MOST_CASES, Table, Values};
use super::value::in_order;
use crate::numeric::Shape;
use glisten_front::hir::Scalar;
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
    pub(super) shape: Shape,
}

/// The values of a parameter as numbers.
#[derive(Clone, Debug, PartialEq)]
enum Column {
    Range([f64; 2]),
    /// Each with all of its components.
    List(Vec<Vec<f64>>),
    Unit,
}

/// The rows of a table for these parameters.
pub(super) fn rows(table: &Table, parameters: &[Parameter]) -> Result<Vec<Vec<f64>>, (u32, String)> {
    for (line, name, _) in &table.values {
        if !parameters.iter().any(|parameter| parameter.name == *name) {
            return Err((*line, format!("the function has no parameter `{name}`")));
        }
    }
    let shapes: Vec<Shape> = parameters.iter().map(|parameter| parameter.shape).collect();
    let width: usize = shapes.iter().map(|shape| shape.size()).sum();
    let mut rows = Vec::new();
    for row in &table.rows {
        let size: usize = row.inputs.iter().map(super::value::Value::size).sum();
        if size != width {
            return Err((row.line, format!("the arguments are {size} numbers, and the parameters have {width}")));
        }
        rows.push(in_order(&row.inputs, &shapes).map_err(|message| (row.line, message))?);
    }
    if !table.rows.is_empty() {
        return match table.values.first() {
            Some((line, name, _)) => Err((*line, format!("`{name}` has values by rows already"))),
            None => Ok(rows),
        };
    }
    let mut columns = Vec::new();
    for parameter in parameters {
        columns.push(column(table, parameter)?);
    }
    made(&columns, parameters, table.cases).map_err(|message| (0, message))
}

/// The values of a parameter.
fn column(table: &Table, parameter: &Parameter) -> Result<Column, (u32, String)> {
    let Parameter { name, shape } = parameter;
    let Some((line, _, values)) = table.values.iter().find(|(_, known, _)| known == name) else {
        if shape.scalar == Scalar::Bool && shape.size() == 1 {
            return Ok(Column::List(vec![vec![0.0], vec![1.0]]));
        }
        return Err((0, format!("the parameter `{name}` has no values: write `//! {name} = 0..1`, or a list")));
    };
    let column = match values {
        Values::Unit if shape.is_vector() => Ok(Column::Unit),
        Values::Unit => Err(format!("`{name}` is not a vector, so it has no direction")),
        Values::Range(range) => limited(name, *range, shape.scalar).map(Column::Range),
        Values::List(list) => {
            let whole = list.iter().map(|value| match (value.size(), shape.size()) {
                (given, size) if given != 1 && given != size => {
                    Err(format!("`{name}` has {size} components, not {given}"))
                }
                (_, size) => {
                    let part = value.as_part_of(*shape)?;
                    Ok(if let [one] = part.as_slice() { vec![*one; size] } else { part })
                }
            });
            whole.collect::<Result<_, String>>().map(Column::List)
        }
    };
    column.map_err(|message| (*line, message))
}

/// A range of the values that a type has.
fn limited(name: &str, [low, high]: [f64; 2], scalar: Scalar) -> Result<[f64; 2], String> {
    let (least, greatest) = match scalar {
        Scalar::Float => return Ok([low, high]),
        Scalar::Bool => return Err(format!("`{name}` is a `bool`: write `{name} in true false`")),
        Scalar::Int => (f64::from(i32::MIN), f64::from(i32::MAX)),
        Scalar::Uint => (0.0, f64::from(u32::MAX)),
    };
    let [low, high] = [low.ceil(), high.floor()];
    match low <= high && low >= least && high <= greatest {
        true => Ok([low, high]),
        false if low > high => Err(format!("the range of `{name}` has no whole number")),
        false => Err(format!("the range of `{name}` goes beyond those of a `{}`", scalar.name())),
    }
}

/// The rows of columns.
fn made(columns: &[Column], parameters: &[Parameter], cases: Option<usize>) -> Result<Vec<Vec<f64>>, String> {
    let mut random = SplitMix64::new(SEED);
    let combinations = columns.iter().fold(1_usize, |count, column| match column {
        Column::List(list) => count.saturating_mul(list.len()),
        _ => count,
    });
    if combinations > MOST_CASES {
        let many = format!("the listed values have {combinations} combinations");
        return Err(format!("{many}, and a test has at most {MOST_CASES} cases"));
    }
    let ranges = columns.iter().filter(|column| matches!(column, Column::Range(_))).count();
    let corners = if ranges <= MOST_CORNERS { 1_usize << ranges } else { 0 };
    let axes = columns.iter().zip(parameters).filter(|(column, _)| **column == Column::Unit);
    let ends = axes.map(|(_, parameter)| 2 * parameter.shape.size()).fold(corners.max(1), usize::max);
    let all = combinations.saturating_mul(ends);
    let count = match cases {
        _ if columns.iter().all(|column| matches!(column, Column::List(_))) => combinations,
        Some(cases) => cases.max(combinations),
        None => CASES.max(if all <= MOST_CASES { all } else { combinations }),
    };
    // Where there is no room for each combination with each end, both change from row to row.
    let rows_an_end = if all <= count { combinations } else { 1 };
    let mut rows = Vec::new();
    for number in 0..count {
        let end = number / rows_an_end;
        let (mut row, mut left, mut corner) = (Vec::new(), number, end);
        for (column, parameter) in columns.iter().zip(parameters) {
            let size = parameter.shape.size();
            match column {
                Column::List(list) => {
                    let value = list.get(left % list.len().max(1)).map_or(&[][..], Vec::as_slice);
                    left /= list.len().max(1);
                    row.extend(value.iter().map(|number| parameter.stored(*number)));
                }
                Column::Range([low, high]) => {
                    let at_high = corner % 2 == 1;
                    corner /= 2;
                    for _ in 0..size {
                        let by_chance = random.unit();
                        let value = match end < corners {
                            true if at_high => *high,
                            true => *low,
                            false if parameter.shape.scalar.is_integer() => {
                                low + (by_chance * (high - low + 1.0)).floor()
                            }
                            false => low + by_chance * (high - low),
                        };
                        row.push(parameter.stored(value).clamp(parameter.stored(*low), parameter.stored(*high)));
                    }
                }
                Column::Unit => row.extend(direction(end, size, &mut random)),
            }
        }
        rows.push(row);
    }
    Ok(rows)
}

impl Parameter {
    /// The number as the parameter stores it.
    fn stored(&self, number: f64) -> f64 {
        if self.shape.scalar == Scalar::Float { f64::from(number as f32) } else { number }
    }
}

/// A direction: those of the axes first, then by chance.
fn direction(number: usize, size: usize, random: &mut SplitMix64) -> Vec<f64> {
    if number < 2 * size {
        let sign = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        return (0..size).map(|index| if index == number / 2 { sign } else { 0.0 }).collect();
    }
    loop {
        let vector: Vec<f64> = (0..size).map(|_| 2.0 * random.unit() - 1.0).collect();
        let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length > 0.1 && (length <= 1.0 || size == 1) {
            return vector.iter().map(|part| f64::from((part / length) as f32)).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Parameter, rows};
    use crate::numeric::Shape;
    use crate::unit_test::table::Table;
    use glisten_front::hir::Scalar;

    fn parameter(name: &str, size: u32) -> Parameter {
        Parameter { name: name.to_owned(), shape: Shape { scalar: Scalar::Float, columns: 1, rows: size } }
    }

    fn made(line: &str, parameters: &[Parameter]) -> Vec<Vec<f64>> {
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
    fn every_end_meets_every_listed_value() {
        let all = made("a = 0..1, b = 1 2 3", &[parameter("a", 1), parameter("b", 1)]);
        let wanted = [0.0, 1.0].into_iter().flat_map(|end| [1.0, 2.0, 3.0].map(|listed| vec![end, listed]));
        assert_eq!(all[..6], wanted.collect::<Vec<_>>());
        assert_eq!(all.len(), 256);
    }

    #[test]
    fn integers_keep_all_of_their_bits() {
        let whole = |scalar| Parameter { name: "i".to_owned(), shape: Shape { scalar, columns: 1, rows: 1 } };
        assert_eq!(made("i in 16777217 2147483647", &[whole(Scalar::Int)]), [[16_777_217.0], [2_147_483_647.0]]);
        let ends = made("i = 0.5..4294967295", &[whole(Scalar::Uint)]);
        assert_eq!(ends[..2], [[1.0], [4_294_967_295.0]]);
        let told = |line: &str, scalar| {
            let table = Table::read(&[(1, line.to_owned())]).expect("it is read");
            rows(&table, &[whole(scalar)]).expect_err(line).1
        };
        assert!(told("i = 0.2..0.8", Scalar::Int).contains("no whole number"));
        assert!(told("i = -1..1", Scalar::Uint).contains("beyond those of a `uint`"));
        assert!(told("i = 0..1", Scalar::Bool).contains("write `i in true false`"));
        assert!(told("i in 1.5", Scalar::Int).contains("not of type `int`"));
    }

    #[test]
    fn too_many_combinations_are_told() {
        let five = ["a", "b", "c", "d", "e"].map(|name| parameter(name, 1));
        let listed: Vec<String> = five.iter().map(|one| format!("{} in 0 1 2 3 4 5 6 7 8 9", one.name)).collect();
        let table = Table::read(&[(1, listed.join(", "))]).expect("it is read");
        let (_, told) = rows(&table, &five).expect_err("they are too many");
        assert_eq!(told, "the listed values have 100000 combinations, and a test has at most 65536 cases");
    }

    #[test]
    fn directions_have_the_length_one() {
        let all = made("n = unit", &[parameter("n", 3)]);
        assert_eq!(all[0], [1.0, 0.0, 0.0]);
        for row in all {
            assert!((row.iter().map(|part| part * part).sum::<f64>() - 1.0).abs() < 1e-6, "{row:?}");
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
