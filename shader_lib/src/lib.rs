//! The lighting models that come with glisten, as modules to include: `#include <glisten/phong.glsl>`.
//!
//! *In:* the files in `shader_lib`, embedded. *Out:* [`modules`]; [`Embedded`], which resolves includes of them; and
//! the catalogue ([`entries`]): the header, the functions and the cost of each module.
//!
//! *Holds:* every function is total: its result is finite for every finite input. A module includes what it needs and
//! may be included twice.

mod body;
mod catalogue;
mod cost;
pub mod flat;
mod header;
mod programs;
#[cfg(feature = "reference")]
mod reads;
mod scenes;
pub mod wgsl;

pub use catalogue::{Entry, FunctionEntry, entries, entry};
pub use cost::own as own_cost;
pub use cost::{Cost, cost, costs};
pub use flat::flat;
pub use header::Header;
pub use programs::{LibraryProgram, programs, shader, shader_files};
#[cfg(feature = "reference")]
pub use scenes::SceneFiles;
pub use scenes::{LibraryScene, scene_files, scenes};
pub use wgsl::{Overloads, wgsl};

use glisten_front::source::{IncludeForm, IncludeResolver, Included};

/// The folder of the modules in an include: `<glisten/...>`.
const FOLDER: &str = "glisten/";
/// The prefix of a module's file name where a file name is shown.
pub const SHOWN: &str = "<glisten>/";

/// A module of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Module {
    /// The name: `phong`.
    pub name: &'static str,
    /// The text, GLSL 1.50 without a `#version` line; in a module for the web without its header.
    pub text: &'static str,
}

#[cfg(not(target_arch = "wasm32"))]
macro_rules! module {
    ($name:literal) => {
        Module { name: $name, text: include_str!(concat!("../", $name, ".glsl")) }
    };
}

#[cfg(target_arch = "wasm32")]
macro_rules! module {
    ($name:literal) => {{
        const TEXT: &str = include_str!(concat!("../", $name, ".glsl"));
        const BODY: &[u8] = &body::body_bytes::<{ body::body_len(TEXT) }>(TEXT);
        match std::str::from_utf8(BODY) {
            Ok(text) => Module { name: $name, text },
            Err(_) => panic!("a module is UTF-8"),
        }
    }};
}

static MODULES: &[Module] = &[
    module!("ambient"),
    module!("ao"),
    module!("area_light"),
    module!("artistic"),
    module!("attenuation"),
    module!("beckmann"),
    module!("blinn_phong"),
    module!("burley"),
    module!("clearcoat"),
    module!("color"),
    module!("dissolve"),
    module!("energy"),
    module!("environment"),
    module!("fog"),
    module!("fresnel"),
    module!("ggx"),
    module!("half_lambert"),
    module!("hemisphere"),
    module!("illumination"),
    module!("interpolation"),
    module!("iridescence"),
    module!("irradiance"),
    module!("lambert"),
    module!("lights"),
    module!("ltc"),
    module!("lunar"),
    module!("lut"),
    module!("matcap"),
    module!("naive"),
    module!("noise"),
    module!("normal"),
    module!("normal_map"),
    module!("normalized"),
    module!("oren_nayar"),
    module!("outline"),
    module!("phong"),
    module!("photometry"),
    module!("punctual"),
    module!("quartic"),
    module!("safe"),
    module!("scene"),
    module!("schlick"),
    module!("sdf"),
    module!("shadow"),
    module!("sheen"),
    module!("specular_lut"),
    module!("spot"),
    module!("srgb"),
    module!("standard"),
    module!("subsurface"),
    module!("threshold"),
    module!("tonemap"),
    module!("toon"),
    module!("transmission"),
    module!("ward"),
];

/// All modules, by name.
pub fn modules() -> &'static [Module] {
    MODULES
}

/// Whether a file name is that of a module rather than of a file on disk.
pub fn is_embedded(name: &str) -> bool {
    name.starts_with(SHOWN)
}

/// Resolves `<glisten/phong.glsl>` and the includes among modules, and nothing else.
#[derive(Clone, Copy, Debug, Default)]
pub struct Embedded;

impl Embedded {
    /// The module that an include refers to, if there is one.
    pub fn find(path: &str, form: IncludeForm, from: &str) -> Option<Included> {
        if form == IncludeForm::Quoted && !is_embedded(from) {
            return None;
        }
        let module = Self::module(path, form)?;
        Some(Included { name: format!("{SHOWN}{}.glsl", module.name), text: body::body(module.text).into() })
    }

