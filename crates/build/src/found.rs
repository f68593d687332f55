//! [`Found`]: the compiled programs of a build.
//!
//! *In:* programs, and diagnostics of those that did not compile. *Out:* both, for the module or the message.

use glisten_front::Program;
use glisten_front::diagnostic::write::human;
use glisten_front::diagnostic::{Diagnostic, Diagnostics, Severity};
use glisten_front::source::SourceMap;
use glisten_library::is_embedded;

/// A program that was compiled, with its texts.
pub(super) struct Compiled {
    pub(super) name: String,
    pub program: Program,
    pub sources: SourceMap,
}

/// The programs of a build, and what there is to say about them.
#[derive(Default)]
pub(super) struct Found {
    pub(super) programs: Vec<Compiled>,
    /// The names of all, also of those with errors.
    pub(super) names: Vec<String>,
    /// All errors, as `glisten lint` prints them.
    pub(super) errors: String,
    /// Warnings, a line each.
    pub(super) warnings: Vec<String>,
}

impl Found {
    /// Takes over diagnostics. Returns whether there is no error among them.
    pub(super) fn hears(&mut self, sources: &SourceMap, diagnostics: &Diagnostics) -> bool {
        let failed = diagnostics.has_errors();
        if failed {
            self.errors.push_str(&human(sources, diagnostics, false));
        } else {
            self.warnings.extend(diagnostics.iter().filter_map(|found| warning(sources, found)));
        }
        !failed
    }

    /// Adds a program without errors.
    pub(super) fn add(&mut self, name: String, program: Program, sources: SourceMap) {
        self.names.push(name.clone());
        self.programs.push(Compiled { name, program, sources });
    }
}

/// A warning in a line, unless it is about a module of the library.
fn warning(sources: &SourceMap, found: &Diagnostic) -> Option<String> {
    let place = sources.location(found.primary.span)?;
    let file = sources.file(place.file).name();
    let told = found.severity == Severity::Warning && !is_embedded(file);
    told.then(|| format!("{file}:{}:{}: {} [{}]", place.line, place.column, found.message, found.code))
}
