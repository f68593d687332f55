//! [`Picture`]: the contents of the framebuffer after a draw; and picture files.
//!
//! *In:* a runner's results, or the bytes of a file. *Out:* pictures, 8-bit colors, the bytes of a file.
//!
//! *Holds:* top row first, x fastest. Nothing here draws or touches the file system.

mod eight_bits;
mod exr;
mod file;
mod hdr;
mod image;
mod interval;
mod jpeg;
mod npy;
mod png;
mod tone;
mod transfer;
mod uri;

pub use self::exr::exr_of_colors;
pub use self::png::{Effort, png_rgb};
pub use eight_bits::{NOT_FINITE, byte, visible_rgb};
pub use file::ImageFormat;
pub use image::{Image, ImageError, Shape};
pub use interval::Interval;
pub use tone::{Encoding, Tone};
pub use transfer::Transfer;
pub use uri::{color_uri, colors, data_uri, png_uri};

/// The contents of a framebuffer, top row first, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// The RGBA of every pixel of every color attachment, as stored in the framebuffer's format (integers unchanged).
    pub attachments: Vec<Vec<[f64; 4]>>,
    /// Whether a fragment was written to the pixel, after discard and depth test.
    pub covered: Vec<bool>,
    /// For a reference with envelopes: the values that a conforming GPU may draw, for each channel of each
    /// attachment.
    pub intervals: Option<Vec<Vec<[Interval; 4]>>>,
    /// For a reference with envelopes: pixels where a discard, a depth test or too many branches are undecided.
    pub undecided: Vec<bool>,
    /// Pixels whose center is within 1/128 pixel of an edge of a primitive that was drawn. For a reference with
    /// envelopes, the interval there is the hull of the colors of the primitives that may own the pixel.
    pub near_edge: Vec<bool>,
    /// For a reference with envelopes: those of them at a silhouette, which a conforming GPU may leave uncovered.
    pub silhouette: Vec<bool>,
    /// For a reference with envelopes: near edges, the largest width of the interval of one owner. Empty if there are
    /// none.
    pub owner_width: Vec<f32>,
}

impl Picture {
    /// The number of pixels with a channel, in any attachment, that differs bit by bit when both pictures are rounded
    /// to f32. All NaNs count as equal.
    pub fn bit_unequal(&self, other: &Self) -> u64 {
        let differs = |a: &[f64; 4], b: &[f64; 4]| {
            a.iter()
                .zip(b)
                .map(|(a, b)| (*a as f32, *b as f32))
                .any(|(a, b)| a.to_bits() != b.to_bits() && !(a.is_nan() && b.is_nan()))
        };
        let mut unequal = vec![false; self.covered.len()];
        for (ours, theirs) in self.attachments.iter().zip(&other.attachments) {
            for ((unequal, a), b) in unequal.iter_mut().zip(ours).zip(theirs) {
                *unequal |= differs(a, b);
            }
        }
        unequal.into_iter().filter(|unequal| *unequal).count() as u64
    }

    /// Whether both have the same coverage and, bit by bit, the same colors, so that whatever compares one of them with a
    /// third picture finds the same for the other.
    pub fn has_bits_of(&self, other: &Self) -> bool {
        let bits = |color: &[f64; 4]| color.map(f64::to_bits);
        let same = |(ours, theirs): (&Vec<[f64; 4]>, &Vec<[f64; 4]>)| ours.iter().map(bits).eq(theirs.iter().map(bits));
        (self.width, self.height, self.attachments.len()) == (other.width, other.height, other.attachments.len())
            && self.covered == other.covered
            && self.attachments.iter().zip(&other.attachments).all(same)
    }
}

#[cfg(test)]
mod tests {
    use super::Picture;

    fn picture(reds: &[f64]) -> Picture {
        Picture::of_colors(reds.len() as u32, 1, reds.iter().map(|&red| [red, 0.0, 0.0, 1.0]).collect())
    }

    #[test]
    fn pictures_have_the_same_bits_or_not() {
        let one = picture(&[0.0, f64::NAN, 2.0]);
        assert!(one.has_bits_of(&one.clone()));
        assert!(!one.has_bits_of(&picture(&[-0.0, f64::NAN, 2.0])));
        assert!(!one.has_bits_of(&picture(&[0.0, f64::NAN])));
        let uncovered = Picture { covered: vec![true, true, false], ..one.clone() };
        assert!(!one.has_bits_of(&uncovered));
    }

    #[test]
    fn bits_are_those_of_f32() {
        let ours = picture(&[0.1, 1.0, f64::NAN, 0.0]);
        let theirs = picture(&[f64::from(0.1f32), 1.0 + 2e-7, f64::NAN, -0.0]);
        assert_eq!(ours.bit_unequal(&theirs), 2);
    }
}
