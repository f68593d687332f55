//! [`Sample`]: a part of a picture that stands for all of it.
//!
//! *In:* the size of a picture, a number of blocks or a distance. *Out:* which pixels are in the sample. *Holds:* the blocks are spread by a
//! hash of their places, so the same numbers give the same sample on every machine; a larger sample has all blocks of a smaller one. The
//! pixels of a lattice have the values that they have in the whole picture.

use crate::pipeline::PixelSet;
use glisten_scene::picture::Picture;

/// The side of a block in pixels.
const SIDE: u32 = 8;

/// Blocks of 8 by 8 pixels, single pixels at equal distances, or all of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sample(Part);

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Part {
    /// The blocks whose hash is up to this one.
    Blocks { most: u64 },
    /// The pixel in the middle of each block of this side.
    Lattice { step: u32 },
}

impl Default for Sample {
    fn default() -> Self {
        Self::ALL
    }
}

impl Sample {
    /// The whole picture.
    pub const ALL: Self = Self(Part::Blocks { most: u64::MAX });

    /// So many blocks of a picture of this width and height; at least one.
    pub fn of(blocks: usize, size: [u32; 2]) -> Self {
        let mut hashes: Vec<u64> = blocks_of(size).map(|[column, row]| hash(column, row)).collect();
        hashes.sort_unstable();
        match hashes.get(blocks.saturating_sub(1)) {
            Some(most) if blocks < hashes.len() => Self(Part::Blocks { most: *most }),
            _ => Self::ALL,
        }
    }

    /// The pixel in the middle of each block of `step` by `step` pixels.
    pub fn lattice(step: u32) -> Self {
        Self(Part::Lattice { step: step.max(1) })
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
        match self.0 {
            Part::Blocks { most } => most == u64::MAX || hash(x / SIDE, y / SIDE) <= most,
            Part::Lattice { step } => [x, y].iter().all(|at| at % step == step / 2),
        }
    }

    /// Gives every pixel of a picture, of which a lattice was drawn, the values of the nearest pixel of it: color and coverage.
    pub fn spread(self, picture: &mut Picture) {
        let Part::Lattice { step } = self.0 else { return };
        let (width, height) = (picture.width, picture.height);
        if width.min(height) <= step / 2 {
            return;
        }
        let nearest = |at: u32, most: u32| (at / step).min((most - 1 - step / 2) / step) * step + step / 2;
        let places: Vec<usize> = pixels([width, height])
            .map(|[x, y]| nearest(y, height) as usize * width as usize + nearest(x, width) as usize)
            .collect();
        for plane in &mut picture.attachments {
            *plane = places.iter().filter_map(|place| plane.get(*place).copied()).collect();
        }
        picture.covered = places.iter().filter_map(|place| picture.covered.get(*place).copied()).collect();
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

    /// Whether each pixel is drawn: those of the sample, and around blocks those that comparisons look at, too.
    fn marks(self, [width, height]: [u32; 2]) -> Vec<bool> {
        if matches!(self.0, Part::Lattice { .. }) {
            return pixels([width, height]).map(|[x, y]| self.has(x, y)).collect();
        }
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
    use glisten_scene::picture::Picture;

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

    #[test]
    fn a_lattice_stands_for_all_pixels() {
        let size = [13, 9];
        let lattice = Sample::lattice(4);
        let inside: Vec<[u32; 2]> = pixels(size).filter(|[x, y]| lattice.has(*x, *y)).collect();
        assert_eq!(inside, [[2, 2], [6, 2], [10, 2], [2, 6], [6, 6], [10, 6]]);
        assert_eq!(lattice.drawn_share(size), 6.0 / 117.0);
        let mut picture = Picture {
            width: 13,
            height: 9,
            attachments: vec![pixels(size).map(|[x, y]| [f64::from(x), f64::from(y), 0.0, 1.0]).collect()],
            covered: pixels(size).map(|[x, y]| [x, y] == [6, 2]).collect(),
            intervals: None,
            undecided: Vec::new(),
            near_edge: Vec::new(),
            silhouette: Vec::new(),
            owner_width: Vec::new(),
        };
        lattice.spread(&mut picture);
        let at = |x: usize, y: usize| picture.attachments[0][y * 13 + x];
        assert_eq!(
            [at(0, 0), at(3, 3), at(12, 8)],
            [[2.0, 2.0, 0.0, 1.0], [2.0, 2.0, 0.0, 1.0], [10.0, 6.0, 0.0, 1.0]]
        );
        assert_eq!(picture.covered.iter().filter(|covered| **covered).count(), 16);
    }
}
