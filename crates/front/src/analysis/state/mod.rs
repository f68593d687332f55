//! The parts of the analysis's state that are more than a value, each behind methods.
//!
//! *In:* what the traversal meets. *Out:* the same, when it is asked for. Nothing here knows the
//! [`Analyzer`](super::context::Analyzer), or reports anything.
//!
//! * [`arrays`]: the elements that are used of arrays without a size.
//! * [`budget`]: how much time, and how many variables, a shader may still take.
//! * [`declared`]: everything declared, by name. Names that have scopes are in [`scope`](super::scope).
//! * [`layouts`]: layouts and redeclarations that concern the whole shader, with their spans.
//! * [`notes`]: what names denote, for those who ask.
//! * [`precisions`]: the types that have a default precision, in ES.
//! * [`uses`]: where something is used first.

mod arrays;
mod budget;
mod declared;
mod layouts;
mod notes;
mod precisions;
mod uses;

pub(super) use arrays::ArrayKey;
pub(super) use budget::{Budget, MAX_BOUND};
pub(super) use declared::{Declared, Signature};
pub(super) use layouts::{BlockDefaults, Layouts, PerVertex};
pub(super) use notes::NoteTaker;
pub use notes::{Denoted, Note, NoteRole, Notes, Probe};
pub(super) use precisions::Precisions;
pub(super) use uses::Uses;
