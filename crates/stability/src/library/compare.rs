//! [`compare`]: the error of a function's f32, and how much of it the rounding of its inputs explains.
//!
//! *In:* a function with its inputs. *Out:* its [`Figures`], and those of its naive form. *Holds:* the truth is f64, or 192
//! bits where f64 could be wrong. An error is explained if moving each input by a few ULP changes the exact result nearly as
//! much: then the problem is ill-conditioned there, or the result jumps, and no formula helps. It is also explained if the
//! function is right for its directions as f32 has them, whose lengths are not quite 1: near L = -V, that decides.

use super::calls::{Calls, Rows, brightest, moved, unit_inputs};
use super::{Bound, BoundUnit, ROUNDING, Verdict, parameters};
use glisten_reference::stability::Arithmetic;
use glisten_verify::evaluate::EvaluateError;
use glisten_verify::measure::Form;
use serde::Serialize;
use std::collections::BTreeMap;

/// How often the inputs are moved.
const MOVES: u64 = 8;

/// How many times the change by moving the inputs an error may be to count as explained: directions round twice, once when
/// they are normalized and once as inputs, and the moves find half of the worst direction at best.
pub(super) const EXPLAINED: f64 = 4.0;

/// An unexplained error of this share of the result's size is another result altogether.
const ANOTHER: f64 = 0.25;

/// How many of the worst rows are checked in 192 bits.
const CHECKED: usize = 64;

/// The figures of a function.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Figures {
    /// The largest error in ULP of the largest number of the exact result, where moving the inputs does not give another
    /// result altogether.
    pub max_ulp: f64,
    /// The largest error, in the same calls.
    pub max_abs: f64,
    /// The largest error beyond four times the change that moving the inputs by an ULP makes, as the bound counts it.
    pub unexplained: f64,
    /// By how much the function magnifies relative errors of its inputs, at the largest error.
    pub condition: f64,
    /// The number of calls with a result that is not finite.
    pub non_finite: usize,
    /// The number of calls with another result altogether, which nothing explains.
    pub another: usize,
    /// Whether 192 bits were needed for the truth.
    pub beyond_f64: bool,
    /// The number of those that are not finite in exact arithmetic either.
    #[serde(skip)]
    undefined: usize,
    /// The inputs with the largest error.
    #[serde(skip)]
    worst: Vec<f32>,
    /// The largest unexplained error relative to 1 or to the result, whichever is larger.
    #[serde(skip)]
    beyond_rounding: f64,
}

