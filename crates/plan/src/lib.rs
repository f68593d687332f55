//! The calls of WebGPU that draw a scene, without a device.
//!
//! *In:* a [`Scene`](glisten_scene::Scene). *Out:* layouts, bytes and states; all of them as one [`Plan`]; a picture from what was read back.
//!
//! ```text
//!  Scene ──► assembly    vertex numbers: strips, fans and loops made lists, the provoking vertex first
//!        ──► vertices    attribute bytes, expanded to the declared types
//!        ──► uniforms    the bytes of the loose block and of every uniform block
//!        ──► slots, texels, texture_extent    textures and samplers
//!        ──► bindings, visibility, states     layouts, targets, fixed functions
//!        ──► plan        all of it as JSON and bytes
//!  bytes of attachments ──► pixels ──► Picture
//! ```
//!
//! *Holds:* nothing here opens a device or draws. `glisten-gpu` does, by wgpu; a page does, by its browser.

pub mod assembly;
pub mod beyond;
pub mod bindings;
mod error;
pub mod pixels;
mod plan;
pub mod slots;
pub mod sprites;
pub mod states;
pub mod texels;
pub mod texture_extent;
pub mod uniforms;
pub mod vertices;
pub mod visibility;
mod words;

pub use error::Error;
pub use plan::{Plan, Written};
