//! [`Precisions`]: the types that have a default precision at a place (GLSL ES 3.00 §4.5.4).
//!
//! *Holds:* the desktop language has no precision, so that no type lacks one there.

use crate::hir::{SamplerDim, SamplerType, Scalar, Stage};
use crate::language::Version;

/// The defaults in force.
#[derive(Clone, Debug, Default)]
pub(in crate::analysis) struct Precisions {
    /// Whether types need a precision: in ES.
    needed: bool,
    float: bool,
    samplers: Vec<SamplerType>,
    /// The types that have been reported, each once.
    reported_float: bool,
    reported_samplers: Vec<SamplerType>,
}

impl Precisions {
    /// The predeclared defaults of a stage: all but those of `float` in fragment shaders and of the samplers that came
    /// after ES 1.00.
    pub(in crate::analysis) fn of(stage: Stage, version: Version) -> Self {
        Self { needed: version.is_es(), float: stage != Stage::Fragment, ..Self::default() }
    }

    /// `precision highp float;`
    pub(in crate::analysis) fn set_float(&mut self) {
        self.float = true;
    }

    /// `precision highp sampler3D;`
    pub(in crate::analysis) fn set_sampler(&mut self, sampler: SamplerType) {
        self.samplers.push(sampler);
    }

    /// Whether a scalar type lacks a precision. It is so once.
    pub(in crate::analysis) fn lacks(&mut self, scalar: Scalar) -> bool {
        let lacks = self.needed && scalar == Scalar::Float && !self.float && !self.reported_float;
        self.reported_float |= lacks;
        lacks
    }

    /// Whether a sampler type lacks a precision. It is so once.
    pub(in crate::analysis) fn lacks_sampler(&mut self, sampler: SamplerType) -> bool {
        let SamplerType { texel, dim, arrayed, shadow } = sampler;
        let predeclared =
            texel == Scalar::Float && !arrayed && !shadow && matches!(dim, SamplerDim::D2 | SamplerDim::Cube);
        let known = predeclared || self.samplers.contains(&sampler) || self.reported_samplers.contains(&sampler);
        let lacks = self.needed && !known;
        if lacks {
            self.reported_samplers.push(sampler);
        }
        lacks
    }

    /// The defaults when a function's body ends: those from before it, with what has been reported.
    pub(in crate::analysis) fn ended(&self, before: &Self) -> Self {
        Self { float: before.float, samplers: before.samplers.clone(), ..self.clone() }
    }
}
