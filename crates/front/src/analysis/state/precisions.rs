//! [`Precisions`]: the types that have a default precision at a place (GLSL ES 3.00 §4.5.4).
//!
//! *Holds:* the desktop language has no precision, so that no type lacks one there.

use crate::hir::{SamplerDim, SamplerType, Scalar, Stage};
use crate::language::{Precision, Version};

/// The default precisions of the types.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Defaults {
    float: Option<Precision>,
    int: Precision,
    samplers: Vec<(SamplerType, Precision)>,
}

/// The defaults in force.
#[derive(Clone, Debug)]
pub(in crate::analysis) struct Precisions {
    /// Whether types need a precision: in ES.
    needed: bool,
    defaults: Defaults,
    /// The types that have been reported, each once.
    reported_float: bool,
    reported_samplers: Vec<SamplerType>,
}

impl Precisions {
    /// The predeclared defaults of a stage: all but those of `float` in fragment shaders and of the samplers that came
    /// after ES 1.00.
    pub(in crate::analysis) fn of(stage: Stage, version: Version) -> Self {
        let is_fragment = stage == Stage::Fragment;
        Self {
            needed: version.is_es(),
            defaults: Defaults {
                float: (!is_fragment).then_some(Precision::High),
                int: if is_fragment { Precision::Medium } else { Precision::High },
                samplers: Vec::new(),
            },
            reported_float: false,
            reported_samplers: Vec::new(),
        }
    }

    /// `precision highp float;`
    pub(in crate::analysis) fn set_scalar(&mut self, scalar: Scalar, precision: Precision) {
        match scalar {
            Scalar::Float => self.defaults.float = Some(precision),
            Scalar::Int => self.defaults.int = precision,
            _ => {}
        }
    }

    /// `precision highp sampler3D;`
    pub(in crate::analysis) fn set_sampler(&mut self, sampler: SamplerType, precision: Precision) {
        self.defaults.samplers.push((sampler, precision));
    }

    /// The default of a scalar type: that of `int` is the one of unsigned integers, too.
    pub(in crate::analysis) fn of_scalar(&self, scalar: Scalar) -> Option<Precision> {
        match scalar {
            Scalar::Float => self.defaults.float,
            Scalar::Int | Scalar::Uint => Some(self.defaults.int),
            Scalar::Bool => None,
        }
    }

    /// The default of a sampler type.
    pub(in crate::analysis) fn of_sampler(&self, sampler: SamplerType) -> Option<Precision> {
        let SamplerType { texel, dim, arrayed, shadow } = sampler;
        let predeclared =
            texel == Scalar::Float && !arrayed && !shadow && matches!(dim, SamplerDim::D2 | SamplerDim::Cube);
        let stated = self.defaults.samplers.iter().rev().find(|(other, _)| *other == sampler);
        stated.map(|(_, precision)| *precision).or(predeclared.then_some(Precision::Low))
    }

    /// Says nothing about types that lack a precision from here on.
    pub(in crate::analysis) fn forgive(&mut self) {
        self.needed = false;
    }

    /// Whether a scalar type lacks a precision. It is so once.
    pub(in crate::analysis) fn lacks(&mut self, scalar: Scalar) -> bool {
        let lacks = self.needed && scalar == Scalar::Float && self.defaults.float.is_none() && !self.reported_float;
        self.reported_float |= lacks;
        lacks
    }

    /// Whether a sampler type lacks a precision. It is so once.
    pub(in crate::analysis) fn lacks_sampler(&mut self, sampler: SamplerType) -> bool {
        let known = self.of_sampler(sampler).is_some() || self.reported_samplers.contains(&sampler);
        let lacks = self.needed && !known;
        if lacks {
            self.reported_samplers.push(sampler);
        }
        lacks
    }

    /// The defaults in force, to restore them.
    pub(in crate::analysis) fn defaults(&self) -> Defaults {
        self.defaults.clone()
    }

    /// Takes the defaults back that were in force; what has been reported stays so.
    pub(in crate::analysis) fn restore(&mut self, defaults: Defaults) {
        self.defaults = defaults;
    }
}
