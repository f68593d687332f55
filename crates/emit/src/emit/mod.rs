//! Emits code for targets, and the reflection.
//!
//! *In:* a [`Program`](glisten_front::link::Program) and [`Conventions`](crate::Conventions). *Out:* WGSL or SPIR-V (also MSL, HLSL, GLSL), and
//! the reflection.
//!
//! *Holds:* every module is checked by naga's validator. An error of naga's validator or writers becomes an internal
//! error at the position in the GLSL text, without naga's handles. The same input gives the same bytes.

mod alone;
mod emitted;
mod merge;
mod messages;
mod naga_repairs;
mod notes;
pub mod reflection;
mod statements;
mod targets;
mod wgsl;
mod write;

pub use alone::interface_of;
pub use emitted::{Emitted, Origin, Traced};
pub use notes::{levels_of_comparisons, notes};
pub use reflection::{Reflection, reflect};
pub use write::{emit, emit_functions, emit_single_file, emit_traced};
