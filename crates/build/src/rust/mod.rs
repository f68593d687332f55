//! A program as a Rust module.
//!
//! *In:* a linked program, its texts, and choices. *Out:* the text of a module: code for the targets, structs in the layout of
//! uniform buffers ([`layout`]), vertices ([`vertex`]), and descriptors for wgpu ([`wgpu`]).
//!
//! *Holds:* the text needs no crate unless a choice asks for one, compiles without warnings, and asserts the offset of every
//! field when it is compiled.

mod c;
mod defaults;
mod fields;
mod indent;
mod layout;
mod names;
mod structs;
mod types;
mod vertex;
mod wgpu;

pub(super) use c::header;
pub(super) use names::module_name;

use glisten_emit::{self as emit, Conventions, Emitted, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, comments};
use layout::Layouts;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The parts of a module that are chosen.
#[derive(Clone, Debug)]
pub(super) struct Choices {
    /// The targets of the code, each once.
    pub(super) targets: Vec<Target>,
    pub(super) bytemuck: bool,
    pub(super) glam: bool,
    pub(super) wgpu: bool,
    /// The attributes that step by instance.
    pub(super) instanced: Vec<String>,
    /// The folder that the names of files are relative to.
    pub(super) root: Option<PathBuf>,
}

impl Default for Choices {
    fn default() -> Self {
        Self {
            targets: vec![Target::Wgsl, Target::Spirv],
            bytemuck: false,
            glam: false,
            wgpu: false,
            instanced: Vec::new(),
            root: None,
        }
    }
}

/// The attributes of each module, for code that nobody formats or reads in part. A crate may deny any lint: those that code which
/// nobody wrote can meet are allowed by name.
const ATTRIBUTES: &str = include_str!("attributes.rs.txt");

/// The text in front of all programs.
pub(super) fn opening() -> String {
    let mut text = format!("// Written by glisten {} from GLSL. Changes are lost.\n\n", env!("CARGO_PKG_VERSION"));
    text.push_str("/// Values as the bytes of a buffer.\n");
    text.push_str(ATTRIBUTES);
    text.push_str(include_str!("memory.rs.txt"));
    text
}

/// The module of a program.
pub(super) fn module(
    name: &str,
    program: &Program,
    sources: &SourceMap,
    conventions: &Conventions,
    choices: &Choices,
) -> Result<String, Vec<Diagnostic>> {
    let mut body = String::new();
    for shader in &program.stages {
        for target in &choices.targets {
            body.push_str(&code(shader.stage, *target, emit::emit(program, shader.stage, *target, conventions)?));
        }
    }
    let reflection = emit::reflect(program, conventions);
    let layouts = Layouts::of(program, sources, &reflection);
    body.push_str(&structs::text(&layouts, choices));
    let vertices = vertex::Vertices::of(program, sources, &choices.instanced);
    body.push_str(&vertices.text(choices));
    if choices.wgpu {
        body.push_str(&wgpu::text(&reflection, &layouts, &vertices));
    }
    let mut text = String::new();
    let files: Vec<String> = program.stages.iter().filter_map(|shader| file_of(shader, sources, choices)).collect();
    let _ = writeln!(text, "/// The program of {}.", files.join(" and "));
    let leading = program.stages.first().and_then(|shader| leading(shader, sources)).unwrap_or_default();
    leading.iter().for_each(|line| text.push_str(&doc_line(line)));
    text.push_str(ATTRIBUTES);
    let _ = writeln!(text, "pub mod {} {{", module_name(name));
    if body.contains("impl Bytes for") {
        text.push_str("use super::glisten_memory::Bytes;\n\n");
    }
    text.push_str(&body);
    text.push_str("}\n");
    Ok(indent::indented(&text))
}

/// The constant with the code of a stage.
fn code(stage: Stage, target: Target, emitted: Emitted) -> String {
    let constant = format!("{}_{}", stage.name(), target.word()).to_uppercase();
    let (what, ty, value) = match emitted {
        Emitted::Text(text) => ("", "&str", raw(&text)),
        Emitted::Words(words) => {
            let words: Vec<String> = words.iter().map(u32::to_string).collect();
            (" The entry point is `main`.", "&[u32]", format!("&[{}]", words.join(",")))
        }
    };
    let (stage, target) = (stage.name(), target.name());
    format!("/// The {stage} stage in {target}.{what}\npub const {constant}: {ty} = {value};\n\n")
}

/// The file of a stage, as code in a comment.
fn file_of(shader: &glisten_front::hir::Shader, sources: &SourceMap, choices: &Choices) -> Option<String> {
    let main = shader.main.and_then(|main| shader.functions.get(main.index()))?;
    let name = Path::new(sources.file(sources.file_of(main.span)?).name());
    let root = choices.root.as_deref().unwrap_or(Path::new(""));
    let name = name.strip_prefix(root).unwrap_or(name).to_string_lossy();
    Some(format!("`{}`", name.replace('\\', "/")))
}

/// The comment at the top of a stage's file.
fn leading(shader: &glisten_front::hir::Shader, sources: &SourceMap) -> Option<Vec<String>> {
    let main = shader.main.and_then(|main| shader.functions.get(main.index()))?;
    let text = sources.file(sources.file_of(main.span)?).text();
    let lines: Vec<String> = comments::leading(text).iter().map(|line| uncommented(line)).collect();
    (!lines.is_empty()).then(|| std::iter::once(String::new()).chain(lines).collect())
}

/// A line of a comment without its signs.
fn uncommented(line: &str) -> String {
    let line = line.trim();
    let line = line.strip_prefix("/**").or(line.strip_prefix("/*")).or(line.strip_prefix("///")).unwrap_or(line);
    let line = line.strip_prefix("//").or(line.strip_prefix("* ")).unwrap_or(line);
    let line = line.strip_suffix("*/").unwrap_or(line);
    if line == "*" { String::new() } else { line.trim().to_owned() }
}

/// A line of documentation. Brackets are no links, and signs are no markup.
fn doc_line(line: &str) -> String {
    let escaped: String = line
        .chars()
        .flat_map(|one| {
            let special = matches!(one, '[' | ']' | '<' | '>' | '*' | '_' | '`' | '|' | '\\');
            special.then_some('\\').into_iter().chain([one])
        })
        .collect();
    if escaped.is_empty() { "///\n".into() } else { format!("/// {escaped}\n") }
}

/// The documentation of a declaration: its name in GLSL, and its comments.
fn documentation(what: &str, sources: &SourceMap, span: glisten_front::source::Span) -> String {
    let mut text = format!("/// {what}\n");
    let comment: Vec<String> = comments::above_but_not_leading(sources, span)
        .iter()
        .map(|line| uncommented(line))
        .chain(comments::behind(sources, span).map(|line| uncommented(&line)))
        .filter(|line| !line.is_empty())
        .collect();
    if !comment.is_empty() {
        text.push_str("///\n");
        comment.iter().for_each(|line| text.push_str(&doc_line(line)));
    }
    text
}

/// A raw string with enough signs around it.
fn raw(text: &str) -> String {
    let mut signs = String::from("#");
    while text.contains(&format!("\"{signs}")) {
        signs.push('#');
    }
    format!("r{signs}\"{text}\"{signs}")
}
