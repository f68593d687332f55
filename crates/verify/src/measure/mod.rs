//! Measures the library's functions by value: each is compared with its closed form, which is written here in f64
//! from the equations.
//!
//! *In:* [`forms()`], one row per function. *Out:* the [`Figures`] of its errors on the reference in f64 and f32, and
//! on any backend that drew the scene of a [`Trial`].
//!
//! *Holds:* the closed forms share no text with the modules, and where an equation has two good forms, they use the
//! other one. Directions pass through `normalize` on both sides, so that the function is measured and not the
//! rounding of its inputs. Every function of every module has a row; a test compares the lists.

mod forms;
mod inputs;
pub mod vector;

pub use inputs::InputKind;
pub use inputs::Random;

use crate::evaluate::{EvaluateError, Evaluator, table};
use crate::scene::{Filter, Scene, Texture};
use glisten_front::{Compiler, Options};
use glisten_library::Embedded;
use glisten_reference::Precision;
use std::cell::Cell;
use std::sync::Arc;

/// The number of texels of the table for functions with a sampler.
const TABLE: usize = 64;

/// Extreme values of floats, for testing that functions are total.
static EDGES: [f32; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    1.0 - f32::EPSILON / 2.0,
    1.0 + f32::EPSILON,
    1e-20,
    -1e-20,
    1e20,
    -1e20,
    f32::MIN_POSITIVE,
    1e-40,
    -1e-40,
    1e38,
    f32::MAX,
    f32::MIN,
];

/// The expected result of a function.
#[derive(Clone, Debug)]
pub struct Answer {
    /// The expected numbers.
    pub values: Vec<f64>,
    /// The magnitude to which errors are relative: 1 for factors, or the value itself.
    pub scale: f64,
    /// The condition number: by how much the rounding of the arguments is amplified in the result.
    pub condition: f64,
    /// The distance of the arguments from a jump of the result, in multiples of their uncertainty beyond rounding.
    pub jump: f64,
    /// Whether the result is only determined up to a positive factor.
    pub projective: bool,
}

impl Answer {
    fn new(values: impl Into<Vec<f64>>, scale: f64) -> Self {
        Self { values: values.into(), scale, condition: 1.0, jump: f64::INFINITY, projective: false }
    }

    /// An answer whose errors are relative to its largest number.
    fn relative(values: impl Into<Vec<f64>>) -> Self {
        let values = values.into();
        let scale = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        Self::new(values, scale)
    }

    fn conditioned(self, condition: f64) -> Self {
        Self { condition, ..self }
    }

    fn jumping(self, distance: f64) -> Self {
        Self { jump: self.jump.min(distance), ..self }
    }
}

/// The numbers of a row, read in order.
struct Args<'a> {
    numbers: &'a [f64],
    at: Cell<usize>,
}

impl<'a> Args<'a> {
    /// The numbers of a row.
    fn of(numbers: &'a [f64]) -> Self {
        Self { numbers, at: Cell::new(0) }
    }

    fn f(&self) -> f64 {
        let at = self.at.replace(self.at.get() + 1);
        self.numbers.get(at).copied().unwrap_or(f64::NAN)
    }

    fn v(&self) -> vector::V {
        [self.f(), self.f(), self.f()]
    }

    /// A direction, normalized in f64.
    fn d(&self) -> vector::V {
        vector::unit(self.v())
    }

    fn v4(&self) -> [f64; 4] {
        [self.f(), self.f(), self.f(), self.f()]
    }

    fn v2(&self) -> [f64; 2] {
        [self.f(), self.f()]
    }
}

/// A function and its closed form.
#[derive(Debug)]
pub struct Form {
    /// The module.
    pub module: &'static str,
    /// The function, in the form that [`signatures`](crate::evaluate::signatures) writes.
    pub signature: &'static str,
    /// The kinds of its parameters, without samplers.
    pub inputs: &'static [InputKind],
    /// The closed form; `None` where the model is undefined.
    answer: fn(&Args<'_>) -> Option<Answer>,
}

impl Form {
    /// The parameters that are unit vectors, which pass through `normalize`.
    pub fn wraps(&self) -> Vec<(usize, &'static str)> {
        let mut wraps = Vec::new();
        let mut place = 0;
        for kind in self.inputs {
            let (params, unit) = kind.params();
            wraps.extend((place..place + params).filter(|_| unit).map(|place| (place, "normalize")));
            place += params;
        }
        wraps
    }
}

/// All functions of all modules.
pub fn forms() -> impl Iterator<Item = &'static Form> {
    forms::ALL.iter().copied().flatten()
}

/// The errors of one function over many inputs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// The number of rows that were compared.
    pub counted: usize,
    /// The number of rows within rounding of a jump of the result, and of those where the model is undefined.
    pub undecided: usize,
    /// The number of rows with a result that is not finite.
    pub non_finite: usize,
    /// The largest error, relative to the answer's scale.
    pub error: f64,
    /// The largest error relative to what the rounding of the arguments explains, in ULPs of the precision.
    pub ulps: f64,
}

/// How a precision rounds.
struct Rounding {
    /// The ULP of 1.
    ulp: f64,
    /// The smallest condition number: in f32, numbers that are small compared with the scale need not have all
    /// digits.
    least: f64,
    /// Within this distance of a jump, either side is accepted. For f32, twice what was observed on a GPU.
    jump: f64,
}

const DOUBLE: Rounding = Rounding { ulp: f64::EPSILON, least: 0.0, jump: 1e-12 };
const SINGLE: Rounding = Rounding { ulp: f32::EPSILON as f64, least: 1.0, jump: 4e-7 };

