//! [`DiskIncludes`]: finds the files that `#include` names on disk.
//!
//! *Holds:* `"x"` is searched next to the including file, then in the `-I` folders in order; `<x>` in the `-I`
//! folders, then among the embedded modules (`<glisten/phong.glsl>`). A path that begins with `/`, as all of
//! ARB_shading_language_include do, starts at an `-I` folder, or else at the root of the disk. An engine's style may try
//! several paths below each folder, and the folders above the including file. The name of an included file is the path under
//! which it was found, so that diagnostics and depfiles show a path that opens.

use super::disk::Disk;
use crate::engines::{Lookup, Style};
use glisten_front::source::{IncludeForm, IncludeResolver, Included, blanked, version_line};
use glisten_library::Embedded;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::fs::DirEntry;
use std::ops::Range;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// The largest number of files below a search folder among which one is found by its name alone.
const MAX_FILES: usize = 50_000;
/// The largest number of files near a source among which a missing include is looked for, in each folder above it.
const MAX_NEARBY: usize = 2_000;
/// The largest number of imported files whose versions are read for a source.
const MAX_IMPORTED: usize = 2_000;
/// How many folders above a source are searched for a missing include.
const NEARBY: usize = 2;
/// The largest number of places that are told of a file that is nowhere.
const MAX_LOOKED: usize = 4;
/// Folders in folders deeper than this are not searched: they are links in a circle.
const DEEPEST: usize = 32;

/// Finds files next to the including one and along a search path.
#[derive(Clone)]
pub struct DiskIncludes {
    disk: Arc<dyn Disk>,
    folders: Vec<PathBuf>,
    lookup: &'static Lookup,
    /// The names of folders above an including file that are search folders, too.
    roots: Vec<String>,
    /// All files below the search folders by their names, if the style looks there.
    below: Arc<OnceLock<BTreeMap<String, PathBuf>>>,
    /// The files near sources, which many missing includes look through.
    seen: Arc<Seen>,
}

impl DiskIncludes {
    /// A resolver that searches `folders`, and the folders called `roots` above an including file, in the style of an engine.
    pub fn new(disk: Arc<dyn Disk>, folders: Vec<PathBuf>, style: Style, roots: &[String]) -> Self {
        Self {
            disk,
            folders,
            lookup: style.lookup(),
            roots: roots.to_vec(),
            below: Arc::default(),
            seen: Arc::default(),
        }
    }

    /// The folders above a file in which its includes are searched.
    fn above(&self, from: &str) -> Vec<PathBuf> {
        let names: Vec<&str> =
            self.roots.iter().map(String::as_str).chain(self.lookup.ancestors.iter().copied()).collect();
        let is_root = |folder: &&Path| {
            folder.file_name().and_then(|name| name.to_str()).is_some_and(|name| names.contains(&name))
        };
        let mut above: Vec<PathBuf> = Path::new(from).ancestors().skip(1).filter(is_root).map(Path::to_owned).collect();
        if above.is_empty() && !names.is_empty() {
            // The command may run inside of the folder.
            let absolute = std::path::absolute(from).unwrap_or_default();
            above.extend(absolute.ancestors().skip(1).filter(is_root).map(Path::to_owned));
        }
        if let Some(mark) = self.lookup.mark {
            let whole = |folder: &&Path| !folder.as_os_str().is_empty() && folder.join(mark).is_file();
            above.extend(Path::new(from).ancestors().skip(1).filter(whole).map(Path::to_owned));
        }
        above
    }

