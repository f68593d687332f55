//! Draws scenes by OpenGL through EGL, without a window, from the original sources, which the driver's own compiler
//! compiles.
//!
//! *In:* a [`Scene`](glisten_scene::Scene). *Out:* a [`Picture`](glisten_scene::picture::Picture), as from
//! the GPU runner and the reference.
//!
//! ```text
//!  libEGL ──► egl         a software device, and on it a context of 3.2 or later for each scene: a core context, or a
//!                         compatibility context if a program names the fixed-function pipeline
//!         ──► api         safe wrappers for the OpenGL functions in use
//!  Scene  ──► programs    the texts compiled and linked, attributes and outputs bound to the scene's locations
//!         ──► uniforms    loose ones by name; blocks at the offsets that the driver reports
//!         ──► fixed       the state of the fixed-function pipeline, by the functions of `old`
//!         ──► pipeline    its switches, for a draw that names one stage: the driver's own provides the other
//!         ──► textures    all kinds that 1.50 samples, with their parameters
//!         ──► vertices    a buffer per attribute; OpenGL fills in missing components
//!         ──► frame       attachments, fixed state, draws, read-back ──► Picture
//! ```
//!
//! *Holds:* the texts are the original ones; if a program uses `#include` or macros from outside, they are the texts
//! with those inserted ([`Shader::texts`](glisten_front::hir::Shader::texts)). The runner uses nothing of `lower`, `emit` and
//! `gpu`, and of `link` only names and locations, so the driver is an independent judge of what the sources mean.
//! Whatever a scene contains, the result is a picture or an [`Error`]. All `unsafe` code is in `egl`, `api` and `old`.
//!
//! *Not done here:* judging the picture ([`compare`](glisten_scene::compare)), times, multisampling, geometry shaders.

mod api;
mod combine;
mod egl;
mod error;
mod fixed;
mod frame;
mod multisample;
mod old;
mod pipeline;
mod programs;
mod states;
mod texels;
mod textures;
mod uniforms;
mod vertices;

pub use egl::Gl;
pub use error::Error;
