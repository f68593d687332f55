//! The scenes of the library, which `glisten gallery` draws: files in `shader_lib/scenes`.
//!
//! *In:* the embedded files. *Out:* [`scenes`], in the order of the gallery.
//!
//! *Holds:* a scene refers only to programs of the library and to generated textures, so it needs no other files.

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
        LibraryScene { name: $name, text: include_str!(concat!("../../shader_lib/scenes/", $name, ".toml")) }
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
    scene!("moon"),
    scene!("velvet"),
    scene!("lacquer"),
    scene!("lamps"),
    scene!("panels"),
    scene!("shadows"),
    scene!("corner"),
    scene!("lux"),
    scene!("furnace"),
    scene!("lines"),
    scene!("probe"),
    scene!("noises"),
    scene!("ember"),
    scene!("dial"),
    scene!("mist"),
    scene!("tones"),
];

/// All scenes, in the order in which the two documents discuss what they show.
pub fn scenes() -> &'static [LibraryScene] {
    SCENES
}

#[cfg(test)]
mod tests {
    use super::scenes;
    use std::path::Path;

    #[test]
    fn every_scene_is_embedded() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shader_lib/scenes");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".toml").map(str::to_owned))
            .collect();
        files.sort();
        let mut embedded: Vec<&str> = scenes().iter().map(|scene| scene.name).collect();
        embedded.sort_unstable();
        assert_eq!(files, embedded);
    }
}
