//! The fixed-function pipeline of OpenGL 2.1: its state, what is derived from it, and its two stages as GLSL.
//!
//! | file | contents |
//! | --- | --- |
//! | `state` | matrices, lights, materials, fog: what a host sets, with OpenGL's initial values |
//! | `derived` | inverse matrices, half vectors, products of lights and materials: what OpenGL computes from it |
//! | `names` | both under the names of the uniforms in GLSL |
//! | `pipeline` | the switches: lighting, fog, texture environments |
//! | `combine` | texture environments that combine several colors |
//! | `complete` | the stage that a program lacks |
//! | `vertex`, `environment`, `fragment` | the stages, as texts that one can read |
//!
//! *Holds:* values are derived in f64 from values that were rounded to f32, as OpenGL's state is.

mod combine;
mod complete;
mod derived;
mod environment;
mod fragment;
mod names;
mod pipeline;
mod state;
mod vertex;

pub use combine::{Combination, Combine, CombineArgument, CombineFunction, CombineOperand, CombineSource};
pub use complete::{OtherStage, has_fixed_function, other_stage};
pub use names::{SetError, current_attribute, is_fixed_uniform, uses_fixed_state};
pub use pipeline::{
    ColorMaterial, EnvironmentMode, FogMode, FogSource, GlslDialect, NormalScaling, Pipeline, TexGen, TextureTarget,
    TextureUnit,
};
pub use state::{FixedFunction, Fog, LightSource, Material, PointParameters};

/// The texture units, light sources and clip planes that every implementation has (GLSL 1.20 §7.4).
pub const UNITS: usize = 8;
