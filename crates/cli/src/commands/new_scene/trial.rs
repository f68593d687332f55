//! [`choose`]: tries scenes on the reference, and takes the first one that shows something.
//!
//! *In:* forms, and the text for each. *Out:* the choice, with what its picture shows. *Holds:* a scene is drawn small and in f32. Forms are
//! tried in their order; where all pictures are flat, those that cover something are tried with other numbers and textures, then one
//! uniform after the other has another number. A time limit holds for all of them.

use super::choice::{Changed, Choice, Taste};
use super::forms::Form;
use crate::files::SceneFiles;
use crate::process::guard;
use crate::threads::STACK_BYTES;
use glisten_front::Compiler;
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::picture::Picture;
use glisten_scene::{FileError, FileSource};
use glisten_verify::scene;
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The width and height of a trial's window.
const SIDE: u32 = 40;
/// The time for all trials.
pub(super) const BUDGET: Duration = Duration::from_secs(6);
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
    /// The end of the time for all trials ([`BUDGET`] from now on).
    pub(super) deadline: Instant,
    /// Uniforms, each with a number that it may have instead.
    pub(super) alternatives: &'a [(Changed, f64)],
}

enum Outcome {
    Drew(Shown),
    Failed,
    Late,
}

/// The best one of the choices that were tried.
type Best = Option<(Choice, Shown)>;

/// The first choice that shows something, or else the best one, for a window of `side` pixels.
pub(super) fn choose(trials: &Trials<'_>, forms: &[Form], side: u32) -> Option<Chosen> {
    let mut best: Best = None;
    let ended = try_forms(trials, forms, &mut best).or_else(|| try_numbers(trials, forms, &mut best));
    let (choice, shown) = match (ended, best) {
        (Some(Ended::Good(choice, shown)), _) => (choice, Some(shown)),
        (_, Some((choice, shown))) => (choice, Some(shown)),
        (Some(Ended::Late(choice)), None) => (choice, None),
        (None, None) => (trial(forms.first()?, Taste::default()), None),
    };
    Some(Chosen { choice: Choice { side, ..choice }, shown })
}

/// The end of the trials: a good picture, or the time limit with what was tried last.
enum Ended {
    Good(Choice, Shown),
    Late(Choice),
}

fn trial(form: &Form, taste: Taste) -> Choice {
    Choice { form: form.clone(), taste, side: SIDE, changed: None }
}

/// Tries all forms, then those that cover something with other tastes.
fn try_forms(trials: &Trials<'_>, forms: &[Form], best: &mut Best) -> Option<Ended> {
    let mut covering: Vec<Form> = Vec::new();
    for number in 0..TASTES {
        let tried = match number {
            0 => forms.to_vec(),
            // Where nothing is covered, a number may discard everything.
            _ if covering.is_empty() => forms.iter().take(SPARE).cloned().collect(),
            _ => covering.clone(),
        };
        for form in tried {
            let shown = match trials.tried(trial(&form, Taste(number)), best) {
                Ok(shown) => shown,
                Err(ended) => return Some(ended),
            };
            if number == 0 && covering.len() < SPARE && shown.is_some_and(|shown| shown.covered >= COVERED) {
                covering.push(form);
            }
        }
    }
    None
}

/// Tries the best choice with another number for one uniform after the other.
fn try_numbers(trials: &Trials<'_>, forms: &[Form], best: &mut Best) -> Option<Ended> {
    let base = match best {
        Some((choice, _)) => choice.clone(),
        None => trial(forms.first()?, Taste::default()),
    };
    let changes = trials.alternatives.iter().cloned().map(|changed| Choice { changed: Some(changed), ..base.clone() });
    changes.into_iter().find_map(|choice| trials.tried(choice, best).err())
}

impl Trials<'_> {
    /// Whether a picture shows something: more than one color, if the program has more.
    fn is_good(&self, shown: Shown) -> bool {
        shown.covered >= COVERED && !(self.has_colors && shown.is_flat())
    }

    /// Draws a choice; better ones become the best one.
    fn tried(&self, choice: Choice, best: &mut Best) -> Result<Option<Shown>, Ended> {
        match self.draw(&choice) {
            Outcome::Drew(shown) if self.is_good(shown) => Err(Ended::Good(choice, shown)),
            Outcome::Drew(shown) => {
                if best.as_ref().is_none_or(|(_, other)| shown.rank() > other.rank()) {
                    *best = Some((choice, shown));
                }
                Ok(Some(shown))
            }
            Outcome::Late => Err(Ended::Late(choice)),
            Outcome::Failed => Ok(None),
        }
    }

    fn draw(&self, choice: &Choice) -> Outcome {
        let left = self.deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Outcome::Late;
        }
        let files = Overlay { path: self.path.to_owned(), text: (self.text)(choice) };
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
        if path == self.path { Ok(self.text.clone().into_bytes()) } else { SceneFiles.read(path) }
    }
}

fn drawn(files: &Overlay, compiler: &Compiler) -> Option<Shown> {
    let scene = scene::load(&files.path, files, compiler).scene?;
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    render(&scene, &options).ok().map(|picture| Shown::of(&picture))
}
