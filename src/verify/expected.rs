//! [`Expected`]: the reference's picture of a scene, and the verdict on another picture of it.
//!
//! *In:* a scene and [`Options`]. *Out:* the reference's picture; verdicts.
//! *Holds:* the reference draws once. It draws again with known faults excused only if a picture needs an excuse.

use super::{Failure, Options};
use crate::scene::Scene;
use glisten_reference::domain::faults::Faults;
use glisten_reference::faults_of;
use glisten_scene::compare::{Criterion, Verdict};
use glisten_scene::picture::Picture;
use std::time::Instant;

/// The picture of the reference, with which others are compared. For pictures that no [`Runner`](super::Runner) drew.
pub struct Expected<'a> {
    scene: &'a Scene,
    options: &'a Options<'a>,
    picture: Picture,
    milliseconds: f64,
    /// The picture with each known fault excused alone, and with all of them; drawn on demand.
    excused: Option<Vec<(&'static str, Picture)>>,
}

impl<'a> Expected<'a> {
    /// Draws the scene by the reference.
    ///
    /// # Errors
    /// The reference cannot draw it.
    pub fn new(scene: &'a Scene, options: &'a Options<'a>) -> Result<Self, Failure> {
        let start = Instant::now();
        let picture = options.reference.render(scene, &options.reference_options(Faults::NONE))?;
        let milliseconds = start.elapsed().as_secs_f64() * 1e3;
        Ok(Self { scene, options, picture, milliseconds, excused: None })
    }

    /// The reference's picture with its envelope.
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// The reference's picture, and its time in milliseconds.
    pub(super) fn into_picture(self) -> (Picture, f64) {
        (self.picture, self.milliseconds)
    }

    /// Compares a picture of the scene with the reference.
    ///
    /// # Errors
    /// The reference cannot draw the scene with a fault excused.
    pub fn compare(&mut self, picture: &Picture) -> Result<Verdict, Failure> {
        let Options { criterion, excuse_known_faults, .. } = *self.options;
        let verdict = Verdict::new(picture, &self.picture, criterion);
        if criterion != Criterion::Envelope || !verdict.needs_excuse() || !excuse_known_faults {
            return Ok(verdict);
        }
        let excused = match self.excused.take() {
            Some(excused) => excused,
            None => self.draw_excused()?,
        };
        let verdict = Verdict::excusing(picture, &self.picture, criterion, &excused);
        self.excused = Some(excused);
        Ok(verdict)
    }

    /// One picture for each known fault that can show in the scene; and one with all of them, if there are several.
    fn draw_excused(&self) -> Result<Vec<(&'static str, Picture)>, Failure> {
        let known = faults_of(self.scene);
        let one = known.iter().map(|known| (known.name, Faults::only(known.fault)));
        let named = one.chain((known.len() > 1).then(|| ("several", Faults::all())));
        let (names, options): (Vec<_>, Vec<_>) =
            named.map(|(name, faults)| (name, self.options.reference_options(faults))).unzip();
        Ok(names.into_iter().zip(self.options.reference.render_all(self.scene, &options)?).collect())
    }
}
