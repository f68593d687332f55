//! Emits code for targets, and the reflection.
//!
//! *In:* a [`Program`](crate::link::Program) and [`Conventions`]. *Out:* WGSL or SPIR-V (also MSL, HLSL, GLSL), and
//! the reflection.
//!
//! *Holds:* every module is checked by naga's validator. An error of naga's validator or writers becomes an internal
//! error at the position in the GLSL text, without naga's handles. The same input gives the same bytes.

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
