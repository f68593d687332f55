//! Finds out what a name of a program is (`glisten reflect --find`).
//!
//! OpenGL hosts look up attributes, uniforms and outputs with different functions. The wrong function silently
//! returns -1, so the answer says which kind a name is.

use super::{Binding, Reflection};
use glisten_front::diagnostic::nearest_path;
use glisten_front::hir::Storage;
use glisten_front::link::Program;
use serde::Serialize;

/// A thing of that name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Match {
    /// `attribute`, `varying`, `output`, `block`, `uniform`, `sampler`, or `other` for what no host can access.
    pub kind: &'static str,
    /// Its name, or the path of a part of what was asked for.
    pub name: String,
    /// Whether it is a part of what was asked for.
    pub part: bool,
    /// A sentence that says what it is.
    pub description: String,
    /// Its row in the reflection; null for `other`.
    pub row: serde_json::Value,
}

impl Match {
    fn new(kind: &'static str, name: &str, description: String, row: &impl Serialize) -> Self {
        let row = serde_json::to_value(row).unwrap_or_default();
        Self { kind, name: name.to_owned(), part: false, description, row }
    }
}

/// The answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// All things of that name, or the parts of one.
    Known(Vec<Match>),
    /// There is no such name.
    Unknown {
        /// The most similar name.
        nearest: Option<String>,
    },
}

/// Looks up a name among attributes, varyings, outputs, uniforms, blocks and samplers, then among all other globals.
/// `a[0]` finds the array `a`, `a[2]` its element, as `glGetUniformLocation` does (OpenGL 3.2 §2.11.4); a struct or a block finds its
/// members, and the instance of a block finds what hosts name after the block.
pub fn find(program: &Program, reflection: &Reflection, name: &str) -> Found {
    let mut lines = places(reflection, name);
    let of_block = path_of_block(program, name);
    if let (true, Some(path)) = (lines.is_empty(), &of_block) {
        lines = by_instance(reflection, name, path);
    }
    if lines.is_empty() {
        lines = globals(program, name);
    }
    let wanted = of_block.as_deref().unwrap_or(name);
    if lines.is_empty() {
        Found::Unknown { nearest: nearest(program, reflection, wanted) }
    } else {
        Found::Known(lines)
    }
}

/// The things that hosts reach by a name.
fn places(reflection: &Reflection, name: &str) -> Vec<Match> {
    let mut lines = exact(reflection, name);
    if lines.is_empty()
        && let Some(base) = name.strip_suffix("[0]")
    {
        lines = exact(reflection, base);
        lines.retain(|found| is_array(&found.row));
    }
    if lines.is_empty() {
        lines = element(reflection, name);
    }
    if lines.is_empty() {
        lines = members(reflection, name);
    }
    lines
}

/// Whether a row of the reflection is one of an array. What is none has no element 0 (OpenGL 3.2 §2.11.4).
fn is_array(row: &serde_json::Value) -> bool {
    let is_of_elements = |ty: &str| ty.ends_with(']');
    row["array_size"].is_number() || row["type"].as_str().is_some_and(is_of_elements)
}

/// The path by which hosts name a part of a block that has an instance name: with the block's name (OpenGL 3.2 §2.11.4).
fn path_of_block(program: &Program, name: &str) -> Option<String> {
    let (instance, rest) = name.split_at(name.find(['.', '[']).unwrap_or(name.len()));
    let mut globals = program.stages.iter().flat_map(|shader| &shader.globals);
    let block = globals.find(|global| global.block.is_some() && global.name == instance)?.match_name();
    (block != instance).then(|| format!("{block}{rest}"))
}

/// The things that hosts name after a block, by the name of its instance.
fn by_instance(reflection: &Reflection, name: &str, path: &str) -> Vec<Match> {
    let found = places(reflection, path);
    let Some(kind) = found.first().map(|first| first.kind) else { return Vec::new() };
    let head = format!("`{name}` is named `{path}` by hosts, after its block:");
    let mut lines = vec![Match::new(kind, name, head, &serde_json::Value::Null)];
    lines.extend(found.into_iter().map(|found| Match { part: true, ..found }));
    lines
}

fn state(active: bool) -> &'static str {
    if active { "" } else { ", not in use" }
}

fn at(group: u32, binding: u32) -> String {
    format!("group {group}, binding {binding}")
}

fn exact(reflection: &Reflection, name: &str) -> Vec<Match> {
    let mut lines = Vec::new();
    for row in reflection.attributes.iter().filter(|row| row.name == name) {
        let line = format!("`{name}` is an attribute: {} at location {}{}", row.ty, row.location, state(row.active));
        lines.push(Match::new("attribute", name, line, row));
    }
    for row in reflection.varyings.iter().filter(|row| row.name == name) {
        let line = format!(
            "`{name}` is a varying: {} {} at location {}, component {}{}",
            row.interpolation,
            row.ty,
            row.location,
            row.component,
            state(row.active)
        );
        lines.push(Match::new("varying", name, line, row));
    }
    for row in reflection.outputs.iter().filter(|row| row.name == name) {
        let line = format!("`{name}` is a fragment output: {}, color number {}", row.ty, row.location);
        lines.push(Match::new("output", name, line, row));
    }
    for row in reflection.blocks.iter().filter(|row| row.name == name) {
        let place = at(row.group, row.binding);
        let line = format!("`{name}` is a uniform block of {} bytes at {place}{}", row.size, state(row.active));
        lines.push(Match::new("block", name, line, row));
    }
    for row in reflection.uniforms.iter().filter(|row| row.name == name) {
        let array = row.array_size.map_or(String::new(), |size| format!("[{size}]"));
        let place = at(row.group, row.binding);
        let active = state(row.active);
        let line = format!("`{name}` is a uniform: {}{array} at {place}, offset {}{active}", row.ty, row.offset);
        lines.push(Match::new("uniform", name, line, row));
    }
    for row in reflection.samplers.iter().filter(|row| row.name == name) {
        let Binding { group, binding } = row.texture;
        let sampler = if row.sampler == row.texture {
            String::new()
        } else {
            format!(", sampler at {}", at(row.sampler.group, row.sampler.binding))
        };
        let active = state(row.active);
        let line = format!("`{name}` is a uniform: {}, texture at {}{sampler}{active}", row.ty, at(group, binding));
        lines.push(Match::new("sampler", name, line, row));
    }
    lines
}

