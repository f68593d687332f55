//! [`Asked`]: included files by their names, and those that the host is to be asked for.

use glisten_binding::{Answer, joined};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// An answer of the host: the include that it was asked for, and its text if there is one, with the name that tells it from others.
#[derive(Clone, Deserialize)]
pub(crate) struct Found {
    path: String,
    angled: bool,
    from: String,
    name: Option<String>,
    text: Option<String>,
}

/// Paths, whether they are in angle brackets, and the files that include them.
type Wanted = Vec<(String, bool, String)>;

/// The includes that a call needed and did not have.
#[derive(Clone)]
pub(crate) struct Asked {
    asks: bool,
    wanted: Arc<Mutex<Wanted>>,
}

impl Asked {
    /// Nothing is missing yet.
    pub(crate) fn new(asks: bool) -> Self {
        Self { asks, wanted: Arc::default() }
    }

    /// Looks for a file next to the including one, then from the root.
    pub(crate) fn resolve(
        &self,
        files: &BTreeMap<String, String>,
        answers: &[Found],
        path: &str,
        angled: bool,
        from: &str,
    ) -> Answer {
        self.resolve_in(&[], files, answers, path, angled, from)
    }

    /// Looks for a file next to the including one, then in folders, then from the root.
    pub(crate) fn resolve_in(
        &self,
        folders: &[String],
        files: &BTreeMap<String, String>,
        answers: &[Found],
        path: &str,
        angled: bool,
        from: &str,
    ) -> Answer {
        let folder = from.rsplit_once('/').map_or("", |(folder, _)| folder);
        let near = if angled || path.starts_with('/') { None } else { Some(joined(folder, path)) };
        let along = folders.iter().map(|folder| joined(folder, path));
        let candidates = near.into_iter().chain(along).chain([joined("", path), path.to_owned()]);
        for name in candidates {
            if let Some(text) = files.get(&name) {
                return Answer::Found { name, text: text.clone() };
            }
        }
        let is_it = |one: &&Found| one.path == path && one.angled == angled && one.from == from;
        match answers.iter().find(is_it) {
            Some(Found { name, text: Some(text), .. }) => {
                Answer::Found { name: name.clone().unwrap_or_else(|| path.to_owned()), text: text.clone() }
            }
            Some(_) => Answer::Pass,
            None => {
                if self.asks {
                    let mut wanted = self.wanted.lock().unwrap_or_else(PoisonError::into_inner);
                    wanted.push((path.to_owned(), angled, from.to_owned()));
                }
                Answer::Pass
            }
        }
    }

    /// What the host is to be asked for; none if the call had everything.
    pub(crate) fn wanted(&self) -> Option<Value> {
        let wanted = self.wanted.lock().unwrap_or_else(PoisonError::into_inner);
        let one =
            |(path, angled, from): &(String, bool, String)| json!({ "path": path, "angled": angled, "from": from });
        (!wanted.is_empty()).then(|| wanted.iter().map(one).collect())
    }
}
