//! The files that the page knows: which scenes and shaders there are, saving, and what changed on disk.
//!
//! *Holds:* a file that changed since the page read it is not overwritten, and no file whose bytes are not UTF-8: the page has none of
//! its other bytes. Changes that follow each other closely are one.

use super::access::Folders;
use crate::files as disk;
use glisten_front::Stage;
use glisten_sources::stages;
use ignore::WalkBuilder;
use notify::{Event, EventKind, RecommendedWatcher, RecursiveMode, Watcher};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
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
    let drawable: Vec<&Vec<String>> = programs.iter().filter(|files| files.iter().any(is_fragment)).collect();
    json!({ "scenes": scenes, "programs": programs, "drawable": drawable })
}

fn is_fragment(name: &String) -> bool {
    stages::by_name(Path::new(name)) == Some(Stage::Fragment)
}

/// The files of the program that a shader belongs to.
pub(super) fn program_of(root: &str, shader: &str) -> Vec<String> {
    let listed = list(root);
    let programs = listed.get("programs").cloned().and_then(|all| serde_json::from_value::<Vec<Vec<String>>>(all).ok());
    let own = programs.into_iter().flatten().find(|files| files.iter().any(|name| name == shader));
    own.unwrap_or_else(|| vec![shader.to_owned()])
}

/// A name for a new scene of a shader: `a.toml`, or what is free.
pub(super) fn free_name(shader: &str) -> String {
    let path = Path::new(shader);
    let stem = stages::stem(path);
    let named = |name: String| path.with_file_name(name + ".toml");
    let others = (2..).map(|number| format!("{stem}-scene-{number}"));
    let mut names = [stem.clone(), format!("{stem}-scene")].into_iter().chain(others).map(named);
    let free = names.find(|path| std::fs::symlink_metadata(path).is_err());
    free.map_or_else(String::new, |path| path.to_string_lossy().into_owned())
}

/// The name of a path, without `.` in it.
pub(super) fn name_of(path: &Path) -> String {
    let plain: PathBuf = path.components().filter(|part| *part != Component::CurDir).collect();
    plain.to_string_lossy().into_owned()
}

/// The mark of old systems for the end of a file, which is not a part of its text.
const END_OF_FILE: &str = "\x1a";

/// The reason why the page may not change a file, if there is one.
pub(super) fn fixed(folders: &Folders, name: &str) -> Option<&'static str> {
    let Some(path) = folders.path(name) else { return Some("it is in none of the folders of `glisten play`") };
    let is_text = std::fs::read(path).map_or(true, |bytes| std::str::from_utf8(&bytes).is_ok());
    (!is_text).then_some(NOT_TEXT)
}

/// The reason for a file whose bytes the page does not have.
pub(super) const NOT_TEXT: &str = "its bytes are not UTF-8";

/// Why a text was not saved.
pub(super) enum NotSaved {
    /// The file lies in no folder.
    Outside,
    /// The file has another text than the page read: this one.
    Changed(String),
    /// The file's bytes are not UTF-8.
    NotText,
    /// The system's reason.
    Failed(String),
}

