//! glisten compiles, checks, draws and measures OpenGL 3.2 era GLSL (`#version 150`).
//!
//! ```text
//!  GLSL 150 text ──► syntax ──► analysis ──► link ──►┬─► lower ──► naga ──► emit     WGSL, SPIR-V, MSL, HLSL, GLSL
//!                    tokens,    typed        program │                        └────► gpu     wgpu on Vulkan
//!                    ast        program      facts   ├─► cpu    reference executor and rasterizer
//!                               (hir)                ├─► gl     the text itself on an OpenGL driver
//!                                                    └─► lint   rules over hir and link facts
//!                        gpu picture ─┐
//!                        cpu picture ─┼─► compare ──► report
//!                         gl picture ─┘
//! ```

/// Code for targets and the reflection: what [`glisten_emit`] makes of a program.
pub mod emit {
    pub use glisten_emit::{
        ClipZ, Conventions, Emitted, Reflection, SpirvEnv, Target, WindowOrigin, emit, emit_with_sources, reflect,
        reflection,
    };
}
pub mod library;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "reference")]
pub mod evaluate;
#[cfg(feature = "cli")]
pub mod gallery;
#[cfg(feature = "reference")]
pub mod measure;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "reference")]
pub mod scene;
#[cfg(feature = "reference")]
pub mod shader_test;
#[cfg(feature = "reference")]
pub mod specialize;

pub use glisten_front::{Compilation, Compiler, Diagnostic, Diagnostics, Options, Program, Source, Stage};
pub use glisten_front::{diagnostic, lint, source};
#[cfg(feature = "gl")]
pub use glisten_gl::Gl;
#[cfg(feature = "gpu")]
pub use glisten_gpu::Gpu;
#[cfg(feature = "reference")]
pub use glisten_reference::{Precision, RenderOptions, render};
#[cfg(feature = "reference")]
pub use glisten_scene::compare::Picture;
