//! Source texts, and positions in them.
//!
//! *In:* named texts, and an [`IncludeResolver`] for the files that they include.
//! *Out:* a [`SourceMap`] in which every text has its own range of global byte offsets, and [`Span`]s that point into
//! it. A span is eight bytes plus an expansion number: it says where a token was written and, through
//! [`ExpansionId`], which macro use put it where it is.
//!
//! *Holds:* neither this phase nor any later one does I/O. The caller supplies the texts.

pub mod comments;
mod completion;
mod map;
mod remarks;
mod span;
mod whole;

pub(crate) use completion::is_replaced;
pub use completion::{Completion, ImportDirective, Prelude, blanked, version_line};
pub(crate) use map::{Addition, Mark};
pub use map::{
    Expansion, FileId, IncludeForm, IncludeResolver, Included, Language, Location, NoIncludes, SourceFile, SourceMap,
    line_end_length,
};
pub(crate) use remarks::is_comment;
pub use span::{ExpansionId, Span};
pub use whole::{Edits, Inclusion, Unrolled, whole_text};
