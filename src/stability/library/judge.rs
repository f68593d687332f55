//! [`judge`]: the error of a function's f32, and how much of it the rounding of its inputs explains.
//!
//! *In:* a function with its inputs. *Out:* its [`Figures`], and those of its naive form. *Holds:* the truth is f64, or 192
//! bits where f64 could be wrong. An error is explained if moving each input by an ULP changes the exact result nearly as
//! much: then the problem is ill-conditioned there, or the result jumps, and no formula helps.

use super::calls::{Calls, Rows, moved};
use super::{Bound, BoundUnit, ROUNDING, Verdict, parameters};
use crate::evaluate::EvaluateError;
use glisten_reference::stability::Arithmetic;
use serde::Serialize;
use std::collections::BTreeMap;

/// How often the inputs are moved.
const MOVES: u64 = 8;

/// How many times the change by moving the inputs an error may be to count as explained: directions round twice, once when
/// they are normalized and once as inputs, and the moves find half of the worst direction at best.
const EXPLAINED: f64 = 8.0;

/// An unexplained error of this share of the result's size is another result altogether.
const ANOTHER: f64 = 0.25;

/// How many of the worst rows are checked in 192 bits.
const CHECKED: usize = 64;

/// The figures of a function.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Figures {
    /// The largest error in ULP of the largest number of the exact result.
    pub max_ulp: f64,
    /// The largest error.
    pub max_abs: f64,
    /// The largest error beyond what moving the inputs by an ULP explains, as the bound counts it.
    pub unexplained: f64,
    /// By how much the function magnifies relative errors of its inputs, at the largest error.
    pub condition: f64,
    /// The number of calls with a result that is not finite.
    pub non_finite: usize,
    /// The number of calls with another result altogether, which nothing explains.
    pub another: usize,
    /// Whether 192 bits were needed for the truth.
    pub beyond_f64: bool,
    #[serde(skip)]
    worst: usize,
    /// The largest unexplained error relative to 1 or to the result, whichever is larger.
    #[serde(skip)]
    beyond_rounding: f64,
}

/// The figures of a naive form.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Naive {
    /// The form, as GLSL.
    pub form: String,
    /// The largest error in ULP.
    pub max_ulp: f64,
    /// The largest error against its own exact value, where that is finite.
    pub max_abs: f64,
    /// The number of calls with a result that is not finite in f32.
    pub non_finite: usize,
    /// The number of those that are not finite in exact arithmetic either: the equation has no value there.
    pub undefined: usize,
    /// The smallest and the largest number among the finite results.
    pub range: [f64; 2],
    /// The operations of a call of the function and of the naive form.
    pub operations: [f64; 2],
    #[serde(skip)]
    pub(super) ratio: Option<f64>,
}

fn size(row: &[f64]) -> f64 {
    row.iter().fold(0.0, |most, number| f64::max(most, number.abs()))
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let each = a.iter().zip(b).map(|(a, b)| if a == b { 0.0 } else { (a - b).abs() });
    // A NaN is as far away as anything.
    each.fold(0.0, |most, apart| if apart.is_nan() { f64::INFINITY } else { f64::max(most, apart) })
}

fn is_finite(row: &[f64]) -> bool {
    row.iter().all(|number| number.is_finite())
}

/// An ULP of f32 at a number of this size.
fn ulp(size: f64) -> f64 {
    f64::from(size.clamp(f64::from(f32::MIN_POSITIVE), f64::from(f32::MAX)) as f32) * f64::from(f32::EPSILON)
}

/// The exact results. f64's are good enough unless those with the largest errors are not.
fn truth(calls: &Calls, inputs: &[f32], single: &Rows) -> Result<(Rows, bool), EvaluateError> {
    let double = calls.results(inputs, Arithmetic::Double)?;
    let errors: Vec<f64> = single.iter().zip(&double).map(|(single, double)| apart(single, double)).collect();
    let mut order: Vec<usize> = (0..errors.len()).collect();
    order.sort_by(|a, b| errors[*b].total_cmp(&errors[*a]));
    order.truncate(CHECKED);
    let width = calls.width();
    let rows = order.iter().filter_map(|row| inputs.get(row * width..(row + 1) * width));
    let exact = if width == 0 {
        double.clone()
    } else {
        calls.results(&rows.flatten().copied().collect::<Vec<_>>(), Arithmetic::Exact)?
    };
    let is_enough = order.iter().zip(&exact).all(|(row, exact)| {
        let double = &double[*row];
        !is_finite(exact) || apart(exact, double) <= errors[*row] / 16.0 + ulp(size(exact)) / 16.0
    });
    Ok(if is_enough { (double, false) } else { (calls.results(inputs, Arithmetic::Exact)?, true) })
}

/// How far moving the inputs by an ULP moves each exact result.
fn changes(calls: &Calls, inputs: &[f32], exact: &Rows) -> Result<Vec<f64>, EvaluateError> {
    let mut most = vec![0.0; exact.len()];
    for seed in 0..MOVES {
        let results = calls.results(&moved(inputs, seed), Arithmetic::Double)?;
        for ((most, exact), result) in most.iter_mut().zip(exact).zip(&results) {
            *most = f64::max(*most, apart(result, exact));
        }
    }
    Ok(most)
}

