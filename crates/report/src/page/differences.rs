//! The picture of a difference, whose colors are codes.
//!
//! *In:* differences from the reference. *Out:* colors. *Holds:* the color of a pixel says how large its difference is, to 4 %,
//! over eight decades: the script of the page reads it back and shows it on any scale. Without the script the picture is one
//! on the scale of the upper four decades: all below is black to the eye, but not to the script.

use glisten_page::raster::{Decades, scale_color};

/// The code of a pixel that is not compared: only one picture covers it, or a color is not finite.
const APART: usize = 255;
/// The codes of differences, from the lowest to the highest decade.
const CODES: usize = 250;
/// The decades that a code holds below those that the eye sees.
const DARK: i32 = 4;

/// The scale of all differences of a report.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scale {
    seen: Decades,
}

impl Scale {
    /// The scale for some differences.
    pub(super) fn of(differences: impl Iterator<Item = f64>) -> Self {
        Self { seen: Decades::of(differences) }
    }

    /// The decades that the eye sees.
    pub(super) fn seen(self) -> [i32; 2] {
        [self.seen.low, self.seen.high]
    }

    /// The decades of the codes 1 to 250.
    pub(super) fn coded(self) -> [i32; 2] {
        [self.seen.low - DARK, self.seen.high]
    }

    /// The color of a pixel.
    pub(super) fn color(self, difference: Option<f64>) -> [u8; 3] {
        self.color_of_code(self.code(difference))
    }

    /// The colors of all codes as the script reads them: `#0a1b2c`; empty for codes that are not used.
    pub(super) fn palette(self) -> Vec<String> {
        let hex = |[r, g, b]: [u8; 3]| format!("#{r:02x}{g:02x}{b:02x}");
        let name = |code| if code <= CODES || code == APART { hex(self.color_of_code(code)) } else { String::new() };
        (0..=APART).map(name).collect()
    }

    /// 0 for no difference, or one below the scale.
    fn code(self, difference: Option<f64>) -> usize {
        let Some(difference) = difference else { return APART };
        let [low, high] = self.coded().map(f64::from);
        let part = (difference.max(f64::MIN_POSITIVE).log10() - low) / (high - low);
        if part < 0.0 { 0 } else { 1 + (part.min(1.0) * (CODES - 1) as f64).round() as usize }
    }

    fn color_of_code(self, code: usize) -> [u8; 3] {
        if code == APART {
            return [0, 200, 220];
        }
        let [low, high] = self.coded().map(f64::from);
        let log = low + (code.max(1) - 1) as f64 / (CODES - 1) as f64 * (high - low);
        if code == 0 || log < f64::from(self.seen.low) {
            // Each its own black: three digits to the base 6.
            return [code % 6, code / 6 % 6, code / 36].map(|digit| digit as u8);
        }
        scale_color(10f64.powf(log), self.seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_code_has_a_color_of_its_own() {
        for most in [0.0, 1e-9, 3e-3, 0.4, 1e6] {
            let palette = Scale::of([most].into_iter()).palette();
            let used: Vec<&String> = palette.iter().filter(|color| !color.is_empty()).collect();
            assert_eq!(used.len(), CODES + 2);
            assert_eq!(used.iter().collect::<BTreeSet<_>>().len(), used.len(), "{most}");
        }
    }

    #[test]
    fn a_code_says_how_large_a_difference_is() {
        let scale = Scale::of([0.03].into_iter());
        assert_eq!((scale.seen(), scale.coded()), ([-5, -1], [-9, -1]));
        assert_eq!([None, Some(0.0), Some(1e-12), Some(7.0)].map(|one| scale.code(one)), [APART, 0, 0, CODES]);
        for difference in [1.1e-9, 3e-6, 2e-3, 0.09] {
            let log = -9.0 + (scale.code(Some(difference)) - 1) as f64 / (CODES - 1) as f64 * 8.0;
            assert!((10f64.powf(log) / difference - 1.0).abs() < 0.04, "{difference}");
        }
        // Below the scale that is seen, all is black to the eye.
        assert!(scale.color(Some(1e-6)).iter().all(|channel| *channel < 6));
    }
}
