//! [`with_exact`]: a reference for the reference.
//!
//! *In:* findings, and the examination that they are of. *Out:* the same with the worst pixels recomputed in 192 bits
//! ([`recompute`]): f64's own error, and which causes f64 is not enough for. *Holds:* a program whose picture agrees in f32
//! and f64 only because both are wrong is not called stable.

use super::recomputed::{ExactFound, ExactPixelFound};
use super::{Examination, Findings};
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::stability::{EXACT_BITS, ExactPixel, Stability, recompute};
use glisten_scene::Scene;

/// f64 is enough if its error is below the bound divided by this.
const MARGIN: f64 = 16.0;

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl ExactPixelFound {
    fn new(pixel: &ExactPixel, bound: f64) -> Self {
        Self {
            x: pixel.x,
            y: pixel.y,
            f32: pixel.single.map(finite),
            f64: pixel.double.map(finite),
            exact: pixel.exact.map(finite),
            error: finite(pixel.double_error),
            f64_is_enough: pixel.double_error <= bound / MARGIN,
        }
    }
}

/// Adds what 192 bits say to the findings of a scene.
///
/// # Errors
/// The errors of [`recompute`].
pub fn with_exact(
    scene: &Scene,
    (mut findings, mut examined): (Findings, Examination),
    bound: f64,
) -> Result<(Findings, Examination), Vec<Diagnostic>> {
    let recomputed = recompute(scene, &examined)?;
    let most = |error: fn(&ExactPixel) -> f64| recomputed.iter().map(error).fold(0.0, f64::max);
    let (double, single) = (most(|pixel| pixel.double_error), most(|pixel| pixel.single_error));
    let pixels: Vec<ExactPixelFound> = recomputed.iter().map(|pixel| ExactPixelFound::new(pixel, bound)).collect();
    for cause in &mut findings.causes {
        let here = pixels.iter().find(|pixel| (pixel.x, pixel.y) == (cause.at.x, cause.at.y));
        cause.f64_enough = here.map(|pixel| pixel.f64_is_enough);
        if cause.f64_enough == Some(false) {
            cause.diagnostic.notes.push(NOT_ENOUGH.to_owned());
        }
    }
    if single > bound && examined.verdict == Stability::Stable {
        examined.verdict = if single.is_finite() { Stability::Degraded } else { Stability::Broken };
        findings.verdict = examined.verdict.name();
    }
    findings.exact = Some(ExactFound {
        bits: EXACT_BITS,
        f64_is_enough: pixels.iter().all(|pixel| pixel.f64_is_enough),
        pixels,
        f64_max_error: finite(double),
        f32_max_error: finite(single),
    });
    Ok((findings, examined))
}

const NOT_ENOUGH: &str = "f64 is not enough here either: in 192 bits, the pixel has another color";

impl ExactFound {
    /// The result as a sentence.
    pub fn sentence(&self) -> String {
        let count = self.pixels.iter().filter(|pixel| !pixel.f64_is_enough).count();
        let (of, bits) = (self.pixels.len(), self.bits);
        let told = |error: Option<f64>| error.map_or_else(|| "not finite".to_owned(), |error| format!("{error:.1e}"));
        let (double, single) = (told(self.f64_max_error), told(self.f32_max_error));
        match count {
            0 => format!("f64 is enough: its largest error is {double} at {of} pixels recomputed in {bits} bits"),
            _ => format!(
                "f64 is not enough at {count} of {of} pixels recomputed in {bits} bits: its largest error is {double}, that of \
                 f32 {single}"
            ),
        }
    }
}
