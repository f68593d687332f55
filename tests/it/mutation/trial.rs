//! [`Subject`] and [`Trial`]: a scene with its correct picture, and the outcome of one fault planted in it.

use super::{Choice, Kind, Mutation, SIDE, mutations};
use glisten::scene::Scene;
use glisten::verify::{Expected, Options};
use glisten_front::hir::Stage;
use glisten_gpu::{Error, Gpu};
use glisten_scene::compare::{Criterion, Verdict, ulp_f32};
use glisten_scene::picture::Picture;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::io::Write;
use std::process::{Command, Stdio};

/// The judge of `verify`.
const OURS: Criterion = Criterion::Envelope;
/// The tolerance that people choose by hand.
const BY_HAND: Criterion = Criterion::Tolerance(1.0 / 255.0);

/// Why a fault that changes the picture passes the judge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Cover {
    /// Colors that are judged differ, but a conforming GPU may draw them.
    Within,
    /// Only undecided pixels differ.
    Undecided,
    /// Only pixels whose center is practically on an edge differ.
    Edge,
}

impl Cover {
    pub(crate) const ALL: [Self; 3] = [Self::Within, Self::Undecided, Self::Edge];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Within => "within the bound",
            Self::Undecided => "undecided",
            Self::Edge => "at an edge",
        }
    }
}

/// How a mutant's picture differs from the one without the fault, over the pixels whose colors are judged.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Change {
    /// The largest difference of a channel.
    pub(crate) absolute: f64,
    /// The largest difference in ULP of the reference.
    pub(crate) ulps: f64,
    /// The bound at that channel.
    pub(crate) allowed: f64,
    /// The number of pixels that differ at all.
    pub(crate) pixels: u64,
}

/// The outcome of a mutant.
#[derive(Clone, Debug)]
pub(crate) enum Outcome {
    /// `spirv-val` rejects it.
    Invalid,
    /// The driver rejects it, or does not finish.
    Refused(String),
    /// The picture is the same bit for bit: for this scene it is not a fault.
    Unseen,
    /// The picture differs.
    Seen {
        /// Whether `verify` fails.
        caught: bool,
        /// Whether `verify --tolerance` with 1/255 fails; `None` if it also fails without a fault.
        by_hand: Option<bool>,
        /// Why it may pass.
        cover: Cover,
        change: Change,
    },
}

/// One fault.
#[derive(Clone, Debug)]
pub(crate) struct Trial {
    pub(crate) scene: String,
    pub(crate) stage: Stage,
    pub(crate) kind: Kind,
    pub(crate) name: String,
    pub(crate) outcome: Outcome,
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}: {}: ", self.scene, self.stage.name(), self.name)?;
        match &self.outcome {
            Outcome::Invalid => f.write_str("spirv-val refuses it"),
            Outcome::Refused(why) => write!(f, "refused: {}", why.lines().next().unwrap_or_default()),
            Outcome::Unseen => f.write_str("the picture is the same"),
            Outcome::Seen { caught, by_hand, change, .. } => {
                let Change { absolute, ulps, allowed, pixels } = change;
                let verdict = if *caught { "caught" } else { "missed" };
                write!(f, "{verdict}: {pixels} pixels, up to {absolute:.1e} ({ulps:.1} ulp; allowed {allowed:.1e})")?;
                f.write_str(if *by_hand == Some(true) { "; 1/255 catches it" } else { "" })
            }
        }
    }
}

/// A scene, with its pictures without a fault.
pub(super) struct Subject<'a> {
    gpu: &'a Gpu,
    name: String,
    scene: Scene,
    /// The emitted words, in the order in which the device asks for them.
    modules: Vec<(Stage, Vec<u32>)>,
    plain: Picture,
    reference: Picture,
    /// Whether the picture fails 1/255 without a fault.
    pub(super) false_alarm: bool,
}

impl<'a> Subject<'a> {
    /// Prepares a scene. `Err` says why it cannot be tried, for example because `verify` fails it without a fault.
    pub(super) fn new(gpu: &'a Gpu, name: &str, scene: &Scene) -> Result<Self, String> {
        let mut scene = scene.clone();
        scene.framebuffer.width = scene.framebuffer.width.min(SIDE);
        scene.framebuffer.height = scene.framebuffer.height.min(SIDE);
        let modules = RefCell::new(Vec::new());
        let plain = draw(gpu, &scene, &|stage, words| {
            modules.borrow_mut().push((stage, words.clone()));
            words
        });
        let plain = plain.map_err(|error| error.to_string())?;
        let options = Options::default();
        let expected = Expected::new(&scene, &options).map_err(|failure| failure.to_string())?;
        let reference = expected.picture().clone();
        if fails(&plain, &reference, OURS) {
            return Err("verify fails it without a fault".to_owned());
        }
        let false_alarm = fails(&plain, &reference, BY_HAND);
        let modules = modules.into_inner();
        Ok(Self { gpu, name: name.to_owned(), scene, modules, plain, reference, false_alarm })
    }

