//! The account of a specialized scene: what went, and the work before and after.
//!
//! *In:* a scene and what is left of it. *Out:* [`Account`], which is JSON as the contract says.

use super::error::{PictureError, options, picture_error};
use super::residual::SpecializedScene;
use glisten_front::diagnostic::Diagnostic;
#[cfg(feature = "stability")]
use glisten_front::{hir::Stage, link::Program, source::SourceMap};
use glisten_reference::{Precision, Work, work};
use glisten_scene::{Draw, Scene};
use glisten_specialize::{Extent, Math, Moved, optimize};
use glisten_variants::spirv_instructions;
use serde::Serialize;

/// The account of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Account {
    /// The scene's file.
    pub scene: String,
    /// Its draws, in order.
    pub draws: Vec<DrawAccount>,
    /// Under finite math, the error of the whole picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finite_math: Option<PictureError>,
    /// Under fast math, the error of the whole picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fast_math: Option<PictureError>,
    /// Where computations may move to the vertex stage, the error of the whole picture.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub move_to_vertex: Option<PictureError>,
    /// The times of the original and the residual, where they were measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time: Option<Times>,
}

impl Account {
    /// The error of the whole picture, where the contract allows one. The contracts are measured together: the picture is one.
    pub fn error(&self) -> Option<PictureError> {
        self.finite_math.or(self.fast_math).or(self.move_to_vertex)
    }
}

/// The times of a scene, drawn in turns with its original and with its residual programs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Times {
    /// The median of the original, in milliseconds a frame.
    pub before_ms: f64,
    /// The median of the residual.
    pub after_ms: f64,
    /// The median of the residual's time to that of the original in the same round.
    pub ratio: f64,
    /// The interval that holds this median with a confidence of 95 %.
    pub interval: [f64; 2],
    /// The same interval of the original against itself.
    pub noise: [f64; 2],
    /// The rounds.
    pub rounds: u32,
    /// Whether the residual is slower, so that the original stays.
    pub slower: bool,
}

/// The account of a draw.
#[derive(Clone, Debug, Serialize)]
pub struct DrawAccount {
    /// The original's vertex shader.
    pub vertex: String,
    /// The original's fragment shader.
    pub fragment: String,
    /// The stem of the residual's files.
    pub residual: String,
    /// What stayed as it was because the residual would have been longer than the original without it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kept: Option<&'static str>,
    /// What was left out.
    pub left_out: Vec<Entry>,
    /// The work of the original.
    pub before: Figures,
    /// The work of the residual.
    pub after: Figures,
    /// Under finite math, the error of a picture of this draw alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub finite_math: Option<PictureError>,
    /// Under fast math, the error of a picture of this draw alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fast_math: Option<PictureError>,
    /// What moved to the vertex stage, where that is allowed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub move_to_vertex: Option<Moves>,
}

impl DrawAccount {
    /// The error of a picture of this draw alone, where the contract allows one.
    pub fn error(&self) -> Option<PictureError> {
        self.finite_math.or(self.fast_math).or_else(|| self.move_to_vertex.as_ref().map(|moves| moves.error))
    }
}

/// What moved to the vertex stage of a draw.
#[derive(Clone, Debug, Serialize)]
pub struct Moves {
    /// The computations.
    pub moved: Vec<MovedEntry>,
    /// The error of a picture of this draw alone.
    #[serde(flatten)]
    pub error: PictureError,
}

/// A computation that moved to the vertex stage.
#[derive(Clone, Debug, Serialize)]
pub struct MovedEntry {
    /// The varying that carries its result.
    pub name: String,
    /// Its text.
    pub expression: String,
    /// The file that it was in.
    pub file: String,
    /// The line.
    pub line: u32,
}

/// Something that was left out.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// `branch`, `loop`, `function` and so on.
    pub what: &'static str,
    /// Its name; of a branch its condition.
    pub name: String,
    /// The file that it was in.
    pub file: String,
    /// The line.
    pub line: u32,
    /// What decided it.
    pub because: String,
}

/// The work of a draw.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Figures {
    /// Instructions in the function bodies of both stages as `compile` writes them by default.
    pub spirv_instructions: u64,
    /// Scalars and vectors that are interpolated.
    pub varyings: u64,
    /// Vertex attributes with data.
    pub attributes: u64,
    /// Bytes of their data.
    pub attribute_bytes: u64,
    /// Bytes of uniform blocks, that of the loose uniforms included.
    pub uniform_bytes: u64,
    /// Textures.
    pub textures: u64,
    /// Operations that the vertex stage executes for the picture, without those on integers.
    pub vertex_operations: u64,
    /// Operations that the fragment stage executes for the picture, without those on integers.
    pub fragment_operations: u64,
}

