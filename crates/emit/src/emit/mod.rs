//! The text or binary of each target, and the reflection.
//!
//! *In:* a [`Program`](glisten_front::link::Program) and [`Conventions`](crate::Conventions). *Out:* WGSL, SPIR-V (MSL, HLSL, GLSL), the reflection.
//!
//! *Holds:* what comes out went through naga's validator; a complaint of its validator or writers is an internal error at
//! the place in the GLSL text, and never shows a handle of naga's. The same input gives the same bytes.

mod inline;
mod lines;
mod names;
mod nesting;
mod notes;
pub mod reflection;
mod write;

pub use notes::{levels_of_comparisons, notes};
pub use reflection::{Reflection, reflect};
pub use write::{Emitted, emit, emit_with_sources};
