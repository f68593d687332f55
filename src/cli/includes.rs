//! [`DiskIncludes`]: finds the files that `#include` names on disk.
//!
//! *Holds:* `"x"` is searched next to the including file, then in the `-I` folders in order; `<x>` in the `-I`
//! folders, then among the embedded modules (`<glisten/phong.glsl>`). A path that begins with `/`, as all of
//! ARB_shading_language_include do, starts at an `-I` folder, or else at the root of the disk. The name of an included
//! file is the path under which it was found, so that diagnostics and depfiles show a path that opens.

use super::files;
use crate::library::{self, Embedded};
use glisten_front::source::{IncludeForm, IncludeResolver, Included};
use std::path::{Component, Path, PathBuf};

/// Finds files next to the including one and along a search path.
#[derive(Clone, Debug)]
pub(super) struct DiskIncludes {
    folders: Vec<PathBuf>,
}

impl DiskIncludes {
    /// A resolver that searches `folders` (`-I`).
    pub(super) fn new(folders: &[PathBuf]) -> Self {
        Self { folders: folders.to_vec() }
    }

    fn candidates(&self, path: &str, form: IncludeForm, from: &str) -> Vec<PathBuf> {
        let along = |path: &str| self.folders.iter().map(|folder| normal(&folder.join(path))).collect::<Vec<_>>();
        let inner = path.trim_start_matches('/');
        if inner != path {
            return along(inner).into_iter().chain([normal(Path::new(path))]).collect();
        }
        let folder = Path::new(from).parent().unwrap_or(Path::new(""));
        let own = (form == IncludeForm::Quoted).then(|| normal(&folder.join(path)));
        own.into_iter().chain(along(path)).collect()
    }
}

impl IncludeResolver for DiskIncludes {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        if path.is_empty() {
            return Err("an include names no file".to_owned());
        }
        if let (IncludeForm::Quoted, Some(module)) = (form, Embedded::find(path, form, from)) {
            return Ok(module);
        }
        let candidates = self.candidates(path, form, from);
        for candidate in &candidates {
            if !candidate.exists() {
                continue;
            }
            let name = candidate.to_string_lossy().into_owned();
            // An included file may be empty; otherwise the same rules hold as for a source.
            let bytes = files::read(&name, candidate).map_err(|error| error.message)?;
            let text = if bytes.is_empty() {
                "".into()
            } else {
                files::text_of(&name, bytes).map_err(|error| error.message)?
            };
            return Ok(Included { name, text });
        }
        if let Some(module) = Embedded::find(path, form, from) {
            return Ok(module);
        }
        if form == IncludeForm::Angled && path.starts_with("glisten/") {
            return Err(library::missing(path));
        }
        let looked: Vec<String> = candidates.iter().map(|candidate| format!("`{}`", candidate.display())).collect();
        Err(match looked.len() {
            0 => format!("`<{path}>` is looked for along -I alone, and no folder is given"),
            _ => format!("there is no {}", looked.join(" and no ")),
        })
    }
}

/// The path without `.` and without `x/..`, as far as that is possible without reading the disk (a leading `..`
/// stays).
fn normal(path: &Path) -> PathBuf {
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
    use glisten_front::source::{IncludeForm, IncludeResolver};
    use std::fs;

    #[test]
    fn quoted_looks_beside_first_and_angled_never() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        fs::create_dir_all(path("lib")).expect("a folder");
        fs::create_dir_all(path("src/sub")).expect("a folder");
        fs::write(path("src/a.glsl"), "folder").expect("written");
        fs::write(path("lib/a.glsl"), "library").expect("written");
        let includes = DiskIncludes::new(&[path("lib")]);
        let from = path("src/main.vert").to_string_lossy().into_owned();
        let text = |form, name| includes.resolve(name, form, &from).map(|included| included.text.to_string());
        assert_eq!(text(IncludeForm::Quoted, "a.glsl").as_deref(), Ok("folder"));
        assert_eq!(text(IncludeForm::Quoted, "./sub/../a.glsl").as_deref(), Ok("folder"));
        assert_eq!(text(IncludeForm::Angled, "a.glsl").as_deref(), Ok("library"));
        assert!(text(IncludeForm::Quoted, "b.glsl").expect_err("there is none").contains("no `"));
        assert!(DiskIncludes::new(&[]).resolve("a.glsl", IncludeForm::Angled, &from).is_err());
        for form in [IncludeForm::Quoted, IncludeForm::Angled] {
            assert_eq!(text(form, "/a.glsl").as_deref(), Ok("library"), "from the root of a folder of -I");
        }
        let absolute = path("src/a.glsl").to_string_lossy().into_owned();
        assert_eq!(text(IncludeForm::Quoted, &absolute).as_deref(), Ok("folder"));
        assert!(text(IncludeForm::Quoted, "sub").expect_err("a folder").contains("is a folder"));
    }
}
