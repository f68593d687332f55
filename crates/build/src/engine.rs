//! [`Engine`]: how the sources of a build are completed.
//!
//! *In:* the name of an engine, a version, preludes, search folders. *Out:* [`Completed`], which a compiler asks about each
//! source. *Holds:* what is read for it is remembered.

use super::error::BuildError;
use super::files::Reads;
use glisten_front::compiler::{Preparation, Prepared, Source, SourceSettings};
use glisten_front::diagnostic::did_you_mean;
use glisten_front::source::Prelude;
use glisten_library::is_embedded;
use glisten_sources::engines::{self, Style};
use glisten_sources::{DiskIncludes, Settings, parse_version};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The methods of a build that complete sources.
#[derive(Clone, Debug, Default)]
pub(super) struct Engine {
    pub(super) name: Option<String>,
    pub(super) version: Option<String>,
    pub(super) preludes: Vec<PathBuf>,
    pub(super) folders: Vec<PathBuf>,
}

/// Completes each source in the same way.
pub(super) struct Completed {
    settings: Settings,
    reads: Reads,
}

impl Engine {
    /// The completion of each source.
    ///
    /// # Errors
    /// A name or a version that does not exist, a prelude that cannot be read.
    pub(super) fn completed(&self, reads: &Reads) -> Result<Completed, BuildError> {
        let known = |name: &String| {
            let similar = || did_you_mean(name, engines::names()).map(str::to_owned);
            engines::find(name).ok_or_else(|| BuildError::NoEngine { name: name.clone(), similar: similar() })
        };
        let prelude =
            |path: &PathBuf| Ok(Prelude { name: path.to_string_lossy().into_owned(), text: reads.text(path)? });
        let settings = Settings {
            profile: self.name.as_ref().map(known).transpose()?,
            version: self.version.as_deref().map(parse_version).transpose().map_err(BuildError::Version)?,
            preludes: self.preludes.iter().map(prelude).collect::<Result<_, BuildError>>()?,
            folders: self.folders.clone(),
            ..Settings::default()
        };
        Ok(Completed { settings, reads: reads.clone() })
    }
}

impl Completed {
    /// The resolver of includes for sources that need no completion.
    pub(super) fn includes(&self) -> DiskIncludes {
        DiskIncludes::new(Arc::new(self.reads.clone()), self.settings.folders.clone(), Style::Quote, &[])
    }
}

impl Preparation for Completed {
    fn prepare(&self, source: &Source) -> Prepared {
        // The library's own sources need nothing.
        if is_embedded(&source.name) {
            return Prepared::default();
        }
        self.settings.clone().complete(source, Some(Path::new(&source.name)), Arc::new(self.reads.clone()))
    }

    fn with_settings(&self, settings: &SourceSettings) -> Option<Arc<dyn Preparation + Send + Sync>> {
        let settings = self.settings.clone().over(Settings::from_host(settings));
        Some(Arc::new(Self { settings, reads: self.reads.clone() }))
    }
}
