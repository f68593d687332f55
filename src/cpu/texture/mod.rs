//! Textures, by OpenGL 3.2 §3.8: wrap modes, filters, mipmaps, level of detail, cubes without seams, shadow comparison.
//!
//! *In:* a [`Texture`] and coordinates with their bounds, as f64: every domain's coordinates are exact there. *Out:* the
//! filtered value with a bound on what a GPU may differ by. The domain rounds once.
//!
//! *Holds:* no coordinate panics. Defined here where OpenGL is not: a coordinate that is not finite counts as 0; a fetch
//! outside the texture gives 0 in all components; a missing texture gives (0, 0, 0, 1), as an incomplete one does
//! (§3.8.14); where two axes of a cube's direction are equally long, z goes before y before x.
//!
//! The bound takes the hull of all texels that a coordinate's interval touches, the precision of filter weights
//! ([`rules::FILTER_WEIGHT`](super::domain::rules::FILTER_WEIGHT)) and of a level of detail from derivatives
//! ([`rules::LEVEL_OF_DETAIL`](super::domain::rules::LEVEL_OF_DETAIL)).

mod cube;
mod lod;
mod sample;
mod texel;

pub(crate) use lod::{Gradients, level_of_detail};
pub(crate) use sample::{Request, sample};
pub(crate) use texel::{fetch, size};

use crate::scene::Texture;

/// A number and how far a GPU's may be off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Near {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

impl Near {
    pub(crate) fn exact(value: f64) -> Self {
        Self { value, error: 0.0 }
    }
}

/// What a lookup gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sampled {
    Floats([Near; 4]),
    /// The bits of an integer texture, and whether they are sure.
    Bits([u32; 4], bool),
}

/// Of a sampler without a texture.
pub(crate) const MISSING: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// The level in use, limited to those that there are.
fn level(texture: &Texture, index: usize) -> Option<&crate::scene::TextureLevel> {
    texture.levels.get(index.min(texture.levels.len().saturating_sub(1)))
}
