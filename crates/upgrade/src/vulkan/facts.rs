//! [`Facts`]: what each declaration in the files of a tree is, by all programs that read it.
//!
//! *In:* compiled programs and their files. *Out:* for each file, by the place of a name: a loose uniform, something with numbers, or a
//! variable that does not leave its stage. *Holds:* where programs say different things of one declaration, that is the reason why
//! one of them is not rewritten.

use super::dialect::{Dialect, Numbering};
use super::files::{Files, stages_of_texts};
use super::numbers::{Numbers, Space};
use super::{Compiled, Key};
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Type, TypeId, Types};
use glisten_front::link::{Program, Varying, partners, std140};
use glisten_front::source::{SourceMap, Span};
use std::collections::{BTreeMap, BTreeSet};

/// A uniform outside of blocks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Loose {
    pub(super) name: String,
    /// The alignment and the size.
    pub(super) extent: (u32, u32),
    /// The type, if it needs no struct.
    pub(super) plain: Option<String>,
    /// The names of the structs that it needs.
    pub(super) structs: BTreeSet<String>,
    /// The offset that the link gave to it.
    pub(super) offset: u32,
}

/// Something with numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Numbered {
    pub(super) space: Space,
    pub(super) node: usize,
    /// The difference to the number of the node.
    pub(super) plus: u32,
    pub(super) component: u32,
    pub(super) index: Option<u32>,
    /// Whether it is a block of uniforms.
    pub(super) is_block: bool,
}

/// The meaning of a declaration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Fact {
    Loose(Loose),
    Numbered(Numbered),
    /// A uniform that the host has in a block of its own: the index of that in the dialect.
    Known(usize),
    /// An output that no stage reads.
    Inside,
}

/// The declarations of each file, by the places of their names.
#[derive(Default)]
pub(super) struct Facts {
    pub(super) all: BTreeMap<Key, BTreeMap<usize, Fact>>,
}

/// A reason to leave out a program.
pub(super) type Refusal = (usize, String);

impl Facts {
    /// The facts of programs.
    ///
    /// # Errors
    /// A program that cannot be rewritten, and why.
    pub(super) fn new(
        programs: &[Compiled<'_>],
        files: &Files,
        dialect: &Dialect,
        numbers: &mut Numbers,
    ) -> Result<Self, Refusal> {
        let mut facts = Self::default();
        for compiled in programs {
            let stages = stages_of_texts(compiled);
            for shader in &compiled.program.stages {
                for (id, global) in shader.globals() {
                    let crosses = matches!(global.storage, Storage::Uniform | Storage::In | Storage::Out);
                    if global.builtin.is_some() || global.is_fixed() || !crosses {
                        continue;
                    }
                    let refused = |reason: String| (compiled.index, reason);
                    let place = place(&compiled.compilation.sources, &stages, global);
                    // A host that matches names needs nothing of what it declares itself.
                    if place.is_err() && global.block.is_some() && dialect.numbering != Numbering::All {
                        continue;
                    }
                    let place = place.map_err(refused)?;
                    let fact = fact(compiled, shader, (id, global), numbers).map_err(refused)?;
                    let of_file = facts.all.entry(files.key(&place.0, shader.stage)).or_default();
                    let known = of_file.entry(place.1).or_insert_with(|| fact.clone());
                    merge(known, fact, numbers).map_err(|what| refused(format!("`{}` {what}", global.name)))?;
                }
            }
        }
        Ok(facts)
    }
}

/// Brings together the facts of two programs about one declaration.
fn merge(known: &mut Fact, fact: Fact, numbers: &mut Numbers) -> Result<(), &'static str> {
    match (&mut *known, fact) {
        (Fact::Loose(known), Fact::Loose(other)) => {
            if known.extent != other.extent || known.name != other.name {
                return Err("has different sizes in the programs that read its declaration");
            }
            if known.plain != other.plain {
                known.plain = None;
            }
            known.structs.extend(other.structs);
        }
        (Fact::Numbered(known), Fact::Numbered(other)) => {
            if *known != (Numbered { node: known.node, ..other }) {
                return Err("has different places in the programs that read its declaration");
            }
            numbers.join(known.node, other.node);
        }
        (Fact::Inside, other) => *known = other,
        (_, Fact::Inside) => {}
        _ => return Err("means different things in the programs that read its declaration"),
    }
    Ok(())
}

/// The file of a declaration, and the place of its name in it.
fn place(sources: &SourceMap, stages: &[Option<Stage>], global: &Global) -> Result<(String, usize), String> {
    let names = |text: &str, at: usize| {
        let rest = text.get(at..).unwrap_or("");
        let block = global.block.as_ref();
        let words =
            [Some(&global.name), block.map(|block| &block.name), block.and_then(|block| block.instance.as_ref())];
        words.into_iter().flatten().any(|word| rest.starts_with(word.as_str()))
    };
    let alias = alias(sources, global);
    let start = alias.unwrap_or(global.span).start;
    let found = sources.files().zip(stages).find(|((_, file), _)| (file.base()..file.end()).contains(&start));
    let Some(((_, file), Some(_))) = found else {
        return Err(format!("`{}` is declared by what the engine adds to the source", global.name));
    };
    let offset = (start - file.base()) as usize;
    if alias.is_none() && !names(file.text(), offset) {
        return Err(format!("a macro makes the name `{}`, which stands nowhere in the text", global.name));
    }
    Ok((file.name().to_owned(), offset))
}

