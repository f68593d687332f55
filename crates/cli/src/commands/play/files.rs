//! The files that the page knows: which scenes and shaders there are, saving, and what changed on disk.
//!
//! *Holds:* a file that changed since the page read it is not overwritten. Changes that follow each other closely are one.

use super::access::Folders;
use crate::files as disk;
use glisten_sources::stages;
use ignore::WalkBuilder;
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The most files that are listed.
const MAX_FILES: usize = 5_000;
/// Changes that are closer together than this are one: editors write files in several steps.
const TOGETHER: Duration = Duration::from_millis(60);

/// The scenes of a folder, and the programs that shaders with the same stem form.
pub(super) fn list(root: &str) -> Value {
    let walk = WalkBuilder::new(root).follow_links(false).build().filter_map(Result::ok);
    let files = walk.filter(|entry| entry.file_type().is_some_and(|kind| kind.is_file())).take(MAX_FILES);
    let (mut scenes, mut programs) = (Vec::new(), BTreeMap::<_, Vec<String>>::new());
    for entry in files {
        let path = entry.path();
        let name = name_of(path);
        if path.extension().is_some_and(|extension| extension == "toml") {
            let is_scene = std::fs::read_to_string(path).is_ok_and(|text| text.contains("[[draw]]"));
            scenes.extend(is_scene.then_some(name));
        } else if stages::by_name(path).is_some() {
            programs.entry((path.parent().map(Path::to_owned), stages::stem(path))).or_default().push(name);
        }
    }
    scenes.sort();
    let mut programs: Vec<Vec<String>> = programs.into_values().collect();
    programs.iter_mut().for_each(|files| files.sort());
    programs.sort();
    json!({ "scenes": scenes, "programs": programs })
}

/// The name of a path, without `./` before it.
pub(super) fn name_of(path: &Path) -> String {
    path.strip_prefix(".").unwrap_or(path).to_string_lossy().into_owned()
}

/// Why a text was not saved.
pub(super) enum NotSaved {
    /// The file lies in no folder.
    Outside,
    /// The file has another text than the page read.
    Changed,
    /// The system's reason.
    Failed(String),
}

/// Writes a text in place of `was`, or to a new file if there was none.
pub(super) fn save(folders: &Folders, name: &str, text: &str, was: Option<&str>) -> Result<(), NotSaved> {
    let path = folders.path(name).ok_or(NotSaved::Outside)?;
    let is_as_read = match (std::fs::read(&path), was) {
        (Ok(bytes), Some(was)) => String::from_utf8_lossy(&bytes) == was,
        (Ok(_), None) => false,
        (Err(_), _) => true,
    };
    if !is_as_read {
        return Err(NotSaved::Changed);
    }
    let written = disk::write(&path, text.as_bytes());
    written.map_err(|failure| match failure {
        crate::exit::Failure::Told { message, .. } => NotSaved::Failed(message),
        crate::exit::Failure::OutputClosed => NotSaved::Failed("it cannot be written".into()),
    })
}

/// How often files changed.
#[derive(Default)]
struct Count {
    number: Mutex<u64>,
    changed: Condvar,
}

/// Watches folders.
pub(super) struct Changes {
    count: Arc<Count>,
    /// Watches as long as it lives.
    _watcher: Option<RecommendedWatcher>,
}

impl Changes {
    /// Watches folders from now on. Where the system does not tell of changes, there are none.
    pub(super) fn watch(folders: &Folders) -> Self {
        let count = Arc::new(Count::default());
        let told = Arc::clone(&count);
        let note = move |event: notify::Result<Event>| {
            let counts = |event: &Event| !matches!(event.kind, EventKind::Access(_) | EventKind::Other);
            if event.as_ref().is_ok_and(counts) {
                *told.number.lock().unwrap_or_else(PoisonError::into_inner) += 1;
                told.changed.notify_all();
            }
        };
        let watcher = notify::recommended_watcher(note).ok().map(|mut watcher| {
            for folder in folders.iter() {
                // Without it, the page shows changes when it is loaded again.
                let _ = watcher.watch(folder, RecursiveMode::Recursive);
            }
            watcher
        });
        Self { count, _watcher: watcher }
    }

    /// Waits until the number of changes is another than `since`, at most for `limit`. The number then.
    pub(super) fn after(&self, since: u64, limit: Duration) -> u64 {
        let end = Instant::now() + limit;
        let mut number = self.count.number.lock().unwrap_or_else(PoisonError::into_inner);
        while *number == since {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return since;
            }
            number = self.count.changed.wait_timeout(number, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        drop(number);
        std::thread::sleep(TOGETHER);
        *self.count.number.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::{Changes, Folders, NotSaved, list, save};
    use std::time::Duration;

    #[test]
    fn scenes_and_programs_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        for (name, text) in
            [("b.toml", "[[draw]]"), ("other.toml", ""), ("a.vert", ""), ("a.frag", ""), ("note.txt", "")]
        {
            std::fs::write(path(name), text).expect("it can be written");
        }
        let listed = list(&folder.path().to_string_lossy());
        let name = |name: &str| path(name).to_string_lossy().into_owned();
        assert_eq!(listed["scenes"], serde_json::json!([name("b.toml")]));
        assert_eq!(listed["programs"], serde_json::json!([[name("a.frag"), name("a.vert")]]));
    }

    #[test]
    fn what_changed_meanwhile_is_not_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = Folders::default();
        folders.add(folder.path());
        let path = folder.path().join("a.frag");
        let name = path.to_string_lossy().into_owned();
        assert!(save(&folders, &name, "one", None).is_ok());
        assert!(save(&folders, &name, "two", Some("one")).is_ok());
        assert!(matches!(save(&folders, &name, "three", Some("one")), Err(NotSaved::Changed)));
        assert!(matches!(save(&folders, &name, "three", None), Err(NotSaved::Changed)));
        assert!(matches!(save(&folders, "/etc/a.frag", "", None), Err(NotSaved::Outside)));
        assert_eq!(std::fs::read_to_string(path).expect("it is there"), "two");
    }

    #[test]
    fn changes_are_counted() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = Folders::default();
        folders.add(folder.path());
        let changes = Changes::watch(&folders);
        assert_eq!(changes.after(0, Duration::from_millis(1)), 0);
        std::fs::write(folder.path().join("a.frag"), "").expect("it can be written");
        assert!(changes.after(0, Duration::from_secs(20)) > 0);
    }
}
