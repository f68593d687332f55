//! [`TextureForm`]: the part of a texture function's name that describes its arguments (GLSL 1.50 §8.7).

use crate::language::{SamplerDim, SamplerType};
use smallvec::SmallVec;

/// The kind of a texture lookup.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lookup {
    /// The level of detail comes from derivatives if the stage has them, with or without a bias; otherwise it is the
    /// base level.
    Implicit,
    /// Explicit level of detail.
    Lod,
    /// Explicit derivatives.
    Grad,
    /// One texel.
    Fetch,
    /// The sizes of a level.
    Size,
    /// One component of the four texels that a linear filter would mix (GLSL 4.00 §8.9.3).
    Gather,
    /// The level that an implicit lookup would read, and the level of detail (GLSL 4.00 §8.9.1).
    QueryLod,
    /// The number of levels (GLSL 4.30 §8.9.1).
    Levels,
}

/// The properties that the name of a texture function states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureForm {
    /// The kind of lookup.
    pub lookup: Lookup,
    /// `...Proj`: the coordinate is divided by its last component.
    pub projective: bool,
    /// `...Offset`: an offset in texels.
    pub offset: bool,
    /// `...Offsets`: an offset for each of the four texels of a gather.
    pub offsets: bool,
}

/// The role of an argument of a texture function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureArgument {
    /// The coordinate `P`, with the layer of an array and the reference of a shadow sampler.
    Coordinate,
    /// The level of detail.
    Level,
    /// The number of the sample.
    Sample,
    /// The derivative along x.
    GradientX,
    /// The derivative along y.
    GradientY,
    /// The offset in texels.
    Offset,
    /// Four offsets in texels.
    Offsets,
    /// The reference of a shadow sampler, where `P` does not have it.
    Reference,
    /// The optional number of the gathered component.
    Component,
    /// The optional offset of the implicit level of detail.
    Bias,
}

impl TextureForm {
    /// `textureGatherOffsets` (GLSL 4.00 §8.9.3).
    pub(super) const GATHER_OFFSETS: Self =
        Self { lookup: Lookup::Gather, projective: false, offset: false, offsets: true };

    pub(super) const fn new(lookup: Lookup, projective: bool, offset: bool) -> Self {
        Self { lookup, projective, offset, offsets: false }
    }

    /// The roles of the arguments after the sampler, in order.
    pub fn arguments(self, sampler: SamplerType) -> SmallVec<[TextureArgument; 5]> {
        use TextureArgument::{
            Bias, Component, Coordinate, GradientX, GradientY, Level, Offset, Offsets, Reference, Sample,
        };
        let mut list = SmallVec::new();
        if !matches!(self.lookup, Lookup::Size | Lookup::Levels) {
            list.push(Coordinate);
        }
        match self.lookup {
            Lookup::Gather if sampler.shadow => list.push(Reference),
            // The four components of `P` are all taken.
            Lookup::Implicit if sampler.shadow && sampler.reference_component() > 3 => list.push(Reference),
            Lookup::Implicit | Lookup::Gather | Lookup::QueryLod | Lookup::Levels => {}
            Lookup::Lod => list.push(Level),
            Lookup::Grad => list.extend([GradientX, GradientY]),
            Lookup::Fetch if sampler.dim == SamplerDim::Multisample => list.push(Sample),
            Lookup::Fetch | Lookup::Size if sampler.has_levels() => list.push(Level),
            Lookup::Fetch | Lookup::Size => {}
        }
        if self.offset {
            list.push(Offset);
        }
        if self.offsets {
            list.push(Offsets);
        }
        match self.lookup {
            Lookup::Implicit => list.push(Bias),
            Lookup::Gather if !sampler.shadow => list.push(Component),
            _ => {}
        }
        list
    }
}