/// The place of the macro that a declaration names its variable by: `#define Coord TEX0`, `in vec2 Coord;`.
fn alias(sources: &SourceMap, global: &Global) -> Option<Span> {
    let used = sources.expansion(global.span.expansion)?;
    let is_bare = !used.call.expansion.is_some() && sources.snippet(used.call) == &*used.name;
    let file = sources.file(sources.file_of(used.definition)?);
    let line = file.text().get((used.definition.end - file.base()) as usize..)?.lines().next()?;
    let body = line.split("//").next().and_then(|body| body.split("/*").next())?;
    (is_bare && body.trim() == global.name).then_some(used.call)
}

fn fact(
    compiled: &Compiled<'_>,
    shader: &Shader,
    (id, global): (GlobalId, &Global),
    numbers: &mut Numbers,
) -> Result<Fact, String> {
    let (program, unit) = (compiled.program, compiled.index);
    let interface = &program.interface;
    let own = |globals: &[(Stage, GlobalId)]| globals.contains(&(shader.stage, id));
    let numbered = |space, node| Numbered { space, node, plus: 0, component: 0, index: None, is_block: false };
    if global.storage == Storage::Uniform {
        let root = interface.roots.iter().find(|root| own(&root.globals));
        if let Some(index) = root.and_then(|root| root.block) {
            let Some(block) = interface.blocks.get(index.0 as usize) else { return Ok(Fact::Inside) };
            let size = block.array_size.unwrap_or(1);
            let node = numbers.node(unit, Space::Buffer, &block.name, size, Some(block.slot.binding));
            return Ok(Fact::Numbered(Numbered { is_block: true, ..numbered(Space::Buffer, node) }));
        }
        let slots: Vec<_> = interface.samplers.iter().filter(|slot| own(&slot.globals)).collect();
        if let Some(first) = slots.first() {
            if first.name.contains('.') {
                return Err(format!("`{}` is a struct with a sampler, which Vulkan does not have", global.name));
            }
            let wanted = slots.iter().map(|slot| slot.texture.binding).min();
            let last = slots.iter().map(|slot| slot.sampler.binding.max(slot.texture.binding)).max();
            let size = last.zip(wanted).map_or(1, |(last, first)| last + 1 - first);
            let node = numbers.node(unit, Space::Texture, &global.name, size, wanted);
            return Ok(Fact::Numbered(numbered(Space::Texture, node)));
        }
        let Some(root) = root else { return Ok(Fact::Inside) };
        if program.types.contains_sampler(root.ty) {
            return Err(format!("`{}` is a struct with a sampler, which Vulkan does not have", global.name));
        }
        let extent = std140(&program.types, root.ty);
        let (plain, structs) = (plain_type(&program.types, root.ty), structs(&program.types, root.ty));
        return Ok(Fact::Loose(Loose { name: root.name.clone(), extent, plain, structs, offset: root.offset }));
    }
    if shader.stage == Stage::Vertex && global.storage == Storage::In {
        let Some(row) = interface.attributes.iter().find(|row| row.global == id) else { return Ok(Fact::Inside) };
        let node = numbers.node(unit, Space::Attribute, &row.name, row.columns, Some(row.location));
        return Ok(Fact::Numbered(numbered(Space::Attribute, node)));
    }
    if shader.stage == Stage::Fragment && global.storage == Storage::Out {
        let Some(row) = interface.outputs.iter().find(|row| row.global == id) else { return Ok(Fact::Inside) };
        let dual = interface.outputs.iter().any(|row| row.index == 1);
        let size = match program.types.get(row.ty) {
            Type::Array(..) => program.types.flat_len(row.ty).div_ceil(4).max(1),
            _ => 1,
        };
        let name = if dual { format!("{}#{}", row.location, row.index) } else { row.name.clone() };
        let space =
            if row.index == 1 { return Ok(second_output(unit, row.location, &name, numbers)) } else { Space::Output };
        let node = numbers.node(unit, space, &name, size, Some(row.location));
        return Ok(Fact::Numbered(Numbered { index: dual.then_some(row.index), ..numbered(space, node) }));
    }
    if let Some(output) = geometry_input(program, shader.stage, id) {
        let (name, size) = (output.match_name(), program.types.locations(output.ty));
        let node = numbers.node(unit, Space::GeometryInput, name, size, None);
        return Ok(Fact::Numbered(numbered(Space::GeometryInput, node)));
    }
    if is_of_lone_geometry(program, shader, global) {
        let element = match program.types.get(global.ty) {
            Type::Array(element, _) => element,
            _ => global.ty,
        };
        let size = program.types.locations(element);
        let node = numbers.node(unit, Space::GeometryInput, global.match_name(), size, global.location);
        return Ok(Fact::Numbered(numbered(Space::GeometryInput, node)));
    }
    if is_before_geometry(program, shader, global) {
        return Ok(Fact::Inside);
    }
    let Some((name, first, size, row)) = varying(compiled, id, global.storage) else {
        // Nothing reads it, or nothing writes it and it is not read. Vulkan wants both ends of what is declared.
        return Ok(Fact::Inside);
    };
    let node = numbers.node(unit, Space::Varying, &name, size, Some(first));
    let plus = row.location - first;
    Ok(Fact::Numbered(Numbered { plus, component: row.component, ..numbered(Space::Varying, node) }))
}

