//! Lowers texture functions (§8.7) to separate textures and samplers.
//!
//! *Holds:* the arguments of a call are first decomposed into a [`Lookup`] by the tables of §8.7, and then recombined
//! for the texture that represents the sampler (see [`samplers`](super::samplers)). Integer textures have no sampler
//! in any target: their lookups are in [`texel_loads`](super::texel_loads).

use super::function::Ctx;
use super::slots::SamplerValue;
use super::{Try, internal, lacking};
use crate::target::BUFFER_WIDTH;
use glisten_front::builtin::constants::{MAX_PROGRAM_TEXEL_OFFSET, MIN_PROGRAM_TEXEL_OFFSET};
use glisten_front::builtin::operations::{Lookup as How, TextureArgument as Role, TextureForm};
use glisten_front::hir::{ExprId, SamplerDim, SamplerType, Scalar, ScalarValue, Swizzle, TypeId};
use naga::{BinaryOperator, Expression, Handle, MathFunction, SampleLevel};
use std::ops::RangeInclusive;

/// The constant offsets that every target takes.
pub(super) const OFFSETS: RangeInclusive<i32> = MIN_PROGRAM_TEXEL_OFFSET..=MAX_PROGRAM_TEXEL_OFFSET;

/// A decomposed lookup.
pub(super) struct Lookup {
    pub(super) ty: SamplerType,
    pub(super) value: SamplerValue,
    /// The coordinate, with as many components as the GLSL type: 1 for 1D.
    pub(super) coordinate: Handle<Expression>,
    /// The layer before rounding.
    pub(super) layer: Option<Handle<Expression>>,
    pub(super) reference: Option<Handle<Expression>>,
    pub(super) level: SampleLevel,
    /// The offset, with as many components as the coordinate.
    pub(super) offset: Option<Vec<i32>>,
    /// The offset of a gather that is not constant, or beyond what targets take.
    pub(super) shift: Option<Handle<Expression>>,
    /// The component of a gather.
    pub(super) gather: Option<naga::SwizzleComponent>,
}

impl Ctx<'_, '_> {
    /// A call of a texture function.
    pub(super) fn texture_call(
        &mut self,
        form: TextureForm,
        arguments: &[ExprId],
        ret: TypeId,
    ) -> Try<Handle<Expression>> {
        let Some((sampler, rest)) = arguments.split_first() else {
            return Err(self.internal_error("a texture function without a sampler"));
        };
        let (ty, value) = self.sampler(*sampler)?;
        match form.lookup {
            How::Size => self.texture_size(ty, value, rest.first().copied()),
            How::Fetch => self.texel_fetch(ty, value, form, rest),
            How::QueryLod => self.query_lod(ty, value, rest.first().copied()),
            How::Levels => Ok(self.level_count(value)),
            How::Gather if form.offsets => self.gather_offsets(ty, value, form, rest),
            How::Implicit | How::Lod | How::Grad | How::Gather => {
                let lookup = self.lookup(ty, value, form, rest)?;
                if ty.texel != Scalar::Float && form.lookup == How::Gather {
                    return self.integer_gather(lookup);
                }
                if ty.texel != Scalar::Float {
                    return self.integer_lookup(&lookup);
                }
                let result = self.sample(&lookup)?;
                if !ty.shadow || self.size_of(ret) == 1 || form.lookup == How::Gather {
                    return Ok(result);
                }
                // `shadow2D` and its like of older versions.
                let (zero, one) = (self.float(0.0), self.float(1.0));
                Ok(self.float_vector(self.shader.depth_mode.components(result, zero, one).to_vec()))
            }
        }
    }

