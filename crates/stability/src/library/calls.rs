//! [`Calls`]: one function with its stiff and extreme inputs, called in each arithmetic.
//!
//! *In:* a form of `measure`, and GLSL for the naive form. *Out:* rows of results. *Holds:* directions pass through
//! `normalize` on each side, so that what is measured is the function and not the rounding of its inputs.

use super::inputs::fill;
use glisten_front::{Compiler, Options};
use glisten_library::Embedded;
use glisten_reference::RenderOptions;
use glisten_reference::stability::{Arithmetic, draw};
use glisten_verify::evaluate::{EvaluateError, Evaluator, table};
use glisten_verify::measure::{Form, InputKind, Random, texel_of_tables};
use glisten_verify::scene::{Filter, Texture};
use std::sync::Arc;

/// Values that no model asks for, but that a function may be given: it must return something finite.
static EXTREMES: &[f32] = &[
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
    1e19,
    1e20,
    -1e20,
    f32::MIN_POSITIVE,
    1e-40,
    -1e-40,
    1e38,
    3e38,
    f32::MAX,
    f32::MIN,
];

/// The rows of results of a function.
pub(super) type Rows = Vec<Vec<f64>>;

/// A function, ready to be called.
pub(super) struct Calls {
    evaluator: Evaluator,
    tables: Vec<Arc<Texture>>,
}

impl Calls {
    /// A function of a text. Of the parameters, those in `wraps` pass through a function first.
    pub(super) fn new(text: &str, signature: &str, wraps: &[(usize, &str)]) -> Result<Self, EvaluateError> {
        let compiler = Compiler::new(Options::default()).with_includes(Embedded);
        let evaluator = Evaluator::new(&compiler, text, signature, wraps)?;
        let samplers = signature.matches("sampler2D").count();
        let texels = Arc::new(table(texel_of_tables(), Filter::Linear));
        let tables = (0..samplers).map(|_| Arc::clone(&texels)).collect();
        Ok(Self { evaluator, tables })
    }

    /// How many numbers a row of inputs has.
    pub(super) fn width(&self) -> usize {
        self.evaluator.inputs()
    }

    /// The results in an arithmetic.
    pub(super) fn results(&self, inputs: &[f32], arithmetic: Arithmetic) -> Result<Rows, EvaluateError> {
        let scene = self.evaluator.scene(inputs, &self.tables)?;
        let picture = draw(&scene, arithmetic).map_err(|errors| EvaluateError::told(&errors))?;
        Ok(self.evaluator.read(&picture, inputs.len().checked_div(self.width()).unwrap_or(1)))
    }

    /// The operations that the calls execute.
    pub(super) fn operations(&self, inputs: &[f32]) -> Result<u64, EvaluateError> {
        let scene = self.evaluator.scene(inputs, &self.tables)?;
        let work = glisten_reference::work(&scene, &RenderOptions { mark_edges: false, ..RenderOptions::default() });
        let work = work.map_err(|errors| EvaluateError::told(&errors))?;
        Ok(work.iter().map(|work| work.fragment_operations).sum())
    }
}

/// The inputs that the model of a function allows, stiff ones among them.
pub(super) fn stiff_inputs(form: &Form, rows: usize) -> Vec<f32> {
    let mut random = Random::new(15);
    let mut all = Vec::new();
    for _ in 0..rows {
        let mut row = Vec::new();
        form.inputs.iter().for_each(|kind| fill(*kind, &mut random, &mut row));
        all.extend(row.into_iter().map(|number| match number as f32 {
            number if number.is_subnormal() => 0.0,
            number => number,
        }));
    }
    all
}

/// Inputs that no model asks for.
pub(super) fn extreme_inputs(width: usize, rows: usize) -> Vec<f32> {
    let mut random = Random::new(16);
    (0..rows * width).map(|_| random.pick(EXTREMES)).collect()
}

/// Where the numbers of each kind are in a row.
fn places(form: &Form) -> Vec<(InputKind, std::ops::Range<usize>)> {
    let mut random = Random::new(0);
    let mut places = Vec::new();
    let mut start = 0;
    for kind in form.inputs {
        let mut numbers = Vec::new();
        fill(*kind, &mut random, &mut numbers);
        places.push((*kind, start..start + numbers.len()));
        start += numbers.len();
    }
    places
}

/// The largest number among the colors of each row, or 1.
pub(super) fn brightest(form: &Form, inputs: &[f32], width: usize) -> Vec<f64> {
    let is_color = |kind: &InputKind| matches!(kind, InputKind::Color | InputKind::Intensity);
    let places: Vec<usize> =
        places(form).into_iter().filter(|(kind, _)| is_color(kind)).flat_map(|(_, range)| range).collect();
    let brightest = |row: &[f32]| {
        places
            .iter()
            .filter_map(|place| row.get(*place))
            .fold(1.0, |most, number| f64::max(most, f64::from(number.abs())))
    };
    inputs.chunks(width.max(1)).map(brightest).collect()
}

/// The inputs with the directions among them normalized, as `normalize` in f32 passes them on.
pub(super) fn unit_inputs(form: &Form, inputs: &[f32], width: usize) -> Vec<f32> {
    let units = places(form).into_iter().filter(|(kind, _)| kind.params().1);
    let places: Vec<usize> = units.flat_map(|(_, range)| range.step_by(3)).collect();
    let mut all = inputs.to_vec();
    for row in all.chunks_mut(width.max(1)) {
        for place in &places {
            let Some(direction) = row.get_mut(*place..*place + 3) else { continue };
            let length = direction.iter().map(|number| f64::from(*number).powi(2)).sum::<f64>().sqrt();
            if length > 0.0 {
                direction.iter_mut().for_each(|number| *number = (f64::from(*number) / length) as f32);
            }
        }
    }
    all
}

/// The inputs with each number moved by 1 to 4 ULP, depending on the seed, up or down by chance.
pub(super) fn moved(inputs: &[f32], seed: u64) -> Vec<f32> {
    let mut random = Random::new(1000 + seed);
    let steps = 1 + seed % 4;
    let step = |number: f32, up: bool| {
        (0..steps).fold(number, |number, _| if up { number.next_up() } else { number.next_down() })
    };
    inputs
        .iter()
        .map(|number| match *number {
            0.0 => 0.0,
            number => step(number, random.once_in(2)).clamp(f32::MIN, f32::MAX),
        })
        .collect()
}
