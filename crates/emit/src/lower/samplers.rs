//! Splits combined samplers (§4.1.7) into textures and samplers: as variables, as parameters, as arguments.
//!
//! | GLSL | texture | sampler |
//! | --- | --- | --- |
//! | `sampler1D`, `sampler1DArray` | 2D (array) of height 1 | filtering |
//! | `sampler2D`, `sampler2DArray`, `sampler3D`, `samplerCube` | the same | filtering |
//! | `sampler2DRect` | 2D, coordinates divided by its size | filtering |
//! | `sampler..Shadow` | the depth texture of that dimensionality | comparison |
//! | `isampler..`, `usampler..` | integer texture; for a cube, an array of its faces | none: texels are loaded |
//! | `samplerBuffer` | 2D of width [`BUFFER_WIDTH`](crate::target::BUFFER_WIDTH) | none: texels are loaded |
//! | `sampler2DMS`, `sampler2DMSArray` | multisampled 2D (array) | none: texels are loaded |

use super::function::Ctx;
use super::slots::SamplerValue;
use super::types::naga_scalar;
use super::{Lower, Try, internal, lacking, unsupported};
use glisten_front::hir::{
    ArraySize, ExprId, ExprKind, Local, SamplerDim, SamplerType, ScalarValue, Type, TypeId, VarRef,
};
use glisten_front::source::Span;
use naga::{AddressSpace, Expression, Handle, ImageClass, ImageDimension, TypeInner};

/// The variables of one sampler.
#[derive(Clone, Copy, Debug)]
pub(super) struct SamplerVariables {
    pub(super) flat: u32,
    pub(super) texture: Handle<naga::GlobalVariable>,
    pub(super) sampler: Option<Handle<naga::GlobalVariable>>,
    /// The uniform block, and its member with the number of texels of a buffer.
    pub(super) texel_count: Option<(Handle<naga::GlobalVariable>, u32)>,
}

/// A sampler in a type: its index in the flat layout, its path, its type.
pub(super) struct Leaf {
    pub(super) flat: u32,
    pub(super) path: String,
    pub(super) ty: TypeId,
}

