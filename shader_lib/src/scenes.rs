//! The scenes of the library, which `glisten gallery` draws: files in `shader_lib/scenes`.
//!
//! *In:* the embedded files. *Out:* [`scenes`], in the order of the gallery; [`scene_files`], what they name.
//!
//! *Holds:* a scene refers only to programs of the library, to generated textures, and to files in its folder that are embedded, too.

/// A scene of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LibraryScene {
    /// The name: `hemi_spec`.
    pub name: &'static str,
    /// The text, TOML.
    pub text: &'static str,
}

macro_rules! scene {
    ($name:literal) => {
        LibraryScene { name: $name, text: include_str!(concat!("../scenes/", $name, ".toml")) }
    };
}

static SCENES: &[LibraryScene] = &[
    scene!("reflection"),
    scene!("directional"),
    scene!("point"),
    scene!("lambert"),
    scene!("phong"),
    scene!("blinn_phong"),
    scene!("floor_phong"),
    scene!("floor_blinn_phong"),
    scene!("shininess"),
    scene!("cosine"),
    scene!("schlick"),
    scene!("schlick_phong"),
    scene!("threshold"),
    scene!("ambient"),
    scene!("illumination"),
    scene!("emission"),
    scene!("lights"),
    scene!("attenuation_constant"),
    scene!("attenuation_linear"),
    scene!("attenuation_quadratic"),
    scene!("spot"),
    scene!("spot_exponents"),
    scene!("faces"),
    scene!("per_vertex"),
    scene!("per_fragment"),
    scene!("vertex_color"),
    scene!("vertex_color_flat"),
    scene!("smooth"),
    scene!("noperspective"),
    scene!("diffuse"),
    scene!("specular"),
    scene!("texspec"),
    scene!("metal"),
    scene!("half_lambert"),
    scene!("hemisphere"),
    scene!("hemisphere_table"),
    scene!("hemi_amb"),
    scene!("hemi_spec"),
    scene!("soft"),
    scene!("toon_hard"),
    scene!("edge"),
    scene!("edge_knot"),
    scene!("hemi_knot"),
    scene!("metals"),
    scene!("chess"),
    scene!("studio"),
    scene!("moon"),
    scene!("wax"),
    scene!("skin"),
    scene!("drawing"),
    scene!("lobes"),
    scene!("velvet"),
    scene!("lacquer"),
    scene!("brushed"),
    scene!("pan"),
    scene!("film"),
    scene!("glass"),
    scene!("marbles"),
    scene!("lamps"),
    scene!("panels"),
    scene!("softbox"),
    scene!("shadows"),
    scene!("corner"),
    scene!("lux"),
    scene!("furnace"),
    scene!("lines"),
    scene!("probe"),
    scene!("dusk"),
    scene!("clay"),
    scene!("noises"),
    scene!("ember"),
    scene!("dial"),
    scene!("mist"),
    scene!("tones"),
];

/// The files that scenes name.
static FILES: &[(&str, &[u8])] = &[
    ("chess.glb", include_bytes!("../scenes/chess.glb")),
    ("clay.png", include_bytes!("../scenes/clay.png")),
    ("studio.exr", include_bytes!("../scenes/studio.exr")),
];

/// The files next to the scenes that they name, by their names: models and pictures.
pub fn scene_files() -> &'static [(&'static str, &'static [u8])] {
    FILES
}

/// The scenes and the files that they name, as files of a folder: `studio.toml`, `<glisten>/scenes/studio.exr`.
#[cfg(feature = "reference")]
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneFiles;

#[cfg(feature = "reference")]
impl glisten_scene::FileSource for SceneFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, glisten_scene::FileError> {
        let name = path.strip_prefix("<glisten>/scenes/").unwrap_or(path);
        let scene = name.strip_suffix(".toml").and_then(|name| SCENES.iter().find(|scene| scene.name == name));
        let file = || FILES.iter().find(|(known, _)| *known == name).map(|(_, bytes)| bytes.to_vec());
        let found = scene.map(|scene| scene.text.as_bytes().to_vec()).or_else(file);
        found.ok_or(glisten_scene::FileError::Missing)
    }
}

/// All scenes, in the order in which the two documents discuss what they show.
pub fn scenes() -> &'static [LibraryScene] {
    SCENES
}

#[cfg(test)]
mod tests {
    use super::{scene_files, scenes};
    use std::path::Path;

    #[test]
    fn every_scene_is_embedded() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .filter_map(|entry| entry.ok()?.file_name().to_str().map(str::to_owned))
            .collect();
        files.sort();
        let mut embedded: Vec<String> = scenes().iter().map(|scene| format!("{}.toml", scene.name)).collect();
        embedded.extend(scene_files().iter().map(|(name, _)| (*name).to_owned()));
        embedded.sort_unstable();
        assert_eq!(files, embedded);
    }
}
