//! The structs of uniform buffers.
//!
//! *In:* the uniforms of a program with their offsets. *Out:* [`Layouts`]: one [`Struct`] for the loose uniforms, for each block
//! and for each struct in them. *Holds:* fields are in the order of their offsets, and gaps are fields.

use super::defaults::literal;
use super::documentation;
use super::fields::{Field, FieldType, Struct};
use super::names::{field, fresh, fresh_type, pascal};
use super::types::Element;
use glisten_emit::Reflection;
use glisten_front::hir::{ArraySize, StructId, Type, TypeId, Types, Value};
use glisten_front::link::{Program, RootIndex, UniformLeaf, UniformRoot};
use glisten_front::source::{SourceMap, Span};
use std::collections::BTreeMap;

/// A uniform buffer and its struct.
#[derive(Clone, Debug)]
pub(super) struct Buffer {
    pub(super) group: u32,
    pub(super) binding: u32,
    /// The name of its struct.
    pub(super) ty: String,
}

/// All structs of a program.
#[derive(Debug, Default)]
pub(super) struct Layouts {
    pub(super) structs: Vec<Struct>,
    pub(super) buffers: Vec<Buffer>,
}

/// A program while its structs are made.
struct Maker<'a> {
    program: &'a Program,
    sources: &'a SourceMap,
    /// The uniforms, by root, element of an array of blocks, and place in the root's flat layout.
    leaves: BTreeMap<(RootIndex, u32), &'a UniformLeaf>,
    structs: Vec<Struct>,
}

/// A place in the flat layout of a uniform.
#[derive(Clone, Copy)]
struct FlatPlace<'a> {
    root: RootIndex,
    flat: u32,
    initial: Option<&'a Value>,
}

impl Layouts {
    /// The structs of a program.
    pub(super) fn of(program: &Program, sources: &SourceMap, reflection: &Reflection) -> Self {
        let uniforms = program.interface.uniforms.iter().filter(|leaf| leaf.block_element == 0);
        let leaves = uniforms.map(|leaf| ((leaf.root, leaf.flat_offset), leaf)).collect();
        let mut maker = Maker { program, sources, leaves, structs: Vec::new() };
        let mut buffers = Vec::new();
        if let Some((slot, size)) = program.interface.loose {
            let ty = maker.loose(size, reflection);
            buffers.push(Buffer { group: slot.group, binding: slot.binding, ty });
        }
        for block in &program.interface.blocks {
            let Some(ty) = maker.block(block) else { continue };
            for element in 0..block.array_size.unwrap_or(1) {
                buffers.push(Buffer { group: block.slot.group, binding: block.slot.binding + element, ty: ty.clone() });
            }
        }
        Self { structs: maker.structs, buffers }
    }
}