/// A function and the inputs for measuring it.
#[derive(Debug)]
pub struct Trial {
    form: &'static Form,
    evaluator: Evaluator,
    numbers: Vec<f32>,
    tables: Vec<Arc<Texture>>,
    rows: usize,
}

impl Trial {
    /// A trial on `rows` random inputs from a fixed seed.
    ///
    /// # Errors
    /// The function is not what the row says.
    pub fn new(form: &'static Form, rows: usize) -> Result<Self, EvaluateError> {
        let wraps = form.wraps();
        let mut random = Random::new(1);
        let mut numbers = Vec::new();
        for _ in 0..rows {
            form.inputs.iter().for_each(|kind| random.fill(*kind, &mut numbers));
        }
        let numbers = numbers.into_iter().map(|number| number as f32).collect();
        Self::of(form, &wraps, numbers)
    }

    /// A trial on extreme floats: zeros, the smallest and the largest numbers, numbers that are flushed to zero. The
    /// only requirement is that the results are finite.
    ///
    /// # Errors
    /// The function is not what the row says.
    pub fn extreme(form: &'static Form, rows: usize) -> Result<Self, EvaluateError> {
        let mut trial = Self::of(form, &[], Vec::new())?;
        let mut random = Random::new(2);
        trial.rows = if trial.evaluator.inputs() == 0 { 1 } else { rows };
        trial.numbers = (0..trial.rows * trial.evaluator.inputs()).map(|_| random.pick(&EDGES)).collect();
        Ok(trial)
    }

    fn of(form: &'static Form, wraps: &[(usize, &str)], numbers: Vec<f32>) -> Result<Self, EvaluateError> {
        let compiler = Compiler::new(Options::default()).with_includes(Embedded);
        let text = format!("#include <glisten/{}.glsl>", form.module);
        let evaluator = Evaluator::new(&compiler, &text, form.signature, wraps)?;
        let samplers = form.signature.matches("sampler2D").count();
        let texels = Arc::new(table((0..TABLE).map(texel).collect(), Filter::Linear));
        let tables = (0..samplers).map(|_| Arc::clone(&texels)).collect();
        let rows = numbers.len().checked_div(evaluator.inputs()).unwrap_or(1);
        Ok(Self { form, evaluator, numbers, tables, rows })
    }

    /// The scene that calls the function, for a GPU.
    ///
    /// # Errors
    /// None for the rows of a trial.
    pub fn scene(&self) -> Result<Scene, EvaluateError> {
        self.evaluator.scene(&self.numbers, &self.tables)
    }

    /// The program around the function.
    pub fn evaluator(&self) -> &Evaluator {
        &self.evaluator
    }

    /// The figures on the CPU reference.
    ///
    /// # Errors
    /// The errors of the reference.
    pub fn reference(&self, precision: Precision) -> Result<Figures, EvaluateError> {
        let results = self.evaluator.reference(&self.numbers, &self.tables, precision)?;
        Ok(self.figures(&results, if precision == Precision::F32 { &SINGLE } else { &DOUBLE }))
    }

    /// The figures from a picture of the scene.
    pub fn picture(&self, picture: &glisten_scene::picture::Picture) -> Figures {
        self.figures(&self.evaluator.read(picture, self.rows), &SINGLE)
    }

    fn figures(&self, results: &[Vec<f64>], rounding: &Rounding) -> Figures {
        let mut figures = Figures::default();
        let width = self.evaluator.inputs();
        for (row, result) in results.iter().enumerate() {
            figures.non_finite += usize::from(result.iter().any(|number| !number.is_finite()));
            let numbers: Vec<f64> =
                self.numbers.iter().skip(row * width).take(width).map(|number| f64::from(*number)).collect();
            match (self.form.answer)(&Args::of(&numbers)) {
                Some(answer) if answer.jump > rounding.jump => figures.add(&answer, result, rounding),
                _ => figures.undecided += 1,
            }
        }
        figures
    }
}

impl Figures {
    fn add(&mut self, answer: &Answer, result: &[f64], rounding: &Rounding) {
        self.counted += 1;
        let size = |numbers: &[f64]| numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
        let (ours, theirs) = if answer.projective { (size(&answer.values), size(result)) } else { (1.0, 1.0) };
        let scale = answer.scale.max(f64::from(f32::MIN_POSITIVE));
        for (value, number) in answer.values.iter().zip(result) {
            let error = if *number == *value { 0.0 } else { (number / theirs - value / ours).abs() / scale };
            let error = if error.is_nan() { f64::INFINITY } else { error };
            self.error = self.error.max(error);
            self.ulps = self.ulps.max(error / answer.condition.max(rounding.least) / rounding.ulp);
        }
    }
}

/// The table for functions with a sampler: a power, its mirror image and a line, so that no two channels and no two
/// texels are equal.
fn texel(index: usize) -> [f32; 4] {
    let x = index as f32 / (TABLE - 1) as f32;
    [x.powi(4), (1.0 - x).powi(2), 0.25 + 0.5 * x, 1.0]
}

/// That table's texels.
#[cfg(feature = "stability")]
pub fn texel_of_tables() -> Vec<[f32; 4]> {
    (0..TABLE).map(texel).collect()
}

/// The result of linear filtering in that table at the corrected coordinate for x.
fn looked_up(x: f64) -> Vec<f64> {
    let at = x.clamp(0.0, 1.0) * (TABLE - 1) as f64;
    let below = at.floor() as usize;
    let (a, b) = (texel(below.min(TABLE - 1)), texel((below + 1).min(TABLE - 1)));
    let t = at - at.floor();
    a.iter().zip(b).take(3).map(|(a, b)| f64::from(*a) * (1.0 - t) + f64::from(b) * t).collect()
}
