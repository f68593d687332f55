//! Scenes and pictures of glisten.
//!
//! [`load()`] reads a scene file (TOML; see `docs/scenes.md`) and its programs. The result is a [`Scene`], in which
//! everything is resolved: vertex data by attribute, uniform values by root, textures by sampler. The runners draw it
//! and know nothing of TOML. [`picture`] contains pictures and intervals of pixel values; [`compare`] measures the
//! difference between two pictures.
//!
//! *Holds:* nothing here draws. Semantics are OpenGL's (lower-left origin, last vertex provoking, clip space z in `[-w, w]`).
//! Files come through a [`FileSource`]; only its implementation [`DiskFiles`] does I/O.

pub mod compare;
mod dependence;
pub mod dynamic;
mod files;
pub mod fixed;
mod geometry;
mod library;
mod load;
mod model;
pub mod picture;
mod portrait;
pub mod profile;
pub mod random;
mod reads;
pub mod roles;
pub mod tables;
mod toml_string;
pub mod values;

pub use dependence::{ColorDependence, depends_on};
pub use files::{
    DiskFiles, FileError, FileSource, MAX_FILE_BYTES, MemoryFiles, confine_to, confined_to, is_allowed, may_end,
};
pub use library::{Library, NoLibrary};
pub use load::{
    Loaded, MAX_ATTACHMENTS, MAX_PIXELS, MAX_SIDE, STABILITY_KEYS, ShaderFiles, default_tessellation, load, load_kept,
    shape_names, write,
};
pub use model::{
    AttributeData, AttributeValues, Blend, BlendFactor, Compare, Cull, Draw, Filter, FixedDraw, Format, Framebuffer,
    Primitive, Sampling, Scene, State, Texels, Texture, TextureLevel, Wrap,
};
pub use portrait::{Portrait, PortraitError, is_model_file, portrait};
pub use reads::{is_leaf_read, scene_values_read};
pub use toml_string::toml_string;
