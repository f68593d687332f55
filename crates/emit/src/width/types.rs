//! The types of values in another width.
//!
//! *In:* a type in f32. *Out:* the same type with floats of the other width, added to the module if it is not there yet.
//!
//! *Holds:* structs and arrays get the offsets and strides that naga's layouter wants; types without floats stay.

use super::{Refusal, Widths};
use naga::proc::Layouter;
use naga::{Handle, Scalar, ScalarKind, StructMember, Type, TypeInner};

/// Whether values of a type contain f32.
pub(super) fn contains_float(types: &naga::UniqueArena<Type>, inner: &TypeInner) -> bool {
    match inner {
        TypeInner::Scalar(scalar) | TypeInner::Vector { scalar, .. } | TypeInner::Matrix { scalar, .. } => {
            *scalar == Scalar::F32
        }
        TypeInner::Array { base, .. } => contains_float(types, &types[*base].inner),
        TypeInner::Struct { members, .. } => {
            members.iter().any(|member| contains_float(types, &types[member.ty].inner))
        }
        _ => false,
    }
}

impl Widths<'_> {
    /// The scalar that represents floats.
    pub(super) fn float(&self) -> Scalar {
        Scalar { kind: ScalarKind::Float, width: self.width }
    }

    /// The type of values whose type in f32 is `ty`. Types of the interface stay.
    pub(super) fn value_type(&mut self, ty: Handle<Type>) -> Result<Handle<Type>, Refusal> {
        if let Some(&known) = self.types.get(&ty) {
            return Ok(known);
        }
        let old = self.old;
        let inner = &old.types[ty].inner;
        let pointer = matches!(inner, TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. });
        if self.interface.contains(&ty) || !(pointer || contains_float(&old.types, inner)) {
            return Ok(ty);
        }
        let changed = match inner {
            TypeInner::Scalar(_) => TypeInner::Scalar(self.float()),
            TypeInner::Vector { size, .. } => TypeInner::Vector { size: *size, scalar: self.float() },
            TypeInner::Matrix { columns, rows, .. } => {
                TypeInner::Matrix { columns: *columns, rows: *rows, scalar: self.float() }
            }
            TypeInner::Array { base, size, .. } => {
                let base = self.value_type(*base)?;
                TypeInner::Array { base, size: *size, stride: self.layouter()?[base].to_stride() }
            }
            TypeInner::Struct { members, .. } => self.structure(members)?,
            TypeInner::Pointer { base, space } => TypeInner::Pointer { base: self.value_type(*base)?, space: *space },
            other => other.clone(),
        };
        let changed = Type { name: old.types[ty].name.clone(), inner: changed };
        let handle = self.new.types.insert(changed, old.types.get_span(ty));
        self.types.insert(ty, handle);
        Ok(handle)
    }

    fn structure(&mut self, members: &[StructMember]) -> Result<TypeInner, Refusal> {
        let mut changed = Vec::new();
        for member in members {
            changed.push(StructMember { ty: self.value_type(member.ty)?, ..member.clone() });
        }
        let layouter = self.layouter()?;
        let (mut offset, mut alignment) = (0, naga::proc::Alignment::ONE);
        for member in &mut changed {
            let layout = layouter[member.ty];
            member.offset = layout.alignment.round_up(offset);
            offset = member.offset + layout.size;
            alignment = alignment.max(layout.alignment);
        }
        Ok(TypeInner::Struct { members: changed, span: alignment.round_up(offset) })
    }

    fn layouter(&self) -> Result<Layouter, Refusal> {
        let mut layouter = Layouter::default();
        layouter.update(self.new.to_ctx()).map_err(|error| error.to_string())?;
        Ok(layouter)
    }
}
