//! Scene files: what is drawn, with which programs and which data.
//!
//! *In:* the TOML of a scene (`[framebuffer]`, `[[draw]]`; see `docs/scenes.md`) and the compiled programs it names.
//! *Out:* a [`Scene`] in which everything is resolved: vertex data by attribute, uniform values by root, textures by
//! sampler. `cpu` and `gpu` draw it and know nothing of TOML.
//!
//! *Holds:* semantics are OpenGL's (lower-left origin, last vertex provoking, clip space z in `[-w, w]`).

pub mod model;

pub use model::{
    AttributeData, AttributeValues, BlendFactor, Compare, Cull, Draw, Filter, Format, Framebuffer, Primitive, Scene,
    State, Texels, Texture, TextureLevel, Wrap,
};
