//! [`Kept`]: the programs of a page, which stay while numbers of its scene change.
//!
//! *In:* scenes. *Out:* the same scenes, whose programs are compiled, and written for WebGPU, once. *Holds:* the answers are the same as without.

use glisten_front::Compiler;
use glisten_verify::scene::{self, FileSource, Loaded};
#[cfg(feature = "plan")]
use {glisten_front::link::Program, glisten_scene::Scene, std::sync::Arc};

/// The programs that were made for earlier answers.
#[derive(Debug, Default)]
pub struct Kept {
    compiled: glisten_front::compiler::Kept,
    #[cfg(feature = "plan")]
    pub(super) written: glisten_plan::Written,
    /// Programs, and what `compile` writes of them.
    #[cfg(feature = "plan")]
    optimized: Vec<(Arc<Program>, Arc<Program>)>,
}

impl Kept {
    /// How many programs are kept; the oldest goes first.
    #[cfg(feature = "plan")]
    const MOST: usize = 64;

    /// Loads a scene, as [`scene::load`] does.
    pub fn load(&mut self, path: &str, files: &dyn FileSource, compiler: &Compiler) -> Loaded {
        scene::load_kept(path, files, compiler, &mut self.compiled)
    }

    /// The scene with programs without what reaches no output.
    #[cfg(feature = "plan")]
    pub(super) fn as_compiled(&mut self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        for draw in &mut scene.draws {
            draw.program = self.optimized(&draw.program);
        }
        scene
    }

    #[cfg(feature = "plan")]
    fn optimized(&mut self, program: &Arc<Program>) -> Arc<Program> {
        if let Some((_, known)) = self.optimized.iter().find(|(known, _)| Arc::ptr_eq(known, program)) {
            return Arc::clone(known);
        }
        let made = Arc::new(glisten_specialize::optimize(program));
        if self.optimized.len() >= Self::MOST {
            self.optimized.remove(0);
        }
        self.optimized.push((Arc::clone(program), Arc::clone(&made)));
        made
    }
}