/// The figures of a function over inputs that its model allows.
pub(super) fn judge(calls: &Calls, inputs: &[f32], bound: Option<&Bound>) -> Result<Figures, EvaluateError> {
    let single = calls.results(inputs, Arithmetic::Single)?;
    let (exact, beyond_f64) = truth(calls, inputs, &single)?;
    let changes = if calls.width() == 0 { vec![0.0; exact.len()] } else { changes(calls, inputs, &exact)? };
    let unit = bound.map_or(BoundUnit::Abs, |bound| bound.unit);
    let mut figures = Figures { beyond_f64, ..Figures::default() };
    let mut worst = -1.0;
    for (row, ((single, exact), change)) in single.iter().zip(&exact).zip(changes).enumerate() {
        if !is_finite(single) || !is_finite(exact) {
            figures.non_finite += 1;
            continue;
        }
        let (error, size) = (apart(single, exact), size(exact));
        let left = (error - EXPLAINED * change).max(0.0);
        let of_one = left / size.max(1.0);
        figures.max_abs = figures.max_abs.max(error);
        figures.max_ulp = figures.max_ulp.max(error / ulp(size));
        figures.beyond_rounding = figures.beyond_rounding.max(of_one);
        figures.another += usize::from(left > ANOTHER * size.max(f64::from(f32::MIN_POSITIVE)) && of_one > ROUNDING);
        let judged = match unit {
            BoundUnit::Abs => left,
            // A result that f32 flushes to 0 has no relative error.
            BoundUnit::Rel => left / size.max(f64::from(f32::MIN_POSITIVE) / f64::from(f32::EPSILON)),
        };
        figures.unexplained = figures.unexplained.max(judged);
        let badness = judged + error.min(1.0) * 1e-9;
        if badness > worst {
            worst = badness;
            figures.worst = row;
            figures.condition = if size > 0.0 { change / size / f64::from(f32::EPSILON) } else { 0.0 };
        }
    }
    Ok(figures)
}

impl Figures {
    /// The verdict.
    pub(super) fn verdict(&self) -> Verdict {
        match () {
            () if self.non_finite > 0 || self.another > 0 => Verdict::Broken,
            () if self.beyond_rounding > ROUNDING => Verdict::Degraded,
            () => Verdict::Stable,
        }
    }

    /// Counts the calls whose results are not finite, for inputs that no model asks for.
    pub(super) fn count_non_finite(&mut self, calls: &Calls, inputs: &[f32]) -> Result<(), EvaluateError> {
        let results = calls.results(inputs, Arithmetic::Single)?;
        self.non_finite += results.iter().filter(|row| !is_finite(row)).count();
        Ok(())
    }

    /// The arguments with the largest error.
    pub(super) fn arguments(&self, declaration: &str, inputs: &[f32], width: usize) -> BTreeMap<String, Vec<f64>> {
        let mut numbers = inputs.iter().skip(self.worst * width).take(width).map(|number| f64::from(*number));
        let mut named = BTreeMap::new();
        for parameter in parameters(declaration).split(", ").filter(|parameter| !parameter.is_empty()) {
            let Some((ty, name)) = parameter.rsplit_once(' ') else { continue };
            let count = match ty {
                "vec2" => 2,
                "vec3" => 3,
                "vec4" => 4,
                "mat3" => 9,
                "mat4" => 16,
                "Light" => 20,
                "Material" => 13,
                "sampler2D" => 0,
                _ => 1,
            };
            if count > 0 {
                named.insert(name.to_owned(), numbers.by_ref().take(count).collect());
            }
        }
        named
    }
}

/// The figures of a naive form over the inputs of the function.
pub(super) fn judge_naive(naive: &Calls, stable: &Calls, inputs: &[f32]) -> Result<Naive, EvaluateError> {
    let single = naive.results(inputs, Arithmetic::Single)?;
    let (exact, _) = truth(naive, inputs, &single)?;
    let ours = stable.results(inputs, Arithmetic::Double)?;
    let mut found = Naive { range: [f64::INFINITY, f64::NEG_INFINITY], ..Naive::default() };
    for ((single, exact), ours) in single.iter().zip(&exact).zip(&ours) {
        found.undefined += usize::from(!is_finite(exact));
        if !is_finite(single) {
            found.non_finite += 1;
            continue;
        }
        for number in single {
            found.range = [found.range[0].min(*number), found.range[1].max(*number)];
        }
        // Where the equation has no value, or one beyond f32, it is compared with the function's.
        let exact = if is_finite(exact) && size(exact) <= f64::from(f32::MAX) { exact } else { ours };
        let error = apart(single, exact);
        found.max_abs = found.max_abs.max(error);
        found.max_ulp = found.max_ulp.max(error / ulp(size(exact)));
    }
    Ok(found)
}

impl Naive {
    /// Counts the operations of a function and of its naive form, beyond those of a call of nothing.
    pub(super) fn count_operations(&mut self, calls: [&Calls; 3], inputs: &[f32]) -> Result<(), EvaluateError> {
        const ROWS: usize = 256;
        let width = calls[0].width().max(1);
        let rows = (inputs.len() / width).min(ROWS);
        let inputs = &inputs[..rows * width];
        let mut counts = [0.0; 3];
        for (count, calls) in counts.iter_mut().zip(calls) {
            *count = calls.operations(inputs)? as f64 / rows.max(1) as f64;
        }
        let [stable, naive, nothing] = counts;
        let tenths = |count: f64| (count * 10.0).round() / 10.0;
        self.operations = [tenths(stable - nothing), tenths(naive - nothing)];
        self.ratio = (naive > nothing).then(|| ((stable - nothing) / (naive - nothing) * 100.0).round() / 100.0);
        Ok(())
    }
}
