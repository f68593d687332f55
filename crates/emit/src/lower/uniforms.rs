//! Lowers types of uniform memory (OpenGL 3.2 §2.11.4, "Standard Uniform Block Layout"), and the variables of
//! uniforms.
//!
//! *Holds:* naga's WGSL writer never writes `@size`, `@align` or a stride, so the natural WGSL layout of a type has
//! to be its std140 layout. Gaps are members of their own, elements of less than 16 bytes are stored in a `vec4`,
//! matrices of two rows are arrays of `vec4`, `row_major` matrices are stored transposed, and a `bool` is a `u32`.
//! Where none of that is needed, the type of the value and the type in memory are the same.

use super::slots::{GlobalSlot, HostId};
use super::types::round_up;
use super::{Lower, Try, internal};
use glisten_front::hir::{ArraySize, MatrixLayout, Scalar, Type, TypeId};
use glisten_front::link::{Block, SlotBinding, UniformRoot};
use glisten_front::source::Span;
use naga::{AddressSpace, GlobalVariable, Handle, ResourceBinding, StructMember, TypeInner};
use rustc_hash::FxHashMap;

/// How a value of the type is represented in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum HostKind {
    /// Unchanged.
    Value,
    /// A `bool` or a vector of them as `u32`.
    Bits,
    /// Columns of two components, each in a `vec4` of an array.
    WideColumns,
    /// A `row_major` matrix as the matrix of its rows.
    Rows,
    /// A `row_major` matrix of two columns: its rows, each in a `vec4` of an array.
    WideRows,
    /// For each GLSL member: the member of the struct in memory, and its own type; `None` for samplers.
    Struct(Vec<Option<(u32, HostId)>>),
    /// Elements one by one; a `wide` element is the first components of a `vec4`.
    Array { element: HostId, wide: bool },
}

/// A type in memory: naga's type, and its std140 layout in bytes.
#[derive(Clone, Debug)]
pub(super) struct Host {
    pub(super) ty: TypeId,
    pub(super) handle: Handle<naga::Type>,
    pub(super) kind: HostKind,
    size: u32,
    align: u32,
}

/// All types in memory.
#[derive(Debug, Default)]
pub(super) struct Hosts {
    all: Vec<Host>,
    ids: FxHashMap<(TypeId, MatrixLayout), HostId>,
}

/// A member with its offset in a struct in memory.
struct Placed {
    name: String,
    handle: Handle<naga::Type>,
    offset: u32,
    size: u32,
}

/// The contents of a member of the loose uniforms' block.
enum LooseMember<'a> {
    Root(&'a UniformRoot, HostId),
    /// The framebuffer's height.
    Height,
    /// The number of texels of a buffer texture, identified by its offset.
    TexelCount(u32),
}

