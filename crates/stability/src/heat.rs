//! [`heat`]: a map of the errors over the picture.
//!
//! *In:* an examination. *Out:* a picture: the exact one in gray and dark, over it the error from blue (a hundredth of the
//! bound) over yellow (the bound) to red (a hundred times the bound), and magenta where f32 is not finite. *Holds:* a pixel
//! near an edge, which is not compared, stays gray.

use glisten_reference::stability::{ErrorMap, Examination};
use glisten_scene::picture::Picture;

/// The colors from a hundredth of the bound to a hundred times the bound.
const SCALE: [[f64; 3]; 5] =
    [[0.05, 0.10, 0.45], [0.10, 0.55, 0.75], [0.98, 0.85, 0.20], [0.95, 0.45, 0.10], [0.80, 0.05, 0.10]];

/// The color of a pixel that is not finite in f32.
pub(super) const NOT_FINITE: [f64; 3] = [1.0, 0.0, 1.0];

/// The decades below and above the bound that the scale spans.
pub(super) const DECADES: f64 = 2.0;

/// The map.
pub fn heat(examined: &Examination, bound: f64) -> Picture {
    map(&examined.exact, &examined.errors, bound)
}

/// The map of these errors over an exact picture.
pub(super) fn map(exact: &Picture, errors: &ErrorMap, bound: f64) -> Picture {
    let colors = exact.attachments.first().map_or(&[][..], Vec::as_slice);
    let pixels = colors.iter().zip(&errors.errors).map(|(color, error)| {
        let [r, g, b] = match *error {
            error if error.is_infinite() => NOT_FINITE,
            error if error < bound * 10f64.powf(-DECADES) => gray(*color),
            error => mix(gray(*color), scale((error / bound).log10()), 0.85),
        };
        [r, g, b, 1.0]
    });
    Picture::of_colors(exact.width, exact.height, pixels.collect())
}

/// A dark gray of the color's brightness.
fn gray([r, g, b, _]: [f64; 4]) -> [f64; 3] {
    let brightness = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    [if brightness.is_finite() { 0.35 * brightness.clamp(0.0, 1.0) } else { 0.0 }; 3]
}

/// The color of an error, by the decimal logarithm of its ratio to the bound.
pub(super) fn scale(decades: f64) -> [f64; 3] {
    let place = ((decades + DECADES) / (2.0 * DECADES)).clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let index = (place.floor() as usize).min(SCALE.len() - 2);
    mix(SCALE[index], SCALE[index + 1], place - index as f64)
}

fn mix(a: [f64; 3], b: [f64; 3], t: f64) -> [f64; 3] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * t)
}

#[cfg(test)]
mod tests {
    use super::scale;

    #[test]
    fn the_scale_goes_from_blue_to_red() {
        let (low, middle, high) = (scale(-5.0), scale(0.0), scale(5.0));
        assert!(
            low[2] > low[0] && high[0] > high[2] && middle[0] > 0.9 && middle[1] > 0.8,
            "{low:?} {middle:?} {high:?}"
        );
    }
}
