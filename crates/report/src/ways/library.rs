//! The report on the library: one scene, shaded by each of its models, per fragment and per vertex.
//!
//! *In:* nothing. *Out:* [`LibraryFiles`], which has the scene with its `[report]` table as a file. *Holds:* the standard
//! program per fragment is the reference of each model; a program of its own, where there is one, is another variant of that model. In one
//! group more, highlights as wide and as bright as that of GGX are compared with it.

use glisten_scene::{FileError, FileSource};
use std::fmt::Write;

/// The name of the scene's file.
pub const LIBRARY_SCENE: &str = "library.toml";

/// A model of the library.
struct Model {
    name: &'static str,
    /// Keys of its material.
    material: &'static str,
    /// The library's program for this model alone. There is one per vertex, with `_vertex` after its name.
    program: Option<&'static str>,
}

const fn model(name: &'static str, material: &'static str, program: Option<&'static str>) -> Model {
    Model { name, material, program }
}

static MODELS: &[Model] = &[
    model("Lambert (83)", "specular_model = \"none\"", Some("lambert")),
    model("half Lambert", "diffuse_model = \"half_lambert\", specular_model = \"none\"", None),
    model(
        "soft toon",
        "diffuse_model = \"toon_soft\", specular_model = \"none\", ramp = { pattern = \"soft\", filter = \"linear\" }",
        None,
    ),
    model("hard toon", "diffuse_model = \"toon_hard\", specular_model = \"none\", shade = [0.2, 0.15, 0.35]", None),
    model("Phong (86)", "specular_model = \"phong\"", Some("phong")),
    model("Blinn-Phong (89)", "specular_model = \"blinn_phong\"", Some("blinn_phong")),
    model("Schlick (90) on R.V", "specular_model = \"schlick_phong\"", None),
    model("Schlick (90) on N.H", "specular_model = \"schlick_blinn\"", Some("schlick")),
    model("threshold (91)", "specular_model = \"threshold\", threshold = 0.95", Some("threshold")),
    model("the article's fourth power", "specular_model = \"quartic\"", None),
    model(
        "table on N.H",
        "specular_model = \"table_half\", highlight = { pattern = \"specular\", exponent = 40, filter = \"linear\" }",
        None,
    ),
    model(
        "table on N.L, mottled",
        "specular_model = \"table_light\", highlight = { pattern = \"metal\", exponent = 40, filter = \"linear\" }",
        None,
    ),
    model("GGX", "specular_model = \"ggx\", roughness = 0.45", None),
    model("Beckmann", "specular_model = \"beckmann\", roughness = 0.45", None),
    model("normalized Blinn-Phong", "specular_model = \"normalized\"", None),
    model("Oren and Nayar", "diffuse_model = \"oren_nayar\", specular_model = \"none\"", None),
    model("EON", "diffuse_model = \"eon\", specular_model = \"none\"", None),
    model("Burley", "diffuse_model = \"burley\", specular_model = \"none\"", None),
    model("wrap", "diffuse_model = \"wrap\", specular_model = \"none\", threshold = 0.4", None),
    model("Minnaert", "diffuse_model = \"minnaert\", specular_model = \"none\", roughness = 0.4", None),
    model("fibers", "specular_model = \"sheen\", roughness = 0.45", None),
];

/// The name of the group of highlights that are compared with GGX.
const LIKE_GGX: &str = "like GGX";

/// Highlights alone, the first one of GGX with alpha = 0.2025. The exponents are 2 / alpha^2 - 2, with which Blinn's lobe is as wide, and a
/// quarter of it for R.V; models without a norm are as bright in the middle, 1 / (4 alpha^2) times.
static HIGHLIGHTS: &[(&str, &str)] = &[
    ("GGX", "specular_model = \"ggx\", specular = [0.5, 0.5, 0.5], roughness = 0.45"),
    ("Beckmann", "specular_model = \"beckmann\", specular = [0.5, 0.5, 0.5], roughness = 0.45"),
    ("normalized Blinn-Phong", "specular_model = \"normalized\", specular = [0.5, 0.5, 0.5], shininess = 46.8"),
    ("Blinn-Phong", "specular_model = \"blinn_phong\", specular = [3.05, 3.05, 3.05], shininess = 46.8"),
    ("Phong", "specular_model = \"phong\", specular = [3.05, 3.05, 3.05], shininess = 11.7"),
    ("Schlick (90) on N.H", "specular_model = \"schlick_blinn\", specular = [3.05, 3.05, 3.05], shininess = 46.8"),
    ("fourth power", "specular_model = \"quartic\", specular = [3.05, 3.05, 3.05]"),
];

/// The scene without its variants: a knot under a warm and a dim blue light.
const SCENE: &str = r#"
global_ambient = [0.03, 0.03, 0.04]

[framebuffer]
width = 240
height = 240
clear = [0.009, 0.01, 0.015, 1.0]
encode = "srgb"

[camera]
eye = [0.0, 0.0, 6.0]
target = [0.0, 0.0, 0.0]
fovy = 30
near = 1.0
far = 20.0

