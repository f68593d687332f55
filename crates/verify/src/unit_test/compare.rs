//! Compares the results of a function with what a test expects.
//!
//! *In:* inputs, results, and the envelope of results. *Out:* the cases that fail, each with a sentence. *Holds:* a number may differ from the
//! expected one by what a conforming GPU may round, and by the stated tolerance, and an integer by the latter alone; a result that nothing bounds
//! needs a stated tolerance.

use super::cases::Parameter;
use crate::numeric::Shape;
use glisten_front::hir::Scalar;
use glisten_scene::picture::Interval;

/// The expectation of a test.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Expected {
    /// A `bool` that is true.
    True,
    /// These numbers, a list for each row.
    Numbers(Vec<Vec<f64>>),
    /// The numbers of another function, by their intervals.
    Same,
    /// Numbers that are finite.
    Finite,
}

/// The results of a row on a backend.
pub(super) struct Row<'a> {
    pub(super) inputs: &'a [f64],
    /// The type of what is compared.
    pub(super) scalar: Scalar,
    pub(super) got: &'a [f64],
    /// The values that a conforming GPU may compute.
    pub(super) envelope: &'a [Interval],
    /// Those of what is expected, of [`Expected::Same`].
    pub(super) others: &'a [Interval],
}

/// How the results of a row fail, if they do. `number` is that of the row.
pub(super) fn fault(expected: &Expected, row: &Row<'_>, number: usize, tolerance: Option<f64>) -> Option<String> {
    match expected {
        Expected::True => (row.got.first() != Some(&1.0)).then(|| "is false".to_owned()),
        Expected::Finite => {
            let finite = row.got.iter().all(|value| value.is_finite());
            (!finite).then(|| format!("is {}, which is not finite", numbers(row.got, row.scalar)))
        }
        Expected::Numbers(rows) => {
            let wanted = rows.get(number)?;
            let limits = wanted.iter().map(|value| Interval { low: *value, high: *value, may_be_nan: false });
            differs(row, &limits.collect::<Vec<_>>(), &numbers(wanted, row.scalar), tolerance)
        }
        Expected::Same => {
            let middle: Vec<f64> = row.others.iter().map(|one| one.low + (one.high - one.low) / 2.0).collect();
            differs(row, row.others, &numbers(&middle, row.scalar), tolerance)
        }
    }
}

fn differs(row: &Row<'_>, wanted: &[Interval], told: &str, tolerance: Option<f64>) -> Option<String> {
    let stated = tolerance.unwrap_or(0.0);
    for ((got, envelope), wanted) in row.got.iter().zip(row.envelope).zip(wanted) {
        let bounded =
            |interval: &Interval| interval.low.is_finite() && interval.high.is_finite() && !interval.may_be_nan;
        if !bounded(envelope) || !bounded(wanted) {
            let middle = if bounded(wanted) { wanted.low + (wanted.high - wanted.low) / 2.0 } else { f64::NAN };
            match tolerance {
                Some(tolerance) if (got - middle).abs() <= tolerance => continue,
                Some(_) => return Some(format!("is {}, not {told}", numbers(row.got, row.scalar))),
                None => {
                    let message = "and nothing bounds what a GPU may compute there: state a `tolerance`";
                    return Some(format!("is {}, {message}", numbers(row.got, row.scalar)));
                }
            }
        }
        // An expected float is itself rounded.
        let unit = if row.scalar == Scalar::Float { f64::from(f32::EPSILON) } else { 0.0 };
        let room = stated + unit * wanted.low.abs().max(wanted.high.abs());
        let (low, high) = (envelope.low - room, envelope.high + room);
        let meets = wanted.low <= high && wanted.high >= low;
        let is_inside = *got >= low && *got <= high;
        if !meets || !is_inside {
            let may = if meets {
                let [low, high] = [envelope.low, envelope.high].map(|end| number(end, row.scalar));
                format!("; a conforming GPU computes {low} to {high}")
            } else {
                String::new()
            };
            return Some(format!("is {}, not {told}{may}", numbers(row.got, row.scalar)));
        }
    }
    None
}

/// Numbers as GLSL writes them, several in brackets.
fn numbers(values: &[f64], scalar: Scalar) -> String {
    match values {
        [one] => number(*one, scalar),
        all => format!("({})", all.iter().map(|value| number(*value, scalar)).collect::<Vec<_>>().join(", ")),
    }
}

fn number(value: f64, scalar: Scalar) -> String {
    match scalar {
        Scalar::Float => format!("{:?}", value as f32),
        Scalar::Int | Scalar::Uint => format!("{value:.0}"),
        Scalar::Bool => (value != 0.0).to_string(),
    }
}

/// The call of a row as people read it: `f(x = 0.5, n = (1.0, 0.0, 0.0))`.
pub(super) fn call(name: &str, parameters: &[Parameter], inputs: &[f64]) -> String {
    let mut rest = inputs;
    let mut told = Vec::new();
    for Parameter { name, shape } in parameters {
        let Shape { scalar, .. } = *shape;
        let (own, more) = rest.split_at(shape.size().min(rest.len()));
        rest = more;
        told.push(format!("{name} = {}", numbers(own, scalar)));
    }
    format!("{name}({})", told.join(", "))
}

#[cfg(test)]
mod tests {
    use super::{Expected, Row, fault};
    use glisten_front::hir::Scalar;
    use glisten_scene::picture::Interval;

    fn told(got: f64, [low, high]: [f64; 2], wanted: f64, tolerance: Option<f64>) -> Option<String> {
        let envelope = [Interval { low, high, may_be_nan: false }];
        let row = Row { inputs: &[], scalar: Scalar::Float, got: &[got], envelope: &envelope, others: &[] };
        fault(&Expected::Numbers(vec![vec![wanted]]), &row, 0, tolerance)
    }

    #[test]
    fn the_envelope_is_the_tolerance() {
        assert_eq!(told(1.0, [0.999, 1.001], 1.0005, None), None);
        assert_eq!(told(1.0, [0.999, 1.001], 1.5, None), Some("is 1.0, not 1.5".to_owned()));
        assert_eq!(told(1.0, [0.999, 1.001], 1.5, Some(0.5)), None);
        let outside = told(1.2, [0.999, 1.001], 1.0, None).expect("a GPU may not compute that");
        assert!(outside.contains("a conforming GPU computes 0.999 to 1.001"), "{outside}");
    }

    #[test]
    fn integers_are_exact() {
        let point = |at: f64| [Interval { low: at, high: at, may_be_nan: false }];
        let told = |got: f64, wanted: f64, scalar| {
            let row = Row { inputs: &[], scalar, got: &[got], envelope: &point(got), others: &[] };
            fault(&Expected::Numbers(vec![vec![wanted]]), &row, 0, None)
        };
        let [got, wanted] = [4_294_967_295.0, 4_294_967_294.0];
        assert_eq!(told(got, wanted, Scalar::Uint), Some("is 4294967295, not 4294967294".to_owned()));
        assert_eq!((told(got, got, Scalar::Uint), told(got, wanted, Scalar::Float)), (None, None));
        assert_eq!(told(1.0, 0.0, Scalar::Bool), Some("is true, not false".to_owned()));
    }

    #[test]
    fn what_nothing_bounds_needs_a_tolerance() {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        assert!(told(1.0, all, 1.0, None).is_some_and(|told| told.contains("state a `tolerance`")));
        assert_eq!(told(1.0, all, 1.0, Some(1e-6)), None);
        assert!(told(f64::NAN, all, 1.0, Some(1e-6)).is_some());
    }
}
