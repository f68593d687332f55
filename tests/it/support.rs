//! Shared by several test areas: compiling texts and files, and resolving includes next to them.

use glisten_front::diagnostic::Diagnostics;
use glisten_front::hir::Stage;
use glisten_front::source::{IncludeForm, IncludeResolver, Included, SourceMap};
use glisten_front::{Compiler, Options, Source};
use std::fs;
use std::path::{Path, PathBuf};

/// A shader to compile: its name, text and stage.
pub(crate) struct Shader {
    pub(crate) name: String,
    pub(crate) text: String,
    pub(crate) stage: Stage,
}

/// How to compile.
#[derive(Default)]
pub(crate) struct Settings {
    pub(crate) strict: bool,
    pub(crate) defines: Vec<(String, String)>,
    pub(crate) attribute_locations: Vec<(String, u32)>,
}

/// Finds includes next to the including file.
#[derive(Clone, Copy)]
pub(crate) struct Beside;

impl IncludeResolver for Beside {
    fn resolve(&self, path: &str, _: IncludeForm, from: &str) -> Result<Included, String> {
        let file = Path::new(from).parent().unwrap_or(Path::new("")).join(path);
        let text = fs::read_to_string(root().join(&file)).map_err(|_| "no such file beside this one".to_owned())?;
        Ok(Included { name: file.to_string_lossy().into_owned(), text: text.into() })
    }
}

/// The folder of the package.
pub(crate) fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The stage of a file name.
pub(crate) fn stage_of(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "geom" => Some(Stage::Geometry),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

/// All shaders in a folder of the package, in order, with names relative to the package.
pub(crate) fn shaders_under(folder: &str) -> Vec<Shader> {
    let mut pending = vec![root().join(folder)];
    let mut paths: Vec<PathBuf> = Vec::new();
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("a folder entry").path();
            if path.is_dir() { pending.push(path) } else { paths.push(path) }
        }
    }
    paths.sort();
    let shader = |path: &PathBuf| {
        let stage = stage_of(path)?;
        let bytes = fs::read(path).expect("a readable fixture");
        let name = path.strip_prefix(root()).expect("inside the package").to_string_lossy().into_owned();
        Some(Shader { name, text: String::from_utf8_lossy(&bytes).into_owned(), stage })
    };
    paths.iter().filter_map(shader).collect()
}

/// All diagnostics of the shaders of one program.
pub(crate) fn compile(shaders: &[Shader], settings: &Settings) -> (SourceMap, Diagnostics) {
    let options = Options {
        defines: settings.defines.clone(),
        strict: settings.strict,
        attribute_locations: settings.attribute_locations.clone(),
        ..Options::default()
    };
    let source =
        |shader: &Shader| Source { name: shader.name.clone(), text: shader.text.as_str().into(), stage: shader.stage };
    let sources: Vec<Source> = shaders.iter().map(source).collect();
    let compilation = Compiler::new(options).with_includes(Beside).compile(&sources);
    (compilation.sources, compilation.diagnostics)
}
