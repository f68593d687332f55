//! [`draw`]: a picture in one of the arithmetics that an examination compares.

use crate::RenderOptions;
use crate::domain::{Exact, F64, Stepwise};
use crate::pipeline;
use glisten_front::diagnostic::Diagnostic;
use glisten_scene::Scene;
use glisten_scene::picture::Picture;

/// An arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// A GPU's f32: each operation rounds, functions have the steps of their formulas, subnormal numbers are flushed.
    Single,
    /// f64.
    Double,
    /// 192 bits.
    Exact,
}

/// Draws a scene, without marks near edges.
///
/// # Errors
/// The errors of [`render`](crate::render).
pub fn draw(scene: &Scene, arithmetic: Arithmetic) -> Result<Picture, Vec<Diagnostic>> {
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    match arithmetic {
        Arithmetic::Single => pipeline::render::<Stepwise>(scene, &options),
        Arithmetic::Double => pipeline::render::<F64>(scene, &options),
        Arithmetic::Exact => pipeline::render::<Exact>(scene, &options),
    }
}