/// The figures of a naive form.
#[derive(Clone, Debug, Serialize)]
pub struct Naive {
    /// The form, as GLSL.
    pub form: String,
    /// Its figures against its own exact value.
    #[serde(flatten)]
    pub figures: Figures,
    /// Its verdict.
    pub verdict: Verdict,
    /// The number of those that are not finite in exact arithmetic either: the equation has no value there.
    pub undefined: usize,
    /// The arguments with the largest error, or those of the first result that is not finite.
    pub at: BTreeMap<String, Vec<f64>>,
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

/// An error as a share of the color's largest number, or of 1 if that is larger.
pub(super) fn share_left(left: f64, color: &[f64]) -> f64 {
    left / size(color).max(1.0)
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

/// The rest of the errors that are more than rounding, if the directions are taken as f32 has them. Such a result may be far larger
/// than the exact one: a bound that grows with the result (`relative`) takes its error as a share of its own size.
fn left_as_given(
    form: &Form,
    raw: &Calls,
    inputs: &[f32],
    (exact, relative): (&Rows, bool),
    left: &mut [f64],
) -> Result<(), EvaluateError> {
    let width = raw.width();
    let rows: Vec<usize> = (0..left.len()).filter(|row| left[*row] > ROUNDING / 16.0).collect();
    if rows.is_empty() || width == 0 {
        return Ok(());
    }
    let chosen: Vec<f32> =
        rows.iter().filter_map(|row| inputs.get(row * width..(row + 1) * width)).flatten().copied().collect();
    let given = unit_inputs(form, &chosen, width);
    let single = raw.results(&given, Arithmetic::Single)?;
    let double = raw.results(&given, Arithmetic::Double)?;
    for ((row, single), double) in rows.iter().zip(&single).zip(&double) {
        let sizes = [exact.get(*row).map_or(0.0, |exact| size(exact)), size(double)].map(|size| size.max(1.0));
        let share = if relative { (sizes[0] / sizes[1]).min(1.0) } else { 1.0 };
        left[*row] = left[*row].min(share * apart(single, double));
    }
    Ok(())
}

/// The figures of a function over inputs that its model allows. `raw` is the function without `normalize`.
pub(super) fn compare(
    form: &Form,
    [calls, raw]: [&Calls; 2],
    inputs: &[f32],
    bound: Option<&Bound>,
) -> Result<Figures, EvaluateError> {
    let single = calls.results(inputs, Arithmetic::Single)?;
    let (exact, beyond_f64) = truth(calls, inputs, &single)?;
    let changes = if calls.width() == 0 { vec![0.0; exact.len()] } else { changes(calls, inputs, &exact)? };
    let errors: Vec<f64> = single.iter().zip(&exact).map(|(single, exact)| apart(single, exact)).collect();
    let mut left: Vec<f64> =
        errors.iter().zip(&changes).map(|(error, change)| (error - EXPLAINED * change).max(0.0)).collect();
    let unit = bound.map_or(BoundUnit::Abs, |bound| bound.unit);
    let relative = matches!(unit, BoundUnit::Size | BoundUnit::Rel);
    left_as_given(form, raw, inputs, (&exact, relative), &mut left)?;
    let colors = brightest(form, inputs, calls.width());
    let mut figures = Figures { beyond_f64, ..Figures::default() };
    let mut worst = -1.0;
    for (row, (single, exact)) in single.iter().zip(&exact).enumerate() {
        let arguments = || inputs.iter().skip(row * calls.width()).take(calls.width()).copied().collect();
        if !is_finite(single) || !is_finite(exact) {
            figures.non_finite += 1;
            figures.undefined += usize::from(!is_finite(exact));
            if figures.non_finite == 1 {
                (figures.worst, worst) = (arguments(), f64::INFINITY);
            }
            continue;
        }
        let (error, left, size) = (errors[row], left[row], size(exact));
        let color = colors.get(row).copied().unwrap_or(1.0);
        let of_one = left / if unit == BoundUnit::Color { color } else { size.max(1.0) };
        if changes[row] <= ANOTHER * size {
            figures.max_abs = figures.max_abs.max(error);
            figures.max_ulp = figures.max_ulp.max(error / ulp(size));
        }
        figures.beyond_rounding = figures.beyond_rounding.max(of_one);
        figures.another += usize::from(left > ANOTHER * size.max(f64::from(f32::MIN_POSITIVE)) && of_one > ROUNDING);
        let judged = match unit {
            BoundUnit::Abs => left,
            BoundUnit::Color => left / color,
            BoundUnit::Size => left / size.max(1.0),
            // A result that f32 flushes to 0 has no relative error.
            BoundUnit::Rel => left / size.max(f64::from(f32::MIN_POSITIVE) / f64::from(f32::EPSILON)),
        };
        figures.unexplained = figures.unexplained.max(judged);
        let badness = judged + error.min(1.0) * 1e-9;
        if badness > worst {
            (figures.worst, worst) = (arguments(), badness);
            figures.condition = if size > 0.0 { changes[row] / size / f64::from(f32::EPSILON) } else { 0.0 };
        }
    }
    Ok(figures)
}

impl Figures {
    /// Adds a pixel, held to a bound of its size: its error, the part that moving the inputs does not explain, the change by moving them, and the exact color.
    pub(super) fn add(&mut self, error: f64, left: f64, change: f64, color: &[f64]) {
        if !error.is_finite() || !is_finite(color) {
            self.non_finite += 1;
            self.undefined += usize::from(!is_finite(color));
            return;
        }
        let size = size(color);
        if change <= ANOTHER * size {
            self.max_abs = self.max_abs.max(error);
            self.max_ulp = self.max_ulp.max(error / ulp(size));
        }
        let judged = share_left(left, color);
        self.beyond_rounding = self.beyond_rounding.max(judged);
        self.another += usize::from(judged > ANOTHER);
        if judged >= self.unexplained {
            self.unexplained = judged;
            self.condition = if size > 0.0 { change / size / f64::from(f32::EPSILON) } else { 0.0 };
        }
    }

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
        if let Some(row) = results.iter().position(|row| !is_finite(row))
            && self.non_finite == 0
        {
            self.worst = inputs.iter().skip(row * calls.width()).take(calls.width()).copied().collect();
        }
        self.non_finite += results.iter().filter(|row| !is_finite(row)).count();
        Ok(())
    }

    /// The arguments with the largest error.
    pub(super) fn arguments(&self, declaration: &str) -> BTreeMap<String, Vec<f64>> {
        let mut numbers = self.worst.iter().map(|number| f64::from(*number));
        let mut named = BTreeMap::new();
        for parameter in parameters(declaration).split(", ").filter(|parameter| !parameter.is_empty()) {
            let Some((ty, name)) = parameter.rsplit_once(' ') else { continue };
            let count = match ty {
                "vec2" => 2,
                "vec3" | "ivec3" => 3,
                "vec4" => 4,
                "mat3" => 9,
                "mat4" => 16,
                "Light" => 20,
                "vec3[9]" => 27,
                "vec3[16]" => 48,
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
pub(super) fn compare_naive(
    form: &Form,
    calls: [&Calls; 2],
    inputs: &[f32],
    bound: Option<&Bound>,
    text: &str,
) -> Result<Naive, EvaluateError> {
    let figures = compare(form, calls, inputs, bound)?;
    let single = calls[0].results(inputs, Arithmetic::Single)?;
    let finite = single.iter().filter(|row| is_finite(row)).flatten();
    let range =
        finite.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], number| [low.min(*number), high.max(*number)]);
    Ok(Naive {
        form: text.to_owned(),
        verdict: figures.verdict(),
        undefined: figures.undefined,
        figures,
        at: BTreeMap::new(),
        range,
        operations: [0.0; 2],
        ratio: None,
    })
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
