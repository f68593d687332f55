//! [`recompute`]: some pixels in numbers of 192 bits, so that f64's own error is known.
//!
//! *In:* a scene that was examined. *Out:* for each chosen pixel its color in f32, f64 and 192 bits. *Holds:* both stages
//! run in 192 bits, interpolation and blending included; only the chosen pixels are shaded. The same pixels are chosen on
//! every run.
//!
//! *Not done here:* texture lookups. Their coordinates are rounded to f64, and f64 filters the texels.

use super::Examination;
use super::bench::drawing_options;
use super::errors::{shown, unrounded};
use crate::domain::Exact;
use crate::exec::Form;
use crate::pipeline::{self, BIN_SIDE, PixelSet, Study};
use glisten_front::diagnostic::Diagnostic;
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use std::collections::BTreeSet;

pub use crate::domain::EXACT_BITS;

/// The pixels with the largest errors that are chosen.
const WORST: usize = 16;

/// Further pixels, spread over what is covered: where f32 and f64 are wrong alike, no error shows.
const SPREAD: usize = 16;

/// A pixel in three precisions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExactPixel {
    /// The column from the left.
    pub x: u32,
    /// The row from the top.
    pub y: u32,
    /// Its color in f32.
    pub single: [f64; 4],
    /// Its color in f64.
    pub double: [f64; 4],
    /// Its color in 192 bits, rounded to f64.
    pub exact: [f64; 4],
    /// The largest difference of a channel of any attachment between f64 and 192 bits, as the format shows it; infinite
    /// if f64 is not finite and the exact color is.
    pub double_error: f64,
    /// That between f32 and 192 bits.
    pub single_error: f64,
}

/// Draws the worst pixels of an examination, and some others, in 192 bits.
///
/// # Errors
/// The errors of [`render`](crate::render).
pub fn recompute(scene: &Scene, examined: &Examination) -> Result<Vec<ExactPixel>, Vec<Diagnostic>> {
    let format = scene.framebuffer.format;
    let scene = &Scene { framebuffer: unrounded(scene.framebuffer), ..scene.clone() };
    let chosen = chosen(examined);
    // Sorted by column and row.
    let pixels: Vec<[u32; 2]> = chosen.iter().copied().collect();
    let columns = (scene.framebuffer.width as usize).div_ceil(BIN_SIDE);
    let rows = (scene.framebuffer.height as usize).div_ceil(BIN_SIDE);
    let mut bins = vec![false; columns * rows];
    for [x, y] in &pixels {
        if let Some(bin) = bins.get_mut(*y as usize / BIN_SIDE * columns + *x as usize / BIN_SIDE) {
            *bin = true;
        }
    }
    let study = Study { bins: Some(&bins), pixels: Some(&PixelSet::at(&pixels)), form: Form::Unfused, ..Study::NONE };
    let drawing = crate::RenderOptions { mark_edges: false, ..drawing_options() };
    let picture = pipeline::render_studied::<Exact>(scene, &drawing, study)?;
    let width = examined.errors.width as usize;
    let difference = |other: &Picture, index: usize| {
        let attachments = other.attachments.iter().zip(&picture.attachments);
        let colors = attachments.filter_map(|(other, exact)| Some((other.get(index)?, exact.get(index)?)));
        let channels = colors.flat_map(|(other, exact)| other.iter().zip(exact));
        channels.map(|(other, exact)| apart(shown(*other, format), shown(*exact, format))).fold(0.0, f64::max)
    };
    Ok(pixels
        .iter()
        .map(|[x, y]| {
            let index = *y as usize * width + *x as usize;
            ExactPixel {
                x: *x,
                y: *y,
                single: color(&examined.single, index),
                double: color(&examined.exact, index),
                exact: color(&picture, index),
                double_error: difference(&examined.exact, index),
                single_error: difference(&examined.single, index),
            }
        })
        .collect())
}

fn apart(value: f64, exact: f64) -> f64 {
    match (value.is_finite(), exact.is_finite()) {
        (true, true) => (value - exact).abs(),
        (false, true) => f64::INFINITY,
        // The model has no finite color here.
        (_, false) => 0.0,
    }
}

fn color(picture: &Picture, index: usize) -> [f64; 4] {
    picture.attachments.first().and_then(|pixels| pixels.get(index)).copied().unwrap_or_default()
}