impl Lower<'_> {
    /// The type in memory of a handle.
    pub(super) fn host(&self, id: HostId) -> &Host {
        // A `HostId` is only made for this table.
        &self.hosts.all[id.0]
    }

    /// The type in memory of a GLSL type.
    pub(super) fn host_of(&mut self, ty: TypeId, layout: MatrixLayout) -> Try<HostId> {
        if let Some(known) = self.hosts.ids.get(&(ty, layout)) {
            return Ok(*known);
        }
        let host = match self.types.get(ty) {
            Type::Scalar(Scalar::Bool) => self.bits_host(ty, 1),
            Type::Vector(Scalar::Bool, size) => self.bits_host(ty, size),
            Type::Scalar(_) => self.plain_host(ty, 4, 4)?,
            Type::Vector(_, 2) => self.plain_host(ty, 8, 8)?,
            Type::Vector(_, size) => self.plain_host(ty, 4 * u32::from(size), 16)?,
            Type::Matrix(columns, rows) => self.matrix_host(ty, columns, rows, layout)?,
            Type::Array(element, ArraySize::Sized(len)) => self.array_host(ty, element, len, layout)?,
            Type::Struct(_) => self.struct_host(ty, layout)?,
            Type::Error | Type::Void | Type::Sampler(_) | Type::Array(_, ArraySize::Unsized) => {
                return Err(internal(Span::default(), format!("`{}` has no layout", self.types.name(ty))));
            }
        };
        let id = HostId(self.hosts.all.len());
        self.hosts.all.push(host);
        self.hosts.ids.insert((ty, layout), id);
        Ok(id)
    }

    fn plain_host(&mut self, ty: TypeId, size: u32, align: u32) -> Try<Host> {
        Ok(Host { ty, handle: self.value_type(ty)?, kind: HostKind::Value, size, align })
    }

    fn bits_host(&mut self, ty: TypeId, components: u8) -> Host {
        let handle = self.vector_type(Scalar::Uint, components);
        let size = 4 * u32::from(components);
        let align = if components > 2 { 16 } else { size };
        Host { ty, handle, kind: HostKind::Bits, size, align }
    }

    fn matrix_host(&mut self, ty: TypeId, columns: u8, rows: u8, layout: MatrixLayout) -> Try<Host> {
        let (lines, width, row_major) = match layout {
            MatrixLayout::ColumnMajor => (columns, rows, false),
            MatrixLayout::RowMajor => (rows, columns, true),
        };
        let (kind, handle) = match (row_major, width) {
            (false, 2) => (HostKind::WideColumns, self.wide_lines(lines)),
            (false, _) => (HostKind::Value, self.value_type(ty)?),
            (true, 2) => (HostKind::WideRows, self.wide_lines(lines)),
            (true, _) => (HostKind::Rows, self.matrix_type(lines, width)),
        };
        Ok(Host { ty, handle, kind, size: 16 * u32::from(lines), align: 16 })
    }

    fn wide_lines(&mut self, lines: u8) -> Handle<naga::Type> {
        let line = self.vector_type(Scalar::Float, 4);
        self.natural_array(line, u32::from(lines))
    }

    fn array_host(&mut self, ty: TypeId, element: TypeId, len: u32, layout: MatrixLayout) -> Try<Host> {
        let id = self.host_of(element, layout)?;
        let inner = self.host(id).clone();
        let stride = round_up(inner.size, 16);
        let natural = self.layouter[inner.handle].to_stride();
        let wide = natural != stride;
        let (kind, handle) = if wide {
            let scalar = match self.types.scalar_of(element) {
                Some(Scalar::Bool) => Scalar::Uint,
                Some(scalar) => scalar,
                None => return Err(self.layout_slip(ty)),
            };
            let line = self.vector_type(scalar, 4);
            (HostKind::Array { element: id, wide }, self.natural_array(line, len))
        } else if inner.kind == HostKind::Value {
            (HostKind::Value, self.value_type(ty)?)
        } else {
            (HostKind::Array { element: id, wide }, self.natural_array(inner.handle, len))
        };
        Ok(Host { ty, handle, kind, size: stride.saturating_mul(len), align: 16 })
    }

    fn layout_slip(&self, ty: TypeId) -> Box<glisten_front::diagnostic::Diagnostic> {
        internal(Span::default(), format!("the layout of `{}` is not std140", self.types.name(ty)))
    }

    fn struct_host(&mut self, ty: TypeId, layout: MatrixLayout) -> Try<Host> {
        let types = self.types;
        let Type::Struct(id) = types.get(ty) else { return Err(self.layout_slip(ty)) };
        let structure = types.structure(id);
        let mut placed = Vec::new();
        let mut hosts = Vec::new();
        let mut offset = 0;
        for member in &structure.members {
            if !self.has_value(member.ty) {
                hosts.push(None);
                continue;
            }
            // In a block each member has its own matrix layout; in a nested struct, that of the member it belongs to.
            let order = if structure.is_block { member.matrix_layout } else { layout };
            let host = self.host_of(member.ty, order)?;
            let Host { handle, size, align, .. } = *self.host(host);
            offset = if structure.is_block { member.place.start(offset, align) } else { round_up(offset, align) };
            placed.push(Placed { name: member.name.clone(), handle, offset, size });
            hosts.push(Some(host));
            offset = offset.saturating_add(size);
        }
        let size = round_up(offset, 16);
        let name = if structure.name.is_empty() { "Anonymous" } else { &structure.name };
        let plain = hosts.iter().all(|host| host.is_some_and(|host| self.host(host).kind == HostKind::Value));
        let (padded, members, end) = self.pad(&placed, (!structure.is_block).then_some(size), ty)?;
        if plain && padded.len() == placed.len() && !structure.is_block {
            return Ok(Host { ty, handle: self.value_type(ty)?, kind: HostKind::Value, size, align: 16 });
        }
        let name = if structure.is_block { name.to_owned() } else { format!("{name}_in_block") };
        let handle = self.insert_type(Some(name), TypeInner::Struct { members: padded, span: end });
        let mut numbers = members.into_iter();
        let kind = hosts.into_iter().map(|host| host.and_then(|host| numbers.next().map(|n| (n, host)))).collect();
        Ok(Host { ty, handle, kind: HostKind::Struct(kind), size, align: 16 })
    }

    /// Places members at their offsets, with members of four bytes in the gaps and, if a size is given, at the end.
    /// Returns the members, the indices of those that were placed, and the size of the struct.
    fn pad(&self, placed: &[Placed], size: Option<u32>, ty: TypeId) -> Try<(Vec<StructMember>, Vec<u32>, u32)> {
        let filler = self.values.get(&TypeId::UINT).copied();
        let mut members: Vec<StructMember> = Vec::new();
        let mut numbers = Vec::new();
        let mut cursor = 0;
        let mut most = 4;
        let fill = |members: &mut Vec<StructMember>, cursor: &mut u32, until: u32, align: u32| {
            while round_up(*cursor, align) < until {
                let Some(ty) = filler else { return false };
                let name = Some("padding".to_owned());
                members.push(StructMember { name, ty, binding: None, offset: *cursor });
                *cursor += 4;
            }
            round_up(*cursor, align) == until
        };
        for member in placed {
            let align = self.layouter[member.handle].alignment.round_up(1);
            most = most.max(align);
            if !fill(&mut members, &mut cursor, member.offset, align) {
                return Err(self.layout_slip(ty));
            }
            numbers.push(members.len() as u32);
            members.push(StructMember {
                name: Some(member.name.clone()),
                ty: member.handle,
                binding: None,
                offset: member.offset,
            });
            if self.layouter[member.handle].size > member.size {
                return Err(self.layout_slip(ty));
            }
            cursor = member.offset + self.layouter[member.handle].size;
        }
        let end = size.unwrap_or(round_up(cursor, most));
        if !fill(&mut members, &mut cursor, end, most) {
            return Err(self.layout_slip(ty));
        }
        Ok((members, numbers, end))
    }

    /// Declares the variables for the uniforms that this stage uses.
    pub(super) fn declare_uniforms(&mut self) -> Try<()> {
        // The type that fills gaps, so that `pad` finds it.
        self.value_type(TypeId::UINT)?;
        let interface = self.interface;
        self.declare_loose()?;
        for block in &interface.blocks {
            let Some(root) = interface.roots.get(block.root.0 as usize) else { continue };
            self.declare_block(block, root)?;
        }
        Ok(())
    }

    fn is_used(&self, root: &UniformRoot) -> bool {
        root.globals.iter().any(|(stage, global)| {
            *stage == self.shader.stage && self.facts.used.get(global.index()).copied().unwrap_or(false)
        })
    }

    fn declare_loose(&mut self) -> Try<()> {
        let interface = self.interface;
        let Some((slot, _)) = interface.loose else { return Ok(()) };
        let mut roots: Vec<&UniformRoot> =
            interface.roots.iter().filter(|root| root.block.is_none() && self.has_value(root.ty)).collect();
        roots.sort_by_key(|root| root.offset);
        let needs_height = interface.framebuffer_height.is_some() && self.needs_framebuffer_height();
        let counts: Vec<u32> = interface.samplers.iter().filter_map(|slot| slot.texel_count).collect();
        if !needs_height && counts.is_empty() && !roots.iter().any(|root| self.is_used(root)) {
            return Ok(());
        }
        let mut placed = Vec::new();
        let mut hosts = Vec::new();
        for root in &roots {
            let host = self.host_of(root.ty, MatrixLayout::ColumnMajor)?;
            let Host { handle, size, .. } = *self.host(host);
            placed.push(Placed { name: root.name.clone(), handle, offset: root.offset, size });
            hosts.push(LooseMember::Root(root, host));
        }
        // Link has placed hidden members after all roots.
        if let Some(offset) = interface.framebuffer_height {
            let handle = self.value_type(TypeId::FLOAT)?;
            placed.push(Placed { name: "framebuffer_height".into(), handle, offset, size: 4 });
            hosts.push(LooseMember::Height);
        }
        for offset in counts {
            let handle = self.value_type(TypeId::INT)?;
            placed.push(Placed { name: "texel_count".into(), handle, offset, size: 4 });
            hosts.push(LooseMember::TexelCount(offset));
        }
        let (members, numbers, span) = self.pad(&placed, None, TypeId::ERROR)?;
        let ty = self.insert_type(Some("Uniforms".into()), TypeInner::Struct { members, span });
        let variable = self.uniform_variable("uniforms", slot, ty);
        for (host, member) in hosts.into_iter().zip(numbers) {
            match host {
                LooseMember::Height => self.framebuffer_height = Some((variable, member)),
                LooseMember::TexelCount(offset) => {
                    self.texel_counts.insert(offset, (variable, member));
                }
                LooseMember::Root(root, host) => {
                    self.set_globals(root, &GlobalSlot::Loose { variable, member, host });
                }
            }
        }
        Ok(())
    }

    fn declare_block(&mut self, block: &Block, root: &UniformRoot) -> Try<()> {
        if !self.is_used(root) {
            return Ok(());
        }
        let (ty, len) = match self.types.get(root.ty) {
            Type::Array(element, ArraySize::Sized(len)) => (element, Some(len)),
            _ => (root.ty, None),
        };
        let host = self.host_of(ty, MatrixLayout::ColumnMajor)?;
        if self.host(host).size != block.size {
            return Err(self.layout_slip(ty));
        }
        let handle = self.host(host).handle;
        let name = &block.instance.clone().unwrap_or_else(|| variable_name(&block.name));
        let variables = match len {
            None => vec![self.uniform_variable(name, block.slot, handle)],
            Some(len) => (0..len)
                .map(|index| {
                    let slot = SlotBinding { binding: block.slot.binding + index, ..block.slot };
                    self.uniform_variable(&format!("{name}_{index}"), slot, handle)
                })
                .collect(),
        };
        self.set_globals(root, &GlobalSlot::Block { variables, host, arrayed: len.is_some() });
        Ok(())
    }

    fn uniform_variable(&mut self, name: &str, slot: SlotBinding, ty: Handle<naga::Type>) -> Handle<GlobalVariable> {
        self.resource(name, AddressSpace::Uniform, slot, ty)
    }

    /// Adds a variable at a binding.
    pub(super) fn resource(
        &mut self,
        name: &str,
        space: AddressSpace,
        slot: SlotBinding,
        ty: Handle<naga::Type>,
    ) -> Handle<GlobalVariable> {
        let variable = GlobalVariable {
            name: Some(name.to_owned()),
            space,
            binding: Some(ResourceBinding { group: slot.group, binding: slot.binding }),
            ty,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        self.module.global_variables.append(variable, naga::Span::UNDEFINED)
    }

    fn set_globals(&mut self, root: &UniformRoot, slot: &GlobalSlot) {
        for (stage, global) in &root.globals {
            if *stage == self.shader.stage
                && let Some(place) = self.globals.get_mut(global.index())
            {
                *place = slot.clone();
            }
        }
    }
}

/// A name for the variable of a block without an instance name, whose struct has the block's name: `FormulaParams` is
/// `formula_params`.
fn variable_name(block: &str) -> String {
    let mut name = String::new();
    for character in block.chars() {
        let follows_lower = name.ends_with(|last: char| last.is_ascii_lowercase() || last.is_ascii_digit());
        if character.is_ascii_uppercase() && follows_lower {
            name.push('_');
        }
        name.push(character.to_ascii_lowercase());
    }
    if name == block { format!("{name}_block") } else { name }
}
