//! Scene files: what to draw, with which programs and which data.
//!
//! *In:* the TOML of a scene (`[framebuffer]`, `[[draw]]`; see `docs/scenes.md`) and the compiled programs that it
//! names. *Out:* a [`Scene`] with everything resolved: vertex data by attribute, uniform values by root, textures by
//! sampler. `cpu` and `gpu` draw it and know nothing about TOML.
//!
//! *Holds:* semantics are OpenGL's (lower-left origin, last vertex provoking, clip-space z in `[-w, w]`). A
//! [`FileSource`] supplies the files; only its implementation [`DiskFiles`] does I/O.

mod attributes;
mod draw;
mod files;
mod library;
mod lights;
mod load;
mod material;
mod matrices;
mod mesh;
mod mipmaps;
pub mod model;
mod names;
mod patterns;
mod reader;
mod textures;
mod uniforms;
mod write;

pub use files::{DiskFiles, FileError, FileSource, MemoryFiles};
pub use library::{Library, NoLibrary};
pub use write::{ShaderFiles, write};

pub use load::{Loaded, MAX_ATTACHMENTS, MAX_PIXELS, MAX_SIDE, load};
pub use model::{
    AttributeData, AttributeValues, BlendFactor, Compare, Cull, Draw, Filter, Format, Framebuffer, Primitive, Scene,
    State, Texels, Texture, TextureLevel, Wrap,
};
