//! [`TextureForm`]: what the name of a texture function says of its arguments (GLSL 1.50 §8.7).

use crate::language::{SamplerDim, SamplerType};
use smallvec::SmallVec;

/// How a texture is looked up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Lookup {
    /// The level of detail comes from derivatives where the stage has them (else it is the base level), with a bias or
    /// none.
    Implicit,
    /// Explicit level of detail.
    Lod,
    /// Explicit derivatives.
    Grad,
    /// One texel.
    Fetch,
    /// The sizes of a level.
    Size,
}

/// What the name of a texture function says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureForm {
    /// How it is looked up.
    pub lookup: Lookup,
    /// `...Proj`: the coordinate is divided by its last component.
    pub projective: bool,
    /// `...Offset`: an offset in texels.
    pub offset: bool,
}

/// What an argument of a texture function is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureArgument {
    /// Where: `P`, with the layer of an array and the reference of a shadow sampler.
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
    /// What is added to the implicit level of detail; it may be left out.
    Bias,
}

impl TextureForm {
    pub(super) const fn new(lookup: Lookup, projective: bool, offset: bool) -> Self {
        Self { lookup, projective, offset }
    }

    /// What the arguments after the sampler are, in order.
    pub fn arguments(self, sampler: SamplerType) -> SmallVec<[TextureArgument; 5]> {
        use TextureArgument::{Bias, Coordinate, GradientX, GradientY, Level, Offset, Sample};
        let mut list = SmallVec::new();
        if self.lookup != Lookup::Size {
            list.push(Coordinate);
        }
        match self.lookup {
            Lookup::Implicit => {}
            Lookup::Lod => list.push(Level),
            Lookup::Grad => list.extend([GradientX, GradientY]),
            Lookup::Fetch if sampler.dim == SamplerDim::Multisample => list.push(Sample),
            Lookup::Fetch | Lookup::Size if sampler.has_levels() => list.push(Level),
            Lookup::Fetch | Lookup::Size => {}
        }
        if self.offset {
            list.push(Offset);
        }
        if self.lookup == Lookup::Implicit {
            list.push(Bias);
        }
        list
    }
}
