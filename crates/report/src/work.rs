//! The work of a variant: what the reference executes for its picture.

use super::model::Work;
use super::weights::Weights;
use glisten_emit::FloatWidth;
use glisten_front::diagnostic::Diagnostic;
use glisten_reference::{Counts, RenderOptions, Step, counts};
use glisten_scene::Scene;
use glisten_specialize::optimize;

/// Counts the steps of a scene. What reaches no output of a program is left out, as emitters and drivers leave it out.
///
/// # Errors
/// Those of the reference.
pub fn steps(scene: &Scene) -> Result<Counts, Vec<Diagnostic>> {
    let options = RenderOptions { mark_edges: false, ..RenderOptions::default() };
    let mut all = Counts::new();
    for counts in counts(&scene.with_programs(&optimize), &options)? {
        for (step, count) in counts {
            *all.entry(step).or_default() += count;
        }
    }
    Ok(all)
}

/// The work of a scene with floats of a width, by its steps.
pub fn work(all: &Counts, weights: &Weights, floats: FloatWidth) -> Work {
    let of = |name: &str| all.iter().filter(|(step, _)| step.name == name).map(|(_, count)| count).sum();
    Work {
        vertices: of(Step::VERTEX),
        fragments: of(Step::FRAGMENT),
        operations: weights.sum(all, floats),
        texture_lookups: of(Step::LOOKUP),
    }
}