/// Writes a text in place of `was`, or to a new file if there was none.
pub(super) fn save(folders: &Folders, name: &str, text: &str, was: Option<&str>) -> Result<(), NotSaved> {
    let path = folders.path(name).ok_or(NotSaved::Outside)?;
    let mut text = text.to_owned();
    if let Ok(bytes) = std::fs::read(&path) {
        let now = String::from_utf8(bytes).map_err(|_| NotSaved::NotText)?;
        let read = now.strip_suffix(END_OF_FILE).unwrap_or(&now);
        if was != Some(now.as_str()) && was != Some(read) {
            return Err(NotSaved::Changed(now));
        }
        // The page has not read it.
        text.push_str(if was == Some(now.as_str()) || read.len() == now.len() { "" } else { END_OF_FILE });
    }
    let written = disk::write(&path, text.as_bytes());
    written.map_err(|failure| NotSaved::Failed(failure.message))
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
    watcher: Mutex<Option<RecommendedWatcher>>,
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
        let changes = Self { count, watcher: Mutex::new(notify::recommended_watcher(note).ok()) };
        folders.iter().for_each(|folder| changes.add(folder));
        changes
    }

    /// Watches another folder.
    pub(super) fn add(&self, folder: &Path) {
        if let Some(watcher) = &mut *self.watcher.lock().unwrap_or_else(PoisonError::into_inner) {
            // Without it, the page shows changes when it is loaded again.
            let _ = watcher.watch(folder, RecursiveMode::Recursive);
        }
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
    use super::{Changes, Folders, NotSaved, fixed, free_name, list, name_of, program_of, save};
    use std::path::Path;
    use std::time::Duration;

    #[test]
    fn scenes_and_programs_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        for (name, text) in [
            ("b.toml", "[[draw]]"),
            ("other.toml", ""),
            ("a.vert", ""),
            ("a.frag", ""),
            ("note.txt", ""),
            ("c.glslf", ""),
            ("d.vert", ""),
        ] {
            std::fs::write(path(name), text).expect("it can be written");
        }
        let listed = list(&folder.path().to_string_lossy());
        let name = |name: &str| path(name).to_string_lossy().into_owned();
        assert_eq!(listed["scenes"], serde_json::json!([name("b.toml")]));
        let own = [name("a.frag"), name("a.vert")];
        assert_eq!(listed["programs"], serde_json::json!([own, [name("c.glslf")], [name("d.vert")]]));
        assert_eq!(listed["drawable"], serde_json::json!([own, [name("c.glslf")]]));
        assert_eq!(program_of(&folder.path().to_string_lossy(), &name("a.vert")), own);
        assert_eq!(program_of(&folder.path().to_string_lossy(), "none.frag"), ["none.frag"]);
    }

    #[test]
    fn new_scenes_have_names_that_are_free() {
        let folder = tempfile::tempdir().expect("a folder");
        let name = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
        for expected in ["a.toml", "a-scene.toml", "a-scene-2.toml", "a-scene-3.toml"] {
            assert_eq!(free_name(&name("a.frag")), name(expected));
            std::fs::write(name(expected), "").expect("it can be written");
        }
        assert_eq!(name_of(Path::new("./x/./a.toml")), "x/a.toml");
    }

    #[test]
    fn bytes_that_are_not_utf8_are_not_lost() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = Folders::default();
        assert!(folders.add(folder.path()).is_some());
        let path = folder.path().join("a.frag");
        let name = path.to_string_lossy().into_owned();
        assert_eq!(fixed(&folders, &name), None, "it is new");
        let bytes = b"// caf\xe9\n";
        std::fs::write(&path, bytes).expect("it can be written");
        assert!(matches!(save(&folders, &name, "new", Some("// caf\u{fffd}\n")), Err(NotSaved::NotText)));
        assert!(fixed(&folders, &name).is_some() && fixed(&folders, "/etc/a.frag").is_some());
        assert_eq!(std::fs::read(&path).expect("it is there"), bytes);
        std::fs::write(&path, "one\n\x1a").expect("it can be written");
        assert!(save(&folders, &name, "two\n", Some("one\n")).is_ok());
        assert_eq!(std::fs::read(&path).expect("it is there"), b"two\n\x1a");
    }

    #[test]
    fn what_changed_meanwhile_is_not_overwritten() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = Folders::default();
        assert!(folders.add(folder.path()).is_some());
        let path = folder.path().join("a.frag");
        let name = path.to_string_lossy().into_owned();
        assert!(save(&folders, &name, "one", None).is_ok());
        assert!(save(&folders, &name, "two", Some("one")).is_ok());
        assert!(matches!(save(&folders, &name, "three", Some("one")), Err(NotSaved::Changed(now)) if now == "two"));
        assert!(matches!(save(&folders, &name, "three", None), Err(NotSaved::Changed(now)) if now == "two"));
        assert!(matches!(save(&folders, "/etc/a.frag", "", None), Err(NotSaved::Outside)));
        assert_eq!(std::fs::read_to_string(path).expect("it is there"), "two");
    }

    #[test]
    fn changes_are_counted() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut folders = Folders::default();
        assert!(folders.add(folder.path()).is_some());
        let changes = Changes::watch(&folders);
        assert_eq!(changes.after(0, Duration::from_millis(1)), 0);
        std::fs::write(folder.path().join("a.frag"), "").expect("it can be written");
        assert!(changes.after(0, Duration::from_secs(20)) > 0);
    }
}
