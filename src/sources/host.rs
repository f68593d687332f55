//! [`completing`]: a compiler for sources about which a host says more, where no command and no build reads them.
//!
//! *In:* a compiler, [`SourceSettings`]. *Out:* the compiler that completes sources so. *Holds:* included files are read from disk, then
//! asked for as the compiler would.

use super::disk::Plain;
use super::settings::Settings;
use glisten_front::Compiler;
use glisten_front::compiler::{Preparation, Prepared, Source, SourceSettings};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::path::Path;
use std::sync::Arc;

/// The compiler for sources with these settings.
pub(crate) fn completing(compiler: Compiler, settings: &SourceSettings) -> Compiler {
    if let Some(completing) = compiler.with_settings(settings) {
        return completing;
    }
    let completed = Completed { settings: Settings::from_host(settings), includes: compiler.includes() };
    compiler.with_preparation(completed)
}

struct Completed {
    settings: Settings,
    /// The resolver of the compiler.
    includes: Arc<dyn IncludeResolver + Send + Sync>,
}

impl Preparation for Completed {
    fn prepare(&self, source: &Source) -> Prepared {
        // The library's own sources need nothing.
        if source.name.starts_with('<') {
            return Prepared::default();
        }
        let mut prepared = self.settings.clone().complete(source, Some(Path::new(&source.name)), Arc::new(Plain));
        if let Some(first) = prepared.includes.take() {
            prepared.includes = Some(Arc::new(Both { first, second: Arc::clone(&self.includes) }));
        }
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
