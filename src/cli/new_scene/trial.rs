//! [`choose`]: tries scenes on the reference, and takes the first one that shows something.
//!
//! *In:* forms, and the text for each. *Out:* the choice, with what its picture shows. *Holds:* a scene is drawn small and in f32. Forms are
//! tried in their order; where all pictures are flat, those that cover something are tried with other numbers. A time limit holds
//! for all of them.

use super::forms::Form;
use super::text::Choice;
use super::values::Taste;
use crate::cli::guard;
use crate::scene::{self, DiskFiles};
use glisten_front::Compiler;
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::picture::Picture;
use glisten_scene::{FileError, FileSource};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The width and height of a trial's window.
const SIDE: u32 = 40;
/// The time for all trials.
const BUDGET: Duration = Duration::from_secs(6);
/// The stack of the thread that draws.
const STACK_BYTES: usize = 16 << 20;
/// The share of pixels that a picture covers, and the difference between its colors, from which on it shows something.
const COVERED: f64 = 0.04;
const CONTRAST: f64 = 0.03;
/// The number of tastes.
const TASTES: usize = 4;
/// The number of forms that are tried with other tastes than the first one.
const SPARE: usize = 2;

/// The extent and the colors of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shown {
    /// The share of the pixels that are covered.
    pub(super) covered: f64,
    /// The largest difference of a channel between covered pixels.
    contrast: f64,
}

impl Shown {
    fn of(picture: &Picture) -> Self {
        let colors = picture.attachments.iter().map(|colors| contrast(colors, &picture.covered));
        let covered = picture.covered.iter().filter(|covered| **covered).count();
        Self { covered: covered as f64 / picture.covered.len().max(1) as f64, contrast: colors.fold(0.0, f64::max) }
    }

    /// Whether it is one color.
    pub(super) fn is_flat(&self) -> bool {
        self.contrast < CONTRAST
    }

    /// Better pictures have more.
    fn rank(&self) -> (bool, bool, f64) {
        (self.covered > 0.0, self.covered > 0.0 && !self.is_flat(), self.covered)
    }
}

/// The largest difference of a color channel between covered pixels with finite numbers.
fn contrast(colors: &[[f64; 4]], covered: &[bool]) -> f64 {
    let range = |channel: usize| {
        let shown = colors.iter().zip(covered).filter(|(_, covered)| **covered).map(|(color, _)| color[channel]);
        // A window shows nothing below 0 and above 1.
        let visible = shown.filter(|value| value.is_finite()).map(|value| value.clamp(0.0, 1.0));
        let (low, high) = visible.fold((f64::MAX, f64::MIN), |(low, high), value| (low.min(value), high.max(value)));
        (high - low).max(0.0)
    };
    (0..3).map(range).fold(0.0, f64::max)
}

/// A choice, and what its picture shows; `None` if it was not drawn in time.
pub(super) struct Chosen {
    pub(super) choice: Choice,
    pub(super) shown: Option<Shown>,
}

/// Draws trials of a scene.
pub(super) struct Trials<'a> {
    /// The path of the scene, from which its files are found.
    pub(super) path: &'a str,
    pub(super) compiler: &'a Compiler,
    /// The text for a choice.
    pub(super) text: &'a dyn Fn(&Choice) -> String,
    /// Whether the program lets colors differ.
    pub(super) has_colors: bool,
}

enum Outcome {
    Drew(Shown),
    Failed,
    Late,
}

/// The first choice that shows something, or else the best one, for a window of `side` pixels.
pub(super) fn choose(trials: &Trials<'_>, forms: &[Form], side: u32) -> Option<Chosen> {
    let deadline = Instant::now() + BUDGET;
    let mut best: Option<(Form, Taste, Shown)> = None;
    let mut covering: Vec<Form> = Vec::new();
    let chosen = |form: &Form, taste: Taste, shown: Option<Shown>| Chosen {
        choice: Choice { form: form.clone(), taste, side },
        shown,
    };
    for number in 0..TASTES {
        let taste = Taste(number);
        let tried = match number {
            0 => forms.to_vec(),
            // Where nothing is covered, a number may discard everything.
            _ if covering.is_empty() => forms.iter().take(SPARE).cloned().collect(),
            _ => covering.clone(),
        };
        for form in tried {
            match trials.draw(Choice { form: form.clone(), taste, side: SIDE }, deadline) {
                Outcome::Drew(shown) if trials.is_good(shown) => return Some(chosen(&form, taste, Some(shown))),
                Outcome::Drew(shown) => {
                    if number == 0 && shown.covered >= COVERED && covering.len() < SPARE {
                        covering.push(form.clone());
                    }
                    if best.as_ref().is_none_or(|(.., other)| shown.rank() > other.rank()) {
                        best = Some((form, taste, shown));
                    }
                }
                Outcome::Late if best.is_none() => return Some(chosen(&form, taste, None)),
                Outcome::Late => return best.map(|(form, taste, shown)| chosen(&form, taste, Some(shown))),
                Outcome::Failed => {}
            }
        }
    }
    match best {
        Some((form, taste, shown)) => Some(chosen(&form, taste, Some(shown))),
        None => forms.first().map(|form| chosen(form, Taste::default(), None)),
    }
}

impl Trials<'_> {
    /// Whether a picture shows something: more than one color, if the program has more.
    fn is_good(&self, shown: Shown) -> bool {
        shown.covered >= COVERED && !(self.has_colors && shown.is_flat())
    }

    fn draw(&self, choice: Choice, deadline: Instant) -> Outcome {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Outcome::Late;
        }
        let files = Overlay { path: self.path.to_owned(), text: (self.text)(&choice) };
        let compiler = self.compiler.clone();
        let (sender, receiver) = mpsc::channel();
        let work = move || {
            // After the time limit, nothing receives this.
            let _ = sender.send(guard::guarded(|| drawn(&files, &compiler)).ok().flatten());
        };
        if std::thread::Builder::new().stack_size(STACK_BYTES).spawn(work).is_err() {
            return Outcome::Late;
        }
        match receiver.recv_timeout(left) {
            Ok(Some(shown)) => Outcome::Drew(shown),
            Ok(None) => Outcome::Failed,
            Err(_) => Outcome::Late,
        }
    }
}

/// The files of the disk, and a scene that is not there yet.
struct Overlay {
    path: String,
    text: String,
}

impl FileSource for Overlay {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == self.path { Ok(self.text.clone().into_bytes()) } else { DiskFiles.read(path) }
    }
}

fn drawn(files: &Overlay, compiler: &Compiler) -> Option<Shown> {
    let scene = scene::load(&files.path, files, compiler).scene?;
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    render(&scene, &options).ok().map(|picture| Shown::of(&picture))
}
