//! The back end of glisten: from a linked program to WGSL, SPIR-V, MSL, HLSL and GLSL, with the reflection for its
//! host.
//!
//! ```text
//!  program ──► select ──► lower ──► naga ──► width ──► emit ──► text or binary
//!     └──────────────► reflection
//! ```
//!
//! *In:* a [`Program`](glisten_front::Program), a [`Target`], the [`Conventions`] of its host. *Out:* [`Emitted`]
//! from [`emit()`], [`Reflection`] from [`reflect`]. *Holds:* no type of naga leaves the crate.

mod emit;
mod lower;
mod select;
mod target;
mod width;

pub use emit::{
    Emitted, Origin, Reflection, Traced, emit, emit_functions, emit_single_file, emit_traced, interface_of,
    levels_of_comparisons, notes, reflect, reflection,
};
pub use target::{
    BUFFER_WIDTH, ClipZ, Conventions, FloatWidth, GlslVersion, SpirvEnv, Target, TexelWrap, WindowOrigin, viewport_slot,
};

/// Lowers without emitting, for a benchmark of the two parts. Returns how many functions the lowered module has.
///
/// # Errors
/// What the target cannot represent.
#[doc(hidden)]
pub fn lower_alone(
    program: &glisten_front::Program,
    stage: glisten_front::Stage,
    target: Target,
    conventions: &Conventions,
) -> Result<usize, Vec<glisten_front::Diagnostic>> {
    lower::lower(program, stage, target, conventions).map(|module| module.functions.len())
}
