//! The figures of a report: differences of pictures, spreads of ratios.
//!
//! *Holds:* pixels that only one picture covers, and those that are not finite, are counted and are in no other figure but FLIP,
//! which is of the whole pictures.

use super::interval::{SHOWN, median_interval};
use super::model::{Figures, Spread};
use glisten_scene::compare::ulp_f32;
use glisten_scene::picture::Picture;

/// The difference between `picture` and `truth`, as figures and per pixel.
pub(super) fn compare(picture: &Picture, truth: &Picture) -> (Figures, Vec<Option<f64>>) {
    let mut figures = Figures::default();
    let mut squares = 0.0;
    let mut channels = 0u64;
    let empty = Vec::new();
    let colors = picture.attachments.first().unwrap_or(&empty);
    let wanted = truth.attachments.first().unwrap_or(&empty);
    let pixels = colors.iter().zip(wanted).zip(picture.covered.iter().zip(&truth.covered));
    let differences = pixels
        .map(|((color, wanted), (&covered, &should))| {
            if covered != should {
                figures.coverage_mismatch += 1;
                return None;
            }
            if !covered {
                return Some(0.0);
            }
            figures.covered += 1;
            let mut largest = 0.0f64;
            let rgb = || color.iter().zip(wanted).take(3).map(|(a, b)| (a - b).abs());
            if rgb().any(|difference| !difference.is_finite()) {
                figures.non_finite += 1;
                return None;
            }
            for (difference, wanted) in rgb().zip(wanted) {
                squares += difference * difference;
                channels += 1;
                largest = largest.max(difference);
                figures.max_ulp = figures.max_ulp.max(difference / ulp_f32(*wanted));
            }
            figures.max_abs = figures.max_abs.max(largest);
            Some(largest)
        })
        .collect();
    figures.rmse = if channels > 0 { (squares / channels as f64).sqrt() } else { 0.0 };
    figures.psnr = (figures.rmse > 0.0).then(|| -20.0 * figures.rmse.log10());
    (figures, differences)
}

/// The median and the quartiles; NaN if there are no values.
pub(super) fn spread(values: &[f64]) -> Spread {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = |fraction: f64| {
        let place = fraction * sorted.len().saturating_sub(1) as f64;
        let [below, above] = [place.floor(), place.ceil()].map(|i| sorted.get(i as usize).copied().unwrap_or(f64::NAN));
        below + (above - below) * place.fract()
    };
    let interval = median_interval(values, SHOWN).unwrap_or([f64::NAN; 2]);
    Spread { median: at(0.5), low: at(0.25), high: at(0.75), interval }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(reds: &[f64], covered: &[bool]) -> Picture {
        Picture {
            covered: covered.to_vec(),
            ..Picture::of_colors(reds.len() as u32, 1, reds.iter().map(|&red| [red, 0.0, 0.0, 1.0]).collect())
        }
    }

    #[test]
    fn coverage_and_nan_are_counted_apart() {
        let gpu = picture(&[1.0, 0.5, f64::NAN, 9.0], &[true, true, true, false]);
        let truth = picture(&[0.0, 0.5, 0.0, 0.0], &[true, true, true, true]);
        let (figures, differences) = compare(&gpu, &truth);
        assert_eq!((figures.covered, figures.coverage_mismatch, figures.non_finite), (3, 1, 1));
        assert_eq!(figures.max_abs, 1.0);
        // One of the six finite channels is off by 1.
        assert!((figures.rmse - (1.0f64 / 6.0).sqrt()).abs() < 1e-15);
        assert_eq!(figures.max_ulp, 1.0 / f64::from(f32::MIN_POSITIVE) * 2f64.powi(23));
        assert_eq!(differences, [Some(1.0), Some(0.0), None, None]);
    }

    #[test]
    fn equal_pictures_have_no_psnr() {
        let same = picture(&[0.25], &[true]);
        assert_eq!(compare(&same, &same).0.psnr, None);
    }

    #[test]
    fn quartiles_interpolate() {
        let quartiles = |values: &[f64]| {
            let spread = spread(values);
            (spread.median, spread.low, spread.high)
        };
        assert_eq!(quartiles(&[4.0, 1.0, 3.0, 2.0]), (2.5, 1.75, 3.25));
        assert_eq!(quartiles(&[7.0]), (7.0, 7.0, 7.0));
        assert_eq!(spread(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).interval, [1.0, 6.0]);
        assert!(spread(&[1.0]).interval[0].is_nan());
    }
}
