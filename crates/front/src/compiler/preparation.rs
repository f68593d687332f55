//! [`Preparation`]: completes each source as the engine that it was written for.
//!
//! *In:* a source, with its name and stage. *Out:* [`Prepared`]: the part of the text that is this stage's, the texts before
//! it, macros, and the resolver of its includes. *Holds:* the compiler asks once for each source, and knows no engines.

use super::Source;
use crate::diagnostic::Code;
use crate::source::{Completion, IncludeResolver, Prelude};
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

/// The settings of a host for the sources of one program, besides macros.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SourceSettings {
    /// The name of the engine that completes them.
    pub engine: Option<String>,
    /// The version of sources without a `#version` line, as that line has it.
    pub version: Option<String>,
    /// The name of the style in which they name the files that they include.
    pub include_style: Option<String>,
    /// Folders in which included files are searched.
    pub includes: Vec<String>,
    /// Texts before each source.
    pub preludes: Vec<Prelude>,
}

impl SourceSettings {
    /// Whether nothing is said.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Completes sources.
pub trait Preparation {
    /// The source as its engine completes it.
    fn prepare(&self, source: &Source) -> Prepared;

    /// This preparation for sources about which a host says more; `None` if it takes no such settings.
    fn with_settings(&self, _settings: &SourceSettings) -> Option<Arc<dyn Preparation + Send + Sync>> {
        None
    }
}

/// A change of a prepared source.
type Change = dyn Fn(&Source, Prepared) -> Prepared + Send + Sync;

/// A preparation with a change after it.
pub(super) struct Changed {
    /// The preparation; without one, what the options say.
    pub(super) inner: Option<Arc<dyn Preparation + Send + Sync>>,
    pub(super) completion: Completion,
    pub(super) change: Arc<Change>,
}

impl Preparation for Changed {
    fn prepare(&self, source: &Source) -> Prepared {
        let plain = || Prepared { completion: self.completion.clone(), ..Prepared::default() };
        let prepared = self.inner.as_ref().map_or_else(plain, |inner| inner.prepare(source));
        (self.change)(source, prepared)
    }

    fn with_settings(&self, settings: &SourceSettings) -> Option<Arc<dyn Preparation + Send + Sync>> {
        let inner = self.inner.as_ref()?.with_settings(settings)?;
        let (completion, change) = (self.completion.clone(), Arc::clone(&self.change));
        Some(Arc::new(Self { inner: Some(inner), completion, change }))
    }
}
