//! [`Preparation`]: completes each source as the engine that it was written for.
//!
//! *In:* a source, with its name and stage. *Out:* [`Prepared`]: the part of the text that is this stage's, the texts before
//! it, macros, and the resolver of its includes. *Holds:* the compiler asks once for each source, and knows no engines.

use super::Source;
use crate::diagnostic::Code;
use crate::source::{Completion, IncludeResolver};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Something that is wrong with a source for its engine.
#[derive(Clone, Debug)]
pub struct Problem {
    /// The code.
    pub code: &'static Code,
    /// The place in the text of the source.
    pub range: Range<usize>,
    /// The message.
    pub message: String,
    /// The help text.
    pub help: Option<String>,
}

/// A source as its engine completes it.
#[derive(Clone, Default)]
pub struct Prepared {
    /// The text of this stage, if it is not the whole text: of the same length, with the lines of other stages blank.
    pub text: Option<Arc<str>>,
    /// Macros defined before the first line. Those of [`Options`](super::Options) of the same name come instead of them.
    pub defines: Vec<(String, String)>,
    /// The version and the preludes.
    pub completion: Completion,
    /// The resolver of the source's includes, if it is not the compiler's.
    pub includes: Option<Arc<dyn IncludeResolver + Send + Sync>>,
    /// Errors.
    pub problems: Vec<Problem>,
}

impl fmt::Debug for Prepared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (text, completion) = (&self.text, &self.completion);
        f.debug_struct("Prepared").field("text", text).field("completion", completion).finish_non_exhaustive()
    }
}

/// Completes sources.
pub trait Preparation {
    /// The source as its engine completes it.
    fn prepare(&self, source: &Source) -> Prepared;
}
