//! Compiles the shaders of a test, and reads what the verdict depends on.

use glisten_front::{Compilation, Compiler, Diagnostic, Options, Source, Stage};
use std::io;
use std::path::{Path, PathBuf};

/// The stage that a file's extension names.
pub(crate) fn stage_of(path: &Path) -> Option<Stage> {
    match path.extension()?.to_str()? {
        "vert" => Some(Stage::Vertex),
        "geom" => Some(Stage::Geometry),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

/// All files in a folder and its folders, sorted.
pub(crate) fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(next)? {
            let path = entry?.path();
            if path.is_dir() { open.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    Ok(found)
}

/// The text of a file; bytes that are not UTF-8 are replaced.
pub(crate) fn text_of(path: &Path) -> io::Result<String> {
    Ok(String::from_utf8_lossy(&std::fs::read(path)?).into_owned())
}

/// Compiles and links the shaders.
pub(crate) fn compile(shaders: &[(Stage, String)]) -> Compilation {
    let source = |(index, (stage, text)): (usize, &(Stage, String))| Source {
        name: format!("{}{index}", stage.name()),
        text: text.as_str().into(),
        stage: *stage,
    };
    let sources: Vec<Source> = shaders.iter().enumerate().map(source).collect();
    Compiler::new(Options::default()).compile(&sources)
}

/// The line of a diagnostic, as the text counts.
pub(crate) fn line_of(compilation: &Compilation, diagnostic: &Diagnostic) -> u32 {
    compilation.sources.location(diagnostic.primary.span).map_or(0, |place| place.line)
}

/// The first error with its line.
pub(crate) fn first_error(compilation: &Compilation) -> Option<String> {
    let error = compilation.diagnostics.iter().find(|diagnostic| diagnostic.is_error())?;
    Some(format!("{} {} (line {})", error.code, error.message, line_of(compilation, error)))
}

/// The extension or feature that the program needs and glisten does not have, if a diagnostic names one.
pub(crate) fn missing(compilation: &Compilation) -> Option<String> {
    let lacks = |diagnostic: &&Diagnostic| matches!(diagnostic.code.id, "E0125" | "W0106" | "E0001");
    let found = compilation.diagnostics.iter().find(lacks)?;
    Some(found.message.clone())
}
