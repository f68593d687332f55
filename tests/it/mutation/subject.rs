//! [`Subject`]: a scene with its correct pictures, in which faults are planted one by one.
//!
//! *In:* a device, a scene. *Out:* [`Trial`]s; the legal changes that `verify` fails.
//! *Holds:* every module that reaches the driver was validated, and all its loops end.

use super::scenery::Scenery;
use super::trial::{Seen, Trial, difference};
use super::{Choice, Code, Form, Kind, Mutation, Outcome, Target, guard, legal, mutations};
use glisten::scene::Scene;
use glisten::verify::{Conclusion, Options};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_gpu::{Error, Gpu};
use glisten_scene::compare::evidence::{Ruler, Written};
use glisten_scene::compare::{Compared, Criterion, Verdict};
use glisten_scene::picture::Picture;
use glisten_verify::verify::{Demands, Expected};
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::io::Write;
use std::process::{Command, Stdio};

/// The tolerance that people choose by hand.
const BY_HAND: Criterion = Criterion::Tolerance(1.0 / 255.0);

/// The picture of one form without a fault.
struct Plain {
    form: Form,
    picture: Picture,
    is_open: bool,
    /// Whether it fails 1/255.
    is_false_alarm: bool,
}

/// A scene, with its pictures without a fault.
pub(super) struct Subject<'a> {
    gpu: &'a Gpu,
    name: String,
    scenery: Scenery,
    scene: &'a Scene,
    /// The scene that the device draws: where there is a geometry stage, that of what it emits.
    drawn: Cow<'a, Scene>,
    expected: Expected<'a>,
    /// The emitted code, in the order in which the device asks for it, by form.
    modules: Vec<(Stage, Code)>,
    plain: Vec<Plain>,
    /// The forms that cannot be tried, with the reason.
    pub(super) left_out: Vec<(Form, String)>,
}

/// A legal change of a scene's modules.
#[derive(Clone, Debug)]
pub(crate) struct Legal {
    pub(crate) scene: String,
    pub(crate) name: String,
    /// Whether the picture differs at all.
    pub(crate) is_seen: bool,
    /// The conclusion of `verify`, or why there is none.
    pub(crate) conclusion: Result<Conclusion, String>,
    /// The verdict's figures, for a report.
    pub(crate) figures: String,
}

impl<'a> Subject<'a> {
    /// Prepares a scene of at most [`SIDE`](super::SIDE) pixels per side. `Err` says why it cannot be tried.
    pub(super) fn new(gpu: &'a Gpu, name: &str, scene: &'a Scene, options: &'a Options<'a>) -> Result<Self, String> {
        let expected = Expected::new(scene, options).map_err(|failure| failure.to_string())?;
        let first = |found: Vec<Diagnostic>| found.first().map_or_else(String::new, |first| first.message.clone());
        let mut subject = Self {
            gpu,
            name: name.to_owned(),
            scenery: Scenery::Plain,
            scene,
            drawn: glisten_reference::expand(scene).map_err(first)?,
            expected,
            modules: Vec::new(),
            plain: Vec::new(),
            left_out: Vec::new(),
        };
        for form in Form::ALL {
            if let Err(why) = subject.add(form) {
                subject.left_out.push((form, why));
            }
        }
        subject.scenery = Scenery::of(scene, &subject.modules);
        Ok(subject)
    }

    /// Adds the picture of a form and its modules, if the picture is right.
    fn add(&mut self, form: Form) -> Result<(), String> {
        let modules = RefCell::new(Vec::new());
        let picture = self.draw(form, &|stage, code| {
            let bounded = guard::bounded(&code);
            modules.borrow_mut().push((stage, code));
            bounded
        });
        let picture = picture.map_err(|error| error.to_string())?;
        let modules = modules.into_inner();
        let Compared { verdict, .. } = self.expected.compared(&picture).map_err(|failure| failure.to_string())?;
        let conclusion = verdict.conclusion(&Demands::default());
        // The words tell the class of the scene, even if its picture is wrong.
        self.modules.extend(modules);
        if conclusion == Conclusion::Fails {
            return Err("verify fails it without a fault".to_owned());
        }
        let is_false_alarm = fails_by_hand(&picture, self.expected.picture());
        let is_open = conclusion == Conclusion::Inconclusive;
        self.plain.push(Plain { form, picture, is_open, is_false_alarm });
        Ok(())
    }

