//! Pictures and differences as data URIs.
//!
//! *Holds:* colors are those of [`glisten_scene::picture::color_uri`]. Differences have a logarithmic scale of some [`Decades`]; pixels that only one picture covers
//! are cyan.

use glisten_scene::picture::Effort;
pub use glisten_scene::picture::{color_uri, colors, data_uri};

/// The differences between which the colors lie, in powers of ten: at the low one and below, a pixel is black.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decades {
    /// The power at which a pixel is black.
    pub low: i32,
    /// The power at which a pixel has full intensity.
    pub high: i32,
}

impl Decades {
    /// From the rounding of f32 to full intensity.
    pub const ALL: Self = Self { low: -7, high: 0 };
    /// The number of decades that a scale has: fewer tell more of differences that are alike.
    const SPAN: i32 = 4;

    /// The scale for some differences: up to the power of ten above the largest.
    pub fn of(differences: impl Iterator<Item = f64>) -> Self {
        let most = differences.filter(|difference| difference.is_finite()).fold(0.0, f64::max);
        if most <= 0.0 {
            return Self::ALL;
        }
        let high = (most.log10().ceil() as i32).clamp(Self::ALL.low + Self::SPAN, Self::ALL.high);
        Self { low: high - Self::SPAN, high }
    }
}

/// The colors of the difference scale, dark to light, in equal steps; colors between them are interpolated.
pub const SCALE: [[u8; 3]; 8] = [
    [0, 0, 4],
    [40, 11, 84],
    [101, 21, 110],
    [159, 42, 99],
    [212, 72, 66],
    [245, 125, 21],
    [250, 193, 39],
    [252, 255, 164],
];

/// Differences as a PNG data URI.
pub fn difference_uri(differences: &[Option<f64>], width: u32, height: u32, scale: Decades) -> String {
    let pixels = differences.iter().map(|difference| match difference {
        Some(difference) => scale_color(*difference, scale),
        None => [0, 200, 220],
    });
    data_uri(&pixels.collect::<Vec<_>>(), width, height, Effort::Fast)
}

/// The color of a difference.
pub fn scale_color(difference: f64, Decades { low, high }: Decades) -> [u8; 3] {
    let part = (difference.max(f64::MIN_POSITIVE).log10() - f64::from(low)) / f64::from(high - low);
    let place = part.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let index = (place as usize).min(SCALE.len() - 2);
    let [low, high] = [SCALE[index], SCALE[index + 1]];
    let mix = place - index as f64;
    std::array::from_fn(|i| (f64::from(low[i]) * (1.0 - mix) + f64::from(high[i]) * mix).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_ends_where_it_says() {
        let scale = Decades::of([0.0, 0.03, 1e-9].into_iter());
        assert_eq!(scale, Decades { low: -5, high: -1 });
        assert_eq!([0.0, 1e-5, 0.1, 100.0].map(|x| scale_color(x, scale)), [SCALE[0], SCALE[0], SCALE[7], SCALE[7]]);
        // A factor of ten is seen.
        assert_ne!(scale_color(1e-3, scale), scale_color(1e-2, scale));
        assert_eq!(Decades::of([0.0].into_iter()), Decades::ALL);
        assert_eq!(Decades::of([1e-12].into_iter()), Decades { low: -7, high: -3 });
        assert_eq!(Decades::of([7.0].into_iter()), Decades { low: -4, high: 0 });
    }
}
