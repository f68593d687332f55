//! glisten compiles, checks, draws and measures OpenGL 3.2 era GLSL (`#version 150`).
//!
//! ```text
//!  GLSL 150 text ──► Compiler ──► Program ──┬─► emit::emit      WGSL, SPIR-V, MSL, HLSL, GLSL
//!                       │                   ├─► emit::reflect   what a host program needs
//!                       ▼                   └─► lint::check     what is legal but will hurt
//!                  Diagnostics
//!
//!  scene file ──► scene::load ──► Scene ────┬─► render          Picture, by the CPU reference
//!                                           ├─► Gpu, Gl         Picture, by a driver
//!                                           └─► verify::verify  is the picture right?
//! ```
//!
//! [`Compiler`] turns the texts of a program into a [`Program`] and everything that is wrong with them. [`mod@emit`] translates
//! it. [`library`] has lighting models to include. With the feature `reference`, `scene` loads scenes, `render` draws them, and
//! `evaluate` calls a single function with many inputs. With `gpu` or `gl`, drivers draw them, too, and `verify` judges the
//! pictures.
//!
//! Without features, this is the compiler core and [`build`], for build scripts: no GPU, no command line. Only `build` reads and
//! writes files.

pub mod build;
pub mod cost;
pub mod engines;
pub mod library;
mod sources;

#[cfg(feature = "cli")]
pub mod account;
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[cfg(feature = "cli")]
mod embedded;
#[cfg(feature = "cli")]
mod environment;
#[cfg(feature = "reference")]
pub mod evaluate;
#[doc(hidden)]
pub mod format;
#[cfg(feature = "cli")]
pub mod gallery;
#[cfg(feature = "lsp")]
mod lsp;
#[cfg(feature = "cli")]
pub mod made;
#[cfg(feature = "reference")]
pub mod measure;
#[cfg(feature = "cli")]
mod page;
#[cfg(feature = "stability")]
#[doc(hidden)]
pub mod play;
#[cfg(feature = "cli")]
pub mod port;
#[cfg(feature = "cli")]
pub mod report;
#[cfg(feature = "reference")]
pub use glisten_scene::fixed as fixed_function;
#[cfg(feature = "reference")]
pub mod scene;
#[cfg(feature = "reference")]
pub mod shader_test;
#[cfg(any(feature = "snapshot", feature = "cli"))]
pub mod snapshot;
pub mod specialize;
#[cfg(feature = "stability")]
pub mod stability;
#[cfg(feature = "stability")]
mod trace;
#[cfg(feature = "reference")]
pub mod unit_test;
pub mod upgrade;
#[cfg(feature = "reference")]
pub mod verify;

pub use glisten_front::compiler::SourceSettings;
pub use glisten_front::{Compilation, Compiler, Diagnostic, Diagnostics, Options, Program, Source, Stage};
pub use glisten_front::{diagnostic, lint, source};
#[cfg(feature = "gl")]
pub use glisten_gl::Gl;
#[cfg(feature = "gpu")]
pub use glisten_gpu::Gpu;
#[cfg(feature = "reference")]
pub use glisten_reference::{Precision, RenderOptions, render};
#[cfg(feature = "reference")]
pub use glisten_scene::picture::Picture;
pub use sources::{Search, completing, stage_of_name};

/// Translates programs to targets, and reflects what a host needs to know.
pub mod emit {
    pub use glisten_emit::{
        ClipZ, Conventions, Emitted, FloatWidth, GlslVersion, Reflection, SpirvEnv, Target, WindowOrigin, emit,
        emit_single_file, emit_with_sources, reflect, reflection,
    };
    pub use glisten_specialize::{left_out, optimize};
}

/// The examples of the README and of the page on the library.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/library.md")]
    struct Library;
}
