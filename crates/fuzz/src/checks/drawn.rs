//! [`Drawn`]: a generated program as a scene, with its pictures.
//!
//! *In:* a program, or other texts for it. *Out:* pictures as [`Bits`]. *Holds:* a picture that is not a number is the same as any other such.

use crate::Sections;
use crate::generate::Program;
use glisten::scene::{Loaded, MemoryFiles, Scene, load};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::{Compiler, Options, Source, Stage};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::picture::Picture;
use glisten_verify::specialize::with_program;
use std::sync::{Arc, OnceLock};

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
    /// The vertex and the fragment stage: `a.vert` and `a.frag`.
    pub sources: [Source; 2],
    /// The scene.
    pub scene: String,
}

impl Texts {
    /// The sections `vertex`, `fragment` and `scene` of a text.
    pub fn of(text: &str) -> Self {
        let sections = Sections::of(text);
        let source = |name: &str, stage| {
            let text = sections.text(stage).unwrap_or_default().into();
            Source {
                name: name.to_owned(),
                text,
                stage: if stage == "vertex" { Stage::Vertex } else { Stage::Fragment },
            }
        };
        let sources = [source("a.vert", "vertex"), source("a.frag", "fragment")];
        Self { sources, scene: sections.text("scene").unwrap_or_default().to_owned() }
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
    exact: OnceLock<Result<Bits, String>>,
}

/// The compiler of generated programs.
pub(super) fn compiler() -> &'static Compiler {
    static COMPILER: OnceLock<Compiler> = OnceLock::new();
    COMPILER.get_or_init(|| Compiler::new(Options::default()))
}

fn first_error<'d>(diagnostics: impl Iterator<Item = &'d Diagnostic>) -> String {
    let mut errors = diagnostics.filter(|one| one.is_error());
    errors.next().map_or("no reason".to_owned(), |one| format!("{}: {}", one.code.id, one.message))
}

/// Draws a scene.
pub(super) fn bits(scene: &Scene, precision: Precision) -> Result<Bits, String> {
    let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
    render(scene, &options).map(|picture| Bits::of(&picture)).map_err(|errors| first_error(errors.iter()))
}

/// The scene of texts.
pub(super) fn scene_of(texts: &Texts) -> Result<(Loaded, Scene), String> {
    let [vertex, fragment] = &texts.sources;
    let files = [("a.toml", texts.scene.as_str()), ("a.vert", &*vertex.text), ("a.frag", &*fragment.text)];
    let loaded = load("a.toml", &MemoryFiles::new(files), compiler());
    match loaded.scene.clone() {
        Some(scene) => Ok((loaded, scene)),
        None => Err(first_error(loaded.diagnostics.iter())),
    }
}

impl<'p> Drawn<'p> {
    pub(super) fn new(texts: Texts, program: Option<&'p Program>) -> Result<Self, String> {
        let (loaded, scene) = scene_of(&texts)?;
        let single = bits(&scene, Precision::F32)?;
        Ok(Self { texts, program, loaded, scene, single, exact: OnceLock::new() })
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

    /// The scene with other texts of its stages.
    pub(super) fn with_texts(&self, texts: [String; 2]) -> Result<Scene, String> {
        let sources: Vec<Source> = self
            .texts
            .sources
            .iter()
            .zip(&texts)
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
    pub(super) fn same(&self, texts: [String; 2]) -> Result<(), String> {
        let scene = self.with_texts(texts.clone())?;
        self.same_scene(&scene).map_err(|message| format!("{message}\n{}", texts.join("\n")))
    }

    /// Whether another scene draws the same bits in f32.
    pub(super) fn same_scene(&self, scene: &Scene) -> Result<(), String> {
        self.single.difference(&bits(scene, Precision::F32)?)
    }
}
