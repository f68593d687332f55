//! A name in words and in GLSL: declarations, values, and the places that the link assigns.
//!
//! *In:* a symbol of a program. *Out:* its declaration as GLSL, its comment, and facts: location, offset, interpolation, value.

use super::analysis::Analysis;
use glisten_front::analysis::Denoted;
use glisten_front::hir::{
    Function, Global, Interpolation, LocalKind, ParamMode, ScalarValue, Stage, Storage, Type, TypeId, Types, Value,
};
use glisten_front::index::{Symbol, View};
use glisten_front::link::Program;
use glisten_front::source::{Span, comments};

/// A longer line, in bytes, does not describe what is declared on it.
const MAX_LINE: u32 = 512;
/// A struct with more members is shown in part.
const MAX_MEMBERS: usize = 24;
/// A value with more numbers is shown in part.
const MAX_NUMBERS: usize = 16;

/// The word before a global.
fn storage_word(storage: Storage) -> &'static str {
    match storage {
        Storage::Const => "const ",
        Storage::Private => "",
        Storage::Uniform => "uniform ",
        Storage::In => "in ",
        Storage::Out => "out ",
    }
}

fn interpolation_word(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Smooth => "smooth",
        Interpolation::Noperspective => "noperspective",
        Interpolation::Flat => "flat",
    }
}

fn mode_word(mode: ParamMode) -> &'static str {
    match mode {
        ParamMode::In => "",
        ParamMode::ConstIn => "const ",
        ParamMode::Out => "out ",
        ParamMode::Inout => "inout ",
    }
}

/// A variable as it is declared: `float a[3]`.
fn variable(types: &Types, ty: TypeId, name: &str) -> String {
    format!("{} {name}", types.name(ty))
}

/// A parameter as it is declared.
pub(crate) fn parameter(types: &Types, ty: TypeId, mode: ParamMode, name: &str) -> String {
    let text = variable(types, ty, name);
    format!("{}{}", mode_word(mode), text.trim_end())
}

/// The header of a function.
pub(crate) fn header(types: &Types, function: &Function) -> String {
    let params: Vec<String> = parameters(types, function);
    format!("{} {}({})", types.name(function.ret), function.name, params.join(", "))
}

/// The parameters of a function.
pub(crate) fn parameters(types: &Types, function: &Function) -> Vec<String> {
    let params = function.params().iter().enumerate();
    params.map(|(index, param)| parameter(types, param.ty, function.param_mode(index), &param.name)).collect()
}

fn global(types: &Types, global: &Global) -> String {
    let mut text = String::new();
    if global.interpolation_written {
        text.push_str(&format!("{} ", interpolation_word(global.interpolation)));
    }
    if global.invariant {
        text.insert_str(0, "invariant ");
    }
    text.push_str(storage_word(global.storage));
    text.push_str(&variable(types, global.ty, &global.name));
    if let Some(value) = &global.value {
        text.push_str(&format!(" = {}", self::value(types, value)));
    }
    text
}

/// The declaration of what a symbol denotes in a view.
pub(crate) fn declaration(analysis: &Analysis, view: usize, denoted: Denoted) -> Option<String> {
    let inspection = &analysis.compiled.inspection;
    let (types, shader) = (&inspection.types, &inspection.view(view)?.shader);
    Some(match denoted {
        Denoted::Global(id) => global(types, shader.globals.get(id.index())?),
        Denoted::Local(function, id) => {
            let local = shader.functions.get(function.index())?.locals.get(id.index())?;
            match local.kind {
                LocalKind::Param(mode) => parameter(types, local.ty, mode, &local.name),
                LocalKind::Variable => variable(types, local.ty, &local.name),
                LocalKind::Const => match &local.value {
                    Some(value) => {
                        format!("const {} = {}", variable(types, local.ty, &local.name), self::value(types, value))
                    }
                    None => format!("const {}", variable(types, local.ty, &local.name)),
                },
            }
        }
        Denoted::Function(id) => header(types, shader.functions.get(id.index())?),
        Denoted::Struct(id) => {
            let structure = types.structure(id);
            format!("struct {} {}", structure.name, members(types, TypeMembers::of(structure)))
        }
        Denoted::Block(id) => {
            let structure = types.structure(id);
            let block = shader.globals.iter().find(|global| {
                global.block.as_ref().is_some_and(|block| block.name == structure.name)
                    && has(types, global.ty, denoted)
            });
            let word = block.map_or("", |block| storage_word(block.storage));
            format!("{word}{} {}", structure.name, members(types, TypeMembers::of(structure)))
        }
        Denoted::Member(id, member) => {
            let structure = types.structure(id);
            let member = structure.members.get(member as usize)?;
            let owner = if structure.name.is_empty() { String::new() } else { format!("{}.", structure.name) };
            format!("{} {owner}{}", types.name(member.ty), member.name)
        }
        Denoted::Broken(span) => {
            // Of a line with thousands of names, each would have all.
            let line = line_of(analysis, span).filter(|line| line.end - line.start <= MAX_LINE)?;
            analysis.sources().snippet(line).trim().to_owned()
        }
        Denoted::Builtin | Denoted::Components(_) | Denoted::Length(_) => return None,
    })
}

