//! The part of a picture that is judged, so that a verdict on long loops takes seconds and not minutes.
//!
//! *In:* a scene, and the work that a verdict may take. *Out:* a [`Sample`]. *Holds:* it depends on the scene and on that number alone,
//! not on the machine's speed: the same call judges the same pixels everywhere.

use super::{Failure, Options};
use crate::scene::Scene;
use glisten_front::hir::{Stage, StmtKind};
use glisten_reference::domain::faults::Faults;
use glisten_reference::{RenderOptions, Sample};
use glisten_scene::picture::Picture;
use std::borrow::Cow;

/// The operations of the fragment stages up to which all of a picture is judged, if nobody says another number.
pub const MOST_WORK: u64 = 60_000_000;
/// The numbers of blocks on which the work is measured.
const TRIAL: std::ops::RangeInclusive<usize> = 2..=16;
/// The smallest number of blocks that stands for a picture: 256 pixels.
const FEWEST: usize = 4;

/// The part of a scene's picture that a verdict with these options is about.
pub(super) fn part(scene: &Scene, options: &Options<'_>) -> Result<Sample, Failure> {
    let size = [scene.framebuffer.width, scene.framebuffer.height];
    let blocks = Sample::blocks(size);
    let Some(most) = options.most_work.filter(|_| has_loops(scene) && blocks > FEWEST) else {
        return Ok(Sample::ALL);
    };
    let trial = Sample::of((blocks / 64).clamp(*TRIAL.start(), *TRIAL.end()), size);
    let drawn = RenderOptions { sample: trial, ..options.reference_options(Faults::NONE) };
    let work: u64 = options.reference.work(scene, &drawn)?.iter().map(|work| work.fragment_operations).sum();
    let all = work as f64 / trial.drawn_share(size).max(f64::MIN_POSITIVE);
    if all <= most as f64 {
        return Ok(Sample::ALL);
    }
    let wanted = blocks as f64 * most as f64 / all;
    Ok(Sample::of((wanted as usize).max(FEWEST), size))
}

/// Whether a fragment stage has a loop. Straight code ends soon.
fn has_loops(scene: &Scene) -> bool {
    let stages = scene.draws.iter().filter_map(|draw| draw.program.stage(Stage::Fragment));
    stages.into_iter().any(|shader| {
        let mut found = false;
        for body in shader.functions.iter().filter_map(|function| function.body.as_deref()) {
            shader.visit_statements(body, &mut |statement| found |= matches!(statement.kind, StmtKind::Loop { .. }));
        }
        found
    })
}

/// Leaves nothing covered outside of a sample in the picture of the reference.
pub(super) fn keep_only(picture: &mut Picture, sample: Sample) {
    let width = picture.width.max(1);
    let is_outside = |index: usize| !sample.has(index as u32 % width, index as u32 / width);
    for marks in [&mut picture.covered, &mut picture.undecided] {
        let outside = marks.iter_mut().enumerate().filter(|(index, _)| is_outside(*index));
        outside.for_each(|(_, mark)| *mark = false);
    }
}

/// A picture of which nothing is covered outside of a sample. There it has the colors of the reference.
pub(super) fn only<'p>(picture: &'p Picture, sample: Sample, reference: &Picture) -> Cow<'p, Picture> {
    if sample.is_all() {
        return Cow::Borrowed(picture);
    }
    let mut part = picture.clone();
    keep_only(&mut part, sample);
    let width = picture.width.max(1);
    for (new, old) in part.attachments.iter_mut().zip(&reference.attachments) {
        for (index, (new, old)) in new.iter_mut().zip(old).enumerate() {
            if !sample.has(index as u32 % width, index as u32 / width) {
                *new = *old;
            }
        }
    }
    Cow::Owned(part)
}
