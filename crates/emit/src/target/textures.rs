//! [`Shape`]: the texture and sampler that represent a sampler type, in WebGPU's terms.
//!
//! *In:* a [`SamplerType`]. *Out:* the entry for the layout of a bind group. *Holds:* it agrees with what the
//! lowering declares (see `lower/samplers.rs`); a test with a host that knows only the reflection shows that.

use glisten_front::hir::{SamplerDim, SamplerType, Scalar};

/// The number of texels in a row of the 2D texture that emulates a buffer texture: texel `i` is at (`i` mod width,
/// `i` / width).
pub const BUFFER_WIDTH: u32 = 4096;

/// A texture and its sampler.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Shape {
    pub(crate) view_dimension: &'static str,
    pub(crate) sample_type: &'static str,
    pub(crate) multisampled: bool,
    pub(crate) sampler_type: Option<&'static str>,
    pub(crate) row_width: Option<u32>,
}

impl Shape {
    /// The texture and sampler of a sampler type.
    pub(crate) fn of(ty: SamplerType) -> Self {
        let multisampled = ty.dim == SamplerDim::Multisample;
        Self {
            view_dimension: match (ty.dim, ty.arrayed) {
                (SamplerDim::D3, _) => "3d",
                // Texels cannot be loaded from a cube, and integer texels are only loaded.
                (SamplerDim::Cube, _) if ty.is_integer_cube() => "2d-array",
                (SamplerDim::Cube, false) => "cube",
                (SamplerDim::Cube, true) => "cube-array",
                (_, false) => "2d",
                (_, true) => "2d-array",
            },
            sample_type: match ty.texel {
                Scalar::Int => "sint",
                Scalar::Uint => "uint",
                Scalar::Bool | Scalar::Float if ty.shadow => "depth",
                Scalar::Bool | Scalar::Float if !ty.is_filtered() => "unfilterable-float",
                Scalar::Bool | Scalar::Float => "float",
            },
            multisampled,
            sampler_type: ty.is_filtered().then_some(if ty.shadow { "comparison" } else { "filtering" }),
            row_width: (ty.dim == SamplerDim::Buffer).then_some(BUFFER_WIDTH),
        }
    }
}