fn has(types: &Types, ty: TypeId, block: Denoted) -> bool {
    let mut ty = ty;
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    matches!((types.get(ty), block), (Type::Struct(one), Denoted::Block(other)) if one == other)
}

/// The line that a span begins on.
fn line_of(analysis: &Analysis, span: Span) -> Option<Span> {
    let file = analysis.sources().file(analysis.sources().file_of(span)?);
    let range = file.line_range(analysis.sources().line(span)?)?;
    Some(Span::new(file.base() + range.start as u32, file.base() + range.end as u32))
}

/// The members of a struct.
struct TypeMembers<'t>(&'t [glisten_front::language::Member]);

impl<'t> TypeMembers<'t> {
    fn of(structure: &'t glisten_front::language::StructType) -> Self {
        Self(&structure.members)
    }
}

fn members(types: &Types, list: TypeMembers<'_>) -> String {
    let mut text = "{\n".to_owned();
    for member in list.0.iter().take(MAX_MEMBERS) {
        text.push_str(&format!("    {};\n", variable(types, member.ty, &member.name)));
    }
    if list.0.len() > MAX_MEMBERS {
        text.push_str(&format!("    // and {} more\n", list.0.len() - MAX_MEMBERS));
    }
    text.push('}');
    text
}

/// A constant as GLSL.
pub(crate) fn value(types: &Types, value: &Value) -> String {
    let number = |scalar: &ScalarValue| match scalar {
        ScalarValue::Bool(value) => value.to_string(),
        ScalarValue::Int(value) => value.to_string(),
        ScalarValue::Uint(value) => format!("{value}u"),
        ScalarValue::Float(value) => format!("{value:?}"),
    };
    let numbers: Vec<String> = value.scalars.iter().take(MAX_NUMBERS).map(number).collect();
    let more = if value.scalars.len() > MAX_NUMBERS { ", .." } else { "" };
    match (types.get(value.ty), numbers.as_slice()) {
        (Type::Scalar(_), [one]) => one.clone(),
        _ => format!("{}({}{more})", types.name(value.ty), numbers.join(", ")),
    }
}

/// Whether a name is a parameter, whose line has the comment of its function above it.
pub(crate) fn is_parameter(analysis: &Analysis, view: usize, denoted: Denoted) -> bool {
    let Denoted::Local(function, id) = denoted else { return false };
    let view = analysis.compiled.inspection.view(view);
    let function = view.and_then(|view| view.shader.functions.get(function.index()));
    let local = function.and_then(|function| function.locals.get(id.index()));
    local.is_some_and(|local| matches!(local.kind, LocalKind::Param(_)))
}

/// The comment at a declaration, as text.
pub(crate) fn comment(analysis: &Analysis, symbol: &Symbol) -> Option<String> {
    let comments = symbol.declarations.iter().filter_map(|span| {
        let above = comments::above(analysis.sources(), *span);
        let lines =
            if above.is_empty() { comments::behind(analysis.sources(), *span).into_iter().collect() } else { above };
        (!lines.is_empty()).then_some(lines)
    });
    let lines = comments.into_iter().next()?;
    let text: Vec<&str> = lines.iter().map(|line| words_of(line)).collect();
    let text = text.join("\n").trim().to_owned();
    (!text.is_empty()).then_some(text)
}

/// A line of a comment without its signs.
fn words_of(line: &str) -> &str {
    let line = line.trim().trim_start_matches("/**").trim_start_matches("/*").trim_end_matches("*/");
    let line = line.trim_start_matches('/').trim_start_matches('*');
    line.strip_prefix(' ').unwrap_or(line).trim_end()
}

/// The stage of a view.
pub(crate) fn stage(view: &View) -> Stage {
    view.shader.stage
}

