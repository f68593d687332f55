//! [`Scenery`]: a scene file with its programs, and the picture that the CPU reference draws of it ([`Drawn`]).
//!
//! *In:* the path of a scene, and the files of the host or those on disk. *Out:* RGBA of every pixel, top row first. *Holds:* a
//! scene never changes, and can be drawn from many threads.

use crate::error::{Error, Kind, Unreadable};
use crate::paths::joined;
use crate::program::{Format, Report};
use crate::settings::Settings;
use glisten::scene::{DiskFiles, FileError, FileSource, Scene};
use glisten::{Precision, RenderOptions, render};
use glisten_front::diagnostic::write::Finding;
use glisten_verify::scene;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A host's function for files: the bytes at a path, or why there are none.
type Read = Arc<dyn Fn(&str) -> Result<Vec<u8>, FileError> + Send + Sync>;

/// Where the files of a scene are.
#[derive(Clone, Default)]
pub enum Files {
    /// On disk.
    #[default]
    Disk,
    /// Where the host says.
    Host(Read),
}

impl Files {
    /// Files of a host, whose paths are without `.` and `..`.
    pub fn of(files: Arc<BTreeMap<String, Vec<u8>>>) -> Self {
        Self::Host(Arc::new(move |path| files.get(&joined("", path)).cloned().ok_or(FileError::Missing)))
    }
}

impl FileSource for Files {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        match self {
            Self::Disk => DiskFiles.read(path),
            Self::Host(read) => read(path),
        }
    }
}

impl Files {
    /// The number of the system's error for a file that was not read.
    fn errno(&self, path: &str, error: &FileError) -> Option<i32> {
        // These two have the same numbers everywhere: ENOENT, EISDIR.
        match (error, self) {
            (FileError::Missing, _) => Some(2),
            (FileError::Folder, _) => Some(21),
            (FileError::Unreadable(_), Self::Disk) => std::fs::read(path).err().and_then(|error| error.raw_os_error()),
            (FileError::Unreadable(_), Self::Host(_)) => None,
        }
    }
}

/// Files, with the first one that could not be read.
struct Noted<'a> {
    files: &'a Files,
    unreadable: Mutex<Option<Unreadable>>,
}

impl FileSource for Noted<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let read = self.files.read(path);
        if let Err(error) = &read {
            let found = || Unreadable { path: path.to_owned(), errno: self.files.errno(path, error) };
            self.unreadable.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(found);
        }
        read
    }
}

/// A scene that was loaded.
pub struct Scenery {
    report: Report,
    scene: Option<Scene>,
}

/// What was drawn.
pub struct Drawn {
    /// The width in pixels.
    pub width: u32,
    /// The height in pixels.
    pub height: u32,
    /// RGBA of every pixel of every color attachment.
    pub attachments: Vec<Vec<[f64; 4]>>,
    /// Whether a fragment was written to the pixel.
    pub covered: Vec<bool>,
}

impl Scenery {
    /// Loads the scene at a path.
    ///
    /// # Errors
    /// A file cannot be read.
    pub fn load(settings: &Settings, path: &str, files: &Files) -> Result<Self, Error> {
        let noted = Noted { files, unreadable: Mutex::default() };
        let loaded = scene::load(path, &noted, &settings.compiler());
        let report = Report { sources: loaded.sources, diagnostics: loaded.diagnostics.into_iter().collect() };
        if loaded.io_error {
            let errors = report.diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
            let message = errors.map(|diagnostic| diagnostic.message.clone()).collect::<Vec<_>>().join("; ");
            let file = noted.unreadable.into_inner().unwrap_or_else(PoisonError::into_inner);
            return Err(Error { kind: Kind::File, message, file, diagnostics: None });
        }
        let scene = loaded.scene.filter(|_| !report.has_errors());
        Ok(Self { report, scene })
    }

    /// Whether there are no errors.
    pub fn is_sound(&self) -> bool {
        self.scene.is_some()
    }

