//! [`Study`]: all trials on some scenes.
//!
//! *In:* a device, scenes. *Out:* trials, counts of them, legal changes and their conclusions.

use super::subject::{Legal, Subject};
use super::table::Count;
use super::trial::Trial;
use super::{Choice, SIDE};
use glisten::scene::Scene;
use glisten::verify::{Conclusion, Options};
use glisten_gpu::Gpu;
use glisten_scene::compare::Class;

/// Trials on some scenes.
#[derive(Debug, Default)]
pub(crate) struct Study {
    pub(crate) trials: Vec<Trial>,
    /// Legal changes.
    pub(crate) legal: Vec<Legal>,
    /// Scenes, or forms of scenes, that could not be tried, with the reason.
    pub(crate) left_out: Vec<(String, String)>,
    /// Scenes that fail 1/255 without a fault.
    pub(crate) false_alarms: Vec<String>,
    /// Scenes that are inconclusive without a fault.
    pub(crate) open: Vec<String>,
}

/// The parts of a study.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parts {
    pub(crate) faults: bool,
    pub(crate) legal: bool,
}

impl Study {
    /// Tries the selected faults of each scene, and the legal changes; `progress` gets the name of each scene and the
    /// number of its faults.
    pub(crate) fn of(
        gpu: &Gpu,
        scenes: &[(String, Scene)],
        (choice, parts): (Choice, Parts),
        progress: &mut dyn FnMut(&str, usize),
    ) -> Self {
        let mut study = Self::default();
        let options = Options::default();
        for (name, scene) in scenes {
            let mut scene = scene.clone();
            scene.framebuffer.width = scene.framebuffer.width.min(SIDE);
            scene.framebuffer.height = scene.framebuffer.height.min(SIDE);
            match Subject::new(gpu, name, &scene, &options) {
                Err(why) => study.left_out.push((name.clone(), why)),
                Ok(subject) => study.add(name, subject, (choice, parts), progress),
            }
        }
        study
    }

    fn add(
        &mut self,
        name: &str,
        mut subject: Subject<'_>,
        (choice, parts): (Choice, Parts),
        progress: &mut dyn FnMut(&str, usize),
    ) {
        let told = |form: super::Form| format!("{name} ({})", form.name());
        self.false_alarms.extend(subject.false_alarms().map(told));
        self.open.extend(subject.open().map(told));
        self.left_out.extend(subject.left_out.iter().map(|(form, why)| (told(*form), why.clone())));
        let faults = if parts.faults { subject.faults(choice) } else { Vec::new() };
        progress(name, faults.len());
        self.trials.extend(faults.iter().map(|(module, one)| subject.try_out(*module, one)));
        if parts.legal {
            self.legal.extend(subject.legal(choice.seed));
        }
    }

    /// Counts the trials for which a condition holds.
    pub(crate) fn count(&self, holds: impl Fn(&Trial) -> bool) -> Count {
        let mut count = Count::default();
        self.trials.iter().filter(|trial| holds(trial)).for_each(|trial| count.add(&trial.outcome));
        count
    }

    /// The faults that change the picture and do not fail `verify`, by the class of the pixel that moves most.
    pub(crate) fn survivors(&self, wanted: Option<Class>) -> Vec<&Trial> {
        let survives = |trial: &&Trial| {
            trial.seen().is_some_and(|seen| !seen.is_caught() && !seen.is_rounding() && seen.change.class == wanted)
        };
        self.trials.iter().filter(survives).collect()
    }

    /// The faults that pass and move the picture by no more than rounding.
    pub(crate) fn roundings(&self) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(|trial| trial.seen().is_some_and(|seen| !seen.is_caught() && seen.is_rounding()))
    }

    /// The legal changes that fail `verify`.
    pub(crate) fn wrongly_failed(&self) -> Vec<&Legal> {
        self.legal.iter().filter(|legal| matches!(legal.conclusion, Ok(Conclusion::Fails))).collect()
    }
}