/// The link's facts about a symbol: locations, offsets, bindings.
pub(crate) fn facts(analysis: &Analysis, symbol: &Symbol) -> Vec<String> {
    let (Some(program), Some(&(view, denoted))) = (&analysis.good, symbol.places.first()) else { return Vec::new() };
    let Some(view) = analysis.compiled.inspection.view(view) else { return Vec::new() };
    match denoted {
        Denoted::Global(id) => {
            view.shader.globals.get(id.index()).map_or_else(Vec::new, |global| of_global(program, view, global))
        }
        Denoted::Member(id, _) => {
            let structure = analysis.compiled.inspection.types.structure(id);
            if structure.is_block { of_member(program, &structure.name, &symbol.name) } else { Vec::new() }
        }
        Denoted::Block(_) => of_block(program, &symbol.name),
        _ => Vec::new(),
    }
}

/// The link's facts about a global.
pub(crate) fn of_global(program: &Program, view: &View, global: &Global) -> Vec<String> {
    let interface = &program.interface;
    let is_part = |name: &str| {
        let rest = name.strip_prefix(global.name.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '.']))
    };
    let mut facts = Vec::new();
    if let Some(block) = &global.block {
        return of_block(program, &block.name);
    }
    match (global.storage, view.shader.stage) {
        (Storage::In, Stage::Vertex) => {
            let found = interface.attributes.iter().find(|attribute| attribute.name == global.name);
            facts.extend(found.map(|attribute| locations("attribute location", attribute.location, attribute.columns)));
        }
        (Storage::Out, Stage::Fragment) => {
            let found = interface.outputs.iter().find(|output| output.name == global.name);
            facts.extend(found.map(|output| format!("color number {}", output.location)));
        }
        (Storage::In | Storage::Out, _) => {
            let parts: Vec<_> = interface.varyings.iter().filter(|varying| is_part(&varying.name)).collect();
            if let Some(first) = parts.first() {
                let mut text = locations("varying location", first.location, parts.len() as u32);
                if first.component > 0 {
                    text.push_str(&format!(", component {}", first.component));
                }
                facts.push(text);
                facts.push(format!("interpolation {}", interpolation_word(first.interpolation)));
                if !first.active {
                    facts.push("the fragment stage does not read it".to_owned());
                }
            }
        }
        (Storage::Uniform, _) => {
            if let Some(slot) = interface.samplers.iter().find(|slot| is_part(&slot.name)) {
                let (texture, sampler) = (slot.texture, slot.sampler);
                facts.push(format!("texture: group {}, binding {}", texture.group, texture.binding));
                if texture != sampler {
                    facts.push(format!("sampler: group {}, binding {}", sampler.group, sampler.binding));
                }
            }
            if let Some(root) = interface.roots.iter().find(|root| root.block.is_none() && root.name == global.name) {
                facts.push(format!("offset {} in the block of loose uniforms (std140)", root.offset));
                if !root.active {
                    facts.push("no stage reads it".to_owned());
                }
            }
        }
        (Storage::Const | Storage::Private, _) => {}
    }
    facts
}

fn locations(what: &str, first: u32, count: u32) -> String {
    if count > 1 { format!("{what} {first} to {}", first + count - 1) } else { format!("{what} {first}") }
}

/// The link's facts about a member of a block.
pub(crate) fn of_member(program: &Program, block: &str, member: &str) -> Vec<String> {
    let Some(offset) = member_offset(program, block, member) else { return Vec::new() };
    let (leaf, n_bytes) = offset;
    let mut facts = vec![format!("offset {n_bytes} in `{block}` (std140)")];
    facts.extend(leaf.array_stride.map(|stride| format!("array stride {stride}")));
    facts.extend(leaf.matrix_stride.map(|stride| format!("matrix stride {stride}")));
    facts
}

/// The first leaf of a member of a uniform block, and its offset.
pub(crate) fn member_offset<'p>(
    program: &'p Program,
    block: &str,
    member: &str,
) -> Option<(&'p glisten_front::link::UniformLeaf, u32)> {
    let interface = &program.interface;
    let root = interface.blocks.iter().find(|found| found.name == block)?.root;
    let leaf = interface.uniforms.iter().filter(|leaf| leaf.root == root).find(|leaf| {
        // Members of a block with an instance name have the block's name before them, and an index if it is an array.
        let name = leaf.name.strip_prefix(block).filter(|rest| rest.starts_with(['.', '['])).unwrap_or(&leaf.name);
        let name = if name.starts_with('[') { name.split_once('.').map_or(name, |(_, rest)| rest) } else { name };
        let name = name.trim_start_matches('.');
        name.strip_prefix(member).is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '.']))
    })?;
    Some((leaf, leaf.offset))
}

fn of_block(program: &Program, name: &str) -> Vec<String> {
    let Some(block) = program.interface.blocks.iter().find(|block| block.name == name) else { return Vec::new() };
    vec![format!("group {}, binding {}", block.slot.group, block.slot.binding), format!("{} bytes", block.size)]
}
