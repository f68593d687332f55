//! Shaders in the strings of JavaScript, TypeScript, Rust, Python, C and C++, for `lint --embedded` and the language server.
//!
//! *In:* files of those languages. *Out:* inputs as others are, each with its place in its file; the findings that do not depend on what
//! the strings lack ([`glisten_sources::embedded::doubt`]). *Holds:* the tables of `glisten.toml` count for them by the name of their file; what the
//! file itself shows (three.js, WebGL) counts where they say nothing.

use crate::arguments::engine::Engines;
use crate::batch::Batch;
use crate::exit::Failure;
use crate::files;
use crate::inputs::{self, Group, Input, Inputs, PartOf};
use crate::search::{self, Left, Why};
use glisten_front::compiler::Compiler;
use glisten_front::source::SourceMap;
use glisten_sources::Settings;
use glisten_sources::embedded::{self, Filling, Host, Program, doubt};
use glisten_sources::engines;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where three.js has its chunks, below a folder above the file.
const CHUNKS: [&str; 2] = ["node_modules/three/src/renderers/shaders/ShaderChunk", "src/renderers/shaders/ShaderChunk"];

/// The inputs in the text of a file.
pub(crate) fn inputs_in(path: &Path, text: &str) -> Vec<Input> {
    let Some(host) = Host::of(path) else { return Vec::new() };
    let stem = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut inputs = Vec::new();
    for (index, program) in embedded::programs(host, text).iter().enumerate() {
        let part = PartOf::in_string(index, format!("{stem}:{}", index + 1), host);
        let name = path.to_string_lossy();
        let input =
            |stage| Input { name: name.to_string(), path: Some(path.to_owned()), stage, part: Some(part.clone()) };
        inputs.extend(program.shaders.iter().map(|shader| input(shader.stage)));
    }
    inputs
}

/// The files whose strings are looked at, and the others.
pub(crate) fn split(named: Vec<PathBuf>) -> (Vec<PathBuf>, Vec<PathBuf>) {
    named.into_iter().partition(|path| Host::of(path).is_some() && !path.is_dir())
}

/// Adds the shaders in the strings of these files, and of those in the folders among `named`.
///
/// # Errors
/// A file or a folder that cannot be read.
pub(crate) fn add(inputs: &mut Inputs, hosts: &[PathBuf], named: &[PathBuf]) -> Result<(), Failure> {
    let mut all: Vec<PathBuf> = hosts.to_vec();
    for folder in named.iter().filter(|path| path.is_dir()) {
        let found = hosts_in(folder)?;
        inputs.found.extend(found.iter().cloned());
        all.extend(found);
    }
    let mut seen = BTreeSet::new();
    for path in all.into_iter().filter(|path| seen.insert(inputs::identity(path))) {
        let name = path.to_string_lossy();
        let found = match files::read_source(&name, Some(&path)) {
            Ok(text) => {
                if Host::of(&path) == Some(Host::C) && embedded::has_unread_macros(&text) {
                    inputs.left.push(Left { path: path.clone(), why: Why::Macros });
                }
                inputs_in(&path, &text)
            }
            // A file that a search found need not be a text.
            Err(_) if inputs.found.contains(&path) => Vec::new(),
            Err(error) => {
                let failure = Failure::usage(error.message);
                return Err(if let Some(help) = error.help { failure.help(help) } else { failure });
            }
        };
        let groups = inputs::group(found);
        if !groups.is_empty() && !inputs.empty_folders.is_empty() {
            let own = inputs::identity(&path);
            inputs.empty_folders.retain(|folder| !own.starts_with(inputs::identity(Path::new(folder))));
        }
        inputs.groups.extend(groups);
    }
    Ok(())
}

/// The files in a folder whose strings are looked at.
///
/// # Errors
/// A folder that cannot be read.
pub(crate) fn hosts_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut found = search::files(folder)?.files;
    found.retain(|path| Host::of(path).is_some());
    found.sort();
    Ok(found)
}

/// The programs in the strings of a file, if it is one of their languages.
#[cfg(feature = "lsp")]
pub(crate) fn programs(path: &Path, text: &str) -> Option<Vec<Program>> {
    Host::of(path).map(|host| embedded::programs(host, text))
}

/// The program of a group that is in strings, with the text of its file.
fn program_of(group: &Group, text: &str) -> Option<Program> {
    let (index, host) = group.inputs.first()?.part.as_ref()?.host()?;
    embedded::programs(host, text).into_iter().nth(index)
}

/// The settings of the shaders of a group, where flags and tables say nothing.
fn fallback(program: &Program, file: &Path) -> Settings {
    let mut folders = Vec::new();
    if program.engine == Some("three") {
        let absolute = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
        let above = absolute.ancestors().skip(1);
        folders.extend(above.flat_map(|folder| CHUNKS.map(|chunks| folder.join(chunks))).find(|path| path.is_dir()));
    }
    Settings {
        folders,
        profile: program.engine.and_then(engines::find),
        version: program.version.map(str::to_owned),
        ..Settings::default()
    }
}

/// The compiler for a group whose shaders are in the strings of this file.
pub(crate) fn compiler(compiler: &Compiler, engines: &Engines, group: &Group, text: &str) -> Option<Compiler> {
    let program = program_of(group, text)?;
    let file = group.inputs.first()?.path.as_deref()?;
    Some(compiler.clone().with_preparation(engines.with_fallback(fallback(&program, file))))
}

/// Whether a shader is in a string.
pub(crate) fn is_in_string(input: &Input) -> bool {
    input.part.as_ref().is_some_and(|part| part.host().is_some())
}

/// The group with another filling of what its strings leave open.
fn filled(group: &Group, filling: Filling) -> Group {
    let mut group = group.clone();
    for part in group.inputs.iter_mut().filter_map(|input| input.part.as_mut()) {
        part.fill(filling);
    }
    group
}

/// Drops the findings of a group that depend on what its strings leave open. `compile` tells the findings of other fillings.
pub(crate) fn keep_certain(
    group: &Group,
    text: &str,
    batch: &mut Batch,
    mut compile: impl FnMut(Group) -> Option<Batch>,
) {
    let Some(program) = program_of(group, text) else { return };
    let mut others = Vec::new();
    if program.is_unsure() {
        for filling in Filling::OTHERS {
            let other = compile(filled(group, filling));
            // What does not fit the grammar cannot be there.
            if let Some(other) = other.filter(|other| !doubt::breaks(&other.diagnostics, &batch.diagnostics)) {
                others.push(doubt::known(&other.sources, &other.diagnostics));
            }
        }
    }
    doubt::keep(&program, text, &batch.sources, &others, &mut batch.diagnostics);
}

/// Lets findings in a part of a file show the lines of the file, whose text `text` gives.
pub(crate) fn show_files(group: &Group, sources: &mut SourceMap, text: impl Fn(&Input) -> Option<Arc<str>>) {
    for input in group.inputs.iter().filter(|input| input.part.is_some()) {
        if let Some(text) = text(input) {
            sources.show(&input.name, &text);
        }
    }
}
