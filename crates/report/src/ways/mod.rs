//! The variants to shade a scene that are found by themselves (`--ways auto`).
//!
//! *In:* [`Origin`]: a loaded scene with its texts. *Out:* [`FoundWay`]s, each a scene of its own that both the reference
//! and the GPU can draw.
//!
//! *Holds:* the first variant is the scene as written; the order is the same on every run; no variant is equal to the scene as
//! written. *Not done here:* drawing and measuring.

mod coarser;
mod depends;
mod edit;
mod find;
mod fixed;
mod library;
mod models;
mod naive;
mod names;
mod powers;
mod probe;
mod roots;
mod same;
mod screen;
mod stable;
mod tables;
#[cfg(test)]
mod tests;
mod vertex;

pub(crate) use edit::differs;
pub use library::{LIBRARY_SCENE, LibraryFiles};

use glisten_emit::FloatWidth;
use glisten_front::hir::Stage;
use glisten_gpu::Via;
use glisten_verify::scene::Scene;

/// The name and the kind of the scene as written.
pub(super) const AS_WRITTEN: &str = "as written";

/// The scene that variants are found for.
#[derive(Clone, Copy)]
pub(super) struct Origin<'a> {
    /// The scene's name, which is the name of its model as well.
    pub(super) name: &'a str,
    /// The scene as written.
    pub(super) scene: &'a Scene,
    /// The text of the scene file, without its `[report]` table.
    pub(super) text: &'a str,
    /// Loads the scene from another text of its file; `None` if that has errors.
    pub(super) load: &'a dyn Fn(&str) -> Option<Scene>,
}

/// A variant that was found.
#[derive(Clone, Debug)]
pub(super) struct FoundWay {
    /// A name for people, unique within the model and tessellation.
    pub(super) name: String,
    /// The kind of the transformation in a word: `as written`, `specialized`, `table`.
    pub(super) kind: &'static str,
    /// The change in a plain sentence.
    pub(super) about: String,
    /// The model: variants of one model have one reference.
    pub(super) model: String,
    /// The scene to draw.
    pub(super) scene: Scene,
    /// The segments and rings of its mesh, if they are not those of the scene as written.
    pub(super) tessellation: Option<[u32; 2]>,
    /// The form of the code that this variant needs, if the user's choice does not matter.
    pub(super) via: Option<Via>,
    /// The width of floats on the GPU.
    pub(super) floats: FloatWidth,
    /// The GLSL texts of each draw, if they are at hand; otherwise they are printed from the programs.
    pub(super) programs: Option<Vec<Vec<(Stage, String)>>>,
    /// The reference of its model, if that is not the scene as written. The first variant of a model decides.
    pub(super) truth: Option<FoundTruth>,
}

/// The scene whose f64 picture is the reference of a model.
#[derive(Clone, Debug)]
pub(super) struct FoundTruth {
    /// The name of the variant that it is.
    pub(super) way: String,
    /// The scene to draw in f64.
    pub(super) scene: Scene,
    /// The segments and rings of its mesh, if they are not those of the scene as written.
    pub(super) tessellation: Option<[u32; 2]>,
}

/// The variants of a scene, the scene as written first.
pub(super) fn found(origin: &Origin<'_>) -> Vec<FoundWay> {
    let mut list = List::new(as_written(origin));
    find::all(origin, &mut list);
    list.ways
}

/// The scene as written, which is the reference of its model.
fn as_written(origin: &Origin<'_>) -> FoundWay {
    FoundWay::new((AS_WRITTEN, AS_WRITTEN), "The scene as its file says.".into(), origin.name, origin.scene.clone())
}

impl FoundWay {
    /// A variant by its name and kind, with the tessellation of the scene.
    fn new((name, kind): (&str, &'static str), about: String, model: &str, scene: Scene) -> Self {
        Self {
            name: name.into(),
            kind,
            about,
            model: model.into(),
            scene,
            tessellation: None,
            via: None,
            floats: FloatWidth::Single,
            programs: None,
            truth: None,
        }
    }
}

/// The variants that were found so far: no two draw with the same programs and data.
struct List {
    ways: Vec<FoundWay>,
}

impl List {
    /// No report has more variants.
    const MOST: usize = 28;

    fn new(first: FoundWay) -> Self {
        Self { ways: vec![first] }
    }

    /// Adds a variant, unless it is one that is there, or one that no GPU could draw.
    fn add(&mut self, way: FoundWay) {
        let is_new = self.ways.iter().all(|known| known.floats != way.floats || differs(&known.scene, &way.scene));
        if is_new && self.ways.len() < Self::MOST && edit::is_emitted(&way.scene) {
            self.ways.push(way);
        }
    }
}