    fn candidates(&self, path: &str, form: IncludeForm, from: &str) -> Vec<PathBuf> {
        let above = self.above(from);
        let folder = Path::new(from).parent().unwrap_or(Path::new(""));
        let from_here = |path: &str| {
            let paths = self.lookup.paths_from_here(path);
            paths.iter().map(|path| normal(&folder.join(path))).collect::<Vec<_>>()
        };
        let along = |path: &str| {
            let paths = self.lookup.paths(path);
            let below = |folder: &PathBuf| paths.iter().map(|path| normal(&folder.join(path))).collect::<Vec<_>>();
            let given = self.folders.iter().flat_map(below);
            if self.lookup.own_first {
                // A path that names the namespace comes before one that does not, wherever it is.
                let own = paths.iter().flat_map(|path| above.iter().map(move |folder| normal(&folder.join(path))));
                return own.chain(from_here(path)).chain(given).collect::<Vec<_>>();
            }
            given.chain(above.iter().flat_map(below)).collect()
        };
        let inner = path.trim_start_matches('/');
        if inner != path {
            return along(inner).into_iter().chain([normal(Path::new(path))]).collect();
        }
        let own = (form == IncludeForm::Quoted).then(|| normal(&folder.join(path)));
        own.into_iter().chain(along(path)).chain(from_here(path)).collect()
    }

    /// The file with this name anywhere below the search folders, if the style looks there.
    fn deep(&self, path: &str) -> Option<&PathBuf> {
        let name = Path::new(path).file_name()?.to_str()?;
        if self.lookup.deep {
            // A whole tree of folders was looked through.
            self.disk.searched();
        }
        self.lookup.deep.then(|| self.below.get_or_init(|| files_below(&self.folders)).get(name)).flatten()
    }

    /// The first of some candidates that is there. All that were looked for in vain are told to the disk.
    fn first_there<'c>(&self, candidates: &'c [PathBuf]) -> Option<&'c PathBuf> {
        // A chunk may have the name of a folder next to its file.
        let several = self.lookup.patterns.len() > 1;
        candidates.iter().find(|candidate| {
            self.disk.looked_for(candidate);
            if several { candidate.is_file() } else { candidate.exists() }
        })
    }

    /// The place of a source's `#version` line, and the version that it has, if a file that it imports has a higher one. Only for a
    /// style that ignores the `#version` lines of included files: the engine takes the highest number of all.
    pub(crate) fn lifted_version(&self, source: &str, from: &str) -> Option<(Range<usize>, String)> {
        let line = version_line(source).filter(|_| self.lookup.drops_version)?;
        let (own, profile) = version_of(source.get(line.clone())?)?;
        let highest = self.highest_version(source, from);
        (highest > own && profile != "es").then(|| (line, format!("{highest} {profile}").trim().to_owned()))
    }

    /// The highest version of the files that a text includes, and of those that these include; 0 if none has one.
    fn highest_version(&self, source: &str, from: &str) -> u16 {
        let mut open: Vec<(String, IncludeForm, String)> = named_files(source, from);
        let mut seen: BTreeSet<PathBuf> = BTreeSet::new();
        let mut highest = 0;
        while let Some((path, form, from)) = open.pop() {
            let candidates = self.candidates(&path, form, &from);
            let Some(found) = self.first_there(&candidates).cloned() else { continue };
            if seen.len() >= MAX_IMPORTED || !seen.insert(found.clone()) {
                continue;
            }
            let Ok(text) = self.disk.text(&found) else { continue };
            let line = version_line(&text).and_then(|line| version_of(text.get(line)?));
            highest = highest.max(line.map_or(0, |(number, _)| number));
            open.extend(named_files(&text, &found.to_string_lossy()));
        }
        highest
    }

    /// The text of a file, as the style reads it.
    fn read(&self, path: &Path) -> Result<Included, String> {
        let name = path.to_string_lossy().into_owned();
        let text = self.disk.text(path)?;
        let text = if name.ends_with(".js") { in_backquotes(&text) } else { text };
        let version = if self.lookup.drops_version { version_line(&text) } else { None };
        let text = version.map_or(text.clone(), |line| blanked(&text, &[line]));
        Ok(Included { name, text })
    }
}

/// The number and the profile of a `#version` line.
fn version_of(line: &str) -> Option<(u16, &str)> {
    let mut words = line.trim_start_matches('#').trim_start().strip_prefix("version")?.split_whitespace();
    Some((words.next()?.parse().ok()?, words.next().unwrap_or("")))
}

