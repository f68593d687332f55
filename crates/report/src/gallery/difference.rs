//! [`Difference`]: of two pictures that two programs drew of the same thing.
//!
//! *In:* two pictures of one size, before they are averaged. *Out:* the largest difference of a channel, and a picture of
//! all differences. *Holds:* differences are those of linear light. They are multiplied by a power of two that brings the
//! largest to between a half and 1, and are not encoded: black is equal.

use super::tile::Tile;
use glisten_scene::picture::{Picture, byte};

/// The largest factor by which differences are multiplied.
const MOST: f64 = 65_536.0;

/// How two pictures differ.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// The largest absolute difference of a color channel.
    pub most: f64,
    /// The factor by which the tile shows differences.
    pub factor: u32,
    /// The differences by channel.
    pub tile: Tile,
}

impl Difference {
    /// The difference of the first attachments; `None` if the pictures have different sizes.
    pub fn new(one: &Picture, other: &Picture) -> Option<Self> {
        let size = (one.width, one.height);
        let (one, other) =
            (one.attachments.first()?, other.attachments.first().filter(|_| size == (other.width, other.height))?);
        let channel = |a: f64, b: f64| if a.is_finite() && b.is_finite() { (a - b).abs() } else { f64::INFINITY };
        let pair = |(a, b): (&[f64; 4], &[f64; 4])| std::array::from_fn(|i| channel(a[i], b[i]));
        let differences: Vec<[f64; 3]> = one.iter().zip(other).map(pair).collect();
        let most = differences.iter().flatten().fold(0.0, |most: f64, difference| most.max(*difference));
        let factor = if most > 0.0 { (1.0 / most).log2().floor().exp2().clamp(1.0, MOST) } else { 1.0 };
        let pixels = differences.iter().map(|pixel| pixel.map(|channel| byte(factor * channel))).collect();
        Some(Self { most, factor: factor as u32, tile: Tile::of_bytes(size.0, size.1, pixels) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(red: f64) -> Picture {
        Picture::of_colors(1, 1, vec![[red, 0.5, 0.0, 1.0]])
    }

    #[test]
    fn the_factor_brings_the_largest_to_light() {
        let found = Difference::new(&picture(0.5), &picture(0.45)).expect("one size");
        assert!((found.most - 0.05).abs() < 1e-12);
        assert_eq!((found.factor, &found.tile), (16, &Tile::of_bytes(1, 1, vec![[204, 0, 0]])));
        let equal = Difference::new(&picture(0.5), &picture(0.5)).expect("one size");
        assert_eq!((equal.most, equal.factor, equal.tile), (0.0, 1, Tile::of_bytes(1, 1, vec![[0; 3]])));
        let lost = Difference::new(&picture(f64::NAN), &picture(0.5)).expect("one size");
        assert_eq!((lost.most, lost.factor), (f64::INFINITY, 1));
        assert_eq!(Difference::new(&picture(0.5), &Picture::of_colors(2, 1, vec![[0.0; 4]; 2])), None);
    }
}
