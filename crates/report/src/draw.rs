//! [`Drawing`]: draws references and variants, and compares their pictures.
//!
//! *In:* the scene of a variant. *Out:* a [`Way`] with its errors and its work, and the variant on the device. *Holds:* a variant that was
//! found and cannot be drawn is skipped, with the reason; one that the scene's file declares is an error.

use super::clock::Candidate;
use super::figures::{compare, spread};
use super::model::{OnFront, Skipped, Truth, Way};
use super::options::{Error, Options, Watcher};
use super::plan::{DECLARED, PlannedTruth, PlannedWay};
use super::ways::AS_WRITTEN;
use super::work::{steps, work};
use glisten_gpu::Gpu;
use glisten_reference::{Precision, RenderOptions};
use glisten_scene::Scene;
use glisten_scene::compare::flip;
use glisten_scene::picture::Picture;
use glisten_verify::verify::as_compiled;
use std::sync::Arc;

/// A variant that was drawn.
pub(super) struct Draw {
    pub(super) way: Way,
    pub(super) candidate: Candidate,
}

/// The references and variants that were drawn so far.
pub(super) struct Drawing<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) options: &'a Options,
    pub(super) truths: Vec<Truth>,
    pub(super) done: Vec<Draw>,
    pub(super) skipped: Vec<Skipped>,
    /// The steps that the watcher was told of.
    pub(super) steps: usize,
}

fn reference(way: &str, scene: &Scene) -> Result<Picture, Error> {
    let options = RenderOptions { precision: Precision::F64, mark_edges: false, ..RenderOptions::default() };
    glisten_reference::render(scene, &options).map_err(|diagnostics| Error::Reference { way: way.into(), diagnostics })
}

impl Drawing<'_> {
    fn step(&mut self, what: &str, watcher: &mut dyn Watcher) {
        watcher.step(what);
        self.steps += 1;
    }

    /// Draws the reference of a model.
    pub(super) fn truth(
        &mut self,
        planned: &PlannedTruth,
        scene: &Scene,
        watcher: &mut dyn Watcher,
    ) -> Result<(), Error> {
        self.step(&format!("the reference of {}", planned.model), watcher);
        self.truths.push(Truth {
            model: planned.model.clone(),
            way: planned.way.clone(),
            tessellation: planned.tessellation,
            precision: "f64",
            picture: reference(&planned.way, scene)?,
        });
        Ok(())
    }

    /// Draws a variant on the reference and on the GPU.
    pub(super) fn way(&mut self, planned: &PlannedWay, scene: &Scene, watcher: &mut dyn Watcher) -> Result<(), Error> {
        match self.drawn(planned, scene, watcher) {
            Ok(draw) => self.done.push(draw),
            Err(error) if [DECLARED, AS_WRITTEN].contains(&planned.kind) => return Err(error),
            Err(error) => self.skipped.push(Skipped {
                name: planned.name.clone(),
                model: planned.model.clone(),
                because: reason(&error),
            }),
        }
        Ok(())
    }

    /// A frame that only clears, on the device.
    pub(super) fn empty(&self) -> Option<Candidate> {
        let scene = &self.done.first()?.way.scene;
        let empty = Scene { name: scene.name.clone(), framebuffer: scene.framebuffer, draws: Vec::new() };
        let prepared = self.gpu.prepare(&empty, self.options.via).ok()?;
        let frames = self.gpu.frames_for_a_stretch(&prepared).ok()?;
        Some(Candidate { prepared, frames })
    }

    fn drawn(&mut self, planned: &PlannedWay, scene: &Scene, watcher: &mut dyn Watcher) -> Result<Draw, Error> {
        let failed = |error| Error::Gpu { way: planned.name.clone(), error };
        self.step(&format!("{} on the CPU", planned.name), watcher);
        let exact = reference(&planned.name, scene)?;
        let counts = steps(scene).map_err(|diagnostics| Error::Reference { way: planned.name.clone(), diagnostics })?;
        self.step(&format!("{} on the GPU", planned.name), watcher);
        let (gpu, via) = (self.gpu, planned.via.unwrap_or(self.options.via));
        // No target has geometry stages: the host runs them, and the GPU draws what they emit.
        let compiled =
            as_compiled(scene).map_err(|diagnostics| Error::Reference { way: planned.name.clone(), diagnostics })?;
        let prepared = gpu.prepare_in(&compiled, via, planned.floats).map_err(failed)?;
        let picture = gpu.draw(&prepared).map_err(failed)?.picture;
        let fragments = gpu.fragments_shaded(&prepared).map_err(failed)?;
        let frames = gpu.frames_for_a_stretch(&prepared).map_err(failed)?;
        let truth = self.truths.iter().find(|truth| truth.model == planned.model);
        let truth = truth.map_or(&exact, |truth| &truth.picture);
        let (mut error, difference) = compare(&picture, truth);
        error.flip = Some(flip(truth, &picture));
        let (rounding, _) = compare(&picture, &exact);
        let vertices = scene.draws.iter().map(|draw| u64::from(draw.vertex_count) * u64::from(draw.instances)).sum();
        let way = Way {
            name: planned.name.clone(),
            kind: planned.kind,
            about: planned.about.clone(),
            model: planned.model.clone(),
            tessellation: planned.tessellation,
            vertices,
            fragments,
            work: work(&counts, &self.options.weights, planned.floats),
            error,
            rounding,
            milliseconds: f64::NAN,
            ratio: spread(&[]),
            pareto: false,
            pareto_time: OnFront::Open,
            via: via.name(),
            floats: planned.floats,
            times: Vec::new(),
            scene: Arc::new(scene.clone()),
            programs: planned.programs.clone(),
            picture,
            difference,
        };
        Ok(Draw { way, candidate: Candidate { prepared, frames } })
    }
}

/// Why a variant cannot be drawn, in a sentence.
fn reason(error: &Error) -> String {
    let first = |messages: Vec<&str>| messages.first().map_or_else(String::new, |message| (*message).to_owned());
    match error {
        Error::Scene { diagnostics, .. } => first(diagnostics.iter().map(|found| found.message.as_str()).collect()),
        Error::Reference { diagnostics, .. } => first(diagnostics.iter().map(|found| found.message.as_str()).collect()),
        Error::Gpu { error, .. } => match error.diagnostics().first() {
            Some(found) => found.message.clone(),
            None => error.to_string(),
        },
        Error::Stopped => "it was interrupted".to_owned(),
    }
}