    /// Whether a form fails 1/255 without a fault.
    pub(super) fn false_alarms(&self) -> impl Iterator<Item = Form> {
        self.plain.iter().filter(|plain| plain.is_false_alarm).map(|plain| plain.form)
    }

    /// The forms whose picture without a fault is inconclusive.
    pub(super) fn open(&self) -> impl Iterator<Item = Form> {
        self.plain.iter().filter(|plain| plain.is_open).map(|plain| plain.form)
    }

    fn plain(&self, form: Form) -> Option<&Plain> {
        self.plain.iter().find(|plain| plain.form == form)
    }

    /// The selected faults: the index of the module, and the change.
    pub(super) fn faults(&self, choice: Choice) -> Vec<(usize, Mutation)> {
        let height = self.scene.framebuffer.height;
        let tried = self.modules.iter().enumerate().filter(|(_, (_, code))| self.plain(code.form()).is_some());
        let all: Vec<(usize, Mutation)> = tried
            .flat_map(|(number, (stage, code))| {
                let target = Target { stage: *stage, height };
                mutations(code, target).into_iter().map(move |one| (number, one))
            })
            .collect();
        let of = |kind: Kind, form: Form| {
            let has = |(number, one): &&(usize, Mutation)| one.kind == kind && self.modules[*number].1.form() == form;
            choice.of(&self.name, all.iter().filter(has).cloned().collect())
        };
        Form::ALL.into_iter().flat_map(|form| Kind::ALL.into_iter().flat_map(move |kind| of(kind, form))).collect()
    }

    pub(super) fn try_out(&mut self, module: usize, mutation: &Mutation) -> Trial {
        let (stage, code) = &self.modules[module];
        let (stage, form) = (*stage, code.form());
        let mutant = guard::bounded(&mutation.rewrite.apply(code));
        let other = |code: Code| {
            let changed = if mutation.rewrite.is_everywhere() { mutation.rewrite.apply(&code) } else { code };
            guard::bounded(&changed)
        };
        let outcome = match is_valid(&mutant) {
            false => Outcome::Invalid,
            true => self.outcome(form, &|number, code| if number == module { mutant.clone() } else { other(code) }),
        };
        let (scene, name) = (self.name.clone(), mutation.name.clone());
        Trial { scene, scenery: self.scenery, form, stage, kind: mutation.kind, name, outcome }
    }

    fn outcome(&mut self, form: Form, edit: &dyn Fn(usize, Code) -> Code) -> Outcome {
        let picture = match self.drawn_with(form, edit) {
            Ok(picture) => picture,
            Err(error) => return Outcome::Refused(error.to_string()),
        };
        let Compared { verdict, classes } = match self.expected.compared(&picture) {
            Ok(compared) => compared,
            Err(failure) => return Outcome::Refused(failure.to_string()),
        };
        let Some(plain) = self.plain(form) else { return Outcome::Unseen };
        if is_same(&picture, &plain.picture) {
            return Outcome::Unseen;
        }
        let reference = self.expected.picture();
        let written = Written::of(self.scene);
        let ruler = Ruler::new(reference, &written, None);
        Outcome::Seen(Seen {
            conclusion: verdict.conclusion(&Demands::default()),
            by_envelope: verdict.conclusion(&Demands { likely: false, ..Demands::default() }) == Conclusion::Fails,
            was_open: plain.is_open,
            by_hand: (!plain.is_false_alarm).then(|| fails_by_hand(&picture, reference)),
            suspect: verdict.suspect.unwrap_or(0),
            change: difference([&picture, &plain.picture, reference], &ruler, &classes),
        })
    }

