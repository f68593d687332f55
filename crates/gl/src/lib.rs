//! Draws scenes on OpenGL through EGL, without a window: the sources themselves, as the driver's own compiler takes them.
//!
//! *In:* a [`Scene`](glisten_scene::Scene). *Out:* a [`Picture`](glisten_scene::picture::Picture) as `gpu` and `cpu` give it.
//!
//! ```text
//!  libEGL ──► egl         a software device, and on it a core context of 3.2 or later for each scene
//!         ──► api         the calls of OpenGL that are made, as safe functions
//!  Scene  ──► programs    the texts compiled and linked, attributes and outputs bound to the scene's locations
//!         ──► uniforms    loose ones by name; blocks at the offsets that the driver tells
//!         ──► textures    all kinds that 1.50 samples, with their parameters
//!         ──► vertices    a buffer an attribute, components that are missing left to OpenGL
//!         ──► frame       attachments, fixed state, draws, read-back ──► Picture
//! ```
//!
//! *Holds:* the texts are the untouched ones; where a program uses `#include` or macros from outside, the texts with
//! those in their places ([`Shader::texts`](glisten_front::hir::Shader::texts)). Nothing of `lower`, `emit` and `gpu` is used, and
//! of `link` only names and locations: the driver is an independent judge of what the sources mean. Whatever a scene
//! contains, the answer is a picture or an [`Error`]. All `unsafe` is in `egl` and `api`.
//!
//! *Not done here:* judging the picture ([`compare`](glisten_scene::compare)), times, multisampling, geometry shaders.

mod api;
mod egl;
mod error;
mod frame;
mod programs;
mod states;
mod textures;
mod uniforms;
mod vertices;

pub use egl::Gl;
pub use error::Error;
