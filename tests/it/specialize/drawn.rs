//! Residuals on the GPU, judged by the envelopes of the originals.
//!
//! A share of the scenes is drawn; `SPECIALIZE_ALL=1` draws all of them.

use super::{load, scene_files};
use glisten::scene::Scene;
use glisten::specialize::specialize_scene;
use glisten::verify::{OnGpu, Options, Runner, verify};
use glisten_emit::{Conventions, Target, emit};
use glisten_verify::verify::{Drawn, Failure};

/// One scene in this many is drawn.
const SHARE: usize = 12;

/// Draws a scene in the place of another.
pub(crate) struct Instead<'a> {
    pub(crate) runner: &'a dyn Runner,
    pub(crate) scene: &'a Scene,
}

impl Runner for Instead<'_> {
    fn name(&self) -> &'static str {
        self.runner.name()
    }

    fn draw(&self, _: &Scene) -> Result<Drawn, Failure> {
        self.runner.draw(self.scene)
    }
}

/// The scenes that are drawn: a share of them, or all.
pub(crate) fn share() -> impl Iterator<Item = std::path::PathBuf> {
    let step = if std::env::var_os("SPECIALIZE_ALL").is_some() { 1 } else { SHARE };
    scene_files().into_iter().step_by(step)
}

#[test]
fn residuals_hold_on_the_gpu_by_the_originals() {
    let gpu = crate::drawing::gpu();
    let (mut wrong, mut n_drawn) = (Vec::new(), 0);
    // Some scenes cull or discard everything, and their residuals have to do so, too.
    let options = Options { allow_inconclusive: true, ..Options::default() };
    for path in share() {
        let Some((scene, sources)) = load(&path) else { continue };
        let specialized = specialize_scene(&scene, &sources, &[]);
        let runners = OnGpu::both(&gpu);
        let runners = runners.each_ref().map(|runner| Instead { runner, scene: &specialized.scene });
        let runners = [&runners[0] as &dyn Runner, &runners[1]];
        match verify(&scene, &runners, &options) {
            Ok(verification) if !verification.fails() => n_drawn += 1,
            Ok(verification) => wrong.push(format!("{}\n{verification}", path.display())),
            Err(failure) => wrong.push(format!("{}: {failure}", path.display())),
        }
    }
    assert!(wrong.is_empty() && n_drawn > 10, "{n_drawn} hold:\n{}", wrong.join("\n"));
}

/// A target takes a residual wherever it takes the original.
#[test]
fn residuals_are_emitted_for_every_target() {
    let mut wrong = Vec::new();
    for path in scene_files() {
        let Some((scene, sources)) = load(&path) else { continue };
        let specialized = specialize_scene(&scene, &sources, &[]);
        for (draw, left) in scene.draws.iter().zip(&specialized.scene.draws) {
            for shader in &left.program.stages {
                for target in Target::ALL {
                    let conventions = Conventions::default();
                    let refused = emit(&draw.program, shader.stage, *target, &conventions).is_err();
                    if let Err(found) = emit(&left.program, shader.stage, *target, &conventions)
                        && !refused
                    {
                        let name = path.display();
                        wrong.push(format!("{name} as {}: {}", target.name(), found[0].message));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
