//! The runners of `verify`, with a time limit for each draw and a progress bar.
//!
//! *In:* scenes. *Out:* pictures, or failures.

use crate::exit::{Exit, Failure};
use crate::process::journal;
use crate::progress::Progress;
use crate::scenes::{DrawError, MachineArgs, told};
use glisten_gpu::{Foreign, Gpu, Via};
use glisten_reference::{Contribution, RenderOptions, Undefined};
use glisten_scene::compare::Population;
use glisten_scene::picture::Picture;
use glisten_verify::scene::Scene;
use glisten_verify::verify::{self, Channel, Drawn, OnGpu, Reference, Runner, ThisThread};
use std::ops::Range;
use std::sync::Arc;

/// The reference.
pub(crate) struct TimedReference<'a> {
    machine: &'a MachineArgs,
    progress: &'a Progress,
}

impl<'a> TimedReference<'a> {
    pub(crate) fn new(machine: &'a MachineArgs, progress: &'a Progress) -> Self {
        Self { machine, progress }
    }
}

impl Reference for TimedReference<'_> {
    fn render(&self, scene: &Scene, options: &RenderOptions) -> Result<Picture, verify::Failure> {
        self.progress.say("the reference");
        let (scene, options) = (scene.clone(), *options);
        let picture = self.machine.within_time(move || Ok(ThisThread.render(&scene, &options)?))?;
        self.progress.step();
        Ok(picture)
    }

    fn work(&self, scene: &Scene, options: &RenderOptions) -> Result<u64, verify::Failure> {
        let (scene, options) = (scene.clone(), *options);
        Ok(self.machine.within_time(move || Ok(ThisThread.work(&scene, &options)?))?)
    }

    /// Draws all of them within the time limit of one draw.
    fn render_all(&self, scene: &Scene, options: &[RenderOptions]) -> Result<Vec<Picture>, verify::Failure> {
        let (scene, options) = (scene.clone(), options.to_vec());
        Ok(self.machine.within_time(move || Ok(ThisThread.render_all(&scene, &options)?))?)
    }

    /// Each member has the time limit of a draw.
    fn populate(
        &self,
        population: Population,
        scene: &Scene,
        options: &RenderOptions,
        members: Range<u32>,
    ) -> Result<Population, verify::Failure> {
        let mut population = population;
        self.progress.extend_by(members.len());
        for number in members {
            self.progress.say(&format!("the simulated GPU {}", number + 1));
            let (scene, options) = (scene.clone(), *options);
            let drawn = move || Ok(ThisThread.populate(population, &scene, &options, number..number + 1)?);
            population = self.machine.within_time(drawn)?;
            self.progress.step();
        }
        Ok(population)
    }

    fn undefined(&self, scene: &Scene, options: &RenderOptions) -> Result<Option<Undefined>, verify::Failure> {
        self.progress.say("what the language leaves undefined");
        let (scene, options) = (scene.clone(), *options);
        Ok(self.machine.within_time(move || Ok(ThisThread.undefined(&scene, &options)?))?)
    }

    fn explain(
        &self,
        scene: &Scene,
        options: &RenderOptions,
        at: Channel,
    ) -> Result<Vec<Contribution>, verify::Failure> {
        let (scene, options) = (scene.clone(), *options);
        Ok(self.machine.within_time(move || Ok(ThisThread.explain(&scene, &options, at)?))?)
    }
}

/// A form of the emitted code on a GPU.
pub(crate) struct TimedGpu<'a> {
    gpu: Arc<Gpu>,
    via: Via,
    /// The scene's file.
    name: &'a str,
    foreign: Arc<[Foreign]>,
    whole: bool,
    machine: &'a MachineArgs,
    progress: &'a Progress,
}

impl<'a> TimedGpu<'a> {
    pub(crate) fn new(
        gpu: &Arc<Gpu>,
        via: Via,
        name: &'a str,
        machine: &'a MachineArgs,
        progress: &'a Progress,
    ) -> Self {
        Self { gpu: Arc::clone(gpu), via, name, foreign: Arc::new([]), whole: false, machine, progress }
    }

    /// Draws with modules of other translators.
    pub(crate) fn with(self, foreign: &Arc<[Foreign]>) -> Self {
        Self { foreign: Arc::clone(foreign), ..self }
    }

    /// Draws everything that the sources use.
    pub(crate) fn whole(self, whole: bool) -> Self {
        Self { whole, ..self }
    }
}

impl Runner for TimedGpu<'_> {
    fn name(&self) -> &'static str {
        self.via.name()
    }

    fn draw(&self, scene: &Scene) -> Result<Drawn, verify::Failure> {
        self.progress.say(self.name());
        let (gpu, via, scene) = (Arc::clone(&self.gpu), self.via, scene.clone());
        let (foreign, whole) = (Arc::clone(&self.foreign), self.whole);
        let work = format!("{} by {}", journal::drawing(self.name), via.name());
        let drawn = self.machine.within_time(move || {
            let _work = journal::at_work(&work);
            Ok(OnGpu::new(&gpu, via).with(&foreign).whole(whole).draw(&scene)?)
        })?;
        self.progress.step();
        Ok(drawn)
    }
}

/// The separator between a message and its help in one text.
const HELP: &str = "\nhelp: ";

impl From<DrawError> for verify::Failure {
    fn from(error: DrawError) -> Self {
        match error {
            DrawError::Diagnostics(diagnostics) => Self::Diagnostics(diagnostics),
            DrawError::Failure(Failure { exit, message, help }) => {
                let text = help.map_or(message.clone(), |help| format!("{message}{HELP}{help}"));
                if exit == Exit::Machine { Self::Machine(text) } else { Self::Refused(text) }
            }
        }
    }
}

impl From<verify::Failure> for DrawError {
    fn from(failure: verify::Failure) -> Self {
        match failure {
            verify::Failure::Diagnostics(diagnostics) => Self::Diagnostics(diagnostics),
            verify::Failure::Machine(text) => Self::Failure(told(Exit::Machine, &text)),
            verify::Failure::Refused(text) => Self::Failure(told(Exit::Content, &text)),
        }
    }
}
