//! [`Sample`]: a part of a picture that stands for all of it.
//!
//! *In:* the size of a picture, a number of blocks. *Out:* which pixels are in the sample. *Holds:* the blocks are spread by a hash of
//! their places, so the same numbers give the same sample on every machine; a larger sample has all blocks of a smaller one.

use crate::pipeline::PixelSet;

/// The side of a block in pixels.
const SIDE: u32 = 8;

/// Blocks of 8 by 8 pixels, or all of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sample {
    /// The blocks whose hash is up to this one.
    most: u64,
}

impl Default for Sample {
    fn default() -> Self {
        Self::ALL
    }
}

impl Sample {
    /// The whole picture.
    pub const ALL: Self = Self { most: u64::MAX };

    /// So many blocks of a picture of this width and height; at least one.
    pub fn of(blocks: usize, size: [u32; 2]) -> Self {
        let mut hashes: Vec<u64> = blocks_of(size).map(|[column, row]| hash(column, row)).collect();
        hashes.sort_unstable();
        match hashes.get(blocks.saturating_sub(1)) {
            Some(most) if blocks < hashes.len() => Self { most: *most },
            _ => Self::ALL,
        }
    }

    /// Whether it is the whole picture.
    pub fn is_all(self) -> bool {
        self == Self::ALL
    }

    /// The number of blocks in a picture of this width and height.
    pub fn blocks([width, height]: [u32; 2]) -> usize {
        width.div_ceil(SIDE) as usize * height.div_ceil(SIDE) as usize
    }

    /// Whether a pixel is in the sample: column from the left, row from the top.
    pub fn has(self, x: u32, y: u32) -> bool {
        self.is_all() || hash(x / SIDE, y / SIDE) <= self.most
    }

    /// The share of a picture's pixels that are in the sample.
    pub fn share(self, [width, height]: [u32; 2]) -> f64 {
        let n_inside = pixels([width, height]).filter(|[x, y]| self.has(*x, *y)).count();
        n_inside as f64 / (f64::from(width) * f64::from(height)).max(1.0)
    }

    /// The share of a picture's pixels that are drawn for the sample.
    pub fn drawn_share(self, size: [u32; 2]) -> f64 {
        let marks = self.marks(size);
        marks.iter().filter(|mark| **mark).count() as f64 / (marks.len() as f64).max(1.0)
    }

    /// The pixels that are drawn for the sample; nothing for the whole picture.
    pub(crate) fn drawn(self, size: [u32; 2]) -> Option<PixelSet> {
        (!self.is_all()).then(|| PixelSet::of(&self.marks(size), size[0]))
    }

    /// Whether each pixel is drawn: those of the sample, and those around them, which comparisons look at, too.
    fn marks(self, [width, height]: [u32; 2]) -> Vec<bool> {
        let around = |at: u32, most: u32| at.saturating_sub(1)..(at + 2).min(most);
        let is_near = |[x, y]: [u32; 2]| around(y, height).any(|y| around(x, width).any(|x| self.has(x, y)));
        pixels([width, height]).map(is_near).collect()
    }
}

fn pixels([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}

fn blocks_of([width, height]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    pixels([width.div_ceil(SIDE), height.div_ceil(SIDE)])
}

/// A hash of a block's place (the finalizer of SplitMix64).
fn hash(column: u32, row: u32) -> u64 {
    let mut bits = (u64::from(row) << 32 | u64::from(column)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ bits >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ bits >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ bits >> 31
}

#[cfg(test)]
mod tests {
    use super::{Sample, pixels};

    #[test]
    fn a_sample_has_its_blocks_and_grows() {
        let size = [100, 60];
        assert_eq!(Sample::blocks(size), 104);
        let count = |sample: Sample| pixels(size).filter(|[x, y]| sample.has(*x, *y)).count();
        let [few, more] = [8, 40].map(|blocks| Sample::of(blocks, size));
        assert!((8 * 8..=8 * 64).contains(&count(few)) && count(few) < count(more));
        assert!(pixels(size).all(|[x, y]| !few.has(x, y) || more.has(x, y)));
        assert_eq!(Sample::of(104, size), Sample::ALL);
        assert!((few.share(size) - count(few) as f64 / 6000.0).abs() < 1e-12);
        assert_eq!(Sample::ALL.share(size), 1.0);
    }
}
