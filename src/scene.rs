//! Scene files, with the programs of the library at hand.

use crate::library::Embedded;
use glisten_front::Compiler;

pub use glisten_scene::{
    AttributeData, AttributeValues, BlendFactor, Compare, Cull, DiskFiles, Draw, FileError, FileSource, Filter,
    FixedDraw, Format, Framebuffer, Library, Loaded, MAX_ATTACHMENTS, MAX_PIXELS, MAX_SIDE, MemoryFiles, NoLibrary,
    Primitive, Sampling, Scene, State, Texels, Texture, TextureLevel, Wrap,
};

/// Loads the scene at `path`, whose draws may name programs of the library.
pub fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Loaded {
    glisten_scene::load(path, files, &Embedded, compiler)
}