    /// The diagnostics in the order of their places.
    pub fn findings(&self) -> Vec<Finding> {
        self.report.findings()
    }

    /// The diagnostics as a text.
    pub fn diagnostics(&self, format: Format) -> String {
        self.report.text(format)
    }

    fn scene(&self) -> Result<&Scene, Error> {
        self.scene.as_ref().ok_or_else(|| Error::content("there is no scene to draw, since it has errors"))
    }

    /// Draws the scene on the CPU.
    ///
    /// # Errors
    /// The scene has errors, or something that the reference does not support.
    pub fn draw(&self, precision: Precision) -> Result<Drawn, Error> {
        let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
        let picture = render(self.scene()?, &options).map_err(|errors| self.report.error(&errors))?;
        let glisten::Picture { width, height, attachments, covered, .. } = picture;
        Ok(Drawn { width, height, attachments, covered })
    }

    /// Measures how f32 arithmetic harms the picture: the verdict, the figures and the causes, as JSON.
    ///
    /// # Errors
    /// The scene has errors, or something that the reference does not support.
    #[cfg(feature = "stability")]
    pub fn stability(&self) -> Result<String, Error> {
        use glisten::stability::{ExamineOptions, find};
        use glisten_stability::BOUND;
        let scene = self.scene()?;
        let mut go_on = |_, _| true;
        let mut options =
            ExamineOptions { bound: BOUND, bound_relative: 0.0, all: false, figures: false, progress: &mut go_on };
        let (findings, _) =
            find(scene, &self.report.sources, &mut options, None).map_err(|errors| self.report.error(&errors))?;
        serde_json::to_string_pretty(&findings).map_err(|error| Error::content(format!("no JSON: {error}")))
    }
}

#[cfg(test)]
mod tests {
    use super::{Files, Scenery};
    use crate::{Kind, Settings};
    use glisten::Precision;
    use glisten::scene::FileError;
    use std::sync::Arc;

    const SCENE: &str = r#"
        [framebuffer]
        width = 4
        height = 2
        [[draw]]
        vertex = "v.vert"
        fragment = "f.frag"
        vertex_count = 3
    "#;
    const VERTEX: &str = "#version 150
        void main() { gl_Position = vec4(vec2[](vec2(-1), vec2(3, -1), vec2(-1, 3))[gl_VertexID], 0.0, 1.0); }";

    fn files(text: &'static str) -> Files {
        Files::Host(Arc::new(move |path| match path {
            "s.toml" => Ok(SCENE.as_bytes().to_vec()),
            "v.vert" => Ok(VERTEX.as_bytes().to_vec()),
            "f.frag" => Ok(text.as_bytes().to_vec()),
            _ => Err(FileError::Missing),
        }))
    }

    #[test]
    fn a_scene_from_memory_is_drawn() {
        let files = files("#version 150\nout vec4 c;\nvoid main() { c = vec4(0.25, 0.5, 1.0, 1.0); }\n");
        let scene = Scenery::load(&Settings::default(), "s.toml", &files).expect("files");
        assert!(scene.is_sound(), "{}", scene.diagnostics(crate::Format::Human));
        let drawn = scene.draw(Precision::F64).expect("drawn");
        assert_eq!((drawn.width, drawn.height, drawn.covered), (4, 2, vec![true; 8]));
        assert_eq!(drawn.attachments, [vec![[0.25, 0.5, 1.0, 1.0]; 8]]);
    }

    #[test]
    fn what_is_wrong_is_told() {
        let error = Scenery::load(&Settings::default(), "t.toml", &files("")).err().expect("no such file");
        assert_eq!(error.kind, Kind::File);
        assert!(error.file.is_some_and(|file| file.errno == Some(2)));
        let scene = Scenery::load(&Settings::default(), "s.toml", &files("#version 150\nvoid main() { x; }\n"));
        let scene = scene.expect("files");
        assert!(!scene.is_sound() && scene.draw(Precision::F32).is_err());
    }
}
