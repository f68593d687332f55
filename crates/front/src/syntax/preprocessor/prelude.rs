//! Preludes: the texts that an engine puts before a source.
//!
//! *In:* a [`Completion`], after the main file was entered and before its first token is read. *Out:* the texts are entered
//! at once, or after the source's own `#version` line. *Holds:* a prelude ends at its end, as an included file does: its
//! conditional groups are complete.

use super::{FileId, ParseSession, Preprocessor, Span};
use crate::diagnostic::{Diagnostic, codes::general};
use crate::source::{Completion, ImportDirective};

/// The preprocessor's knowledge of an engine.
#[derive(Debug, Default)]
pub(super) struct Engine {
    /// The texts that are read after the `#version` line of the main file.
    pending: Vec<FileId>,
    pub(super) directive: Option<ImportDirective>,
    pub(super) resolves_includes: bool,
    pub(super) redefines: bool,
    pub(super) unrolls: bool,
    pub(super) unroll_end: super::unroll::NextEnd,
}

impl Preprocessor<'_> {
    /// Adds what an engine puts before the main file, which was entered before.
    pub(in crate::syntax) fn complete(
        &mut self,
        session: &mut ParseSession<'_>,
        main: FileId,
        completion: &Completion,
    ) {
        self.engine.directive = completion.directive;
        self.engine.resolves_includes = completion.resolves_includes;
        self.engine.redefines = completion.redefines;
        self.engine.unrolls = completion.unrolls;
        let text = session.sources.file(main).text().clone();
        let (texts, after_version) = completion.texts(&text);
        for prelude in texts {
            let Some(file) = session.sources.add(prelude.name.clone(), prelude.text) else {
                let message = format!("there is no room for the prelude `{}`", prelude.name);
                session.report(Diagnostic::new(&general::TOO_LARGE, Span::default(), message));
                return self.stop();
            };
            self.engine.pending.push(file);
        }
        if !after_version {
            self.enter_preludes(session);
        }
    }

    /// Begins to read the preludes that wait for the `#version` line.
    pub(super) fn enter_preludes(&mut self, session: &mut ParseSession<'_>) {
        let files = std::mem::take(&mut self.engine.pending);
        self.outcome.preludes.extend(&files);
        for file in files.into_iter().rev() {
            self.enter(session, file, Span::default());
        }
    }

    /// Whether a source says by this extension that it uses the engine's own directive for includes.
    pub(super) fn is_import_extension(&self, name: &str) -> bool {
        self.engine.directive.is_some_and(|directive| directive.extension == Some(name))
    }

    /// Whether `name` is the engine's own directive for includes.
    pub(super) fn is_import(&self, name: &str) -> bool {
        self.engine.directive.is_some_and(|directive| directive.name == name)
    }
}
