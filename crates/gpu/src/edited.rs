//! Scenes with changed text, for tests that plant faults.
//!
//! *In:* a scene, and a function that changes the emitted WGSL. *Out:* a [`Prepared`] scene. *Holds:* wgpu validates the text,
//! as it does any other.

use super::prepare::emitted;
use super::{Error, Gpu, Prepared};
use glisten_emit::{Emitted, Target};
use glisten_front::hir::Stage;
use glisten_scene::{Draw, Scene};

impl Gpu {
    /// Prepares a scene with WGSL after `edit` has changed the emitted text of each stage, in the order of the draws,
    /// vertex stages first. Draws of one program in one state share one call.
    ///
    /// # Errors
    /// Those of [`Gpu::prepare`].
    #[doc(hidden)]
    pub fn prepare_edited_wgsl(
        &self,
        scene: &Scene,
        edit: &dyn Fn(Stage, String) -> String,
    ) -> Result<Prepared, Error> {
        let edited = |draw: &Draw, stage: Stage| match emitted(&scene.framebuffer, draw, stage, Target::Wgsl)? {
            Emitted::Text(text) => Ok(Emitted::Text(edit(stage, text))),
            words @ Emitted::Words(_) => Ok(words),
        };
        self.prepare_with(scene, Target::Wgsl, &edited)
    }
}
