//! Faults planted in emitted SPIR-V: how many of them the judge of pictures catches.
//!
//! *In:* a device and scenes. *Out:* a [`Study`]: for each kind of fault, how many were drawn, changed the picture at
//! all, and were caught by `verify`'s judge and by a tolerance of 1/255, and which ones were missed and why.
//!
//! ```text
//!  Scene ──► gpu.prepare_edited   the emitted words of every stage
//!        ──► operations, places   everything that can be changed in one place: Mutations
//!        ──► trial                each one through spirv-val, drawn, judged: Trials
//!        ──► study                tables
//! ```
//!
//! *Holds:* the same scenes and the same [`Choice`] give the same trials. The judge sees only the mutant's picture
//! and the reference; the picture without the fault only serves to tell faults that change nothing from those that
//! are missed.

mod operations;
mod places;
mod study;
mod trial;
mod words;

pub(crate) use study::Study;
pub(crate) use trial::Outcome;

use glisten_front::hir::Stage;
use words::{Splice, instructions, spliced};

/// The largest side of a picture. Scenes are drawn small: the rules are the same, and a study draws thousands of
/// pictures.
pub(crate) const SIDE: u32 = 64;

/// The object of a mutation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// An operation, or the order of its operands.
    Operation,
    /// One bit of a constant.
    Constant,
    /// One interpolation qualifier.
    Qualifier,
    /// One component is replaced by another.
    Swizzle,
    /// The position of all vertices, by a little.
    Vertex,
}

impl Kind {
    pub(crate) const ALL: [Self; 5] = [Self::Operation, Self::Constant, Self::Qualifier, Self::Swizzle, Self::Vertex];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Operation => "operation",
            Self::Constant => "constant",
            Self::Qualifier => "qualifier",
            Self::Swizzle => "swizzle",
            Self::Vertex => "vertex",
        }
    }
}

/// A change of one module.
#[derive(Clone, Debug)]
struct Mutation {
    kind: Kind,
    /// A description of the change, with the identifier that a disassembler shows.
    name: String,
    splices: Vec<Splice>,
    /// How many identifiers it adds.
    more_ids: u32,
}

impl Mutation {
    fn new(kind: Kind, name: String, splice: Splice) -> Self {
        Self { kind, name, splices: vec![splice], more_ids: 0 }
    }

    fn apply(&self, words: &[u32]) -> Vec<u32> {
        spliced(words, &self.splices, self.more_ids)
    }
}

/// Every possible change of a module.
fn mutations(words: &[u32], stage: Stage) -> Vec<Mutation> {
    let operations = instructions(words).into_iter().filter_map(operations::operation);
    operations.chain(places::places(words, stage)).collect()
}

/// Which of the changes to try.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// The largest number of each kind in each scene; `None` for all.
    pub(crate) each: Option<usize>,
    /// The seed of the selection.
    pub(crate) seed: u64,
}

impl Choice {
    /// Selects a part of a scene's list, in order; the selection differs between scenes.
    fn of<T>(self, scene: &str, list: Vec<T>) -> Vec<T> {
        let Some(each) = self.each.filter(|each| *each < list.len()) else { return list };
        let stirred = |random: u64, by: u64| {
            (random ^ by).wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407)
        };
        let mut random = scene.bytes().fold(self.seed, |random, byte| stirred(random, byte.into()));
        let mut keyed: Vec<(u64, usize, T)> = (list.into_iter().enumerate())
            .map(|(place, item)| {
                random = stirred(random, 0);
                (random >> 32, place, item)
            })
            .collect();
        keyed.sort_by_key(|(key, ..)| *key);
        keyed.truncate(each);
        keyed.sort_by_key(|(_, place, _)| *place);
        keyed.into_iter().map(|(.., item)| item).collect()
    }
}