    /// Decomposes the arguments after the sampler, in their order.
    pub(super) fn lookup(
        &mut self,
        ty: SamplerType,
        value: SamplerValue,
        form: TextureForm,
        arguments: &[ExprId],
    ) -> Try<Lookup> {
        let (mut p, mut gradient_x, mut offset, mut level) = (None, None, None, SampleLevel::Auto);
        let (mut own_reference, mut gather, mut shift) = (None, None, None);
        if form.lookup == How::Gather {
            gather = Some(naga::SwizzleComponent::X);
            level = SampleLevel::Zero;
        }
        for (role, &argument) in form.arguments(ty).into_iter().zip(arguments) {
            match role {
                Role::Offset if form.lookup == How::Gather && !self.is_small_offset(argument) => {
                    shift = Some(self.value(argument)?);
                }
                Role::Offset | Role::Offsets => offset = Some(self.constant_offset(argument)?),
                Role::Coordinate => p = Some((self.value(argument)?, self.size_of(self.shader.expr(argument).ty))),
                Role::Level => level = SampleLevel::Exact(self.value(argument)?),
                Role::GradientX => gradient_x = Some(self.value(argument)?),
                Role::GradientY => {
                    let y = self.value(argument)?;
                    let x = gradient_x.ok_or_else(|| self.internal_error("a gradient along y without one along x"))?;
                    level = SampleLevel::Gradient { x, y };
                }
                Role::Bias => level = SampleLevel::Bias(self.value(argument)?),
                Role::Reference => own_reference = Some(self.value(argument)?),
                Role::Component => gather = Some(self.constant_component(argument)?),
                Role::Sample => return Err(self.internal_error("samples are fetched")),
            }
        }
        let Some((p, p_size)) = p else { return Err(self.internal_error("a texture function lacks an argument")) };
        if self.is_vertex() && matches!(level, SampleLevel::Auto | SampleLevel::Bias(_)) {
            // Outside the fragment stage, the base level is read (§8.7).
            let spelled = !self.low.can().names_base_level && !ty.shadow;
            level = if spelled { SampleLevel::Exact(self.float(0.0)) } else { SampleLevel::Zero };
        }
        let (coordinate, layer, reference) = self.coordinates(ty, form, p, p_size);
        let reference = own_reference.or(reference);
        Ok(Lookup { ty, value, coordinate, layer, reference, level, offset, shift, gather })
    }

    /// The coordinate, layer and reference value in P (the tables of §8.7).
    fn coordinates(
        &mut self,
        ty: SamplerType,
        form: TextureForm,
        p: Handle<Expression>,
        p_size: u8,
    ) -> (Handle<Expression>, Option<Handle<Expression>>, Option<Handle<Expression>>) {
        let n = ty.dimensions();
        let mut component = |index: u8| {
            let index = u32::from(index.min(p_size.saturating_sub(1)));
            self.add(Expression::AccessIndex { base: p, index })
        };
        // The reference value of a 1D shadow is in z, after an unused component; that of a cube is in w.
        let within = ty.shadow && form.lookup != How::Gather && ty.reference_component() < 4;
        let reference = within.then(|| component(ty.reference_component()));
        let layer = ty.arrayed.then(|| component(n));
        let divisor = form.projective.then(|| component(p_size.saturating_sub(1)));
        let coordinate = if p_size == n { p } else { self.first_components(p, n) };
        match divisor {
            None => (coordinate, layer, reference),
            Some(divisor) => {
                let spread = self.splat(divisor, n);
                let coordinate = self.op(BinaryOperator::Divide, coordinate, spread);
                let reference = reference.map(|value| self.op(BinaryOperator::Divide, value, divisor));
                (coordinate, layer, reference)
            }
        }
    }

    /// The value of an offset, which must be a constant expression (§8.7).
    fn constant_offset(&mut self, id: ExprId) -> Try<Vec<i32>> {
        let expr = self.shader.expr(id);
        let value = self.low.evaluated(self.id, id).ok_or_else(|| {
            lacking(
                expr.span,
                "the offset of a texture lookup is not constant",
                "choose among constant offsets with `if`, or add the offset to the coordinate",
            )
        })?;
        let whole = |scalar: &ScalarValue| match scalar {
            ScalarValue::Int(value) => *value,
            ScalarValue::Uint(value) => *value as i32,
            ScalarValue::Bool(_) | ScalarValue::Float(_) => 0,
        };
        Ok(value.scalars.iter().map(whole).collect())
    }

