//! Texts and words for targets, and the reflection.
//!
//! *In:* a [`Program`](crate::link::Program) and [`Conventions`]. *Out:* WGSL, SPIR-V (MSL, HLSL, GLSL), the reflection.
//!
//! *Holds:* what comes out went through naga's validator; a complaint of its validator or writers is an internal error at
//! the place in the GLSL text, and never shows a handle of naga's. The same input gives the same bytes.

mod conventions;
mod inline;
mod lines;
mod names;
mod nesting;
mod notes;
pub mod reflection;
pub(crate) mod textures;
mod write;

pub use conventions::{ClipZ, Conventions, SpirvEnv, Target, WindowOrigin};
#[cfg(feature = "gpu")]
pub(crate) use notes::levels_of_comparisons;
pub use notes::notes;
pub use reflection::{Reflection, reflect};
pub use write::{Emitted, emit, emit_with_sources};
