//! Lowers gathers that no target has as they are (GLSL 4.00 §8.9.3): those of integers, those with four offsets, and those whose
//! offset is not constant, or beyond what targets take.
//!
//! *Holds:* four offsets are four gathers, each of which gives its last component, the texel i0 j0. Four texels of integers are
//! four loads. An offset that is not constant moves the coordinate; the result is in the middle of the four texels, so that no
//! rounding selects others.

use super::Try;
use super::function::Ctx;
use super::lacking;
use super::slots::SamplerValue;
use super::textures::{Lookup, OFFSETS};
use glisten_front::builtin::operations::TextureForm;
use glisten_front::hir::{ExprId, SamplerDim, SamplerType, Scalar};
use naga::{BinaryOperator, Expression, Handle, MathFunction, ScalarKind};

/// The last component of a gather: the texel i0 j0.
const FIRST_TEXEL: u32 = 3;
/// Where the texels of a gather are, in its order.
const SIDES: [[i32; 2]; 4] = [[0, 1], [1, 1], [1, 0], [0, 0]];

impl Ctx<'_, '_> {
    /// `textureGatherOffsets`
    pub(super) fn gather_offsets(
        &mut self,
        ty: SamplerType,
        value: SamplerValue,
        form: TextureForm,
        arguments: &[ExprId],
    ) -> Try<Handle<Expression>> {
        let mut lookup = self.lookup(ty, value, form, arguments)?;
        let offsets = lookup.offset.take().unwrap_or_default();
        let mut components = Vec::new();
        for offset in offsets.chunks(2) {
            let is_small = offset.iter().all(|texels| OFFSETS.contains(texels));
            (lookup.offset, lookup.shift) = match is_small {
                true => (Some(offset.to_vec()), None),
                false => (None, Some(self.int_vector(offset))),
            };
            components.push(if ty.texel == Scalar::Float {
                let base = self.sample(&lookup)?;
                self.add(Expression::AccessIndex { base, index: FIRST_TEXEL })
            } else {
                self.gathered_integer(&lookup)?
            });
        }
        let ty = self.low.vector_type(if ty.shadow { Scalar::Float } else { ty.texel }, 4);
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// The coordinate between the four texels that an offset in texels leads to.
    pub(super) fn shifted(&mut self, lookup: &Lookup, offset: Handle<Expression>) -> Handle<Expression> {
        let size = (lookup.ty.dim != SamplerDim::Rect).then(|| {
            let base_level = self.int(0);
            let size = self.texture_dimensions(lookup.value.texture, Some(base_level));
            self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) })
        });
        let [half, one] = [0.5, 1.0].map(|value| {
            let value = self.float(value);
            self.splat(value, lookup.ty.dimensions())
        });
        let texels = size.map_or(lookup.coordinate, |size| self.op(BinaryOperator::Multiply, lookup.coordinate, size));
        let below = self.op(BinaryOperator::Subtract, texels, half);
        let first = self.math1(MathFunction::Floor, below);
        let offset = self.add(Expression::As { expr: offset, kind: ScalarKind::Float, convert: Some(4) });
        let moved = self.op(BinaryOperator::Add, first, offset);
        let middle = self.op(BinaryOperator::Add, moved, one);
        size.map_or(middle, |size| self.op(BinaryOperator::Divide, middle, size))
    }

    /// One component of four texels, each loaded by itself.
    pub(super) fn integer_gather(&mut self, mut lookup: Lookup) -> Try<Handle<Expression>> {
        if lookup.ty.dim == SamplerDim::Cube {
            return Err(lacking(
                self.here(),
                format!("`textureGather` of a `{}`: integer textures have no sampler", lookup.ty.name()),
                "look the four texels up with `texture`, or use a texture of floats",
            ));
        }
        let own = lookup.offset.take().unwrap_or_else(|| vec![0, 0]);
        let mut texels = Vec::new();
        for side in SIDES {
            lookup.offset = Some(own.iter().zip(side).map(|(own, side)| own.saturating_add(side)).collect());
            texels.push(self.gathered_integer(&lookup)?);
        }
        let ty = self.low.vector_type(lookup.ty.texel, 4);
        Ok(self.add(Expression::Compose { ty, components: texels }))
    }

    /// A component of the texel i0 j0 at the lookup's offset.
    fn gathered_integer(&mut self, lookup: &Lookup) -> Try<Handle<Expression>> {
        let index = lookup.gather.map_or(0, |component| component as u32);
        let base = self.integer_lookup(lookup)?;
        Ok(self.add(Expression::AccessIndex { base, index }))
    }
}