fn chosen(examined: &Examination) -> BTreeSet<[u32; 2]> {
    let errors = &examined.errors;
    let mut order: Vec<usize> = (0..errors.errors.len()).filter(|index| errors.errors[*index] > 0.0).collect();
    // The sort is stable: equal errors stay in the order of the picture.
    order.sort_by(|a, b| errors.errors[*b].total_cmp(&errors.errors[*a]));
    let mut chosen: BTreeSet<[u32; 2]> = order.iter().take(WORST).map(|index| errors.place(*index)).collect();
    chosen.extend(examined.causes.iter().map(|cause| cause.at));
    let counted = |index: &usize| errors.counted.get(*index).copied().unwrap_or(false);
    let drawn: Vec<usize> =
        (0..examined.exact.covered.len()).filter(|index| examined.exact.covered[*index] && counted(index)).collect();
    let places = (0..SPREAD).filter_map(|part| drawn.get((2 * part + 1) * drawn.len() / (2 * SPREAD)));
    chosen.extend(places.map(|index| errors.place(*index)));
    chosen
}

#[cfg(test)]
mod tests {
    use super::super::tests::scene_of;
    use super::{ExactPixel, recompute};
    use crate::RenderOptions;
    use crate::domain::F64;
    use crate::pipeline::{self, PixelSet, Study};
    use crate::stability::{BOUND, ExamineOptions, examine};

    fn recomputed(body: &str) -> Vec<ExactPixel> {
        let (scene, _) = scene_of(body, "");
        let mut options = ExamineOptions {
            bound: BOUND,
            bound_relative: 0.0,
            all: false,
            figures: false,
            progress: &mut |_, _| true,
        };
        let examined = examine(&scene, &mut options).unwrap_or_else(|found| panic!("{found:?}"));
        recompute(&scene, &examined).unwrap_or_else(|found| panic!("{found:?}"))
    }

    #[test]
    fn f64_is_enough_for_an_ordinary_program() {
        let pixels =
            recomputed("void main() { o = vec4(sin(at.x * 50.0), pow(abs(at.y), 7.0), normalize(vec3(at, 0.3)).xy); }");
        assert!(pixels.len() >= 16, "{}", pixels.len());
        for pixel in pixels {
            assert!(pixel.double_error < 1e-13 && pixel.single_error < 1e-4, "{pixel:?}");
        }
    }

    #[test]
    fn what_both_f32_and_f64_lose_is_seen() {
        // Both are 0, so that no pixel differs, and the true value is 1.
        let body =
            "void main() { float lost = ((1.0 + 1e-20 * (2.0 + at.x)) - 1.0) * 1e20; o = vec4(lost, 0.0, 0.0, 1.0); }";
        for pixel in recomputed(body) {
            let x = (f64::from(pixel.x) + 0.5) / 8.0 - 1.0;
            assert_eq!((pixel.single[0], pixel.double[0]), (0.0, 0.0), "{pixel:?}");
            assert!((pixel.exact[0] - (2.0 + x)).abs() < 1e-6, "{pixel:?}");
        }
    }

    #[test]
    fn rumps_polynomial_is_right_in_192_bits_alone() {
        let body = "void main() { float a = 77617.0, b = 33096.0 + 0.0 * at.x; float b2 = b * b, a2 = a * a; \
            float b4 = b2 * b2, b6 = b4 * b2, b8 = b4 * b4; \
            o = vec4(333.75 * b6 + a2 * (11.0 * a2 * b2 - b6 - 121.0 * b4 - 2.0) + 5.5 * b8 + a / (2.0 * b)); }";
        for pixel in recomputed(body) {
            assert!((pixel.exact[0] + 0.827_396_059_946_821_4).abs() < 1e-12, "{pixel:?}");
            assert!(pixel.double_error > 0.5, "{pixel:?}");
        }
    }

    #[test]
    fn chosen_pixels_are_those_of_the_whole_picture() {
        // With derivatives, quads are shaded as a whole.
        for body in [
            "void main() { o = vec4(at * 0.3, dFdx(at.x * at.y), fwidth(at.y * at.y)); }",
            "void main() { o = vec4(at, fract(at * 3.0)); }",
        ] {
            let (scene, _) = scene_of(body, "");
            let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
            let whole = pipeline::render::<F64>(&scene, &options).expect("it can be drawn");
            let pixels = [[0, 0], [3, 5], [3, 6], [15, 15]];
            let study = Study { pixels: Some(&PixelSet::at(&pixels)), ..Study::NONE };
            let some = pipeline::render_studied::<F64>(&scene, &options, study).expect("it can be drawn");
            for (index, (a, b)) in whole.attachments[0].iter().zip(&some.attachments[0]).enumerate() {
                let place = [index as u32 % 16, index as u32 / 16];
                let is_chosen = pixels.contains(&place);
                assert!(!is_chosen || a == b, "{place:?}: {a:?} {b:?}");
                assert!(is_chosen || body.contains("dFdx") || !some.covered[index], "{place:?} was not asked for");
            }
        }
    }
}
