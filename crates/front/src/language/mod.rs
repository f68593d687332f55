//! The vocabulary of the language, which all phases share.
//!
//! *In:* nothing but [`source`](crate::source). *Out:* stages, versions, types and operators. *Holds:* no phase is
//! known here, so that the tables of built-ins, the syntax tree and the typed program can all use these terms.

mod extension;
mod feature;
pub(crate) mod foreign;
mod locations;
mod operators;
mod section;
mod stage;
mod types;
mod version;

pub use extension::{EXTENSIONS, Extension, Extensions, Families};
pub use feature::{FEATURES, Feature, FeatureRow};
pub use operators::IncDec;
pub use section::{EDITIONS, Edition, Section, cite, runs};
pub use stage::{Interpolation, ParamMode, Precision, Sampling, Stage, Storage};
pub use types::{
    ArraySize, MatrixLayout, Member, MemberPlace, SamplerDim, SamplerType, Scalar, StructId, StructType, Type, TypeId,
    Types,
};
pub use version::{Behavior, NEVER, Profile, Since, Version};