/// The files of a program's vertex and fragment shader: those that have their `main`.
#[cfg(feature = "stability")]
pub fn files_of(program: &Program, sources: &SourceMap) -> [String; 2] {
    [Stage::Vertex, Stage::Fragment].map(|stage| {
        let shader = program.stage(stage);
        let main = shader.and_then(|shader| shader.main.map(|main| shader.function(main).span));
        let file = main.and_then(|span| sources.file_of(span));
        file.map_or_else(String::new, |file| sources.file(file).name().to_owned())
    })
}

/// The account of a scene. `names` are the files of each draw's original shaders and the stem of its residual's.
///
/// # Errors
/// What the reference or the emission cannot do.
pub fn account(
    name: &str,
    scene: &Scene,
    specialized: &SpecializedScene,
    names: &[[String; 3]],
) -> Result<Account, Vec<Diagnostic>> {
    let options = options(Precision::F32);
    let contract = specialized.contract;
    let error = if contract.is_exact() { None } else { Some(picture_error(scene, &specialized.scene)?) };
    let (before, after) = (work(scene, &options)?, work(&specialized.scene, &options)?);
    let mut draws = Vec::with_capacity(scene.draws.len());
    for (index, ([vertex, fragment, residual], done)) in names.iter().zip(&specialized.draws).enumerate() {
        let figures = |scene: &Scene, work: &[Work]| {
            let draw = scene.draws.get(index);
            draw.map_or_else(Figures::default, |draw| figures(draw, work.get(index).copied().unwrap_or_default()))
        };
        let of_draw = match error {
            None => None,
            // The picture of the only draw is the picture.
            Some(error) if scene.draws.len() == 1 => Some(error),
            Some(_) => Some(picture_error(&alone(scene, index), &alone(&specialized.scene, index))?),
        };
        let left_out = done.left_out.iter().map(|one| Entry {
            what: one.what.name(),
            name: one.name.clone(),
            file: one.file.clone(),
            line: one.line,
            because: one.because.clone(),
        });
        draws.push(DrawAccount {
            vertex: vertex.clone(),
            fragment: fragment.clone(),
            residual: residual.clone(),
            kept: kept(done.extent),
            left_out: left_out.collect(),
            before: figures(scene, &before),
            after: figures(&specialized.scene, &after),
            finite_math: of_draw.filter(|_| contract.math == Math::Finite),
            fast_math: of_draw.filter(|_| contract.math == Math::Fast),
            move_to_vertex: of_draw
                .filter(|_| contract.move_to_vertex)
                .map(|error| Moves { moved: done.moved.iter().map(moved_entry).collect(), error }),
        });
    }
    Ok(Account {
        scene: name.to_owned(),
        draws,
        finite_math: error.filter(|_| contract.math == Math::Finite),
        fast_math: error.filter(|_| contract.math == Math::Fast),
        move_to_vertex: error.filter(|_| contract.move_to_vertex),
        time: None,
    })
}

/// What an extent leaves as it was.
fn kept(extent: Extent) -> Option<&'static str> {
    match extent {
        Extent::All => None,
        Extent::LoopsKept => Some("loops"),
        Extent::FunctionsKept => Some("loops and functions"),
        Extent::Nothing => Some("program"),
    }
}

fn moved_entry(moved: &Moved) -> MovedEntry {
    let Moved { name, expression, file, line, .. } = moved.clone();
    MovedEntry { name, expression, file, line }
}

/// The scene with one of its draws alone.
fn alone(scene: &Scene, draw: usize) -> Scene {
    let draws = scene.draws.iter().skip(draw).take(1).cloned().collect();
    Scene { draws, ..scene.clone() }
}

fn figures(draw: &Draw, work: Work) -> Figures {
    let interface = &draw.program.interface;
    let given = || draw.attributes.iter().flatten();
    let blocks: u64 =
        interface.blocks.iter().map(|block| u64::from(block.size) * u64::from(block.array_size.unwrap_or(1))).sum();
    Figures {
        spirv_instructions: spirv_instructions(&optimize(&draw.program)),
        varyings: interface.varyings.len() as u64,
        attributes: given().count() as u64,
        attribute_bytes: given().map(|data| data.values.len() as u64 * 4).sum(),
        uniform_bytes: interface.loose.map_or(0, |(_, size)| u64::from(size)) + blocks,
        textures: draw.textures.iter().flatten().count() as u64,
        vertex_operations: work.vertex_operations,
        fragment_operations: work.fragment_operations,
    }
}
