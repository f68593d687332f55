//! Runs emitted code on Vulkan through wgpu.
//!
//! *In:* a [`Scene`](glisten_scene::Scene). *Out:* a [`Picture`], and times.
//!
//! ```text
//!  Scene ──► glisten_plan   vertex numbers, bytes of attributes and uniforms, layouts, states
//!        ──► textures       texels and samplers on the device; depth by drawing
//!        ──► prepare        emitted modules, or others in their place (foreign), layouts, bind groups, pipelines
//!        ──► frame          attachments, passes, read-back ──► Picture
//!        ──► timing         repeated draws under timestamp queries
//! ```
//!
//! *Holds:* whatever a scene contains, the result is a picture or an [`Error`]: error scopes catch wgpu's errors, and
//! waiting has a limit. SPIR-V runs unchanged; the `unsafe` code for that is all in `prepare` (and in `limits`, which reads
//! what wgpu does not report). Pictures are
//! read top row first: code is emitted with [`WindowOrigin::UpperLeft`](glisten_emit::WindowOrigin), so what
//! OpenGL draws at the top of the window is in row 0.
//!
//! *Not done here:* judging the picture ([`compare`](glisten_scene::compare)), multisampling, geometry shaders.

mod device;
#[cfg(feature = "edited-modules")]
mod edited;
mod error;
mod foreign;
mod frame;
mod limits;
mod multisample_upload;
mod prepare;
mod shadow_upload;
mod textures;
mod timing;

#[cfg(test)]
mod tests;

pub use device::{ADAPTER_VARIABLE, AdapterFacts, Gpu, SOFTWARE};
pub use error::Error;
pub use foreign::Foreign;
pub use limits::PrecisionLimits;
pub use prepare::Prepared;

use glisten_scene::picture::Picture;

/// The form of the emitted code that runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Via {
    /// SPIR-V, passed to the driver unchanged.
    Spirv,
    /// WGSL, which wgpu parses with its own naga.
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

/// The result of drawing a scene.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture.
    pub picture: Picture,
    /// The GPU time in milliseconds for drawing the whole scene once, including the first use of its pipelines. Wall
    /// time if the adapter has no timestamp queries.
    pub milliseconds: f64,
}
