//! [`Kept`]: the programs of a page, which stay while numbers of its scene change.
//!
//! *In:* scenes. *Out:* the same scenes, whose programs are compiled, and written for WebGPU, once. *Holds:* the answers are the same as without.

use crate::scene::{self, FileSource, Loaded};
use glisten_front::Compiler;

/// The programs that were made for earlier answers.
#[derive(Debug, Default)]
pub struct Kept {
    compiled: glisten_front::compiler::Kept,
    #[cfg(feature = "plan")]
    pub(super) written: glisten_plan::Written,
}

impl Kept {
    /// Loads a scene, as [`scene::load`] does.
    pub fn load(&mut self, path: &str, files: &dyn FileSource, compiler: &Compiler) -> Loaded {
        scene::load_kept(path, files, compiler, &mut self.compiled)
    }
}