    /// Whether an offset is constant, and in the range that every target takes as one.
    fn is_small_offset(&self, id: ExprId) -> bool {
        let small = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Int(texels) if OFFSETS.contains(texels));
        self.low.evaluated(self.id, id).is_some_and(|value| value.scalars.iter().all(small))
    }

    /// The component of a gather, which must be a constant expression (GLSL 4.00 §8.9.3).
    fn constant_component(&mut self, id: ExprId) -> Try<naga::SwizzleComponent> {
        use naga::SwizzleComponent as C;
        let number = self.low.evaluated(self.id, id).and_then(|value| value.scalars.first().copied());
        let known = match number {
            Some(ScalarValue::Int(0)) => Some(C::X),
            Some(ScalarValue::Int(1)) => Some(C::Y),
            Some(ScalarValue::Int(2)) => Some(C::Z),
            Some(ScalarValue::Int(3)) => Some(C::W),
            _ => None,
        };
        known.ok_or_else(|| {
            let message = "the component of a gather is not a constant from 0 to 3";
            lacking(self.shader.expr(id).span, message, "choose among constant components with `if`")
        })
    }

    /// A lookup through a sampler.
    pub(super) fn sample(&mut self, lookup: &Lookup) -> Try<Handle<Expression>> {
        let Some(sampler) = lookup.value.sampler else {
            return Err(internal(self.here(), "this texture has no sampler"));
        };
        let level = self.shadow_level(lookup);
        let coordinate = match lookup.shift {
            Some(shift) => self.shifted(lookup, shift),
            None => lookup.coordinate,
        };
        let coordinate = self.target_coordinate(lookup, coordinate);
        let level = match level {
            SampleLevel::Gradient { x, y } => {
                SampleLevel::Gradient { x: self.target_gradient(lookup, x), y: self.target_gradient(lookup, y) }
            }
            level => level,
        };
        let array_index = lookup.layer.map(|layer| self.layer_index(layer));
        let offset = lookup.offset.as_ref().map(|offset| {
            let mut offset = offset.clone();
            if lookup.ty.dim == SamplerDim::D1 {
                offset.push(0);
            }
            self.int_vector(&offset)
        });
        Ok(self.add(Expression::ImageSample {
            image: lookup.value.texture,
            sampler,
            gather: lookup.gather,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref: lookup.reference,
            clamp_to_edge: false,
        }))
    }

    /// The level of a comparison: the implicit one or level 0, which are the only ones of a texture with one level.
    /// If another was requested, there is a warning ([`notes`](crate::emit::notes)).
    fn shadow_level(&self, lookup: &Lookup) -> SampleLevel {
        match lookup.level {
            level if lookup.reference.is_none() => level,
            SampleLevel::Auto | SampleLevel::Bias(_) => SampleLevel::Auto,
            SampleLevel::Zero | SampleLevel::Exact(_) | SampleLevel::Gradient { .. } => SampleLevel::Zero,
        }
    }

    /// The coordinate for the texture that represents the sampler. For 1D, it is in the middle of the row; for a
    /// rectangle, it is divided by the size in texels.
    fn target_coordinate(&mut self, lookup: &Lookup, coordinate: Handle<Expression>) -> Handle<Expression> {
        match lookup.ty.dim {
            SamplerDim::D1 => {
                let middle = self.float(0.5);
                self.float_vector(vec![coordinate, middle])
            }
            SamplerDim::Rect => self.by_size(lookup, coordinate),
            _ => coordinate,
        }
    }

    fn target_gradient(&mut self, lookup: &Lookup, gradient: Handle<Expression>) -> Handle<Expression> {
        match lookup.ty.dim {
            SamplerDim::D1 => {
                let zero = self.float(0.0);
                self.float_vector(vec![gradient, zero])
            }
            SamplerDim::Rect => self.by_size(lookup, gradient),
            _ => gradient,
        }
    }

    fn by_size(&mut self, lookup: &Lookup, texels: Handle<Expression>) -> Handle<Expression> {
        let zero = self.int(0);
        let size = self.texture_dimensions(lookup.value.texture, Some(zero));
        let size = self.add(Expression::As { expr: size, kind: naga::ScalarKind::Float, convert: Some(4) });
        self.op(BinaryOperator::Divide, texels, size)
    }

    /// The layer of a coordinate: floor(c + 0.5) (OpenGL 3.2 §3.8.9); targets clamp it.
    pub(super) fn layer_index(&mut self, layer: Handle<Expression>) -> Handle<Expression> {
        let half = self.float(0.5);
        let sum = self.op(BinaryOperator::Add, layer, half);
        let floor = self.math1(MathFunction::Floor, sum);
        self.add(Expression::As { expr: floor, kind: naga::ScalarKind::Sint, convert: Some(4) })
    }

    pub(super) fn float_vector(&mut self, components: Vec<Handle<Expression>>) -> Handle<Expression> {
        let ty = self.low.vector_type(Scalar::Float, components.len() as u8);
        self.add(Expression::Compose { ty, components })
    }

    /// A vector of `int` literals, or the literal itself.
    pub(super) fn int_vector(&mut self, values: &[i32]) -> Handle<Expression> {
        let components: Vec<_> = values.iter().map(|value| self.int(*value)).collect();
        match components.as_slice() {
            [one] => *one,
            _ => {
                let ty = self.low.vector_type(Scalar::Int, components.len() as u8);
                self.add(Expression::Compose { ty, components })
            }
        }
    }

    /// `texelFetch`, `texelFetchOffset`
    fn texel_fetch(
        &mut self,
        ty: SamplerType,
        value: SamplerValue,
        form: TextureForm,
        arguments: &[ExprId],
    ) -> Try<Handle<Expression>> {
        let (mut p, mut index, mut offset) = (None, None, None);
        for (role, &argument) in form.arguments(ty).into_iter().zip(arguments) {
            match role {
                Role::Offset => offset = Some(self.constant_offset(argument)?),
                Role::Coordinate => p = Some((self.value(argument)?, self.size_of(self.shader.expr(argument).ty))),
                Role::Level | Role::Sample => index = Some(self.value(argument)?),
                Role::GradientX | Role::GradientY | Role::Bias | Role::Reference | Role::Component | Role::Offsets => {
                    return Err(self.internal_error("a texel is fetched without a level of detail"));
                }
            }
        }
        let Some((p, p_size)) = p else { return Err(self.internal_error("a texel fetch lacks an argument")) };
        let multisampled = ty.dim == SamplerDim::Multisample;
        let index = index.unwrap_or_else(|| self.int(0));
        let n = ty.dimensions();
        let mut coordinate = if p_size == n { p } else { self.first_components(p, n) };
        if let Some(offset) = offset {
            let offset = self.int_vector(&offset);
            coordinate = self.op(BinaryOperator::Add, coordinate, offset);
        }
        let array_index = ty.arrayed.then(|| self.swizzled(p, Swizzle { len: 1, components: [n, 0, 0, 0] }));
        let coordinate = match ty.dim {
            SamplerDim::D1 => {
                let zero = self.int(0);
                let ty = self.low.vector_type(Scalar::Int, 2);
                self.add(Expression::Compose { ty, components: vec![coordinate, zero] })
            }
            SamplerDim::Buffer => self.buffer_coordinate(coordinate),
            _ => coordinate,
        };
        Ok(self.add(Expression::ImageLoad {
            image: value.texture,
            coordinate,
            array_index,
            sample: multisampled.then_some(index),
            level: (!multisampled).then_some(index),
        }))
    }

    /// Texel `i` of a buffer: (`i` mod width, `i` / width).
    fn buffer_coordinate(&mut self, index: Handle<Expression>) -> Handle<Expression> {
        let width = self.int(BUFFER_WIDTH as i32);
        let x = self.op(BinaryOperator::Modulo, index, width);
        let y = self.op(BinaryOperator::Divide, index, width);
        let ty = self.low.vector_type(Scalar::Int, 2);
        self.add(Expression::Compose { ty, components: vec![x, y] })
    }

    /// `textureSize`
    fn texture_size(&mut self, ty: SamplerType, value: SamplerValue, level: Option<ExprId>) -> Try<Handle<Expression>> {
        if ty.dim == SamplerDim::Buffer {
            return value
                .texel_count
                .ok_or_else(|| self.internal_error("the number of texels has no place among the uniforms"));
        }
        if ty.dim == SamplerDim::Multisample && ty.arrayed {
            // naga's SPIR-V writer queries a level, which multisampled images do not have.
            return Err(lacking(
                self.here(),
                format!("the number of layers of a `{}` cannot be asked for", ty.name()),
                "pass it in a uniform of your own",
            ));
        }
        let level = match level {
            _ if ty.dim == SamplerDim::Multisample => None,
            Some(level) => Some(self.value(level)?),
            None => Some(self.int(0)),
        };
        let size = self.texture_dimensions(value.texture, level);
        let mut size = self.add(Expression::As { expr: size, kind: naga::ScalarKind::Sint, convert: Some(4) });
        if ty.dim == SamplerDim::D1 {
            size = self.add(Expression::AccessIndex { base: size, index: 0 });
        }
        if !ty.arrayed {
            return Ok(size);
        }
        let query = naga::ImageQuery::NumLayers;
        let layers = self.add(Expression::ImageQuery { image: value.texture, query });
        let mut layers = self.converted(layers, TypeId::UINT, TypeId::INT);
        if ty.is_integer_cube() {
            // Its faces are layers.
            let six = self.int(6);
            layers = self.op(BinaryOperator::Divide, layers, six);
        }
        let n = if ty.dim == SamplerDim::D1 { 2 } else { 3 };
        let ty = self.low.vector_type(Scalar::Int, n);
        Ok(self.add(Expression::Compose { ty, components: vec![size, layers] }))
    }
}