impl Lower<'_> {
    /// The texture type that represents a sampler type.
    pub(super) fn texture_type(&mut self, ty: SamplerType) -> Handle<naga::Type> {
        let faces = ty.is_integer_cube();
        let dim = match ty.dim {
            SamplerDim::D3 => ImageDimension::D3,
            SamplerDim::Cube if !faces => ImageDimension::Cube,
            SamplerDim::Cube
            | SamplerDim::D1
            | SamplerDim::D2
            | SamplerDim::Rect
            | SamplerDim::Buffer
            | SamplerDim::Multisample => ImageDimension::D2,
        };
        let multi = ty.dim == SamplerDim::Multisample;
        let class = if ty.shadow {
            ImageClass::Depth { multi }
        } else {
            ImageClass::Sampled { kind: naga_scalar(ty.texel).kind, multi }
        };
        self.insert_type(None, TypeInner::Image { dim, arrayed: ty.arrayed || faces, class })
    }

    fn sampler_type(&mut self, ty: SamplerType) -> Handle<naga::Type> {
        self.insert_type(None, TypeInner::Sampler { comparison: ty.shadow })
    }

    /// Reports kinds for which the target has no type.
    fn check_kind(&self, ty: SamplerType, span: Span) -> Try<()> {
        if !self.can().has_multisample_arrays && ty.dim == SamplerDim::Multisample && ty.arrayed {
            return Err(lacking(
                span,
                format!("{} has no texture for `{}`", self.target.name(), ty.name()),
                "compile for SPIR-V (`--target spirv`), or use a `sampler2DMS` for each layer",
            ));
        }
        Ok(())
    }

    /// Whether samplers of this type come with their number of texels.
    pub(super) fn counts_texels(&self, ty: SamplerType) -> bool {
        ty.dim == SamplerDim::Buffer && self.interface.samplers.iter().any(|slot| slot.texel_count.is_some())
    }

    /// Declares the textures and samplers that this stage uses.
    pub(super) fn declare_samplers(&mut self) -> Try<()> {
        let interface = self.interface;
        for slot in &interface.samplers {
            let Some(global) = slot.globals.iter().find(|(stage, _)| *stage == self.shader.stage) else { continue };
            let global = global.1;
            if !self.facts.used.get(global.index()).copied().unwrap_or(false) {
                continue;
            }
            let Type::Sampler(ty) = self.types.get(slot.ty) else {
                return Err(internal(self.shader.global(global).span, "a sampler slot without a sampler type"));
            };
            self.check_kind(ty, self.shader.global(global).span)?;
            let name = slot.name.replace(['[', '.'], "_").replace(']', "");
            let texture_type = self.texture_type(ty);
            let texture = self.resource(&name, AddressSpace::Handle, slot.texture, texture_type);
            let sampler = ty.is_filtered().then(|| {
                let sampler_type = self.sampler_type(ty);
                self.resource(&format!("{name}_sampler"), AddressSpace::Handle, slot.sampler, sampler_type)
            });
            let texel_count = slot.texel_count.and_then(|offset| self.texel_counts.get(&offset).copied());
            let variables = SamplerVariables { flat: slot.flat_offset, texture, sampler, texel_count };
            self.samplers.entry(global).or_default().push(variables);
        }
        Ok(())
    }

    /// All samplers in a type, in the order of the flat layout.
    pub(super) fn sampler_leaves(&self, ty: TypeId, path: &str, flat: u32, leaves: &mut Vec<Leaf>) {
        match self.types.get(ty) {
            Type::Sampler(_) => leaves.push(Leaf { flat, path: path.to_owned(), ty }),
            Type::Array(element, ArraySize::Sized(len)) if self.types.contains_sampler(element) => {
                let size = self.types.flat_len(element);
                for index in 0..len {
                    let at = flat.saturating_add(index.saturating_mul(size));
                    self.sampler_leaves(element, &format!("{path}_{index}"), at, leaves);
                }
            }
            Type::Struct(id) => {
                let mut at = flat;
                for member in &self.types.structure(id).members {
                    self.sampler_leaves(member.ty, &format!("{path}_{}", member.name), at, leaves);
                    at = at.saturating_add(self.types.flat_len(member.ty));
                }
            }
            _ => {}
        }
    }
}

impl Ctx<'_, '_> {
    /// Declares a texture and a sampler for each sampler in a parameter.
    pub(super) fn sampler_parameters(&mut self, param: &Local) -> Try<Vec<SamplerValue>> {
        let mut leaves = Vec::new();
        self.low.sampler_leaves(param.ty, &param.name, 0, &mut leaves);
        let mut values = Vec::with_capacity(leaves.len());
        for leaf in leaves {
            let Type::Sampler(ty) = self.low.types.get(leaf.ty) else { continue };
            self.low.check_kind(ty, param.span)?;
            let texture_type = self.low.texture_type(ty);
            let texture = self.argument(&leaf.path, texture_type, None);
            let sampler = ty.is_filtered().then(|| {
                let sampler_type = self.low.sampler_type(ty);
                self.argument(&format!("{}_sampler", leaf.path), sampler_type, None)
            });
            let texel_count = match self.low.counts_texels(ty) {
                true => {
                    let int = self.low.value_type(TypeId::INT)?;
                    Some(self.argument(&format!("{}_texels", leaf.path), int, None))
                }
                false => None,
            };
            values.push(SamplerValue { flat: leaf.flat, texture, sampler, texel_count });
        }
        Ok(values)
    }