/// Whether a varying is between the vertex and the geometry stage.
fn is_before_geometry(program: &Program, shader: &Shader, global: &Global) -> bool {
    program.stage(Stage::Geometry).is_some()
        && matches!((shader.stage, global.storage), (Stage::Vertex, Storage::Out) | (Stage::Geometry, Storage::In))
}

/// Whether a geometry stage reads it whose vertex stage is elsewhere.
fn is_of_lone_geometry(program: &Program, shader: &Shader, global: &Global) -> bool {
    shader.stage == Stage::Geometry && global.storage == Storage::In && program.stage(Stage::Vertex).is_none()
}

/// The output of the vertex stage that feeds the geometry stage, by itself or by the input that it feeds.
fn geometry_input(program: &Program, stage: Stage, id: GlobalId) -> Option<&Global> {
    let (vertex, geometry) = (program.stage(Stage::Vertex)?, program.stage(Stage::Geometry)?);
    let is_it = |(output, input): &(GlobalId, GlobalId)| match stage {
        Stage::Vertex => *output == id,
        Stage::Geometry => *input == id,
        Stage::Fragment => false,
    };
    let (output, _) = partners(vertex, geometry).into_iter().find(is_it)?;
    Some(vertex.global(output))
}

/// The second color of dual-source blending has the location of the first: it is numbered with it.
fn second_output(unit: usize, location: u32, name: &str, numbers: &mut Numbers) -> Fact {
    let first = name.replace("#1", "#0");
    let node = numbers.node(unit, Space::Output, &first, 1, Some(location));
    let index = Some(1);
    Fact::Numbered(Numbered { space: Space::Output, node, plus: 0, component: 0, index, is_block: false })
}

/// A varying with those that share locations with it: their name, their first location and number of them; and its first row.
fn varying<'a>(compiled: &'a Compiled<'_>, id: GlobalId, storage: Storage) -> Option<(String, u32, u32, &'a Varying)> {
    let rows = &compiled.program.interface.varyings;
    let last = if compiled.program.stage(Stage::Geometry).is_some() { Stage::Geometry } else { Stage::Vertex };
    let name_of = |row: &Varying| {
        let (end, of) = row.to.map(|end| (end, Stage::Fragment)).or(row.from.map(|end| (end, last)))?;
        Some(compiled.program.stage(of)?.global(end.global).match_name().to_owned())
    };
    let end = |row: &&Varying| if storage == Storage::In { row.to } else { row.from };
    let own = rows.iter().filter(|row| end(row).is_some_and(|end| end.global == id));
    let first = own.min_by_key(|row| end(row).map(|end| end.flat_offset))?;
    let mut names: BTreeSet<String> = name_of(first).into_iter().collect();
    // Everything that is at one of their locations belongs to them.
    loop {
        let is_of = |row: &&Varying| name_of(row).is_some_and(|name| names.contains(&name));
        let places: BTreeSet<u32> = rows.iter().filter(is_of).map(|row| row.location).collect();
        let at = rows.iter().filter(|row| places.contains(&row.location)).filter_map(name_of);
        let all: BTreeSet<String> = at.chain(names.iter().cloned()).collect();
        if all.len() == names.len() {
            let (low, high) = (places.first().copied()?, places.last().copied()?);
            return Some((names.into_iter().collect::<Vec<_>>().join("+"), low, high + 1 - low, first));
        }
        names = all;
    }
}

/// The names of the structs of a type.
fn structs(types: &Types, ty: TypeId) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    types.for_each_struct(ty, &mut |id| {
        names.insert(types.structure(id).name.clone());
        true
    });
    names
}

/// A type as it is written before a name, if it needs no struct.
pub(super) fn plain_type(types: &Types, ty: TypeId) -> Option<String> {
    let mut inner = ty;
    while let Type::Array(element, _) = types.get(inner) {
        inner = element;
    }
    (!matches!(types.get(inner), Type::Struct(_) | Type::Sampler(_))).then(|| types.name(ty))
}

/// A declaration with a type as the compiler names it: `vec4[2]` has its sizes after the name.
pub(super) fn spelled(ty: &str, name: &str) -> String {
    let (element, sizes) = ty.split_at(ty.find('[').unwrap_or(ty.len()));
    format!("{element} {name}{sizes}")
}
