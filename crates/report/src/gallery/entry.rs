//! [`Entry`]: a scene of the library, with its texts for the gallery.

use glisten_front::compiler::{Compiler, Options};
use glisten_library::{Embedded, LibraryScene, SceneFiles};
use glisten_verify::scene::{self, Scene};
use serde::Deserialize;

/// How many samples a picture has per pixel in each direction.
const SUPERSAMPLING: u32 = 2;

/// The `[gallery]` table of a scene.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Meta {
    pub(super) title: String,
    /// The `id` of a chapter of the page.
    pub(super) chapter: String,
    /// The section of the document.
    pub(super) place: String,
    /// The formulas, in the subset of TeX that `math` parses.
    pub(super) equation: Vec<String>,
    pub(super) says: String,
    /// The scene of which this one gives the picture by other means, if the page shows their difference.
    pub(super) compare: Option<String>,
    /// The modules (`phong.glsl`) and shaders (`programs/phong.frag`) of the library that it shows.
    pub(super) sources: Vec<String>,
}

#[derive(Deserialize)]
struct EntryFile {
    gallery: Meta,
}

/// A scene of the gallery.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The scene's name, which is also its picture's name without the extension.
    pub name: &'static str,
    /// The text of the scene.
    pub(super) text: &'static str,
    pub(super) meta: Meta,
    scene: Scene,
}

/// All entries, in the order of the page.
///
/// # Errors
/// What is wrong with a scene. That is an error in the library, which its tests would find.
pub fn entries() -> Result<Vec<Entry>, String> {
    glisten_library::scenes().iter().map(entry).collect()
}

fn entry(file: &LibraryScene) -> Result<Entry, String> {
    let wrong = |what: &str| format!("the scene `{}` of the library: {what}", file.name);
    let path = format!("<glisten>/scenes/{}.toml", file.name);
    let compiler = Compiler::new(Options::default()).with_includes(Embedded);
    let loaded = scene::load(&path, &SceneFiles, &compiler);
    let Some(scene) = loaded.scene else {
        let first = loaded.diagnostics.iter().next().map_or("it does not load", |finding| &finding.message);
        return Err(wrong(first));
    };
    let EntryFile { gallery } = toml::from_str(file.text).map_err(|error| wrong(error.message()))?;
    Ok(Entry { name: file.name, text: file.text, meta: gallery, scene })
}

impl Entry {
    /// A sentence that describes the picture: the scene's first line.
    pub(super) fn description(&self) -> &'static str {
        self.text.lines().next().map_or("", |line| line.trim_start_matches("# "))
    }

    /// The scene as in its file.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene for [`Tile::new`](super::Tile::new) and a picture of this width in pixels. It has several samples
    /// per pixel, so that edges are smooth. The height keeps the scene's aspect ratio.
    pub fn supersampled(&self, width: u32) -> Scene {
        let mut scene = self.scene.clone();
        let framebuffer = &mut scene.framebuffer;
        let height = (u64::from(width) * u64::from(framebuffer.height)).div_ceil(u64::from(framebuffer.width));
        framebuffer.width = width * SUPERSAMPLING;
        framebuffer.height = height as u32 * SUPERSAMPLING;
        scene
    }

    /// The name of the scene with whose picture this one's is compared.
    pub fn compared_with(&self) -> Option<&str> {
        self.meta.compare.as_deref()
    }

    /// The name of the file with the difference to that picture.
    pub fn difference_name(&self) -> String {
        format!("{}-difference.png", self.name)
    }

    /// The name of the picture's file.
    pub fn file_name(&self) -> String {
        format!("{}.png", self.name)
    }
}

/// How many samples a pixel has in each direction.
pub(super) const fn supersampling() -> u32 {
    SUPERSAMPLING
}

/// The text of a module, or of a program's shader.
pub(super) fn source(name: &str) -> Option<&'static str> {
    match name.strip_prefix("programs/") {
        Some(file) => glisten_library::shader(file),
        None => {
            let module = name.strip_suffix(".glsl")?;
            glisten_library::modules().iter().find(|known| known.name == module).map(|module| module.text)
        }
    }
}