    /// The texture and sampler that an expression of a sampler type denotes.
    pub(super) fn sampler(&mut self, id: ExprId) -> Try<(SamplerType, SamplerValue)> {
        let expr = self.shader.expr(id);
        let Type::Sampler(ty) = self.low.types.get(expr.ty) else {
            return Err(internal(expr.span, "a sampler was expected"));
        };
        let (var, flat) = self.sampler_path(id)?;
        let value = self.sampler_at(var, flat);
        value.map(|value| (ty, value)).ok_or_else(|| internal(expr.span, "this sampler has no place"))
    }

    /// All samplers in an argument, in the order of the flat layout.
    pub(super) fn samplers_of(&mut self, id: ExprId) -> Try<Vec<SamplerValue>> {
        let expr = self.shader.expr(id);
        let (var, flat) = self.sampler_path(id)?;
        let mut leaves = Vec::new();
        self.low.sampler_leaves(expr.ty, "", flat, &mut leaves);
        let found = leaves.iter().map(|leaf| self.sampler_at(var, leaf.flat)).collect::<Option<Vec<_>>>();
        found.ok_or_else(|| internal(expr.span, "a sampler in this argument has no place"))
    }

    fn sampler_at(&mut self, var: VarRef, flat: u32) -> Option<SamplerValue> {
        match var {
            VarRef::Local(local) => self.param_samplers.get(&local)?.iter().find(|value| value.flat == flat).copied(),
            VarRef::Global(global) => {
                let variables = *self.low.samplers.get(&global)?.iter().find(|value| value.flat == flat)?;
                let texture = self.global_variable(variables.texture);
                let sampler = variables.sampler.map(|sampler| self.global_variable(sampler));
                let texel_count = variables.texel_count.map(|(variable, index)| {
                    let base = self.global_variable(variable);
                    let pointer = self.add(Expression::AccessIndex { base, index });
                    self.load(pointer)
                });
                Some(SamplerValue { flat, texture, sampler, texel_count })
            }
        }
    }

    /// The variable at the root of `a.b[2]`, and the index in its flat layout.
    fn sampler_path(&mut self, mut id: ExprId) -> Try<(VarRef, u32)> {
        let mut flat = 0_u32;
        loop {
            let expr = self.shader.expr(id);
            match &expr.kind {
                ExprKind::Var(var) => return Ok((*var, flat)),
                ExprKind::Member(base, member) => {
                    flat = flat.saturating_add(self.flat_of_member(self.shader.expr(*base).ty, *member));
                    id = *base;
                }
                ExprKind::Index(base, index) => {
                    let index = self.constant_index(*index)?;
                    flat = flat.saturating_add(index.saturating_mul(self.low.types.flat_len(expr.ty)));
                    id = *base;
                }
                _ => return Err(internal(expr.span, "a sampler is named by a variable, members and elements alone")),
            }
        }
    }

    /// The index of a member in the flat layout of its struct.
    pub(super) fn flat_of_member(&self, ty: TypeId, member: u32) -> u32 {
        let Type::Struct(id) = self.low.types.get(ty) else { return 0 };
        let before = self.low.types.structure(id).members.iter().take(member as usize);
        before.fold(0, |sum: u32, member| sum.saturating_add(self.low.types.flat_len(member.ty)))
    }

    /// The value of a constant index: arrays of samplers and of blocks allow no others (§4.1.9, §4.3.7).
    pub(super) fn constant_index(&self, id: ExprId) -> Try<u32> {
        let expr = self.shader.expr(id);
        match self.low.constant_of(self.id, id) {
            Some(ScalarValue::Int(index)) => Ok(u32::try_from(index).unwrap_or(0)),
            Some(ScalarValue::Uint(index)) => Ok(index),
            _ => Err(unsupported(expr.span, "a sampler or block is chosen by an index that is not constant")),
        }
    }

    /// The size of the whole texture in texels, or of one level: a `uint` or a vector of them.
    pub(super) fn texture_dimensions(
        &mut self,
        image: Handle<Expression>,
        level: Option<Handle<Expression>>,
    ) -> Handle<Expression> {
        self.add(Expression::ImageQuery { image, query: naga::ImageQuery::Size { level } })
    }
}
