//! Points as quads (`--point-sprites`), for targets whose points are one pixel wide: WGSL and HLSL.
//!
//! The host draws each point as an instance of a triangle strip of four vertices. What was read for each vertex is read
//! for each instance. The vertex stage moves each corner half a point's size away from the position, and hands its
//! place in the point on as a varying. So it does with the number of the point, if the fragment stage reads `gl_PrimitiveID`: the
//! target counts triangles.
//!
//! *Holds:* the pixels and `gl_PointCoord` are those of OpenGL 3.2 §3.4: a square of `gl_PointSize` pixels around the
//! position, 255 at most; the place counts from the upper left (POINT_SPRITE_COORD_ORIGIN). The triangles are front faces. Of a point
//! whose center is outside of the window, the part inside is drawn, as by the GPU's own points; OpenGL drops it (§2.17).

use super::function::Ctx;
use super::slots::Corner;
use super::{Lower, Try};
use crate::target::{WindowOrigin, viewport_slot};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{Shader, Stage, TypeId};
use glisten_front::link::Interface;
use naga::{AddressSpace, BinaryOperator, Binding, BuiltIn, Expression, Handle, MathFunction, TypeInner};

/// The largest size of a point in pixels, as of the points of most drivers (`ALIASED_POINT_SIZE_RANGE`).
const LARGEST_POINT: f32 = 255.0;

/// The location of the varying with the place in the point: after all others.
pub(crate) fn coordinate_location(interface: &Interface) -> u32 {
    interface.interpolated().map(|row| row.location.saturating_add(1)).max().unwrap_or(0)
}

/// The location of the varying with the number of the point: after that.
pub(super) fn number_location(interface: &Interface) -> u32 {
    coordinate_location(interface).saturating_add(1)
}

/// Whether a stage reads the number of its primitive.
pub(super) fn reads_primitive_id(shader: &Shader) -> bool {
    let is_it = |id: &Option<BuiltinVariable>| *id == Some(BuiltinVariable::PrimitiveId);
    shader.globals.iter().any(|global| global.used && is_it(&global.builtin))
}

impl Lower<'_> {
    /// Whether points are drawn as quads.
    pub(super) fn draws_sprites(&self) -> bool {
        self.conventions.point_sprites && !self.can().has_large_points
    }

    /// Declares the uniform buffer with the viewport's size.
    pub(super) fn declare_viewport(&mut self) -> Try<()> {
        if self.shader.stage != Stage::Vertex || !self.draws_sprites() {
            return Ok(());
        }
        let ty = self.value_type(TypeId::VEC2)?;
        let name = Some("viewport_size".to_owned());
        let members = vec![naga::StructMember { name, ty, binding: None, offset: 0 }];
        let ty = self.insert_type(Some("PointSprites".into()), TypeInner::Struct { members, span: 8 });
        let slot = viewport_slot(self.interface);
        self.viewport = Some(self.resource("point_sprites", AddressSpace::Uniform, slot, ty));
        Ok(())
    }
}

impl Ctx<'_, '_> {
    /// The corner that this invocation draws, by the number of the vertex in the strip.
    pub(super) fn sprite_corner(&mut self) -> Try<Corner> {
        let uint = self.low.value_type(TypeId::UINT)?;
        let vec2 = self.low.value_type(TypeId::VEC2)?;
        let index = self.argument("corner", uint, Some(Binding::BuiltIn(BuiltIn::VertexIndex)));
        let one = self.add(Expression::Literal(naga::Literal::U32(1)));
        let (right, up) = (self.op(BinaryOperator::And, index, one), self.op(BinaryOperator::ShiftRight, index, one));
        let float =
            |ctx: &mut Self, expr| ctx.add(Expression::As { expr, kind: naga::ScalarKind::Float, convert: Some(4) });
        let (right, up) = (float(self, right), float(self, up));
        self.name(right, "right");
        self.name(up, "up");
        let whole = self.float(1.0);
        let (left, down) =
            (self.op(BinaryOperator::Subtract, whole, right), self.op(BinaryOperator::Subtract, whole, up));
        // The strip turns counterclockwise. A host whose vertex stage flips y has inverted its front face.
        let upright = self.low.conventions.window_origin == WindowOrigin::UpperLeft;
        let (x, y) = if upright { (right, down) } else { (left, up) };
        let coordinate = self.add(Expression::Compose { ty: vec2, components: vec![x, y] });
        self.name(coordinate, "point_coord");
        let place = self.add(Expression::Compose { ty: vec2, components: vec![x, up] });
        let two = self.float(2.0);
        let doubled = self.op(BinaryOperator::Multiply, place, two);
        let ones = self.add(Expression::Compose { ty: vec2, components: vec![whole; 2] });
        let direction = self.op(BinaryOperator::Subtract, doubled, ones);
        let number = if self.low.reads_primitive_id { Some(self.instance_number()?) } else { None };
        Ok(Corner { direction, coordinate, number })
    }

