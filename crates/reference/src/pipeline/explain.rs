//! Explains the bound of one pixel.
//!
//! *In:* a scene and a pixel. *Out:* the operations of the fragment stage, with how much narrower the pixel's
//! envelope would be if each were exact. *Holds:* only the last draw that changes the pixel is examined; varyings
//! stand for everything that the vertex stage and interpolation contribute.

use super::fragments::{Shading, draw_bin};
use super::origin::Origin;
use super::same_surface::surfaces;
use super::target::Patch;
use super::watch::{Study, Watch};
use super::{draw_all, refuse};
use crate::domain::Envelope;
use crate::exec::{Code, Form, Machine, Muted, Operation, Purpose};
use crate::raster::Bounds;
use crate::{Contribution, RenderOptions};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::SCENE_CANNOT_DRAW;
use glisten_front::hir::Stage;
use glisten_scene::Scene;
use glisten_scene::picture::Interval;
use rayon::prelude::*;

/// The operation's name for an input.
const INTERPOLATION: &str = "interpolation";

/// A share below this explains nothing.
const LEAST_SHARE: f64 = 0.01;

/// The instructions, each for 64 lanes, that may be executed to find the share of every operation.
const MOST_EXECUTED: u64 = 4_000_000;

/// A channel of a pixel.
#[derive(Clone, Copy, Debug)]
struct Channel {
    x: i64,
    y: i64,
    attachment: usize,
    channel: usize,
}

/// The contributions to the width of a channel's envelope, the largest first.
pub(crate) fn explain(
    scene: &Scene,
    options: &RenderOptions,
    [x, y]: [u32; 2],
    attachment: usize,
    channel: usize,
) -> Result<Vec<Contribution>, Vec<Diagnostic>> {
    let (width, height) = (i64::from(scene.framebuffer.width), i64::from(scene.framebuffer.height));
    let place = Channel { x: i64::from(x), y: i64::from(y), attachment, channel };
    if place.x >= width || place.y >= height || channel > 3 {
        return Err(vec![refuse(&SCENE_CANNOT_DRAW, "there is no such pixel")]);
    }
    // Whole quads, for derivatives.
    let (x0, y0) = (place.x & !1, place.y & !1);
    let area = Bounds { x0, x1: (x0 + 2).min(width), y0, y1: (y0 + 2).min(height) };
    let mut patch = Patch::<Envelope>::new(scene.framebuffer, area);
    let mut found = Vec::new();
    let surfaces = surfaces(scene);
    for (number, draw) in scene.draws.iter().enumerate() {
        let watch = Watch {
            study: Study { form: Form::Unfused, ..Study::NONE },
            draw: number,
            instance: 0,
            surface: surfaces.get(number).copied().unwrap_or(0),
        };
        draw_all(scene, draw, options, watch, &mut |shading, code, _, _| {
            if let Some(contributions) = of_draw(shading, code, &mut patch, place) {
                found = contributions;
            }
        })?;
    }
    found.sort_by(|a: &Contribution, b: &Contribution| b.share.total_cmp(&a.share));
    Ok(found)
}

/// Draws over the pixel. If that changes it, returns the contributions.
fn of_draw(
    shading: &Shading<'_, Envelope>,
    code: &Code,
    patch: &mut Patch<Envelope>,
    place: Channel,
) -> Option<Vec<Contribution>> {
    let touching = shading.prims.iter().enumerate().filter(|(_, prim)| prim.shape.may_touch(patch.area));
    let list: Vec<u32> = touching.map(|(index, _)| index as u32).collect();
    let before = patch.clone();
    let drawn_for = |purpose: Purpose<Envelope>| {
        let mut patch = before.clone();
        let draw = shading.draw;
        let mut machine = Machine::with(purpose, shading.profile, code, &draw.uniforms, &draw.textures);
        machine.take_executed();
        patch.draw(|bin| draw_bin(shading, bin, &list, &mut machine));
        (patch, machine.take_executed())
    };
    let drawn = |muted: Muted| drawn_for(Purpose::Share(muted)).0;
    let interval = |patch: &mut Patch<Envelope>| patch.interval(place.x, place.y, place.attachment, place.channel);
    if list.is_empty() {
        return None;
    }
    let old = interval(patch);
    let executed;
    (*patch, executed) = drawn_for(Purpose::Results);
    let whole = interval(patch);
    if whole == old {
        return None;
    }
    let share = |muted: Muted| share(whole, interval(&mut drawn(muted)));
    let operations = code.operations();
    let contribution = |operation: &Operation| {
        let share = share(operation.muted());
        Contribution { span: operation.span, operation: operation.name, share }
    };
    // Each operation draws the quad again. Where that takes long, the origin of the bound has to do.
    let pays = executed.saturating_mul(operations.len() as u64) <= MOST_EXECUTED;
    let tried = operations.get(..if pays { operations.len() } else { 0 }).unwrap_or_default();
    let mut contributions: Vec<Contribution> = tried.par_iter().map(contribution).collect();
    let fragment = shading.draw.program.stage(Stage::Fragment)?;
    let mut inputs: Vec<_> = shading.plan.floats.iter().map(|varying| varying.to.0).collect();
    inputs.sort_unstable();
    inputs.dedup();
    let inputs = inputs.into_iter().filter(|_| pays);
    for (global, facts) in inputs.filter_map(|id| Some((id, fragment.globals.get(id.index())?))) {
        let share = share(Muted::input(global));
        contributions.push(Contribution { span: facts.span, operation: INTERPOLATION, share });
    }
    if contributions.iter().all(|one| one.share < LEAST_SHARE) {
        let origin = Origin::default();
        drawn_for(Purpose::Watching(Box::new(origin.clone())));
        contributions.extend(origin.contributions(&operations));
    }
    Some(contributions)
}

/// The share by which an interval shrinks.
fn share(whole: Interval, muted: Interval) -> f64 {
    match (whole.width().is_finite(), muted.width().is_finite()) {
        (true, _) if whole.width() > 0.0 => (1.0 - muted.width() / whole.width()).max(0.0),
        (false, true) => 1.0,
        _ => 0.0,
    }
}
