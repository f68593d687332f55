//! Runs emitted code on Vulkan through wgpu.
//!
//! *In:* a [`Scene`](glisten_scene::Scene). *Out:* a [`Picture`] and times.
//!
//! ```text
//!  Scene ──► assembly    vertex numbers: strips, fans and loops made lists, the provoking vertex first
//!        ──► vertices    attribute bytes, expanded to the declared types
//!        ──► uniforms    the bytes of the loose block and of every uniform block
//!        ──► textures    texels and samplers (1D as 2D, buffers 4096 wide, depth by drawing)
//!        ──► prepare     emitted modules, layouts, bind groups, pipelines
//!        ──► frame       attachments, passes, read-back ──► Picture
//!        ──► timing      repeated draws under timestamp queries
//! ```
//!
//! *Holds:* whatever a scene contains, the answer is a picture or an [`Error`]: wgpu's complaints are caught in error
//! scopes, waiting has a limit. The emitted SPIR-V runs as it is; all `unsafe` of that is in `prepare`.
//! Pictures are read top row first: code is emitted with [`WindowOrigin::UpperLeft`](glisten_emit::WindowOrigin), so
//! what OpenGL draws at the top of the window is in row 0.
//!
//! *Not done here:* judging the picture ([`compare`](glisten_scene::compare)), multisampling, geometry shaders.

mod assembly;
mod device;
mod error;
mod frame;
mod prepare;
mod shadow_upload;
mod states;
mod textures;
mod timing;
mod uniforms;
mod vertices;

#[cfg(test)]
mod tests;

pub use device::{AdapterFacts, Gpu};
pub use error::Error;
pub use prepare::Prepared;

use glisten_scene::picture::Picture;

/// Which emitted form runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Via {
    /// The emitted words, passed through to the driver untouched.
    Spirv,
    /// The emitted text, read again by wgpu's own naga.
    Wgsl,
}

impl Via {
    /// `spirv`, `wgsl`
    pub fn name(self) -> &'static str {
        match self {
            Self::Spirv => "spirv",
            Self::Wgsl => "wgsl",
        }
    }
}

/// What a draw of a scene gave.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture.
    pub picture: Picture,
    /// Milliseconds of GPU time of one draw of the whole scene, the pipelines' first draw included; wall time where
    /// the adapter has no timestamp queries.
    pub milliseconds: f64,
}
