//! Shared by all test areas: the folder of the package, its files, and compiling files and texts.

use glisten_front::diagnostic::Diagnostics;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::source::{IncludeForm, IncludeResolver, Included, SourceMap};
use glisten_front::{Compilation, Compiler, Options, Source};
use serde_json::Value;
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
pub(crate) struct NextTo;

impl IncludeResolver for NextTo {
    fn resolve(&self, path: &str, _: IncludeForm, from: &str) -> Result<Included, String> {
        let file = Path::new(from).parent().unwrap_or(Path::new("")).join(path);
        let text = fs::read_to_string(root().join(&file)).map_err(|_| "no such file next to this one".to_owned())?;
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

/// All files in a folder and the folders in it, in order.
pub(crate) fn files_under(folder: &Path) -> Vec<PathBuf> {
    let mut pending = vec![folder.to_owned()];
    let mut files: Vec<PathBuf> = Vec::new();
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).into_iter().flatten() {
            let path = entry.expect("a folder entry").path();
            if path.is_dir() { pending.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    files
}

/// All files with an extension in a folder and the folders in it, in order.
pub(crate) fn files_with(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut files = files_under(folder);
    files.retain(|path| path.extension().is_some_and(|found| found == extension));
    assert!(!files.is_empty(), "no file .{extension} in {}", folder.display());
    files
}

/// The text of a fixture, by its path in `fixtures`.
pub(crate) fn fixture(path: &str) -> String {
    fs::read_to_string(root().join("fixtures").join(path)).expect("a fixture")
}

/// All shaders in a folder of the package, in order, with names relative to the package.
pub(crate) fn shaders_under(folder: &str) -> Vec<Shader> {
    let shader = |path: &PathBuf| {
        let stage = stage_of(path)?;
        let bytes = fs::read(path).expect("a readable fixture");
        let name = path.strip_prefix(root()).expect("inside the package").to_string_lossy().into_owned();
        Some(Shader { name, text: String::from_utf8_lossy(&bytes).into_owned(), stage })
    };
    files_under(&root().join(folder)).iter().filter_map(shader).collect()
}

/// A compiler without options.
pub(crate) fn compiler() -> Compiler {
    Compiler::new(Options::default())
}

/// A compiler that finds the modules of the library.
pub(crate) fn library_compiler() -> Compiler {
    compiler().with_includes(glisten::library::Embedded)
}

/// Compiles the shaders of one program, without options.
pub(crate) fn compile_files(files: &[PathBuf]) -> Compilation {
    let source = |path: &PathBuf| Source {
        name: path.display().to_string(),
        text: String::from_utf8_lossy(&fs::read(path).expect("a readable fixture")).into(),
        stage: stage_of(path).expect("a shader"),
    };
    compiler().compile(&files.iter().map(source).collect::<Vec<Source>>())
}

/// Compiles one shader, without options.
pub(crate) fn compile_text(name: &str, text: &str, stage: Stage) -> Compilation {
    compiler().compile(&[Source { name: name.into(), text: text.into(), stage }])
}

/// The program of one fragment shader without errors.
#[track_caller]
pub(crate) fn fragment_program(text: &str) -> Program {
    let compilation = compile_text("test.frag", text, Stage::Fragment);
    let messages: Vec<String> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
    compilation.program.unwrap_or_else(|| panic!("{messages:?} in\n{text}"))
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
    let compilation = Compiler::new(options).with_includes(NextTo).compile(&sources);
    (compilation.sources, compilation.diagnostics)
}

/// Checks a value against the part of JSON Schema that the schemas in `docs` use.
pub(crate) fn conforms(value: &Value, schema: &Value, path: &str) -> Vec<String> {
    let is = |name: &str| match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "integer" => value.is_u64(),
        "number" => value.is_number(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("{path}: the schema uses the type {other}"),
    };
    let types: Vec<&str> = match &schema["type"] {
        Value::String(name) => vec![name],
        Value::Array(names) => names.iter().filter_map(Value::as_str).collect(),
        other => panic!("{path}: no type in the schema: {other}"),
    };
    if !types.iter().any(|name| is(name)) {
        return vec![format!("{path}: {value} is no {types:?}")];
    }
    if let Some(allowed) = schema["enum"].as_array()
        && !allowed.contains(value)
    {
        return vec![format!("{path}: {value} is not among {allowed:?}")];
    }
    let mut wrong = Vec::new();
    if let (Some(object), Some(properties)) = (value.as_object(), schema["properties"].as_object()) {
        for (key, inner) in object {
            match properties.get(key) {
                Some(schema) => wrong.extend(conforms(inner, schema, &format!("{path}.{key}"))),
                None => wrong.push(format!("{path}.{key} is not in the schema")),
            }
        }
        let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
        wrong.extend(required.filter(|key| !object.contains_key(*key)).map(|key| format!("{path}.{key} is missing")));
    }
    for (index, inner) in value.as_array().into_iter().flatten().enumerate() {
        wrong.extend(conforms(inner, &schema["items"], &format!("{path}[{index}]")));
    }
    wrong
}
