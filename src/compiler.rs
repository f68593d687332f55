//! [`Compiler`]: texts in, a [`Program`] and diagnostics out. The one door to the front-end.

use crate::diagnostic::Diagnostics;
use crate::hir::{Shader, Stage};
use crate::link::Program;
use crate::source::{IncludeResolver, NoIncludes, SourceMap};
use std::sync::Arc;

/// What a compilation may be told.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Macros defined before the first line: name and replacement text (`-D NAME=VALUE`).
    pub defines: Vec<(String, String)>,
    /// What the text of the specification forbids and every driver forgives is an error instead of a warning.
    pub strict: bool,
    /// `glBindAttribLocation`: name and location.
    pub attribute_locations: Vec<(String, u32)>,
    /// `glBindFragDataLocation`: name and color number.
    pub frag_data_locations: Vec<(String, u32)>,
}

/// A shader's text.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name for diagnostics, by which includes are resolved: a path as the user gave it.
    pub name: String,
    /// The text. Bytes that are no UTF-8 stand in it as U+FFFD, which is legal in comments alone.
    pub text: Arc<str>,
    /// The stage.
    pub stage: Stage,
}

/// What came of a compilation.
#[derive(Clone, Debug)]
pub struct Compilation {
    /// The name of the program: the stem of the first source's name.
    pub name: String,
    /// All texts, includes among them.
    pub sources: SourceMap,
    /// The linked program, if there are no errors.
    pub program: Option<Program>,
    /// Everything that was found.
    pub diagnostics: Diagnostics,
}

/// Compiles programs. Holds options and no state: one compiler may be used a thousand times and from many threads.
#[derive(Clone)]
pub struct Compiler {
    options: Options,
    includes: Arc<dyn IncludeResolver + Send + Sync>,
}

impl Compiler {
    /// A compiler that resolves no includes.
    pub fn new(options: Options) -> Self {
        Self { options, includes: Arc::new(NoIncludes) }
    }

    /// The same with a way to find what `#include` names.
    #[must_use]
    pub fn with_includes(self, includes: impl IncludeResolver + Send + Sync + 'static) -> Self {
        Self { includes: Arc::new(includes), ..self }
    }

    /// The options.
    pub fn options(&self) -> &Options {
        &self.options
    }
}