    /// The module that an include refers to if a text of the library has it.
    fn module(path: &str, form: IncludeForm) -> Option<&'static Module> {
        let file = match form {
            IncludeForm::Angled => path.strip_prefix(FOLDER)?,
            IncludeForm::Quoted => path.strip_prefix("./").unwrap_or(path),
        };
        let name = file.strip_suffix(".glsl")?;
        MODULES.iter().find(|module| module.name == name)
    }
}

impl IncludeResolver for Embedded {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        Self::find(path, form, from).ok_or_else(|| missing(path))
    }
}

#[cfg(feature = "reference")]
impl glisten_scene::Library for Embedded {
    fn program(&self, name: &str) -> Option<(&'static str, &'static str)> {
        programs().iter().find(|program| program.name == name).map(|program| (program.vertex, program.fragment))
    }

    fn program_names(&self) -> Vec<&'static str> {
        programs().iter().map(|program| program.name).collect()
    }

    fn shader(&self, file: &str) -> Option<&'static str> {
        shader(file)
    }

    fn shader_names(&self) -> Vec<&'static str> {
        shader_files().collect()
    }

    fn includes(&self) -> std::sync::Arc<dyn IncludeResolver + Send + Sync> {
        std::sync::Arc::new(Self)
    }

    fn values_read(&self, program: &str) -> Option<&std::collections::BTreeSet<String>> {
        reads::values_read(program)
    }

    fn attributes_that_reach(&self, program: &glisten_front::Program, sizes_points: bool) -> Vec<bool> {
        use glisten_specialize::{Known, KnownState, optimize, specialize};
        let optimized = optimize(program);
        // What is under a condition that is never true is left out only by evaluation.
        let state = KnownState { point_size: Some(sizes_points), ..KnownState::default() };
        let evaluated = specialize(program, &Known { state, ..Known::default() });
        let is_left = |name: &str| {
            let attributes = &evaluated.program.interface.attributes;
            evaluated.fault.is_some() || attributes.iter().any(|attribute| attribute.active && attribute.name == name)
        };
        let attributes = optimized.interface.attributes.iter();
        attributes.map(|attribute| attribute.active && is_left(&attribute.name)).collect()
    }
}

/// A message that no module has this name, with the most similar one.
pub fn missing(path: &str) -> String {
    let name = path.trim_start_matches(FOLDER).trim_end_matches(".glsl");
    match glisten_front::diagnostic::did_you_mean(name, MODULES.iter().map(|module| module.name)) {
        Some(near) => format!("the library has no `{path}`; did you mean `{FOLDER}{near}.glsl`?"),
        None => format!("the library has no `{path}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::{Embedded, modules};
    use glisten_front::hir::Stage;
    use glisten_front::source::{IncludeForm, IncludeResolver};
    use glisten_front::{Compiler, Options, Source};
    use std::path::Path;

    #[test]
    fn every_file_of_the_library_is_embedded() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).to_path_buf();
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .expect("the folder is there")
            .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".glsl").map(str::to_owned))
            .collect();
        files.sort();
        assert_eq!(files, modules().iter().map(|module| module.name).collect::<Vec<_>>());
    }

    #[test]
    fn every_module_compiles_alone() {
        for module in modules() {
            let text = format!(
                "#version 150\n#extension GL_ARB_shading_language_include : require\n#include <glisten/{}.glsl>\n\
                 out vec4 color;\nvoid main() {{ color = vec4(1.0); }}\n",
                module.name
            );
            let source = Source { name: "main.frag".to_owned(), text: text.into(), stage: Stage::Fragment };
            let compilation = Compiler::new(Options::default()).with_includes(Embedded).compile(&[source]);
            let shown = glisten_front::diagnostic::write::human(&compilation.sources, &compilation.diagnostics, false);
            assert!(compilation.program.is_some() && shown.is_empty(), "{}\n{shown}", module.name);
        }
    }

    #[test]
    fn unknown_modules_name_the_nearest() {
        let error = Embedded.resolve("glisten/phonk.glsl", IncludeForm::Angled, "a.frag").expect_err("there is none");
        assert!(error.contains("glisten/phong.glsl"), "{error}");
        assert!(Embedded.resolve("phong.glsl", IncludeForm::Quoted, "a.frag").is_err());
    }
}
