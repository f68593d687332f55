//! Texts and words for targets, and the reflection.
//!
//! *In:* a [`Program`](crate::link::Program) and [`Conventions`]. *Out:* WGSL, SPIR-V (MSL, HLSL, GLSL), the reflection.

mod conventions;

pub use conventions::{ClipZ, Conventions, SpirvEnv, Target, WindowOrigin};
