//! Compares glisten's verdicts on linking with those that `.shader_test` files state.
//!
//! ```text
//! cargo run --example piglit_linker -- path/to/piglit/tests/spec/glsl-1.50/linker
//! ```
//!
//! The arguments are files and folders. The shaders of each file are compiled and linked, and the verdict is compared
//! with the `link error` or `link success` of its `[test]` section (any drawing test must link). It prints each
//! mismatch with the first error, and a summary, and exits with 1 if there is a mismatch.

#![expect(clippy::print_stdout, reason = "a command-line program")]

use glisten_front::hir::Stage;
use glisten_front::{Compilation, Compiler, Options, Source};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Tests whose verdict depends on more than GLSL 1.50 core, and the reason.
const NOT_JUDGED: [(&str, &str); 3] = [
    ("versions-mingled", "one shader is of version 1.40, which is not compiled"),
    ("compatibility", "the compatibility profile is not compiled"),
    ("vs-gs-max-in-out-components", "it requires GL_ARB_arrays_of_arrays; 1.50 has arrays of one dimension (§4.1.9)"),
];

/// A shader test, as far as linking needs it.
#[derive(Default)]
struct Test {
    shaders: Vec<(Stage, String)>,
    version: Option<String>,
    must_link: bool,
}

fn main() -> ExitCode {
    let mut files = Vec::new();
    for argument in std::env::args_os().skip(1) {
        collect(Path::new(&argument), &mut files);
    }
    files.sort();
    let (mut agreed, mut skipped, mut mismatches) = (0, 0, 0);
    for file in &files {
        let Ok(text) = std::fs::read_to_string(file) else { continue };
        let Some(test) = parse(&text) else {
            skipped += 1;
            println!("skip     {}", file.display());
            continue;
        };
        let path = file.display().to_string();
        if let Some((_, why)) = NOT_JUDGED.iter().find(|row| path.contains(row.0)) {
            skipped += 1;
            println!("not judged {path}: {why}");
            continue;
        }
        let compilation = compile(&test);
        let linked = !compilation.diagnostics.has_errors();
        if linked == test.must_link {
            agreed += 1;
        } else {
            mismatches += 1;
            println!("MISMATCH {}: {}", file.display(), describe(&test, &compilation));
        }
    }
    println!("{agreed} agree, {mismatches} mismatch, {skipped} skipped");
    if mismatches > 0 { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        entries.for_each(|entry| collect(&entry.path(), files));
    } else if path.extension().is_some_and(|extension| extension == "shader_test") {
        files.push(path.to_owned());
    }
}

/// Parses a test; `None` if it has stages that glisten does not support.
fn parse(text: &str) -> Option<Test> {
    let mut test = Test { must_link: true, ..Test::default() };
    let mut section = "";
    for line in text.lines() {
        if let Some(name) = line.strip_prefix('[').and_then(|rest| rest.split(']').next()) {
            section = name;
            match name {
                "vertex shader" => test.shaders.push((Stage::Vertex, String::new())),
                "geometry shader" => test.shaders.push((Stage::Geometry, String::new())),
                "fragment shader" => test.shaders.push((Stage::Fragment, String::new())),
                "vertex shader passthrough" => test.shaders.push((Stage::Vertex, passthrough())),
                "require" | "test" | "vertex data" => {}
                name if name.contains("shader") => return None,
                _ => {}
            }
            continue;
        }
        match section {
            "vertex shader" | "geometry shader" | "fragment shader" => {
                let (_, shader) = test.shaders.last_mut()?;
                shader.push_str(line);
                shader.push('\n');
            }
            "require" if line.starts_with("GLSL >= ") => {
                test.version = Some(line.trim_start_matches("GLSL >= ").replace('.', "").trim().to_owned());
            }
            "test" if line.trim() == "link error" => test.must_link = false,
            _ => {}
        }
    }
    (!test.shaders.is_empty()).then_some(test)
}

fn passthrough() -> String {
    "in vec4 piglit_vertex;\nvoid main() { gl_Position = piglit_vertex; }\n".to_owned()
}

/// Compiles a test. A shader without a `#version` line gets the version that the test requires, as in the runner of
/// such tests.
fn compile(test: &Test) -> Compilation {
    let version = test.version.as_deref().unwrap_or("110");
    let sources: Vec<Source> = test
        .shaders
        .iter()
        .enumerate()
        .map(|(index, (stage, text))| {
            let has_version = text.lines().any(|line| line.trim_start().starts_with("#version"));
            let text = if has_version { text.trim_start().to_owned() } else { format!("#version {version}\n{text}") };
            Source { name: format!("{}{index}", stage.name()), text: text.into(), stage: *stage }
        })
        .collect();
    Compiler::new(Options::default()).compile(&sources)
}

fn describe(test: &Test, compilation: &Compilation) -> String {
    if !test.must_link {
        return "links, and must not".to_owned();
    }
    let error = compilation.diagnostics.iter().find(|diagnostic| diagnostic.is_error());
    error.map_or_else(String::new, |error| {
        let place = compilation.sources.location(error.primary.span);
        let line = place.map_or(0, |place| place.line);
        format!("{} {} (line {line})", error.code, error.message)
    })
}
