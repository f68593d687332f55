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

pub mod analysis;
pub mod builtin;
pub mod compiler;
pub mod diagnostic;
pub mod emit;
pub mod hir;
pub mod library;
pub mod link;
pub mod lint;
pub mod lower;
pub mod source;
pub mod syntax;

#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "reference")]
pub mod compare;
#[cfg(feature = "reference")]
pub mod cpu;
#[cfg(feature = "reference")]
pub mod evaluate;
#[cfg(feature = "cli")]
pub mod gallery;
#[cfg(feature = "gl")]
pub mod gl;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "reference")]
pub mod scene;
#[cfg(feature = "reference")]
pub mod shader_test;

pub use compiler::{Compilation, Compiler, Options, Source};
