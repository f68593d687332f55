//! [`Drawn`]: a generated program as a scene, with its pictures.
//!
//! *In:* a program, or other texts for it. *Out:* pictures as [`Bits`]. *Holds:* a picture that is not a number is the same as any other such.

use crate::Sections;
use crate::generate::Program;
use glisten::scene::{Loaded, MemoryFiles, Scene, load};
use glisten::verify::{Options as VerifyOptions, Runner, verify};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::{Compiler, Options, Source, Stage};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::compare::{Criterion, Verdict};
use glisten_scene::picture::Picture;
use glisten_verify::specialize::with_program;
use glisten_verify::verify::Failure;
use naga::Module;
use naga::valid::ModuleInfo;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::{Arc, OnceLock};

/// A stage as it was emitted.
pub(super) struct Emission {
    pub(super) stage: Stage,
    /// The module that naga reads; none where its front end has a limit.
    pub(super) read: Option<Read>,
    /// The words, of SPIR-V.
    pub(super) words: Option<Vec<u32>>,
    /// Who wrote it.
    pub(super) origin: Origin,
}

/// Who wrote the code of a stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Origin {
    /// glisten, for Vulkan and WebGPU: depths are from 0 to 1, and constants are evaluated in f32.
    Glisten,
    /// glslang, from GLSL that glisten wrote: depths are those of OpenGL, and constants are evaluated in f64.
    Glslang,
}

/// A stage as naga has it.
pub(super) struct Read {
    pub(super) module: Module,
    pub(super) info: ModuleInfo,
}

/// The values of a picture as bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bits(Vec<u64>);

impl Bits {
    /// The bits of a picture. All that is no number is the same: which it is, depends on the machine.
    pub fn of(picture: &Picture) -> Self {
        let bits = |value: &f64| if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() };
        Self(picture.attachments.iter().flatten().flatten().map(bits).collect())
    }

    /// The first difference, as a sentence.
    pub(super) fn difference(&self, other: &Self) -> Result<(), String> {
        if self.0.len() != other.0.len() {
            return Err("the pictures have different sizes".to_owned());
        }
        match self.0.iter().zip(&other.0).position(|(left, right)| left != right) {
            None => Ok(()),
            Some(at) => {
                let value = |bits: &Self| bits.0.get(at).map_or(0.0, |bits| f64::from_bits(*bits));
                Err(format!("value {at} was {:?} and is {:?}", value(self), value(other)))
            }
        }
    }
}

/// The texts of a program and its scene.
#[derive(Clone, Debug)]
pub struct Texts {
    /// The stages: `a.vert`, `a.geom` if there is one, and `a.frag`.
    pub sources: Vec<Source>,
    /// The scene.
    pub scene: String,
}

impl Texts {
    /// The sections `vertex`, `fragment` and `scene` of a text.
    pub fn of(text: &str) -> Self {
        let sections = Sections::of(text);
        let all = [("a.vert", Stage::Vertex), ("a.geom", Stage::Geometry), ("a.frag", Stage::Fragment)];
        let sources = all.into_iter().filter_map(|(name, stage)| {
            let text = sections.text(stage.name())?.into();
            Some(Source { name: name.to_owned(), text, stage })
        });
        Self { sources: sources.collect(), scene: sections.text("scene").unwrap_or_default().to_owned() }
    }
}

impl From<&Program> for Texts {
    fn from(program: &Program) -> Self {
        Self { sources: program.sources(), scene: program.scene_text() }
    }
}

/// A program that has been drawn.
pub struct Drawn<'p> {
    /// Its texts.
    pub texts: Texts,
    /// The program as a tree, if it was generated.
    pub program: Option<&'p Program>,
    /// Its scene and texts.
    pub loaded: Loaded,
    /// The scene.
    pub scene: Scene,
    pub(super) single: Bits,
    /// The picture in f32.
    pub(super) picture: Picture,
    envelope: OnceLock<Result<Picture, String>>,
    exact: OnceLock<Result<Bits, String>>,
    /// The texts that have been drawn, by their hashes.
    seen: RefCell<BTreeSet<u64>>,
    /// Why checks made less than they do for others, since somebody asked.
    left_out: RefCell<Vec<&'static str>>,
    /// By which ways pictures of emitted code were compared, since somebody asked.
    compared: RefCell<Vec<&'static str>>,
    /// The stages of the emitted WGSL.
    pub(super) wgsl: OnceLock<Result<Vec<Emission>, String>>,
}

/// The compiler of generated programs.
pub(super) fn compiler() -> &'static Compiler {
    static COMPILER: OnceLock<Compiler> = OnceLock::new();
    COMPILER.get_or_init(|| Compiler::new(Options::default()))
}

fn hash(texts: &[String]) -> u64 {
    let mut hasher = DefaultHasher::new();
    texts.hash(&mut hasher);
    hasher.finish()
}

/// The first error, as a sentence.
pub(super) fn first_error<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>) -> String {
    let mut errors = diagnostics.filter(|one| one.is_error());
    errors.next().map_or("no reason".to_owned(), |one| format!("{}: {}", one.code.id, one.message))
}

/// Draws a scene.
pub(super) fn bits(scene: &Scene, precision: Precision) -> Result<Bits, String> {
    picture_of(scene, precision, usize::MAX).map(|picture| Bits::of(&picture))
}

/// Draws the first so many attachments of a scene.
pub(super) fn picture_of(scene: &Scene, precision: Precision, attachments: usize) -> Result<Picture, String> {
    let mark_edges = precision == Precision::Envelope;
    let options = RenderOptions { precision, mark_edges, ..RenderOptions::default() };
    let mut picture = render(scene, &options).map_err(|errors| first_error(errors.iter()))?;
    picture.attachments.truncate(attachments);
    Ok(picture)
}