impl<'a> Maker<'a> {
    fn types(&self) -> &'a Types {
        &self.program.types
    }

    /// The struct of the loose uniforms, with what glisten adds to it.
    fn loose(&mut self, size: u32, reflection: &Reflection) -> String {
        let mut fields = Vec::new();
        for (index, root) in (0..).zip(&self.program.interface.roots) {
            if root.block.is_some() {
                continue;
            }
            let at = FlatPlace { root: RootIndex(index), flat: 0, initial: root.default.as_ref() };
            let doc = self.doc(&format!("`{}`", root.name), self.span(root));
            fields.extend(self.field(&root.name, doc, root.ty, at, 0));
        }
        let own = Element { scalar: glisten_front::hir::Scalar::Float, shape: super::types::Shape::Scalar };
        if let Some(hidden) = reflection.conventions.framebuffer_height {
            fields.push(Field {
                name: "framebuffer_height".into(),
                doc: "/// The height of the framebuffer in pixels, by which `gl_FragCoord` is turned over.\n".into(),
                offset: hidden.offset,
                ty: FieldType::Element(own),
                initial: None,
            });
        }
        for sampler in &reflection.samplers {
            let Some(hidden) = sampler.texel_count else { continue };
            fields.push(Field {
                name: field(&format!("{}_texels", sampler.name)),
                doc: format!("/// The number of texels of the buffer texture `{}`.\n", sampler.name),
                offset: hidden.offset,
                ty: FieldType::Element(Element { scalar: glisten_front::hir::Scalar::Int, ..own }),
                initial: None,
            });
        }
        let doc = "/// The uniforms outside of blocks.\n".to_owned();
        self.add(Struct { name: "Uniforms".into(), doc, size, fields: with_gaps(fields, size) })
    }

    fn block(&mut self, block: &glisten_front::link::Block) -> Option<String> {
        let root = self.program.interface.roots.get(block.root.0 as usize)?;
        let mut ty = root.ty;
        while let Type::Array(element, _) = self.types().get(ty) {
            ty = element;
        }
        let Type::Struct(id) = self.types().get(ty) else { return None };
        let at = FlatPlace { root: block.root, flat: 0, initial: None };
        let fields = self.members(id, at, 0);
        let doc = self.doc(&format!("The uniform block `{}`.", block.name), self.span(root));
        let name = pascal(&block.name);
        Some(self.add(Struct { name, doc, size: block.size, fields: with_gaps(fields, block.size) }))
    }

    /// The fields of a struct that begins at `base` bytes.
    fn members(&mut self, id: StructId, at: FlatPlace<'_>, base: u32) -> Vec<Field> {
        let mut flat = at.flat;
        let mut fields = Vec::new();
        for member in &self.types().structure(id).members {
            let doc = self.doc(&format!("`{}`", member.name), member.span);
            fields.extend(self.field(&member.name, doc, member.ty, FlatPlace { flat, ..at }, base));
            flat = flat.saturating_add(self.types().flat_len(member.ty));
        }
        fields
    }

    /// A field; `None` for samplers, which are in no buffer.
    fn field(&mut self, name: &str, doc: String, ty: TypeId, at: FlatPlace<'_>, base: u32) -> Option<Field> {
        let (offset, ty) = match self.leaves.get(&(at.root, at.flat)).copied() {
            Some(leaf) if !self.holds_structs(ty) => {
                let element = Element::of(self.types(), leaf.ty, leaf.matrix_layout)?;
                let ty =
                    leaf.array_size.map_or(FieldType::Element(element), |count| FieldType::Elements(element, count));
                (leaf.offset, ty)
            }
            _ => self.structs(name, ty, at)?,
        };
        let initial = at.initial.and_then(|value| literal(&ty, value, at.flat, &self.structs));
        Some(Field { name: field(name), doc, offset: offset.checked_sub(base)?, ty, initial })
    }

    fn holds_structs(&self, ty: TypeId) -> bool {
        match self.types().get(ty) {
            Type::Array(element, _) => self.holds_structs(element),
            Type::Struct(_) => true,
            _ => false,
        }
    }

    /// A field of structs: its offset and its type.
    fn structs(&mut self, name: &str, ty: TypeId, at: FlatPlace<'_>) -> Option<(u32, FieldType)> {
        let (id, count) = match self.types().get(ty) {
            Type::Struct(id) => (id, None),
            Type::Array(element, ArraySize::Sized(count)) => match self.types().get(element) {
                Type::Struct(id) => (id, Some((count, self.types().flat_len(element)))),
                _ => return None,
            },
            _ => return None,
        };
        let first = |flat: u32, maker: &Self| {
            let own = maker.leaves.range((at.root, flat)..).next()?;
            (own.0.0 == at.root).then_some(own.1.offset)
        };
        let base = first(at.flat, self)?;
        let fields = self.members(id, FlatPlace { initial: None, ..at }, base);
        let end = fields.iter().map(|field| field.offset + field.ty.size()).max()?;
        let size = match count {
            Some((count, len)) if count > 1 => first(at.flat.checked_add(len)?, self)?.checked_sub(base)?,
            _ => end.next_multiple_of(16),
        };
        let declared = self.types().structure(id);
        let own = if declared.name.is_empty() { name } else { &declared.name };
        let (wanted, span) = (pascal(own), declared.span);
        let doc = self.doc(&format!("The struct `{own}` in a uniform buffer."), span);
        let name = self.add(Struct { name: wanted, doc, size, fields: with_gaps(fields, size) });
        Some((
            base,
            count.map_or(FieldType::Struct(name.clone(), size), |(count, _)| FieldType::Structs(name, count, size)),
        ))
    }

    /// Adds a struct, unless it is there, and gives its name.
    fn add(&mut self, mut made: Struct) -> String {
        let same = |known: &&Struct| known.fields == made.fields && known.size == made.size && known.doc == made.doc;
        if let Some(known) = self.structs.iter().find(same) {
            return known.name.clone();
        }
        let taken = |name: &str| RESERVED.contains(&name) || self.structs.iter().any(|known| known.name == name);
        made.name = fresh_type(made.name, taken);
        self.structs.push(made);
        self.structs.last().map_or_else(String::new, |made| made.name.clone())
    }

    fn doc(&self, what: &str, span: Span) -> String {
        documentation(what, self.sources, span)
    }

    /// The declaration of a uniform, in the first stage that has it.
    fn span(&self, root: &UniformRoot) -> Span {
        let global = root.globals.first().and_then(|(stage, id)| self.program.stage(*stage)?.globals.get(id.index()));
        global.map_or_else(Span::default, |global| global.span)
    }
}

/// Names that a module has or needs in any case: its own types, and those of Rust in what it writes.
const RESERVED: [&str; 15] = [
    "BindGroup0",
    "BindGroup1",
    "Bytes",
    "Clone",
    "Copy",
    "Default",
    "Instance",
    "Into",
    "Option",
    "PipelineState",
    "Self",
    "Some",
    "Targets",
    "Vec",
    "Vertex",
];

/// Fields in order, with one for each gap, and names that are all different.
fn with_gaps(mut fields: Vec<Field>, size: u32) -> Vec<Field> {
    fields.sort_by_key(|field| field.offset);
    let (mut all, mut end) = (Vec::new(), 0);
    let add = |all: &mut Vec<Field>, mut one: Field| {
        one.name = fresh(one.name, |name| all.iter().any(|known| known.name == name));
        all.push(one);
    };
    for field in fields {
        gap(end, field.offset).into_iter().for_each(|gap| add(&mut all, gap));
        end = field.offset + field.ty.size();
        add(&mut all, field);
    }
    gap(end, size).into_iter().for_each(|gap| add(&mut all, gap));
    all
}

fn gap(from: u32, to: u32) -> Option<Field> {
    let words = to.checked_sub(from)? / 4;
    (words > 0).then(|| Field {
        name: format!("padding_{from}"),
        doc: "/// Nothing reads it.\n".into(),
        offset: from,
        ty: FieldType::Padding(words),
        initial: None,
    })
}
