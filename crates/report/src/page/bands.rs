//! Mach bands made visible: the second difference of a picture's luminance, and its profile along a row.
//!
//! *In:* a picture. *Out:* [`Luminance`], from that the colors of the bands and the row through the highlight.
//!
//! Where the slope of the luminance jumps, the eye sees a band that is not there: a light one where the slope falls, a dark
//! one where it rises. The second difference is zero but there, so a picture of it shows the bands, and the triangles that
//! make them. *Holds:* pixels at the border of what is covered have none, since a silhouette is no band.

use glisten_scene::picture::Picture;

/// The weights of red, green and blue in the luminance (ITU-R BT.709).
const WEIGHTS: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The share of the pixels that the scale of the bands holds.
const WITHIN: f64 = 0.995;

/// No scale of bands is finer: this is the rounding of f32.
const LEAST_BOUND: f64 = 1e-6;

/// The color of a pixel that has no second difference.
const OUTSIDE: [u8; 3] = [96, 104, 120];

/// The luminance of a picture, where it is covered and finite.
pub(super) struct Luminance {
    width: usize,
    height: usize,
    values: Vec<Option<f64>>,
}

impl Luminance {
    /// The luminance of the first attachment.
    pub(super) fn of(picture: &Picture) -> Self {
        let pixels = picture.attachments.first().map_or(&[][..], Vec::as_slice);
        let value = |(pixel, covered): (&[f64; 4], &bool)| {
            let sum: f64 = pixel.iter().zip(WEIGHTS).map(|(channel, weight)| channel * weight).sum();
            (*covered && sum.is_finite()).then_some(sum)
        };
        Self {
            width: picture.width as usize,
            height: picture.height as usize,
            values: pixels.iter().zip(&picture.covered).map(value).collect(),
        }
    }

    fn at(&self, x: usize, y: usize) -> Option<f64> {
        self.values.get(y * self.width + x).copied().flatten()
    }

    /// The sum of the second differences along rows and along columns.
    pub(super) fn second_difference(&self) -> Vec<Option<f64>> {
        let at = |x: usize, y: usize| -> Option<f64> {
            let inside = x > 0 && y > 0 && x + 1 < self.width && y + 1 < self.height;
            if !inside {
                return None;
            }
            let around = self.at(x - 1, y)? + self.at(x + 1, y)? + self.at(x, y - 1)? + self.at(x, y + 1)?;
            Some(around - 4.0 * self.at(x, y)?)
        };
        (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect()
    }

    /// The row of the brightest pixel, which is where the highlight is; the middle one if nothing is covered.
    pub(super) fn brightest_row(&self) -> usize {
        let mut best = (f64::NEG_INFINITY, self.height / 2);
        for (index, value) in self.values.iter().enumerate() {
            match value {
                Some(value) if *value > best.0 => best = (*value, index / self.width),
                _ => {}
            }
        }
        best.1
    }

    /// The luminance along a row, to six digits after the point.
    pub(super) fn profile(&self, row: usize) -> Vec<Option<f64>> {
        (0..self.width).map(|x| self.at(x, row).map(|value| (value * 1e6).round() / 1e6)).collect()
    }
}

/// The bound of the scale on which these second differences are shown: almost all of them are within it.
pub(super) fn bound<'a>(all: impl Iterator<Item = &'a [Option<f64>]>) -> f64 {
    let mut sizes: Vec<f64> = all.flat_map(|one| one.iter().flatten().map(|value| value.abs())).collect();
    sizes.sort_by(f64::total_cmp);
    let place = (sizes.len() as f64 * WITHIN) as usize;
    sizes.get(place).or(sizes.last()).copied().unwrap_or(LEAST_BOUND).max(LEAST_BOUND)
}

/// The color of a second difference: light where the eye sees a light band. The root brings weak bands out.
pub(super) fn color(second: Option<f64>, bound: f64) -> [u8; 3] {
    let Some(second) = second else { return OUTSIDE };
    let part = (-second / bound).clamp(-1.0, 1.0);
    let level = part.abs().sqrt() * part.signum();
    [(127.5 + 127.5 * level).round() as u8; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(width: u32, height: u32, level: impl Fn(u32, u32) -> f64) -> Picture {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Picture::of_colors(width, height, places.map(|(x, y)| [level(x, y), level(x, y), level(x, y), 1.0]).collect())
    }

    #[test]
    fn only_where_the_slope_jumps_there_is_a_band() {
        // A roof with its ridge in column 4.
        let roof = gray(9, 5, |x, _| 1.0 - (f64::from(x) - 4.0).abs() / 8.0);
        let second = Luminance::of(&roof).second_difference();
        for (index, value) in second.iter().enumerate() {
            let (x, y) = (index % 9, index / 9);
            match value {
                None => assert!(x == 0 || x == 8 || y == 0 || y == 4, "({x}, {y})"),
                Some(value) if x == 4 => assert!((value + 0.25).abs() < 1e-12, "{value}"),
                Some(value) => assert!(value.abs() < 1e-12, "({x}, {y}): {value}"),
            }
        }
        let bound = bound([second.as_slice()].into_iter());
        assert!((bound - 0.25).abs() < 1e-12);
        // The ridge is seen as a light band.
        assert_eq!(color(second[2 * 9 + 4], bound), [255; 3]);
        let [flat, zero] = [second[2 * 9 + 3], Some(0.0)].map(|value| color(value, bound)[0]);
        assert!(flat.abs_diff(zero) <= 1, "{flat} {zero}");
        assert_eq!(color(None, bound), OUTSIDE);
    }

    #[test]
    fn the_profile_goes_through_the_highlight() {
        let mut picture = gray(4, 3, |x, y| if (x, y) == (2, 1) { 2.0 } else { f64::from(x) / 3.0 });
        picture.covered[4] = false;
        picture.attachments[0][7] = [f64::NAN; 4];
        let luminance = Luminance::of(&picture);
        assert_eq!(luminance.brightest_row(), 1);
        assert_eq!(luminance.profile(1), [None, Some(0.333333), Some(2.0), None]);
        assert_eq!(luminance.profile(9), [None; 4]);
    }

    #[test]
    fn nothing_has_a_scale_too() {
        assert_eq!(bound([].into_iter()), LEAST_BOUND);
        let nothing = Picture { covered: vec![false; 6], ..gray(2, 3, |_, _| 0.0) };
        assert_eq!(Luminance::of(&nothing).brightest_row(), 1);
    }
}
