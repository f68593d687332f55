//! Textures by OpenGL 3.2 §3.8: wrap modes, filters, mipmaps, level of detail, seamless cubes, shadow comparison.
//!
//! *In:* a [`Texture`] and coordinates with their intervals, as f64, in which every domain's coordinates are exact.
//! *Out:* the filtered value with the interval of a GPU's results. The domain rounds once.
//!
//! *Holds:* no coordinate panics. These cases are defined here because OpenGL leaves them undefined: a coordinate
//! that is not finite counts as 0; a fetch outside the texture returns 0 in all components; a missing texture returns
//! (0, 0, 0, 1), like an incomplete one (§3.8.14); if two axes of a cube's direction are equally long, z precedes y,
//! and y precedes x.
//!
//! The interval is the hull of all texels that a coordinate's interval touches
//! ([`rules::TEXEL_COORDINATE`](super::domain::rules::TEXEL_COORDINATE)), with the precision of filter weights
//! ([`Profile`](super::domain::Profile)) and the freedom of a level of detail
//! from derivatives ([`level_bounds`]).

mod cube;
mod lod;
mod sample;
mod texel;

pub(crate) use lod::{Gradients, Steps, level_bounds, steps_in_texels};
pub(crate) use sample::{Request, gather, sample};
pub(crate) use texel::{fetch, fetch_floats, size};

use glisten_scene::Texture;

/// A number with the lower and upper bound of the values that a GPU may have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BoundedFloat {
    pub(crate) value: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl BoundedFloat {
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, low: value, high: value }
    }

    /// Any number, with this as the value.
    pub(crate) fn anything(value: f64) -> Self {
        Self { value, low: f64::NEG_INFINITY, high: f64::INFINITY }
    }

    /// The interval widened by `error` on both sides.
    pub(crate) fn widened(self, error: f64) -> Self {
        Self { value: self.value, low: self.low - error, high: self.high + error }
    }

    /// The image under an increasing function.
    pub(crate) fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self { value: f(self.value), low: f(self.low), high: f(self.high) }
    }

    /// The hull of both, with this one's value.
    pub(crate) fn joined(self, other: Self) -> Self {
        Self { value: self.value, low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The largest distance from its value.
    pub(crate) fn error(self) -> f64 {
        (self.value - self.low).max(self.high - self.value)
    }
}

/// The result of a lookup.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sampled {
    Floats([BoundedFloat; 4]),
    /// The bits of an integer texture, with the interval of `int`s for a GPU.
    Ints([BoundedInt; 4]),
}

/// Bits, with the lower and upper bound of the `int`s that a GPU may have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct BoundedInt {
    pub(crate) bits: u32,
    pub(crate) low: i32,
    pub(crate) high: i32,
}

impl BoundedInt {
    pub(crate) fn exact(bits: u32) -> Self {
        Self { bits, low: bits as i32, high: bits as i32 }
    }

    pub(crate) fn joined(self, other: u32) -> Self {
        Self { bits: self.bits, low: self.low.min(other as i32), high: self.high.max(other as i32) }
    }
}

impl Sampled {
    /// The hull of both, with this one's values.
    pub(crate) fn joined(self, other: Self) -> Self {
        match (self, other) {
            (Self::Floats(a), Self::Floats(b)) => Self::Floats(std::array::from_fn(|k| a[k].joined(b[k]))),
            (Self::Ints(a), Self::Ints(b)) => Self::Ints(std::array::from_fn(|k| a[k].joined(b[k].bits))),
            (one, _) => one.unknown(),
        }
    }

    /// The result with its likely value, where everything is possible.
    pub(crate) fn unknown(self) -> Self {
        match self {
            Self::Floats(values) => Self::Floats(values.map(|bounded| BoundedFloat::anything(bounded.value))),
            Self::Ints(bits) => Self::Ints(bits.map(|bits| BoundedInt { low: i32::MIN, high: i32::MAX, ..bits })),
        }
    }
}

/// The result of a sampler without a texture.
pub(crate) const MISSING: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// The level in use, limited to those that exist.
fn level(texture: &Texture, index: usize) -> Option<&glisten_scene::TextureLevel> {
    texture.levels.get(index.min(texture.levels.len().saturating_sub(1)))
}
