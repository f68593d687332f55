//! The scene of a model from the disk.
//!
//! *In:* the path of an OBJ or glTF file. *Out:* the scene of [`portrait`], loaded; what it leaves out is a note. *Holds:* nothing is written:
//! the scene is in memory, next to the model.

use glisten_front::diagnostic::codes::scenes::{MODEL_SIMPLIFIED, SCENE_BAD_ASSET, SCENE_FILE_UNREADABLE};
use glisten_front::diagnostic::{Diagnostic, Diagnostics};
use glisten_front::source::{SourceMap, Span};
use glisten_scene::{FileError, FileSource, Loaded, PortraitError, portrait};
use std::path::Path;

/// The scene of the model at `path`, as `load` loads it.
pub(super) fn load(path: &str, files: &dyn FileSource, load: impl FnOnce(&str, &dyn FileSource) -> Loaded) -> Loaded {
    let name = Path::new(path).file_name().map_or_else(|| path.to_owned(), |name| name.to_string_lossy().into_owned());
    let made = match portrait(path, &name, files) {
        Ok(made) => made,
        Err(error) => return failed(path, &error),
    };
    // Next to the model, where its files are found.
    let place = Path::new(path).with_file_name(format!("{name} (made scene)"));
    let place = place.to_string_lossy();
    let mut loaded = load(&place, &WithScene { place: &place, text: &made.text, files });
    for remark in made.remarks {
        let message = format!("`{path}`: {remark}");
        loaded.diagnostics.push_beside(Diagnostic::new(&MODEL_SIMPLIFIED, Span::default(), message));
    }
    loaded
}

fn failed(path: &str, error: &PortraitError) -> Loaded {
    let (code, message) = match error {
        PortraitError::File(error) => (&SCENE_FILE_UNREADABLE, format!("cannot read `{path}`: {error}")),
        PortraitError::Model(error) => (&SCENE_BAD_ASSET, format!("`{path}`: {error}")),
        PortraitError::Part(error) => (&SCENE_FILE_UNREADABLE, format!("`{path}`: {error}")),
    };
    let mut diagnostics = Diagnostics::default();
    diagnostics.push(Diagnostic::new(code, Span::default(), message));
    let io_error = matches!(error, PortraitError::File(_) | PortraitError::Part(_));
    Loaded { scene: None, sources: SourceMap::default(), diagnostics, io_error }
}

/// The files of a source, and the scene that was made for a model.
struct WithScene<'a> {
    place: &'a str,
    text: &'a str,
    files: &'a dyn FileSource,
}

impl FileSource for WithScene<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == self.place { Ok(self.text.as_bytes().to_vec()) } else { self.files.read(path) }
    }
}