/// The scene of texts.
pub(super) fn scene_of(texts: &Texts) -> Result<(Loaded, Scene), String> {
    let stages = texts.sources.iter().map(|source| (source.name.as_str(), &*source.text));
    let files = std::iter::once(("a.toml", texts.scene.as_str())).chain(stages);
    let loaded = load("a.toml", &MemoryFiles::new(files), compiler());
    match loaded.scene.clone() {
        Some(scene) => Ok((loaded, scene)),
        None => Err(first_error(loaded.diagnostics.iter())),
    }
}

impl<'p> Drawn<'p> {
    pub(super) fn new(texts: Texts, program: Option<&'p Program>) -> Result<Self, String> {
        let (loaded, scene) = scene_of(&texts)?;
        let picture = picture_of(&scene, Precision::F32, usize::MAX)?;
        let single = Bits::of(&picture);
        let own: Vec<String> = texts.sources.iter().map(|source| source.text.to_string()).collect();
        let own = hash(&own);
        let seen = RefCell::new(BTreeSet::from([own]));
        let (exact, envelope, wgsl) = (OnceLock::new(), OnceLock::new(), OnceLock::new());
        let (left_out, compared) = (RefCell::default(), RefCell::default());
        Ok(Self { texts, program, loaded, scene, single, picture, exact, envelope, seen, left_out, compared, wgsl })
    }

    /// A check makes less for this program than for others.
    pub(super) fn leave_out(&self, why: &'static str) {
        self.left_out.borrow_mut().push(why);
    }

    /// Why a check made less.
    pub(super) fn take_left_out(&self) -> Vec<&'static str> {
        self.left_out.take()
    }

    /// A picture of emitted code was compared, by this way back.
    pub(super) fn compare(&self, way: &'static str) {
        self.compared.borrow_mut().push(way);
    }

    /// By which ways pictures were compared.
    pub(super) fn take_compared(&self) -> Vec<&'static str> {
        self.compared.take()
    }

    /// Whether these texts of the stages have not been drawn yet. From now on, they have.
    pub(super) fn is_new(&self, texts: &[String]) -> bool {
        self.seen.borrow_mut().insert(hash(texts))
    }

    /// Whether the texts are of OpenGL ES.
    pub(super) fn is_es(&self) -> bool {
        let shaders = self.scene.draws.iter().flat_map(|draw| &draw.program.stages);
        shaders.into_iter().any(|shader| shader.version.is_es())
    }

    /// The picture in f64.
    pub(super) fn exact(&self) -> Result<&Bits, String> {
        self.exact.get_or_init(|| bits(&self.scene, Precision::F64)).as_ref().map_err(Clone::clone)
    }

    /// Whether a picture is inside of the envelope, as far as that is without a doubt.
    pub(super) fn is_inside(&self, picture: &Picture) -> Result<bool, String> {
        let envelope = self.envelope.get_or_init(|| picture_of(&self.scene, Precision::Envelope, usize::MAX));
        let envelope = envelope.as_ref().map_err(Clone::clone)?;
        Ok(Verdict::new(picture, envelope, Criterion::Envelope).outside == 0)
    }

    /// The scene with other texts of its stages.
    pub(super) fn with_texts(&self, texts: &[String]) -> Result<Scene, String> {
        let sources: Vec<Source> = self
            .texts
            .sources
            .iter()
            .zip(texts)
            .map(|(source, text)| Source { text: text.as_str().into(), ..source.clone() })
            .collect();
        let compilation = compiler().compile(&sources);
        let Some(program) = compilation.program else {
            let error = first_error(compilation.diagnostics.iter());
            return Err(format!("not accepted: {error}\n{}", texts.join("\n")));
        };
        Ok(self.with(Arc::new(program)))
    }

    /// The scene with another program.
    pub(super) fn with(&self, program: Arc<glisten_front::Program>) -> Scene {
        let mut scene = self.scene.clone();
        for draw in &mut scene.draws {
            *draw = with_program(draw, Arc::clone(&program), &[]);
        }
        scene
    }

    /// Whether other texts draw the same bits.
    pub(super) fn same(&self, texts: &[String]) -> Result<(), String> {
        if !self.is_new(texts) {
            return Ok(());
        }
        let scene = self.with_texts(texts)?;
        self.same_scene(&scene).map_err(|message| format!("{message}\n{}", texts.join("\n")))
    }

    /// Whether another scene draws the same bits in f32.
    pub(super) fn same_scene(&self, scene: &Scene) -> Result<(), String> {
        self.single.difference(&bits(scene, Precision::F32)?)
    }
}

/// Whether `verify` finds nothing wrong: it knows what is undefined, too.
pub(super) fn inside(drawn: &Drawn<'_>, runner: &dyn Runner) -> Result<(), String> {
    let options =
        VerifyOptions { sources: Some(&drawn.loaded.sources), allow_inconclusive: true, ..VerifyOptions::default() };
    match verify(&drawn.scene, &[runner], &options) {
        Ok(verification) => {
            let outside: u64 = verification.runs.iter().map(|run| run.verdict.outside).sum();
            if outside == 0 { Ok(()) } else { Err(format!("f32 is outside of the envelope:\n{verification}")) }
        }
        Err(Failure::Diagnostics(errors)) => Err(errors.first().map_or(String::new(), |error| error.message.clone())),
        Err(_) => Ok(()),
    }
}
