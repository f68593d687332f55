//! Pixels that depend on what the language leaves undefined.
//!
//! *In:* a [`Scene`]. *Out:* [`Undefined`]: the pixels, and the expressions and variables that make them so.
//!
//! *The rule:* a strict GPU draws the scene; then again, with other numbers wherever an operation is undefined for its
//! operands (GLSL 1.50 §5.4.1, §5.9, chapter 8), a texel, an element or a variable is read that is not there or was never
//! written. A pixel that changes depends on those numbers. So it does not matter how they reach the picture: through
//! `max`, a comparison, a loop or a `discard`. The places are found by changing the numbers of one of them alone.

use crate::domain::F32;
use crate::exec::{Code, Form, Guess, Numbers, Place, UndefinedKind};
use crate::pipeline::{self, Study};
use crate::{Precision, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use std::sync::Arc;

/// The numbers that are tried. No result of a comparison with one of them is that with all others. The fourth and the fifth
/// differ between neighbors, as texels do. The last are what most drivers have for `pow` of a negative base.
const TRIED: [Numbers; 6] = [
    Numbers { float: 0.371_25, step: 0.0, int: 5, magnitudes: false },
    Numbers { float: -17_408.0, step: 0.0, int: 0x8000_0007, magnitudes: false },
    Numbers { float: 311_296.0, step: 0.0, int: 0x7fff_ff00, magnitudes: false },
    Numbers { float: 0.02, step: 0.97, int: 1, magnitudes: false },
    Numbers { float: 0.99, step: -0.98, int: 2, magnitudes: false },
    Numbers { float: 0.0, step: 0.0, int: 0, magnitudes: true },
];

/// The largest number of places that are examined.
const MOST_PLACES: usize = 8;

/// The parts of a picture that the language leaves undefined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Undefined {
    /// For each pixel, whether it depends on something undefined.
    pub pixels: Vec<bool>,
    /// Where, those with most pixels first.
    pub places: Vec<UndefinedPlace>,
}

/// An expression or a variable that is undefined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UndefinedPlace {
    /// The expression, or the declaration of a variable.
    pub span: Span,
    /// The undefined thing, in words.
    pub what: &'static str,
    /// How it is undefined.
    pub kind: UndefinedKind,
    /// The number of pixels that depend on it alone; 0 if they depend on several places together.
    pub pixels: u64,
    /// One of them, column from the left and row from the top.
    pub example: [u32; 2],
    /// The largest finite change of a channel that other numbers make.
    pub change: f64,
}

/// The pixels of a scene that depend on something undefined; `None` if there are none.
///
/// # Errors
/// As [`render`](crate::render).
pub fn undefined(scene: &Scene, options: &RenderOptions) -> Result<Option<Undefined>, Vec<Diagnostic>> {
    undefined_among(scene, options, &[])
}

/// Those of [`undefined`] among some pixels of the picture; an empty list stands for all.
pub(crate) fn undefined_among(
    scene: &Scene,
    options: &RenderOptions,
    counted: &[bool],
) -> Result<Option<Undefined>, Vec<Diagnostic>> {
    let mut places = Vec::new();
    let plain = draw(scene, options, None, None, &mut places)?;
    for draw in &scene.draws {
        for stage in &draw.program.stages {
            places.extend(Code::compile_as(&draw.program, stage.stage, Form::Guessed)?.unwritten());
        }
    }
    if places.is_empty() {
        return Ok(None);
    }
    let mut pixels = vec![false; plain.covered.len()];
    let mut sensitive = Vec::new();
    for numbers in TRIED {
        // Other numbers may make a loop endless, which is a change of its own, but of no particular pixel.
        let Ok(other) = draw(scene, options, Some(numbers), None, &mut places) else { continue };
        let before = pixels.iter().filter(|changed| **changed).count();
        mark_changed(&mut pixels, counted, &plain, &other);
        if pixels.iter().filter(|changed| **changed).count() > before {
            sensitive.push(numbers);
        }
    }
    if sensitive.is_empty() {
        return Ok(None);
    }
    let places = examined(scene, options, (&plain, counted), (&places, &sensitive));
    Ok(Some(Undefined { pixels, places }))
}

/// Whether a picture may depend on something undefined although no envelope is wide because of it.
///
/// # Errors
/// The reference cannot compile a stage.
pub fn hides_undefined(scene: &Scene) -> Result<bool, Vec<Diagnostic>> {
    for draw in &scene.draws {
        for stage in [Stage::Vertex, Stage::Fragment] {
            if draw.program.stage(stage).is_some()
                && Code::compile_as(&draw.program, stage, Form::Guessed)?.hides_undefined()
            {
                return Ok(true);
            }
        }
    }
    Ok(false)
}

/// The places whose numbers alone change pixels.
fn examined(
    scene: &Scene,
    options: &RenderOptions,
    (plain, counted): (&Picture, &[bool]),
    (places, sensitive): (&[Place], &[Numbers]),
) -> Vec<UndefinedPlace> {
    let mut found: Vec<UndefinedPlace> = Vec::new();
    for place in places.iter().take(MOST_PLACES) {
        let mut changed = vec![false; plain.covered.len()];
        let mut change = 0.0_f64;
        for numbers in sensitive {
            if let Ok(other) = draw(scene, options, Some(*numbers), Some(*place), &mut Vec::new()) {
                change = change.max(mark_changed(&mut changed, counted, plain, &other));
            }
        }
        let count = changed.iter().filter(|changed| **changed).count() as u64;
        if let Some(first) = changed.iter().position(|changed| *changed) {
            let columns = (plain.width as usize).max(1);
            let example = [(first % columns) as u32, (first / columns) as u32];
            let (what, kind) = (place.what.text, place.what.kind);
            found.push(UndefinedPlace { span: place.span, what, kind, pixels: count, example, change });
        }
    }
    found.sort_by_key(|place| std::cmp::Reverse(place.pixels));
    found
}

/// The picture of a strict GPU with these numbers at undefined places. Adds the places that it meets.
fn draw(
    scene: &Scene,
    options: &RenderOptions,
    numbers: Option<Numbers>,
    only: Option<Place>,
    places: &mut Vec<Place>,
) -> Result<Picture, Vec<Diagnostic>> {
    let guess = Arc::new(Guess::new(numbers, only));
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..*options };
    let study = Study { guess: Some(&guess), form: Form::Guessed, ..Study::NONE };
    let picture = pipeline::render_studied::<F32>(scene, &options, study)?;
    for place in guess.places() {
        if !places.contains(&place) {
            places.push(place);
        }
    }
    Ok(picture)
}

/// Marks the pixels that differ in coverage or in a bit of a channel, and tells the largest finite difference.
fn mark_changed(changed: &mut [bool], counted: &[bool], plain: &Picture, other: &Picture) -> f64 {
    let bits = |value: f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
    let mut most = 0.0_f64;
    let pixels = changed.iter_mut().enumerate().filter(|(pixel, _)| counted.get(*pixel).copied().unwrap_or(true));
    for (pixel, changed) in pixels {
        *changed |= plain.covered.get(pixel) != other.covered.get(pixel);
        let pairs = plain.attachments.iter().zip(&other.attachments);
        for (a, b) in pairs.filter_map(|(a, b)| a.get(pixel).zip(b.get(pixel))) {
            *changed |= a.map(bits) != b.map(bits);
            let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            most = differences.filter(|difference| difference.is_finite()).fold(most, f64::max);
        }
    }
    most
}
