//! Source texts and where things stand in them.
//!
//! *In:* named texts, and an [`IncludeResolver`] for the files that those name.
//! *Out:* a [`SourceMap`] in which every text has its range of global byte offsets, and [`Span`]s that
//! point into it. A span of eight bytes plus an expansion number tells both where a token was
//! written and, through [`ExpansionId`], which macro use brought it to its place.
//!
//! *Holds:* no I/O happens here or in any phase behind it; who compiles brings the texts.

mod map;
mod span;
mod whole;

pub use map::{Expansion, FileId, IncludeForm, IncludeResolver, Included, Location, NoIncludes, SourceFile, SourceMap};
pub use span::{ExpansionId, Span};
pub use whole::{Inclusion, whole_text};