/// The files that the directives of a text name, with the name of the text. Conditions are not looked at.
fn named_files(text: &str, from: &str) -> Vec<(String, IncludeForm, String)> {
    let named = |line: &str| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start();
        let rest = rest.strip_prefix("moj_import").or(rest.strip_prefix("include"))?.trim_start();
        let (form, end) = if rest.starts_with('<') { (IncludeForm::Angled, '>') } else { (IncludeForm::Quoted, '"') };
        let name = rest.get(1..)?.split(end).next()?;
        Some((name.to_owned(), form, from.to_owned()))
    };
    text.lines().filter_map(named).collect()
}

/// The files below folders, by their names; of several, the first in order. Hidden folders are left out.
fn files_below(folders: &[PathBuf]) -> BTreeMap<String, PathBuf> {
    let mut files = BTreeMap::new();
    for path in folders.iter().flat_map(|folder| walk(folder, MAX_FILES)) {
        if let Some(name) = path.file_name() {
            files.entry(name.to_string_lossy().into_owned()).or_insert_with(|| normal(&path));
        }
    }
    files
}

/// How long the files below a folder are known.
const FRESH: Duration = Duration::from_secs(2);

/// The files below a folder by their last name, those of one name in order, and when they were listed.
type Listed = (Instant, Arc<BTreeMap<OsString, Vec<PathBuf>>>);

/// The files below folders.
#[derive(Default)]
struct Seen(Mutex<BTreeMap<PathBuf, Listed>>);

impl Seen {
    /// The files of a folder and of those below it.
    fn files(&self, folder: &Path) -> Arc<BTreeMap<OsString, Vec<PathBuf>>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, files)) = known.get(folder).filter(|(listed, _)| listed.elapsed() < FRESH) {
            return Arc::clone(files);
        }
        let mut files: BTreeMap<OsString, Vec<PathBuf>> = BTreeMap::new();
        for path in walk(folder, MAX_NEARBY).iter().map(|path| normal(path)) {
            if let Some(name) = path.file_name() {
                files.entry(name.to_owned()).or_default().push(path);
            }
        }
        let files = Arc::new(files);
        known.retain(|_, (listed, _)| listed.elapsed() < FRESH);
        known.insert(folder.to_owned(), (Instant::now(), Arc::clone(&files)));
        files
    }

    /// The file that a missing include may mean: below the folders that the source is in, up to the working directory, the nearest
    /// first.
    fn nearest(&self, wanted: &Path, from: &str) -> Option<PathBuf> {
        let folder = Path::new(from).parent().unwrap_or(Path::new(""));
        let here = [Path::new("")].into_iter().filter(|_| !folder.is_absolute());
        // Above that, there may be a whole disk.
        let is_root = |folder: &Path| folder.as_os_str().is_empty() || folder.parent().is_none();
        let above = folder.ancestors().filter(|folder| !is_root(folder)).take(NEARBY);
        let shown = |folder: &Path| if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder.to_owned() };
        let mut folders = above.chain(here);
        let name = wanted.file_name()?;
        folders.find_map(|folder| {
            let files = self.files(&shown(folder));
            files.get(name)?.iter().find(|file| file.ends_with(wanted)).cloned()
        })
    }
}

/// The files of a folder and of those below it, in order, at most `most`, and at most as many folders.
fn walk(folder: &Path, most: usize) -> Vec<PathBuf> {
    let (mut files, mut open, mut n_seen) = (Vec::new(), vec![(folder.to_owned(), true, 0)], 0);
    while let Some((path, is_folder, depth)) = open.pop() {
        n_seen += 1;
        if files.len() >= most || n_seen > most * 2 {
            break;
        }
        if !is_folder {
            files.push(path);
            continue;
        }
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        if depth > 0 && (is_hidden || depth > DEEPEST) {
            continue;
        }
        let mut entries: Vec<(PathBuf, bool)> =
            std::fs::read_dir(&path).into_iter().flatten().flatten().filter_map(|entry| kind(&entry)).collect();
        // The last one is looked at first.
        entries.sort_by(|(a, _), (b, _)| b.as_os_str().cmp(a.as_os_str()));
        open.extend(entries.into_iter().map(|(path, is_folder)| (path, is_folder, depth + 1)));
    }
    files
}

