//! The color spaces of FLIP, and the distance of two colors.
//!
//! *In:* colors of sRGB in 8 bits, or filtered YCxCz. *Out:* YCxCz, L\*a\*b\* with the Hunt adjustment, color differences
//! from 0 to 1.
//!
//! *Holds:* the white is D65, by the sums of the rows of the matrix of sRGB; gray has the chrominance 0.

use super::filter::Plane;
use crate::picture::Transfer;
use std::sync::LazyLock;

/// From linear sRGB to XYZ, as shares of the white's (IEC 61966-2-1, with more digits).
const TO_XYZ: [[f32; 3]; 3] = [
    [0.433_895_4, 0.376_242_37, 0.189_862_24],
    [0.212_636_82, 0.715_183, 0.072_180_2],
    [0.017_752_423, 0.109_465_63, 0.872_781_95],
];

/// The inverse of [`TO_XYZ`].
const FROM_XYZ: [[f32; 3]; 3] = [
    [3.080_342, -1.537_399, -0.542_943],
    [-0.921_178_4, 1.875_93, 0.045_248_41],
    [0.052_881_293, -0.204_011_2, 1.151_13],
];

/// The exponent of the color difference, q_c.
const EXPONENT: f32 = 0.7;
/// The share of the largest difference below which differences are spread, p_c.
const SPREAD_BELOW: f32 = 0.4;
/// The share of [0, 1] onto which they are spread, p_t.
const SPREAD_ONTO: f32 = 0.95;

/// The largest color difference of sRGB, c_max: that of green and blue.
static LARGEST: LazyLock<f32> = LazyLock::new(|| {
    let perceived = |linear| hunt_adjusted(lab(linear));
    hyab(perceived([0.0, 1.0, 0.0]), perceived([0.0, 0.0, 1.0])).powf(EXPONENT)
});

/// A picture in the opponent color space YCxCz, which is linear in light: luminance, red against green, blue against yellow.
pub(super) struct Opponent {
    /// The luminance, -16 to 100.
    pub(super) y: Plane,
    /// Red against green.
    pub(super) cx: Plane,
    /// Yellow against blue.
    pub(super) cz: Plane,
}

impl Opponent {
    /// The picture of colors of sRGB.
    pub(super) fn of(width: usize, colors: &[[u8; 3]]) -> Self {
        let linear: [f32; 256] = std::array::from_fn(|byte| Transfer::Srgb.decode(byte as f64 / 255.0) as f32);
        let decoded = |color: &[u8; 3]| color.map(|byte| linear[usize::from(byte)]);
        let colors: Vec<[f32; 3]> = colors.iter().map(|color| ycxcz(decoded(color))).collect();
        let channel = |of: fn(&[f32; 3]) -> f32| Plane::new(width, colors.iter().map(of).collect());
        Self { y: channel(|[y, ..]| *y), cx: channel(|[_, cx, _]| *cx), cz: channel(|[.., cz]| *cz) }
    }

    /// The colors as a person perceives them: clamped to sRGB, in L\*a\*b\*, adjusted.
    pub(super) fn perceived(&self) -> impl Iterator<Item = [f32; 3]> {
        let chrominance = self.cx.values.iter().zip(&self.cz.values);
        let colors = self.y.values.iter().zip(chrominance).map(|(y, (cx, cz))| [*y, *cx, *cz]);
        colors.map(|color| hunt_adjusted(lab(linear(color).map(|channel| channel.clamp(0.0, 1.0)))))
    }
}

/// YCxCz of linear sRGB: L\*a\*b\* without its cube roots.
fn ycxcz(linear: [f32; 3]) -> [f32; 3] {
    opponent(product(&TO_XYZ, linear))
}

/// Linear sRGB of YCxCz, which may be out of [0, 1].
fn linear([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let luminance = (y + 16.0) / 116.0;
    product(&FROM_XYZ, [luminance + cx / 500.0, luminance, luminance - cz / 200.0])
}

/// L\*a\*b\* of linear sRGB (CIE 1976).
fn lab(linear: [f32; 3]) -> [f32; 3] {
    opponent(product(&TO_XYZ, linear).map(lightness))
}

/// The luminance and the two differences of XYZ that L\*a\*b\* and YCxCz have in common.
fn opponent([x, y, z]: [f32; 3]) -> [f32; 3] {
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// The function f of L\*a\*b\*: a cube root, and a line near black (CIE 1976).
fn lightness(share: f32) -> f32 {
    const JOINT: f32 = 6.0 / 29.0;
    if share > JOINT * JOINT * JOINT { share.powf(1.0 / 3.0) } else { share / (3.0 * JOINT * JOINT) + 4.0 / 29.0 }
}

/// The Hunt adjustment: chrominance counts less where it is dark.
fn hunt_adjusted([l, a, b]: [f32; 3]) -> [f32; 3] {
    [l, 0.01 * l * a, 0.01 * l * b]
}

/// The HyAB distance: of luminance in the city block, of chrominance by Euclid.
fn hyab([l, a, b]: [f32; 3], [other_l, other_a, other_b]: [f32; 3]) -> f32 {
    let (da, db) = (a - other_a, b - other_b);
    (l - other_l).abs() + (da * da + db * db).sqrt()
}

/// The difference of two perceived colors, from 0 to 1.
pub(super) fn difference(reference: [f32; 3], test: [f32; 3]) -> f32 {
    redistributed(hyab(reference, test).powf(EXPONENT), *LARGEST)
}

/// A difference up to `largest` redistributed on [0, 1]: large ones share a small part of it.
fn redistributed(difference: f32, largest: f32) -> f32 {
    let below = SPREAD_BELOW * largest;
    if difference < below {
        SPREAD_ONTO / below * difference
    } else {
        SPREAD_ONTO + (difference - below) / (largest - below) * (1.0 - SPREAD_ONTO)
    }
}

fn product(matrix: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    matrix.map(|[a, b, c]| a * x + b * y + c * z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn assert_near(found: [f32; 3], expected: [f32; 3], tolerance: f32) {
        let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() <= tolerance);
        assert!(near, "{found:?}, not {expected:?}");
    }

    #[test]
    fn lab_has_the_usual_values() {
        assert_near(lab([1.0; 3]), [100.0, 0.0, 0.0], 1e-3);
        assert_near(lab([0.0; 3]), [0.0; 3], 1e-3);
        assert_near(lab([1.0, 0.0, 0.0]), [53.24, 80.09, 67.2], 0.02);
        assert_near(lab([0.0, 0.0, 1.0]), [32.3, 79.19, -107.86], 0.02);
    }

    #[test]
    fn opponent_colors_come_back() {
        assert_near(ycxcz([1.0; 3]), [100.0, 0.0, 0.0], 1e-3);
        for color in [[0.0, 0.5, 1.0], [0.3, 0.2, 0.1], [1.0, 0.0, 0.0]] {
            assert_near(linear(ycxcz(color)), color, 1e-5);
        }
    }

    #[test]
    fn distances_add_up_and_colors_fade_in_the_dark() {
        assert_eq!(hyab([10.0, 3.0, 0.0], [15.0, 0.0, 4.0]), 10.0);
        assert_eq!(hunt_adjusted([50.0, 20.0, -8.0]), [50.0, 10.0, -4.0]);
    }

    #[test]
    fn differences_fill_0_to_1() {
        let of = |share: f32| redistributed(share * 40.0, 40.0);
        assert_near([of(0.0), of(0.2), of(0.4)], [0.0, 0.475, 0.95], 1e-6);
        assert_near([of(0.4), of(0.7), of(1.0)], [0.95, 0.975, 1.0], 1e-6);
    }
}