    /// The legal changes of all stages together.
    pub(super) fn legal(&mut self, seed: u64) -> Vec<Legal> {
        let changes: Vec<Vec<(String, Vec<u32>)>> = (self.modules.iter())
            .map(|(_, code)| match code {
                Code::Words(words) => legal::legal(words, seed),
                Code::Text(_) => Vec::new(),
            })
            .collect();
        let mut names: Vec<&String> = Vec::new();
        for (name, _) in changes.iter().flatten().filter(|_| self.plain(Form::Spirv).is_some()) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let change = |number: usize, name: &str, code: Code| {
            let found = changes.get(number).and_then(|all| all.iter().find(|(of, _)| of == name));
            found.map_or(code, |(_, words)| Code::Words(words.clone()))
        };
        let mut found = Vec::new();
        for name in names {
            let changed = changes.iter().flatten().filter(|(of, _)| of == name);
            let is_valid = changed.into_iter().all(|(_, words)| is_valid(&Code::Words(words.clone())));
            let drawn = match is_valid {
                true => self.drawn_with(Form::Spirv, &|number, code| change(number, name, code)),
                false => Err(Error::Refused("spirv-val refuses it".to_owned())),
            };
            let (is_seen, figures, conclusion) = match drawn {
                Ok(picture) => {
                    let is_seen = self.plain(Form::Spirv).is_some_and(|plain| !is_same(&picture, &plain.picture));
                    match self.expected.compared(&picture) {
                        Ok(Compared { verdict, .. }) => {
                            (is_seen, figures(&verdict), Ok(verdict.conclusion(&Demands::default())))
                        }
                        Err(failure) => (is_seen, String::new(), Err(failure.to_string())),
                    }
                }
                Err(error) => (false, String::new(), Err(error.to_string())),
            };
            let name = name.clone();
            found.push(Legal { scene: self.name.clone(), name, is_seen, conclusion, figures });
        }
        found
    }

    /// The picture with the code of each module, counted from 0 over both forms, replaced.
    fn drawn_with(&self, form: Form, edit: &dyn Fn(usize, Code) -> Code) -> Result<Picture, Error> {
        let first = self.modules.iter().position(|(_, code)| code.form() == form).unwrap_or(0);
        let number = Cell::new(first);
        self.draw(form, &|_, code| edit(number.replace(number.get() + 1), code))
    }

    #[expect(unsafe_code, reason = "the words are glisten's own, or spirv-val has accepted them")]
    fn draw(&self, form: Form, edit: &dyn Fn(Stage, Code) -> Code) -> Result<Picture, Error> {
        let words = |stage: Stage, words: Vec<u32>| match edit(stage, Code::Words(words)) {
            Code::Words(words) => words,
            Code::Text(_) => Vec::new(),
        };
        let text = |stage: Stage, text: String| match edit(stage, Code::Text(text)) {
            Code::Text(text) => text,
            Code::Words(_) => String::new(),
        };
        let prepared = match form {
            // SAFETY: `edit` returns its input with an end for loops, or words that `is_valid` has accepted.
            Form::Spirv => unsafe { self.gpu.prepare_edited(&self.drawn, &words)? },
            Form::Wgsl => self.gpu.prepare_edited_wgsl(&self.drawn, &text)?,
        };
        Ok(self.gpu.draw(&prepared)?.picture)
    }
}

fn is_same(picture: &Picture, plain: &Picture) -> bool {
    picture.bit_unequal(plain) == 0 && picture.covered == plain.covered
}

fn fails_by_hand(picture: &Picture, reference: &Picture) -> bool {
    Verdict::new(picture, reference, BY_HAND).conclusion(&Demands::default()) == Conclusion::Fails
}

fn figures(verdict: &Verdict) -> String {
    let Verdict { outside, coverage_mismatch, finiteness_mismatch, suspect, max_abs, .. } = verdict;
    format!(
        "{outside} outside, {coverage_mismatch} with another coverage, {finiteness_mismatch} not finite on one side, \
         {} suspect, largest error {max_abs:.1e}",
        suspect.unwrap_or(0)
    )
}

/// Whether a validator accepts the code: `spirv-val`, or naga's for WGSL.
fn is_valid(code: &Code) -> bool {
    match code {
        Code::Words(words) => is_valid_spirv(words),
        Code::Text(text) => naga::front::wgsl::parse_str(text).is_ok_and(|module| {
            let (flags, capabilities) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
            naga::valid::Validator::new(flags, capabilities).validate(&module).is_ok()
        }),
    }
}

fn is_valid_spirv(words: &[u32]) -> bool {
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
