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

#[cfg(feature = "cli")]
#[doc(hidden)]
pub use glisten_cli as cli;
pub use glisten_front::{Compilation, Compiler, Diagnostic, Diagnostics, Options, Program, Source, Stage};
#[cfg(feature = "gl")]
pub use glisten_gl::Gl;
#[cfg(feature = "gpu")]
pub use glisten_gpu::Gpu;
#[cfg(feature = "reference")]
pub use glisten_reference::{Precision, RenderOptions, render};
#[cfg(feature = "reference")]
pub use glisten_scene::picture::Picture;
#[cfg(feature = "snapshot")]
pub use glisten_snapshot::{
    assert_account, assert_diagnostics, assert_emitted, assert_picture, assert_reflection, assert_scene,
};
pub use glisten_sources::stage_of_name;

/// Texts of shaders, and where their includes come from.
pub mod source {
    pub use glisten_front::source::{IncludeForm, IncludeResolver, Included, Prelude, SourceMap};
}

/// How grave a diagnostic is, and what a host wants to hear of.
pub mod diagnostic {
    pub use glisten_front::diagnostic::{Level, Levels, Severity};

    /// Diagnostics as texts.
    pub mod write {
        pub use glisten_front::diagnostic::write::{github, human, json, sarif};
    }
}

/// Findings on programs that compile.
pub mod lint {
    pub use glisten_front::lint::check;
}

/// Translates programs to targets, and reflects what a host needs to know.
pub mod emit {
    pub use glisten_emit::{
        ClipZ, Conventions, Emitted, FloatWidth, GlslVersion, Reflection, SpirvEnv, Target, WindowOrigin, emit,
        emit_single_file, reflect,
    };
    pub use glisten_specialize::{left_out, optimize};
}

/// The library of lighting models: modules for `#include <glisten/phong.glsl>`, programs, scenes.
pub mod library {
    pub use glisten_library::{Embedded, Module, modules, programs, scenes};
}

/// Shaders in build scripts: checks and compiles them, and writes a Rust module.
pub mod build {
    pub use glisten_build::{Build, BuildError};
}

/// Old shaders as new ones, by edits of their texts.
pub mod upgrade {
    pub use glisten_upgrade::{Refused, Target, upgrade};
}

/// Programs without what a host's values do not need, and scenes without what their pictures do not need.
pub mod specialize {
    pub use glisten_front::hir::ScalarValue;
    pub use glisten_specialize::Options as SpecializeOptions;
    pub use glisten_specialize::{Known, Residual, specialize, specialize_with};
    pub use glisten_variants::{Variant, Variants, specialize_smallest};
    #[cfg(feature = "reference")]
    pub use glisten_verify::specialize::specialize_scene;
}

/// Scene files.
#[cfg(feature = "reference")]
pub mod scene {
    pub use glisten_verify::scene::{DiskFiles, FileError, FileSource, Loaded, MemoryFiles, Scene, load};
}

/// Calls of one function with many inputs.
#[cfg(feature = "reference")]
pub mod evaluate {
    pub use glisten_verify::evaluate::{EvaluateError, Evaluator};
}

/// The fixed-function pipeline: its state, and what is derived from it.
#[cfg(feature = "reference")]
pub mod fixed_function {
    pub use glisten_scene::fixed::FixedFunction;
}

/// Pictures of drivers against the reference.
#[cfg(feature = "reference")]
pub mod verify {
    #[cfg(feature = "gpu")]
    pub use glisten_verify::verify::OnGpu;
    #[cfg(feature = "gl")]
    pub use glisten_verify::verify::OnOpenGl;
    pub use glisten_verify::verify::{Conclusion, Options, Runner, Verification, verify};
}

/// Where a shader loses digits, and what helps.
#[cfg(feature = "stability")]
pub mod stability {
    pub use glisten_stability::{ExamineOptions, SpanError, examine, find, trace};
}

/// How close a picture has to be to a stored one; the assertions are macros.
#[cfg(feature = "snapshot")]
pub mod snapshot {
    pub use glisten_snapshot::Criterion;
}

/// The examples of the README and of the page on the library.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../README.md")]
    struct Readme;
    #[doc = include_str!("../docs/library.md")]
    struct Library;
}