    /// The selected faults: the index of the module, and the change.
    pub(super) fn faults(&self, choice: Choice) -> Vec<(usize, Mutation)> {
        let all: Vec<(usize, Mutation)> = (self.modules.iter().enumerate())
            .flat_map(|(number, (stage, words))| mutations(words, *stage).into_iter().map(move |one| (number, one)))
            .collect();
        let of = |kind: Kind| all.iter().filter(|(_, mutation)| mutation.kind == kind).cloned().collect();
        Kind::ALL.into_iter().flat_map(|kind| choice.of(&self.name, of(kind))).collect()
    }

    pub(super) fn try_out(&self, module: usize, mutation: &Mutation) -> Trial {
        let (stage, words) = &self.modules[module];
        let mutant = mutation.apply(words);
        let outcome = match valid(&mutant) {
            false => Outcome::Invalid,
            true => self.drawn(module, &mutant),
        };
        Trial { scene: self.name.clone(), stage: *stage, kind: mutation.kind, name: mutation.name.clone(), outcome }
    }

    fn drawn(&self, module: usize, mutant: &[u32]) -> Outcome {
        let number = Cell::new(0);
        let picture = draw(self.gpu, &self.scene, &|_, words| {
            number.set(number.get() + 1);
            if number.get() == module + 1 { mutant.to_vec() } else { words }
        });
        let picture = match picture {
            Ok(picture) => picture,
            Err(error) => return Outcome::Refused(error.to_string()),
        };
        if picture.bit_unequal(&self.plain) == 0 && picture.covered == self.plain.covered {
            return Outcome::Unseen;
        }
        let caught = fails(&picture, &self.reference, OURS);
        let by_hand = (!self.false_alarm).then(|| fails(&picture, &self.reference, BY_HAND));
        let (cover, change) = self.difference(&picture);
        Outcome::Seen { caught, by_hand, cover, change }
    }

    /// The bound of a channel, counting those of all attachments in sequence.
    fn allowed(&self, pixel: usize, channel: usize) -> f64 {
        let color = self.reference.attachments[channel / 4][pixel][channel % 4];
        let intervals = self.reference.intervals.as_ref().and_then(|intervals| intervals.get(channel / 4)?.get(pixel));
        intervals.map_or(0.0, |intervals| intervals[channel % 4].reach(color))
    }

    /// Where a picture differs from the one without the fault, and by how much.
    fn difference(&self, picture: &Picture) -> (Cover, Change) {
        let mut change = Change::default();
        let (mut judged, mut open) = (false, false);
        for pixel in 0..picture.covered.len() {
            let covers = [picture.covered[pixel], self.plain.covered[pixel]];
            let colors = || {
                let pairs = picture.attachments.iter().zip(&self.plain.attachments).zip(&self.reference.attachments);
                pairs.flat_map(|((ours, plain), cpu)| (0..4).map(move |k| [ours, plain, cpu].map(|all| all[pixel][k])))
            };
            if covers[0] == covers[1] && colors().all(|[ours, plain, _]| ours == plain) {
                continue;
            }
            change.pixels += 1;
            if self.reference.undecided[pixel] {
                open = true;
            } else if !self.reference.near_edge[pixel] {
                judged = true;
                for (channel, [ours, plain, cpu]) in colors().enumerate() {
                    let difference = (ours - plain).abs();
                    if difference > change.absolute {
                        change.absolute = difference;
                        change.ulps = difference / ulp_f32(cpu);
                        change.allowed = self.allowed(pixel, channel);
                    }
                }
            }
        }
        let cover = match (judged, open) {
            (true, _) => Cover::Within,
            (false, true) => Cover::Undecided,
            (false, false) => Cover::Edge,
        };
        (cover, change)
    }
}

fn fails(picture: &Picture, reference: &Picture, criterion: Criterion) -> bool {
    Verdict::new(picture, reference, criterion).fails()
}

#[expect(unsafe_code, reason = "the words are glisten's own, or spirv-val has accepted them")]
fn draw(gpu: &Gpu, scene: &Scene, edit: &dyn Fn(Stage, Vec<u32>) -> Vec<u32>) -> Result<Picture, Error> {
    // SAFETY: `edit` returns its input unchanged, or words that `valid` has accepted.
    let prepared = unsafe { gpu.prepare_edited(scene, edit)? };
    Ok(gpu.draw(&prepared)?.picture)
}

/// Whether `spirv-val` accepts the words.
fn valid(words: &[u32]) -> bool {
    let mut child = Command::new("spirv-val")
        .args(["--target-env", "vulkan1.1", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("spirv-val is needed: Debian has it in the package spirv-tools");
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    if let Some(mut input) = child.stdin.take() {
        // If the validator rejects a module early, it closes the pipe.
        let _ = input.write_all(&bytes);
    }
    child.wait().is_ok_and(|status| status.success())
}
