//! [`Includes`]: finds the files that `#include` names: by the host's own function, in folders, in the library.
//!
//! *Holds:* `"x"` is searched next to the including file, then in the folders in order; `<x>` in the folders, then among the
//! modules of the library. The host's function is asked first.

use crate::paths::joined;
use glisten::library::Embedded;
use glisten::source::{IncludeForm, IncludeResolver, Included};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The answer of a host that was asked for an included file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// It is this one.
    Found {
        /// The name for diagnostics, and for resolving the includes of that file.
        name: String,
        /// The text.
        text: String,
    },
    /// There is none, for this reason.
    Missing(String),
    /// The folders and the library are to be searched.
    Pass,
}

/// A host's function: the path of the include, whether it is in angle brackets, and the name of the including file.
type Ask = Arc<dyn Fn(&str, bool, &str) -> Answer + Send + Sync>;

/// Where included files are looked for.
#[derive(Clone, Default)]
pub struct Includes {
    /// The folders of the search path.
    pub folders: Vec<PathBuf>,
    /// The host's own function.
    pub ask: Option<Ask>,
    /// Whether the disk is left alone: only the host and the library are asked.
    pub in_memory: bool,
}

impl Includes {
    /// Looks among these files of the host, too, after its function: next to the including file, then from the root. Their paths are
    /// without `.` and `..`.
    pub fn look_in(&mut self, files: Arc<BTreeMap<String, Vec<u8>>>) {
        let inner = self.ask.take();
        self.ask = Some(Arc::new(move |path, angled, from| {
            match inner.as_ref().map_or(Answer::Pass, |ask| ask(path, angled, from)) {
                Answer::Pass => {}
                told => return told,
            }
            let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
            let near = (!angled && !path.starts_with('/')).then(|| joined(folder, path));
            let names = near.into_iter().chain([joined("", path)]);
            let found = names.into_iter().find_map(|name| Some((files.get(&name)?, name)));
            found.map_or(Answer::Pass, |(bytes, name)| Answer::Found {
                name,
                text: String::from_utf8_lossy(bytes).into_owned(),
            })
        }));
    }

    fn on_disk(&self, path: &str, form: IncludeForm, from: &str) -> Option<Result<Included, String>> {
        if self.in_memory {
            return None;
        }
        let inner = path.trim_start_matches('/');
        let own = Path::new(from).parent().filter(|_| form == IncludeForm::Quoted && inner == path);
        let folders = self.folders.iter().map(PathBuf::as_path);
        let mut candidates = own.into_iter().chain(folders).map(|folder| folder.join(inner));
        let found = candidates.find(|candidate| candidate.is_file())?;
        let name = found.to_string_lossy().into_owned();
        Some(match std::fs::read(&found) {
            Ok(bytes) => Ok(Included { name, text: String::from_utf8_lossy(&bytes).into() }),
            Err(error) => Err(format!("`{name}` cannot be read: {error}")),
        })
    }
}

impl IncludeResolver for Includes {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        if let (IncludeForm::Quoted, Some(module)) = (form, Embedded::find(path, form, from)) {
            return Ok(module);
        }
        match self.ask.as_ref().map_or(Answer::Pass, |ask| ask(path, form == IncludeForm::Angled, from)) {
            Answer::Found { name, text } => return Ok(Included { name, text: text.into() }),
            Answer::Missing(reason) => return Err(reason),
            Answer::Pass => {}
        }
        self.on_disk(path, form, from).unwrap_or_else(|| Embedded.resolve(path, form, from))
    }
}
