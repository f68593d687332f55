//! [`completing`]: a compiler for sources about which a host says more, where no command and no build reads them.
//!
//! *In:* a compiler, [`SourceSettings`]. *Out:* the compiler that completes sources so. *Holds:* [`Search`] says where included
//! files are.

use super::disk::Plain;
use super::settings::Settings;
use glisten_front::Compiler;
use glisten_front::compiler::{Preparation, Prepared, Source, SourceSettings};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::path::Path;
use std::sync::Arc;

/// Where the files that sources include are searched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Search {
    /// On disk as the engine does, then as the compiler does.
    EngineFirst,
    /// As the compiler does, then on disk as the engine does.
    CompilerFirst,
    /// As the compiler does: nothing is read from disk.
    CompilerAlone,
}

/// The compiler for sources with these settings: it completes them as their engine does.
///
/// ```
/// use glisten_front::compiler::SourceSettings;
/// use glisten_front::{Compiler, Options, Source, Stage};
/// use glisten_sources::{Search, completing};
///
/// let settings = SourceSettings { engine: Some("three".into()), ..SourceSettings::default() };
/// let compiler = completing(Compiler::new(Options::default()), &settings, Search::CompilerAlone);
/// let text = "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }";
/// let source = Source { name: "a.vert".into(), text: text.into(), stage: Stage::Vertex };
/// assert!(compiler.compile(&[source]).program.is_some());
/// ```
pub fn completing(compiler: Compiler, settings: &SourceSettings, search: Search) -> Compiler {
    if let Some(completing) = compiler.with_settings(settings) {
        return completing;
    }
    let completed = Completed { settings: Settings::from_host(settings), includes: compiler.includes(), search };
    compiler.with_preparation(completed)
}

struct Completed {
    settings: Settings,
    /// The resolver of the compiler.
    includes: Arc<dyn IncludeResolver + Send + Sync>,
    search: Search,
}

impl Preparation for Completed {
    fn prepare(&self, source: &Source) -> Prepared {
        // The library's own sources need nothing.
        if source.name.starts_with('<') {
            return Prepared::default();
        }
        let mut prepared = self.settings.clone().complete(source, Some(Path::new(&source.name)), Arc::new(Plain));
        let of_compiler = || Arc::clone(&self.includes);
        prepared.includes = prepared.includes.take().and_then(|of_engine| match self.search {
            Search::EngineFirst => Some(Arc::new(Both { first: of_engine, second: of_compiler() }) as _),
            Search::CompilerFirst => Some(Arc::new(Both { first: of_compiler(), second: of_engine }) as _),
            Search::CompilerAlone => None,
        });
        prepared
    }
}

/// One resolver after another.
struct Both {
    first: Arc<dyn IncludeResolver + Send + Sync>,
    second: Arc<dyn IncludeResolver + Send + Sync>,
}

impl IncludeResolver for Both {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        self.first.resolve(path, form, from).or_else(|error| self.second.resolve(path, form, from).map_err(|_| error))
    }
}
