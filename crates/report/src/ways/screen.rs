//! Interpolation without perspective: `noperspective` varyings.
//!
//! *In:* a scene and one of its draws. *Out:* the scene whose smooth varyings are interpolated linearly on the screen
//! (the textbook's section 10.2.2: that is cheaper, and bends what it interpolates). *Holds:* a draw without perspective,
//! and one whose fragments read no smooth varying, is left alone.

use super::edit::{Edited, with_draw};
use glisten_front::hir::{GlobalId, Interpolation, Sampling, Shader, Storage};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::Scene;

/// The scene without perspective in the varyings of a draw.
pub(super) fn without_perspective(scene: &Scene, index: usize) -> Option<Scene> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let varyings = &draw.program.interface.varyings;
    let smooth = varyings
        .iter()
        .filter(|one| one.active && one.interpolation == Interpolation::Smooth && one.sampling == Sampling::Center);
    let ends: Vec<_> = smooth.filter_map(|one| Some((one.from?.global, one.to?.global))).collect();
    let plain = |shader: &Shader, id: GlobalId| shader.global(id).block.is_none();
    let ends = ends
        .into_iter()
        .filter(|(from, to)| plain(&edited.vertex.shader, *from) && plain(&edited.fragment.shader, *to));
    let ends: Vec<_> = ends.collect();
    if ends.is_empty() {
        return None;
    }
    for (from, to) in ends {
        change(&mut edited.vertex.shader, from, Storage::Out);
        change(&mut edited.fragment.shader, to, Storage::In);
    }
    let changed = with_draw(scene, index, edited.draw(draw)?)?;
    // Where all w are equal it is the same.
    let options = RenderOptions { precision: Precision::F64, mark_edges: false, ..RenderOptions::default() };
    let [before, after] = [scene, &changed].map(|scene| render(scene, &options).ok());
    let differs = before?.attachments.iter().zip(&after?.attachments).any(|(before, after)| {
        let channels = before.iter().flatten().zip(after.iter().flatten());
        channels.into_iter().any(|(a, b)| (a - b).abs() > LEAST)
    });
    differs.then_some(changed)
}

/// A smaller difference is one of rounding.
const LEAST: f64 = 1e-9;

fn change(shader: &mut Shader, id: GlobalId, storage: Storage) {
    if let Some(global) = shader.globals.get_mut(id.index()).filter(|global| global.storage == storage) {
        (global.interpolation, global.interpolation_written) = (Interpolation::Noperspective, true);
    }
}
