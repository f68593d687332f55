//! Lowers types of values: of variables, arguments and results (§4.1).
//!
//! *Holds:* samplers are not values. A struct omits its samplers, and member indices do not count them.

use super::{Lower, Try, internal};
use glisten_front::hir::{ArraySize, Scalar, Type, TypeId};
use glisten_front::source::Span;
use naga::{Handle, StructMember, TypeInner, VectorSize};

/// The scalar type in naga.
pub(super) fn naga_scalar(scalar: Scalar) -> naga::Scalar {
    match scalar {
        Scalar::Bool => naga::Scalar::BOOL,
        Scalar::Int => naga::Scalar::I32,
        Scalar::Uint => naga::Scalar::U32,
        Scalar::Float => naga::Scalar::F32,
    }
}

/// The vector size in naga; 4 for any invalid size.
pub(super) fn vector_size(size: u8) -> VectorSize {
    match size {
        2 => VectorSize::Bi,
        3 => VectorSize::Tri,
        _ => VectorSize::Quad,
    }
}

/// The next multiple of `align`, a power of two.
pub(super) fn round_up(offset: u32, align: u32) -> u32 {
    offset.saturating_add(align - 1) & !(align - 1)
}

impl Lower<'_> {
    /// The type for values of a GLSL type.
    pub(super) fn value_type(&mut self, ty: TypeId) -> Try<Handle<naga::Type>> {
        if let Some(known) = self.values.get(&ty) {
            return Ok(*known);
        }
        let handle = match self.types.get(ty) {
            Type::Scalar(scalar) => self.insert_type(None, TypeInner::Scalar(naga_scalar(scalar))),
            Type::Vector(scalar, size) => self.vector_type(scalar, size),
            Type::Matrix(columns, rows) => self.matrix_type(columns, rows),
            Type::Array(element, ArraySize::Sized(len)) => self.array_type(element, len)?,
            Type::Struct(_) => self.struct_type(ty)?,
            Type::Error | Type::Void | Type::Sampler(_) | Type::Array(_, ArraySize::Unsized) => {
                return Err(internal(Span::default(), format!("`{}` is not a type of values", self.types.name(ty))));
            }
        };
        self.values.insert(ty, handle);
        Ok(handle)
    }

    /// Adds a type and computes its layout.
    pub(super) fn insert_type(&mut self, name: Option<String>, inner: TypeInner) -> Handle<naga::Type> {
        let handle = self.module.types.insert(naga::Type { name, inner }, naga::Span::UNDEFINED);
        // This fails only for types of unknown size; none of those is ever created here.
        let _ = self.layouter.update(self.module.to_ctx());
        handle
    }

    /// `vecN`, or the scalar for size 1.
    pub(super) fn vector_type(&mut self, scalar: Scalar, size: u8) -> Handle<naga::Type> {
        let scalar = naga_scalar(scalar);
        let inner = match size {
            0 | 1 => TypeInner::Scalar(scalar),
            _ => TypeInner::Vector { size: vector_size(size), scalar },
        };
        self.insert_type(None, inner)
    }

    /// `matCxR`
    pub(super) fn matrix_type(&mut self, columns: u8, rows: u8) -> Handle<naga::Type> {
        let inner =
            TypeInner::Matrix { columns: vector_size(columns), rows: vector_size(rows), scalar: naga::Scalar::F32 };
        self.insert_type(None, inner)
    }

    /// An array of an existing element type, with its natural stride.
    pub(super) fn natural_array(&mut self, base: Handle<naga::Type>, len: u32) -> Handle<naga::Type> {
        let stride = self.layouter[base].to_stride();
        let size = naga::ArraySize::Constant(std::num::NonZeroU32::new(len).unwrap_or(std::num::NonZeroU32::MIN));
        self.insert_type(None, TypeInner::Array { base, size, stride })
    }

    fn array_type(&mut self, element: TypeId, len: u32) -> Try<Handle<naga::Type>> {
        let base = self.value_type(element)?;
        Ok(self.natural_array(base, len))
    }

    fn struct_type(&mut self, ty: TypeId) -> Try<Handle<naga::Type>> {
        let types = self.types;
        let Type::Struct(id) = types.get(ty) else {
            return Err(internal(Span::default(), "a struct was expected"));
        };
        let structure = types.structure(id);
        let mut members = Vec::new();
        for member in &structure.members {
            if !self.has_value(member.ty) {
                continue;
            }
            members.push((member.name.clone(), self.value_type(member.ty)?, None));
        }
        let name = if structure.name.is_empty() { "Anonymous".to_owned() } else { structure.name.clone() };
        Ok(self.natural_struct(name, members))
    }

    /// A struct whose members have their natural offsets.
    pub(super) fn natural_struct(
        &mut self,
        name: String,
        members: Vec<(String, Handle<naga::Type>, Option<naga::Binding>)>,
    ) -> Handle<naga::Type> {
        let mut offset = 0;
        let mut align = 1;
        let mut placed = Vec::with_capacity(members.len());
        for (name, ty, binding) in members {
            let layout = self.layouter[ty];
            offset = layout.alignment.round_up(offset);
            align = align.max(layout.alignment.round_up(1));
            placed.push(StructMember { name: Some(name), ty, binding, offset });
            offset = offset.saturating_add(layout.size);
        }
        let span = round_up(offset, align);
        self.insert_type(Some(name), TypeInner::Struct { members: placed, span })
    }

    /// Whether the type contains anything but samplers.
    pub(super) fn has_value(&self, ty: TypeId) -> bool {
        match self.types.get(ty) {
            Type::Sampler(_) | Type::Void | Type::Error => false,
            Type::Struct(id) => self.types.structure(id).members.iter().any(|member| self.has_value(member.ty)),
            Type::Array(element, _) => self.has_value(element),
            Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) => true,
        }
    }

    /// The index of a struct's member, not counting samplers; `None` for a member without a value.
    pub(super) fn member_index(&self, ty: TypeId, member: u32) -> Option<u32> {
        let Type::Struct(id) = self.types.get(ty) else { return None };
        let members = &self.types.structure(id).members;
        let own = members.get(member as usize)?;
        let before = members.get(..member as usize)?;
        self.has_value(own.ty).then(|| before.iter().filter(|member| self.has_value(member.ty)).count() as u32)
    }

    /// The type of a struct's member.
    pub(super) fn member_type(&self, ty: TypeId, member: u32) -> TypeId {
        match self.types.get(ty) {
            Type::Struct(id) => {
                self.types.structure(id).members.get(member as usize).map_or(TypeId::ERROR, |member| member.ty)
            }
            _ => TypeId::ERROR,
        }
    }

    /// The type that indexing yields: an element, a column, a component.
    pub(super) fn element_type(&self, ty: TypeId) -> TypeId {
        match self.types.get(ty) {
            Type::Array(element, _) => element,
            Type::Matrix(_, rows) => TypeId::vector(Scalar::Float, rows),
            Type::Vector(scalar, _) => TypeId::vector(scalar, 1),
            _ => TypeId::ERROR,
        }
    }
}