/// The path of an entry of a folder, and whether it is a folder; nothing for what is neither a file nor a folder. Links are followed.
fn kind(entry: &DirEntry) -> Option<(PathBuf, bool)> {
    let (path, kind) = (entry.path(), entry.file_type().ok()?);
    let (is_file, is_folder) =
        if kind.is_symlink() { (path.is_file(), path.is_dir()) } else { (kind.is_file(), kind.is_dir()) };
    (is_file || is_folder).then_some((path, is_folder))
}

/// The text of a module of JavaScript between its first and its last backquote; everything else is blank.
fn in_backquotes(text: &str) -> Arc<str> {
    match (text.find('`'), text.rfind('`')) {
        (Some(first), Some(last)) if first < last => blanked(text, &[0..first + 1, last..text.len()]),
        _ => text.into(),
    }
}

impl IncludeResolver for DiskIncludes {
    fn remedy(&self, path: &str, from: &str) -> Option<String> {
        let wanted: PathBuf = normal(Path::new(path.trim_start_matches('/')));
        if wanted.as_os_str().is_empty() {
            return None;
        }
        let found = self.seen.nearest(&wanted, from)?;
        let folder = found.ancestors().nth(wanted.components().count())?;
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        Some(format!("found in `{0}`: add `-I {0}`", folder.display()))
    }

    fn finds_no_text(&self, path: &str, form: IncludeForm, from: &str) -> bool {
        let candidates = self.candidates(path, form, from);
        let found = self.first_there(&candidates).or_else(|| self.deep(path));
        found.is_some_and(|found| self.disk.is_binary(found))
    }

    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        if normal(Path::new(path)).as_os_str().is_empty() {
            return Err("an include names no file".to_owned());
        }
        if let (IncludeForm::Quoted, Some(module)) = (form, Embedded::find(path, form, from)) {
            return Ok(module);
        }
        let candidates = self.candidates(path, form, from);
        if let Some(found) = self.first_there(&candidates).or_else(|| self.deep(path)) {
            return self.read(found);
        }
        if let Some(module) = Embedded::find(path, form, from) {
            return Ok(module);
        }
        if form == IncludeForm::Angled && path.starts_with("glisten/") {
            return Err(glisten_library::missing(path));
        }
        let mut looked: Vec<String> = Vec::new();
        for shown in candidates.iter().map(|candidate| format!("`{}`", candidate.display())) {
            if !looked.contains(&shown) {
                looked.push(shown);
            }
        }
        let more = looked.len().saturating_sub(MAX_LOOKED);
        looked.truncate(MAX_LOOKED);
        Err(match (looked.len(), more) {
            (0, _) => format!("`<{path}>` is looked for along -I alone, and no folder is given"),
            (_, 0) => format!("there is no {}", looked.join(" and no ")),
            (_, more) => format!("there is no {}, and none at {more} more places", looked.join(" and no ")),
        })
    }
}

/// The path without `.` and without `x/..`, as far as that is possible without reading the disk (a leading `..`
/// stays).
pub fn normal(path: &Path) -> PathBuf {
    let mut normal = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(normal.components().next_back(), Some(Component::Normal(_))) => {
                normal.pop();
            }
            _ => normal.push(component),
        }
    }
    normal
}

#[cfg(test)]
mod tests {
    use super::DiskIncludes;
    use crate::disk::Plain;
    use crate::engines::Style;
    use glisten_front::source::{IncludeForm, IncludeResolver};
    use std::fs;
    use std::path::PathBuf;
    use std::sync::Arc;