[[light]]
kind = "directional"
towards = [0.5, 0.7, 0.6]
color = [1.0, 0.95, 0.85]

[[light]]
kind = "point"
position = [-3.0, 0.5, 2.0]
attenuation = [0.4, 0.2, 0.05]
color = [0.1, 0.2, 0.45]

[[draw]]
program = "standard"
cull = "back"
depth_test = true
mesh = { shape = "torus_knot", radius = 0.82, minor_radius = 0.36, tube = 0.23 }
transform = { rotate = [72.0, 0.0, 18.0] }

[report]
tessellations = [[192, 24]]
truth_tessellation = [192, 24]
"#;

/// The uniforms that all materials have.
const MATERIAL: &str = "diffuse = [0.6, 0.3, 0.2], specular = [0.5, 0.5, 0.5], shininess = 40";

/// The text of the scene.
fn text() -> String {
    let mut text = SCENE.to_owned();
    for Model { name, material, program } in MODELS {
        let mut way = |what: &str, program: &str, is_truth: bool| {
            let truth = if is_truth { "truth = true\n" } else { "" };
            let _ = write!(
                text,
                "\n[[report.way]]\nname = \"{name}, {what}\"\nmodel = \"{name}\"\n{truth}\
                 set = {{ program = \"{program}\", material = {{ {MATERIAL}, {material} }} }}\n"
            );
        };
        way("standard program", "standard", true);
        way("standard program per vertex", "standard_vertex", false);
        if let Some(program) = program {
            way("program of its own", program, false);
            way("program of its own per vertex", &format!("{program}_vertex"), false);
        }
    }
    for (index, (name, material)) in HIGHLIGHTS.iter().enumerate() {
        let truth = if index == 0 { "truth = true\n" } else { "" };
        let _ = write!(
            text,
            "\n[[report.way]]\nname = \"{LIKE_GGX}: {name}\"\nmodel = \"{LIKE_GGX}\"\n{truth}\
             set = {{ program = \"standard\", material = {{ diffuse_model = \"none\", diffuse = [0.0, 0.0, 0.0], {material} }} }}\n"
        );
    }
    text
}

/// The file of the report on the library. The files that it names are embedded.
#[derive(Clone, Copy, Debug, Default)]
pub struct LibraryFiles;

impl FileSource for LibraryFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if path == LIBRARY_SCENE { Ok(text().into_bytes()) } else { Err(FileError::Missing) }
    }
}

#[cfg(test)]
mod tests {
    use super::{HIGHLIGHTS, LIBRARY_SCENE, LibraryFiles, MODELS, text};
    use crate::plan::plan;
    use glisten_front::{Compiler, Options};
    use glisten_verify::scene::{FileSource, MemoryFiles, load};

    #[test]
    fn every_way_loads_without_a_warning() {
        let plan = plan("library", &text(), 0).expect("the table is right");
        let programs = MODELS.iter().filter(|model| model.program.is_some()).count();
        let ways = 2 * MODELS.len() + 2 * programs + HIGHLIGHTS.len();
        assert_eq!((plan.ways.len(), plan.truths.len()), (ways, MODELS.len() + 1));
        let compiler = Compiler::new(Options::default()).with_includes(glisten_library::Embedded);
        for way in &plan.ways {
            let crate::plan::Drawn::Text(text) = &way.drawn else { panic!("a text") };
            let loaded = load("s.toml", &MemoryFiles::new([("s.toml", text.text.as_str())]), &compiler);
            let found: Vec<String> = loaded.diagnostics.iter().map(|one| one.message.clone()).collect();
            assert!(loaded.scene.is_some(), "{}: {found:?}", way.name);
        }
    }

    #[test]
    fn no_other_file_is_there() {
        assert!(LibraryFiles.read(LIBRARY_SCENE).is_ok() && LibraryFiles.read("a.vert").is_err());
    }

    #[test]
    fn every_program_of_a_model_is_among_them() {
        for program in glisten_library::programs().iter().filter_map(|program| program.name.strip_suffix("_vertex")) {
            assert!(program == "standard" || MODELS.iter().any(|model| model.program == Some(program)), "{program}");
        }
    }

    /// Every diffuse and every specular model of the program `standard` is among them.
    #[test]
    fn every_model_of_the_standard_program_is_among_them() {
        let module = glisten_library::modules().iter().find(|module| module.name == "scene").expect("it is there");
        let names = |what: &str| {
            let prefix = format!("const int {what}_");
            let names = module
                .text
                .lines()
                .filter_map(|line| Some(line.strip_prefix(&prefix)?.split(' ').next()?.to_lowercase()));
            names.filter(|name| name != "none").collect::<Vec<_>>()
        };
        for (key, name) in names("DIFFUSE")
            .iter()
            .map(|name| ("diffuse_model", name))
            .chain(names("SPECULAR").iter().map(|name| ("specular_model", name)))
        {
            // What a material has without a key.
            let is_default = name == "lambert";
            let named = format!("{key} = \"{name}\"");
            assert!(is_default || MODELS.iter().any(|model| model.material.contains(&named)), "{named}");
        }
    }
}
