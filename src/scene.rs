//! Scene files, with the programs of the library at hand.

use crate::library::Embedded;
use glisten_front::Compiler;

pub use glisten_scene::scene::*;

/// Loads the scene at `path`, whose draws may name programs of the library.
pub fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Loaded {
    glisten_scene::scene::load(path, files, &Embedded, compiler)
}