    fn quoted(folders: Vec<PathBuf>) -> DiskIncludes {
        DiskIncludes::new(Arc::new(Plain), folders, Style::Quote, &[])
    }

    #[test]
    fn quoted_looks_beside_first_and_angled_never() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("lib")).expect("a folder");
        fs::create_dir_all(path("src/sub")).expect("a folder");
        fs::write(path("src/a.glsl"), "folder").expect("written");
        fs::write(path("lib/a.glsl"), "library").expect("written");
        let includes = quoted(vec![path("lib")]);
        let from = path("src/main.vert").to_string_lossy().into_owned();
        let text = |form, name| includes.resolve(name, form, &from).map(|included| included.text.to_string());
        assert_eq!(text(IncludeForm::Quoted, "a.glsl").as_deref(), Ok("folder"));
        assert_eq!(text(IncludeForm::Quoted, "./sub/../a.glsl").as_deref(), Ok("folder"));
        assert_eq!(text(IncludeForm::Angled, "a.glsl").as_deref(), Ok("library"));
        assert!(text(IncludeForm::Quoted, "b.glsl").expect_err("there is none").contains("no `"));
        assert!(text(IncludeForm::Quoted, ".").expect_err("it is a folder").contains("names no file"));
        assert!(quoted(Vec::new()).resolve("a.glsl", IncludeForm::Angled, &from).is_err());
        for form in [IncludeForm::Quoted, IncludeForm::Angled] {
            assert_eq!(text(form, "/a.glsl").as_deref(), Ok("library"), "from the root of a folder of -I");
        }
        let absolute = path("src/a.glsl").to_string_lossy().into_owned();
        assert_eq!(text(IncludeForm::Quoted, &absolute).as_deref(), Ok("folder"));
        assert!(text(IncludeForm::Quoted, "sub").expect_err("a folder").contains("is a folder"));
    }

    #[test]
    fn styles_find_files_of_their_engines() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        for (name, text) in [
            ("assets/minecraft/shaders/include/fog.glsl", "#version 150\nfog"),
            ("assets/mine/shaders/include/sky.glsl", "sky"),
            ("pack/shaders/lib/sun.glsl", "sun"),
            ("chunks/common.glsl.js", "export default /* glsl */`\nchunk\n`;\n"),
            ("media/deep/er/moon.glsl", "moon"),
        ] {
            fs::create_dir_all(path(name).parent().expect("a folder")).expect("a folder");
            fs::write(path(name), text).expect("written");
        }
        let text = |style, folders: &[&str], roots: &[&str], from: &str, name: &str| {
            let folders = folders.iter().map(|name| path(name)).collect();
            let roots: Vec<String> = roots.iter().map(|root| (*root).to_owned()).collect();
            let includes = DiskIncludes::new(Arc::new(Plain), folders, style, &roots);
            let found = includes.resolve(name, IncludeForm::Angled, &path(from).to_string_lossy());
            found.map(|included| included.text.trim().to_owned()).unwrap_or_else(|why| why)
        };
        let core = "assets/minecraft/shaders/core/a.fsh";
        assert_eq!(text(Style::Moj, &[], &[], core, "fog.glsl"), "fog", "without its version");
        assert_eq!(text(Style::Moj, &[], &[], core, "mine:sky.glsl"), "sky");
        assert_eq!(text(Style::Moj, &["assets"], &[], "b.fsh", "minecraft:fog.glsl"), "fog");
        assert_eq!(text(Style::Quote, &[], &["shaders"], "pack/shaders/world0/a.fsh", "/lib/sun.glsl"), "sun");
        assert_eq!(text(Style::Three, &["chunks"], &[], "a.frag", "common"), "chunk");
        assert_eq!(text(Style::Ogre, &["media"], &[], "a.frag", "moon.glsl"), "moon");
        assert!(text(Style::Quote, &["media"], &[], "a.frag", "moon.glsl").contains("there is no"));
    }
}
