//! Faults planted in emitted code: how many of them `verify` catches. Legal changes of it: whether `verify` fails none.
//!
//! *In:* a device and scenes. *Out:* a [`Study`]: for each kind of fault and each class of scenes, how many were drawn,
//! changed the picture at all, and were caught by `verify` and by a tolerance of 1/255, and which ones were missed and why.
//!
//! ```text
//!  Scene ──► gpu.prepare_edited      the emitted words, and gpu.prepare_edited_wgsl the emitted text, of every stage
//!        ──► operations, control,    everything that can be changed in one place: Mutations
//!            numbers, images, memory,
//!            order, conventions, places
//!        ──► tokens, text            the same in text
//!        ──► legal                   what a translator or a driver may do: Mutations of which none is a fault
//!        ──► guard                   an end for every loop
//!        ──► subject                 each one through a validator, drawn, compared: Trials
//!        ──► study                   tables
//! ```
//!
//! *Holds:* the same scenes and the same [`Choice`] give the same trials. `verify` sees only the mutant's picture and the
//! reference; the picture without the fault only serves to tell faults that change nothing from those that are missed.

mod control;
mod conventions;
mod guard;
mod images;
mod legal;
mod memory;
mod module;
mod numbers;
mod operations;
mod order;
mod places;
mod scenery;
mod study;
mod subject;
mod table;
mod text;
mod text_calls;
mod tokens;
mod trial;
mod words;

pub(crate) use study::{Parts, Study};
pub(crate) use trial::Outcome;

use glisten_front::hir::Stage;
use module::Module;
use std::ops::Range;
use words::{Splice, instructions, spliced};

/// The largest side of a picture. Scenes are drawn small: the rules are the same, and a study draws thousands of
/// pictures.
pub(crate) const SIDE: u32 = 64;

/// The object of a mutation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    /// An operation, or the order of its operands.
    Operation,
    /// A branch, a comparison, the exit of a loop, a case of a switch.
    Control,
    /// A float constant.
    Constant,
    /// An integer constant, in one of its uses.
    Integer,
    /// A conversion between types, or its rounding.
    Conversion,
    /// The operands of a texture lookup.
    Image,
    /// Offsets, strides, bindings, locations.
    Memory,
    /// A store or a decoration that is missing.
    Dropped,
    /// The order of operands and of evaluation.
    Order,
    /// The conventions of built-in variables and functions.
    Convention,
    /// One interpolation qualifier.
    Qualifier,
    /// One component is replaced by another.
    Swizzle,
    /// The position of all vertices, by a little.
    Vertex,
}

impl Kind {
    pub(crate) const ALL: [Self; 13] = [
        Self::Operation,
        Self::Control,
        Self::Constant,
        Self::Integer,
        Self::Conversion,
        Self::Image,
        Self::Memory,
        Self::Dropped,
        Self::Order,
        Self::Convention,
        Self::Qualifier,
        Self::Swizzle,
        Self::Vertex,
    ];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Operation => "operation",
            Self::Control => "control",
            Self::Constant => "constant",
            Self::Integer => "integer",
            Self::Conversion => "conversion",
            Self::Image => "image",
            Self::Memory => "memory",
            Self::Dropped => "dropped",
            Self::Order => "order",
            Self::Convention => "convention",
            Self::Qualifier => "qualifier",
            Self::Swizzle => "swizzle",
            Self::Vertex => "vertex",
        }
    }
}

/// The form of emitted code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Form {
    Spirv,
    Wgsl,
}

impl Form {
    pub(crate) const ALL: [Self; 2] = [Self::Spirv, Self::Wgsl];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Spirv => "spirv",
            Self::Wgsl => "wgsl",
        }
    }
}

/// The emitted code of a stage.
#[derive(Clone, Debug)]
enum Code {
    Words(Vec<u32>),
    Text(String),
}

impl Code {
    fn form(&self) -> Form {
        match self {
            Self::Words(_) => Form::Spirv,
            Self::Text(_) => Form::Wgsl,
        }
    }
}

/// The replacements in some code, sorted by position.
#[derive(Clone, Debug)]
enum Rewrite {
    Words {
        splices: Vec<Splice>,
        /// How many identifiers they add.
        more_ids: u32,
    },
    /// Ranges of bytes and their new text.
    Text(Vec<(Range<usize>, String)>),
    /// A text that all stages have in common, and its replacement: the stages of WebGPU must agree on interpolation.
    Everywhere(String, String),
}

impl Rewrite {
    fn one(splice: Splice) -> Self {
        Self::Words { splices: vec![splice], more_ids: 0 }
    }

    /// Whether it changes the other stages as well.
    fn is_everywhere(&self) -> bool {
        matches!(self, Self::Everywhere(..))
    }

    /// The changed code. A rewrite of the other form changes nothing.
    fn apply(&self, code: &Code) -> Code {
        match (self, code) {
            (Self::Words { splices, more_ids }, Code::Words(words)) => Code::Words(spliced(words, splices, *more_ids)),
            (Self::Text(edits), Code::Text(text)) => Code::Text(tokens::edited(text, edits)),
            (Self::Everywhere(from, to), Code::Text(text)) => Code::Text(text.replace(from, to)),
            _ => code.clone(),
        }
    }
}

/// A change of one module.
#[derive(Clone, Debug)]
struct Mutation {
    kind: Kind,
    /// A description of the change, with the identifier that a disassembler shows.
    name: String,
    rewrite: Rewrite,
}

impl Mutation {
    fn new(kind: Kind, name: String, splice: Splice) -> Self {
        Self { kind, name, rewrite: Rewrite::one(splice) }
    }
}

/// The picture of a scene, as far as a fault depends on it.
#[derive(Clone, Copy, Debug)]
struct Target {
    stage: Stage,
    height: u32,
}

/// Every possible change of a module.
fn mutations(code: &Code, target: Target) -> Vec<Mutation> {
    let words = match code {
        Code::Words(words) => words,
        Code::Text(text) => return text::mutations(text, target),
    };
    let list = instructions(words);
    let module = Module::of(words, &list);
    let mut found: Vec<Mutation> = list.iter().filter_map(|one| operations::operation(*one)).collect();
    found.extend(places::places(&module, target.stage));
    let sources = [control::faults, numbers::faults, images::faults, memory::faults, order::faults];
    found.extend(sources.iter().flat_map(|faults| faults(&module)));
    found.extend(conventions::faults(&module, target));
    found
}

/// Which of the changes to try.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    /// The largest number of each kind in each form of each scene; `None` for all.
    pub(crate) each: Option<usize>,
    /// The seed of the selection, and of the legal changes.
    pub(crate) seed: u64,
}

/// A sequence of numbers that looks random, the same for the same seed and text.
struct Random(u64);

impl Random {
    fn new(seed: u64, text: &str) -> Self {
        let mut random = Self(seed);
        for byte in text.bytes() {
            random.0 ^= u64::from(byte);
            random.next();
        }
        random
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 32
    }
}

impl Choice {
    /// Selects a part of a scene's list, in order; the selection differs between scenes.
    fn of<T>(self, scene: &str, list: Vec<T>) -> Vec<T> {
        let Some(each) = self.each.filter(|each| *each < list.len()) else { return list };
        let mut random = Random::new(self.seed, scene);
        let mut keyed: Vec<(u64, usize, T)> =
            list.into_iter().enumerate().map(|(place, item)| (random.next(), place, item)).collect();
        keyed.sort_by_key(|(key, ..)| *key);
        keyed.truncate(each);
        keyed.sort_by_key(|(_, place, _)| *place);
        keyed.into_iter().map(|(.., item)| item).collect()
    }
}