/// An element of an array of uniforms, attributes or outputs.
fn element(reflection: &Reflection, name: &str) -> Vec<Match> {
    let parts = name.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
    let Some((base, Ok(index))) = parts.map(|(base, index)| (base, index.parse::<u32>())) else { return Vec::new() };
    let rows = reflection.uniforms.iter().filter(|row| row.name == base);
    let found = rows.filter_map(|row| {
        let stride = row.array_stride.filter(|_| row.array_size.is_some_and(|size| index < size))?;
        let (place, offset) = (at(row.group, row.binding), row.offset.checked_add(index.checked_mul(stride)?)?);
        let line = format!(
            "`{name}` is an element of the uniform `{base}`: {} at {place}, offset {offset}{}",
            row.ty,
            state(row.active)
        );
        Some(Match::new("uniform", name, line, row))
    });
    let attributes = reflection.attributes.iter().filter(|row| row.name == base).filter_map(|row| {
        let (ty, size) = element_type(&row.ty).filter(|(_, size)| index < *size)?;
        let location = row.location.checked_add(index.checked_mul(row.columns.checked_div(size)?)?)?;
        let active = state(row.active);
        let line = format!("`{name}` is an element of the attribute `{base}`: {ty} at location {location}{active}");
        Some(Match::new("attribute", name, line, row))
    });
    let outputs = reflection.outputs.iter().filter(|row| row.name == base).filter_map(|row| {
        let (ty, _) = element_type(&row.ty).filter(|(_, size)| index < *size)?;
        let number = row.location.checked_add(index)?;
        let line = format!("`{name}` is an element of the fragment output `{base}`: {ty}, color number {number}");
        Some(Match::new("output", name, line, row))
    });
    found.chain(attributes).chain(outputs).collect()
}

/// The type of an array's elements, and how many there are.
fn element_type(ty: &str) -> Option<(&str, u32)> {
    let (element, size) = ty.strip_suffix(']')?.split_once('[')?;
    Some((element, size.parse().ok()?))
}

/// The members or columns of a struct, matrix or block.
fn members(reflection: &Reflection, name: &str) -> Vec<Match> {
    let inside = |path: &str| path.strip_prefix(name).is_some_and(|rest| rest.starts_with(['.', '[']));
    let paths = reflection.uniforms.iter().map(|row| (&row.name, "uniform"));
    let paths = paths.chain(reflection.samplers.iter().map(|row| (&row.name, "uniform")));
    let paths = paths.chain(reflection.varyings.iter().map(|row| (&row.name, "varying")));
    let parts: Vec<_> = paths.filter(|(path, _)| inside(path)).collect();
    let Some((_, kind)) = parts.first() else { return Vec::new() };
    let kind: &'static str = kind;
    let head = format!("`{name}` is a {kind} of {} parts:", parts.len());
    let mut lines = vec![Match::new(kind, name, head, &serde_json::Value::Null)];
    lines.extend(parts.iter().flat_map(|(path, _)| exact(reflection, path)).map(|mut found| {
        found.part = true;
        found
    }));
    lines
}

/// Names that the host cannot access: outputs that nothing reads, built-in and global variables.
fn globals(program: &Program, name: &str) -> Vec<Match> {
    let mut lines = Vec::new();
    for shader in &program.stages {
        for global in shader.globals.iter().filter(|global| global.name == name) {
            let what = match (global.builtin.is_some(), global.storage) {
                (true, _) => "a built-in variable",
                (false, Storage::Const) => "a constant",
                (false, Storage::Private) => "a global variable",
                (false, Storage::Uniform) => "a uniform",
                (false, Storage::In) => "an input",
                (false, Storage::Out) => "an output",
            };
            let stage = shader.stage.name();
            let ty = program.types.name(global.ty);
            let line = format!("`{name}` is {what} of the {stage} stage ({ty}), without a place outside of it");
            lines.push(Match::new("other", name, line, &serde_json::Value::Null));
        }
    }
    lines
}

fn nearest(program: &Program, reflection: &Reflection, name: &str) -> Option<String> {
    let mut names: Vec<&str> = reflection.attributes.iter().map(|row| row.name.as_str()).collect();
    names.extend(reflection.varyings.iter().map(|row| row.name.as_str()));
    names.extend(reflection.outputs.iter().map(|row| row.name.as_str()));
    names.extend(reflection.blocks.iter().map(|row| row.name.as_str()));
    names.extend(reflection.uniforms.iter().map(|row| row.name.as_str()));
    names.extend(reflection.samplers.iter().map(|row| row.name.as_str()));
    names.extend(program.stages.iter().flat_map(|shader| &shader.globals).map(|global| global.name.as_str()));
    nearest_path(name, &names).map(str::to_owned)
}