    /// The number of the instance, which `gl_VertexID` may have asked for already.
    fn instance_number(&mut self) -> Try<Handle<Expression>> {
        let binding = Some(Binding::BuiltIn(BuiltIn::InstanceIndex));
        if let Some(known) = self.out.arguments.iter().position(|argument| argument.binding == binding) {
            return Ok(self.add(Expression::FunctionArgument(known as u32)));
        }
        let uint = self.low.value_type(TypeId::UINT)?;
        Ok(self.argument("instance_index", uint, binding))
    }

    /// The position of the corner: half a point's size away from the point's own.
    pub(super) fn sprite_position(&mut self, position: Handle<Expression>) -> Try<Handle<Expression>> {
        let Some(viewport) = self.low.viewport else {
            return Err(self.internal_error("the viewport's size has no place among the uniforms"));
        };
        let Some(corner) = self.corner.as_ref().map(|corner| corner.direction) else {
            return Err(self.internal_error("a point has no corners"));
        };
        let size = self.sprite_size()?;
        if !self.is_named(position) {
            self.name(position, "center");
        }
        let part = |ctx: &mut Self, index| ctx.add(Expression::AccessIndex { base: position, index });
        let (x, y, z, w) = (part(self, 0), part(self, 1), part(self, 2), part(self, 3));
        let base = self.global_variable(viewport);
        let pointer = self.add(Expression::AccessIndex { base, index: 0 });
        let pixels = self.load(pointer);
        // Two units of normalized device coordinates are the viewport, one to each side of the center.
        let factor = self.op(BinaryOperator::Multiply, size, w);
        let offset = self.op(BinaryOperator::Multiply, corner, factor);
        let offset = self.op(BinaryOperator::Divide, offset, pixels);
        self.name(offset, "offset");
        let part = |ctx: &mut Self, index| ctx.add(Expression::AccessIndex { base: offset, index });
        let (dx, dy) = (part(self, 0), part(self, 1));
        let (x, y) = (self.op(BinaryOperator::Add, x, dx), self.op(BinaryOperator::Add, y, dy));
        let ty = self.low.value_type(TypeId::VEC4)?;
        Ok(self.add(Expression::Compose { ty, components: vec![x, y, z, w] }))
    }

    /// The size in pixels: at least one, at most [`LARGEST_POINT`], and one unless the host enables PROGRAM_POINT_SIZE.
    fn sprite_size(&mut self) -> Try<Handle<Expression>> {
        let one = self.float(1.0);
        let sized = self.low.builtin_global(BuiltinVariable::PointSize);
        match sized.filter(|_| self.low.conventions.program_point_size) {
            Some(global) => {
                let size = self.output_part(global, 0, TypeId::FLOAT)?;
                let most = self.float(LARGEST_POINT);
                Ok(self.math3(MathFunction::Clamp, size, one, most))
            }
            None => Ok(one),
        }
    }

    /// `gl_PointCoord` in the fragment stage: the varying of the quad. `w` is the same at all corners.
    pub(super) fn sprite_coordinate(&mut self) -> Try<Handle<Expression>> {
        let ty = self.low.value_type(TypeId::VEC2)?;
        let location = coordinate_location(self.low.interface);
        Ok(self.argument("gl_PointCoord", ty, Some(coordinate_binding(location))))
    }

    /// `gl_PrimitiveID` in the fragment stage: the varying of the quad.
    pub(super) fn sprite_number(&mut self, name: &str) -> Try<Handle<Expression>> {
        let ty = self.low.value_type(TypeId::UINT)?;
        let location = number_location(self.low.interface);
        let number = self.argument("point_number", ty, Some(number_binding(location)));
        let value = self.add(Expression::As { expr: number, kind: naga::ScalarKind::Sint, convert: Some(4) });
        self.name(value, name);
        Ok(value)
    }
}

/// naga's binding of the number of the point.
pub(super) fn number_binding(location: u32) -> Binding {
    Binding::Location {
        location,
        interpolation: Some(naga::Interpolation::Flat),
        sampling: None,
        blend_src: None,
        per_primitive: false,
    }
}

/// naga's binding of the place in the point.
pub(super) fn coordinate_binding(location: u32) -> Binding {
    Binding::Location {
        location,
        interpolation: Some(naga::Interpolation::Linear),
        sampling: Some(naga::Sampling::Center),
        blend_src: None,
        per_primitive: false,
    }
}
