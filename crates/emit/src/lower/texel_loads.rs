//! Lowers lookups in integer textures, which no target can sample: computes the texel and loads it.
//!
//! *Holds:* the filter is NEAREST, the only complete one for integer textures (OpenGL 3.2 §3.8.10 makes all others
//! incomplete). A shader cannot see the sampler's state, so the host tells the wrap mode ([`TexelWrap`]); rectangles have
//! CLAMP_TO_EDGE. The level is the requested one, rounded, or else the base level.

use super::Try;
use super::function::Ctx;
use super::lacking;
use super::textures::Lookup;
use crate::target::TexelWrap;
use glisten_front::hir::{SamplerDim, Scalar};
use naga::{BinaryOperator, Expression, Handle, ImageQuery, MathFunction, SampleLevel, ScalarKind};

impl Ctx<'_, '_> {
    /// A lookup in an integer texture.
    pub(super) fn integer_lookup(&mut self, lookup: &Lookup) -> Try<Handle<Expression>> {
        if lookup.ty.dim == SamplerDim::Cube {
            return self.integer_cube_lookup(lookup);
        }
        let level = self.integer_level(lookup);
        let size = self.texture_dimensions(lookup.value.texture, Some(level));
        let size = self.add(Expression::As { expr: size, kind: ScalarKind::Sint, convert: Some(4) });
        let coordinate = self.integer_coordinate(lookup, size);
        let array_index = lookup.layer.map(|layer| {
            let layer = self.layer_index(layer);
            let layers = self.add(Expression::ImageQuery { image: lookup.value.texture, query: ImageQuery::NumLayers });
            let layers = self.add(Expression::As { expr: layers, kind: ScalarKind::Sint, convert: Some(4) });
            self.inside(layer, layers, 1)
        });
        Ok(self.add(Expression::ImageLoad {
            image: lookup.value.texture,
            coordinate,
            array_index,
            sample: None,
            level: Some(level),
        }))
    }

    /// The texel of the face that a direction hits (OpenGL 3.2 §3.8.6, table 3.21); the faces are layers of an array.
    /// Where axes are equally long, z precedes y, and y precedes x, as in the reference.
    fn integer_cube_lookup(&mut self, lookup: &Lookup) -> Try<Handle<Expression>> {
        if matches!(lookup.level, SampleLevel::Gradient { .. }) {
            return Err(lacking(
                self.here(),
                format!("`textureGrad` of a `{}`: the level of an integer cube cannot be determined", lookup.ty.name()),
                "use `textureLod`, or a texture of floats",
            ));
        }
        let level = self.integer_level(lookup);
        let size = self.texture_dimensions(lookup.value.texture, Some(level));
        let size = self.add(Expression::As { expr: size, kind: ScalarKind::Sint, convert: Some(4) });
        let [x, y, z] = [0, 1, 2].map(|index| self.add(Expression::AccessIndex { base: lookup.coordinate, index }));
        let [ax, ay, az] = [x, y, z].map(|axis| self.math1(MathFunction::Abs, axis));
        let [over_x, over_y] = [ax, ay].map(|other| self.op(BinaryOperator::GreaterEqual, az, other));
        let is_z = self.op(BinaryOperator::LogicalAnd, over_x, over_y);
        let is_y = self.op(BinaryOperator::GreaterEqual, ay, ax);
        let zero = self.float(0.0);
        let [back_x, back_y, back_z] = [x, y, z].map(|axis| self.op(BinaryOperator::Less, axis, zero));
        let [minus_x, minus_y, minus_z] =
            [x, y, z].map(|axis| self.add(Expression::Unary { op: naga::UnaryOperator::Negate, expr: axis }));
        let mut choose = |condition, accept, reject| self.add(Expression::Select { condition, accept, reject });
        let on_x = choose(back_x, z, minus_z);
        let on_z = choose(back_z, minus_x, x);
        let off_z = choose(is_y, x, on_x);
        let s = choose(is_z, on_z, off_z);
        let on_y = choose(back_y, minus_z, z);
        let off_z = choose(is_y, on_y, minus_y);
        let t = choose(is_z, minus_y, off_z);
        let off_z = choose(is_y, ay, ax);
        let longest = choose(is_z, az, off_z);
        let [f0, f1, f2, f3, f4, f5] = [0, 1, 2, 3, 4, 5].map(|face| self.int(face));
        let mut choose = |condition, accept, reject| self.add(Expression::Select { condition, accept, reject });
        let (on_x, on_y, on_z) = (choose(back_x, f1, f0), choose(back_y, f3, f2), choose(back_z, f5, f4));
        let off_z = choose(is_y, on_y, on_x);
        let face = choose(is_z, on_z, off_z);
        self.name(face, "face");
        let face = match lookup.layer {
            None => face,
            Some(layer) => self.face_of_layer(lookup, layer, face),
        };
        // s = (s_c / m_a + 1) / 2, in texels.
        let place = self.float_vector(vec![s, t]);
        let longest = self.splat(longest, 2);
        let place = self.op(BinaryOperator::Divide, place, longest);
        let (one, half) = (self.float(1.0), self.float(0.5));
        let (one, half) = (self.splat(one, 2), self.splat(half, 2));
        let place = self.op(BinaryOperator::Add, place, one);
        let place = self.op(BinaryOperator::Multiply, place, half);
        let extent = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
        let place = self.op(BinaryOperator::Multiply, place, extent);
        let floor = self.math1(MathFunction::Floor, place);
        let texel = self.add(Expression::As { expr: floor, kind: ScalarKind::Sint, convert: Some(4) });
        let coordinate = self.inside(texel, size, 2);
        Ok(self.add(Expression::ImageLoad {
            image: lookup.value.texture,
            coordinate,
            array_index: Some(face),
            sample: None,
            level: Some(level),
        }))
    }

    /// The layer of a face of a layer of cubes: each has six.
    fn face_of_layer(
        &mut self,
        lookup: &Lookup,
        layer: Handle<Expression>,
        face: Handle<Expression>,
    ) -> Handle<Expression> {
        let layer = self.layer_index(layer);
        let faces = self.add(Expression::ImageQuery { image: lookup.value.texture, query: ImageQuery::NumLayers });
        let faces = self.add(Expression::As { expr: faces, kind: ScalarKind::Sint, convert: Some(4) });
        let six = self.int(6);
        let layers = self.op(BinaryOperator::Divide, faces, six);
        let layer = self.inside(layer, layers, 1);
        let first = self.op(BinaryOperator::Multiply, layer, six);
        self.op(BinaryOperator::Add, first, face)
    }

    /// `clamp(value, 0, size - 1)`
    fn inside(&mut self, value: Handle<Expression>, size: Handle<Expression>, n: u8) -> Handle<Expression> {
        let one = self.int(1);
        let one = self.splat(one, n);
        let last = self.op(BinaryOperator::Subtract, size, one);
        let zero = self.int(0);
        let zero = self.splat(zero, n);
        self.math3(MathFunction::Clamp, value, zero, last)
    }

    /// The requested level, rounded and clamped to the existing levels.
    fn integer_level(&mut self, lookup: &Lookup) -> Handle<Expression> {
        let lod = match lookup.level {
            SampleLevel::Exact(lod) => lod,
            SampleLevel::Gradient { x, y } => self.gradient_level(lookup, x, y),
            SampleLevel::Auto | SampleLevel::Zero | SampleLevel::Bias(_) => return self.int(0),
        };
        let rounded = self.math1(MathFunction::Round, lod);
        let level = self.add(Expression::As { expr: rounded, kind: ScalarKind::Sint, convert: Some(4) });
        let image = lookup.value.texture;
        let levels = self.add(Expression::ImageQuery { image, query: ImageQuery::NumLevels });
        let levels = self.add(Expression::As { expr: levels, kind: ScalarKind::Sint, convert: Some(4) });
        self.inside(level, levels, 1)
    }

    /// log2 of the longer gradient in texels (OpenGL 3.2 §3.8.9, equation 3.17).
    fn gradient_level(&mut self, lookup: &Lookup, x: Handle<Expression>, y: Handle<Expression>) -> Handle<Expression> {
        let n = lookup.ty.dimensions();
        let zero = self.int(0);
        let size = self.texture_dimensions(lookup.value.texture, Some(zero));
        let size = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
        let size = if n == 1 { self.add(Expression::AccessIndex { base: size, index: 0 }) } else { size };
        let rect = lookup.ty.dim == SamplerDim::Rect;
        let mut length = |gradient| {
            let texels = if rect { gradient } else { self.op(BinaryOperator::Multiply, gradient, size) };
            self.math1(MathFunction::Length, texels)
        };
        let (x, y) = (length(x), length(y));
        let longer = self.math2(MathFunction::Max, x, y);
        // Below one texel the base level is read anyway, and this avoids the logarithm of 0.
        let one = self.float(1.0);
        let longer = self.math2(MathFunction::Max, longer, one);
        self.math1(MathFunction::Log2, longer)
    }

    /// The texel that contains a coordinate, with offset and wrap mode applied.
    fn integer_coordinate(&mut self, lookup: &Lookup, size: Handle<Expression>) -> Handle<Expression> {
        let n = lookup.ty.dimensions();
        let size = if n == 1 { self.add(Expression::AccessIndex { base: size, index: 0 }) } else { size };
        let rect = lookup.ty.dim == SamplerDim::Rect;
        let scaled = if rect {
            lookup.coordinate
        } else {
            let size = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
            self.op(BinaryOperator::Multiply, lookup.coordinate, size)
        };
        // A gather begins left of and below the coordinate.
        let scaled = if lookup.gather.is_some() {
            let half = self.float(0.5);
            let half = self.splat(half, n);
            self.op(BinaryOperator::Subtract, scaled, half)
        } else {
            scaled
        };
        let floor = self.math1(MathFunction::Floor, scaled);
        let mut texel = self.add(Expression::As { expr: floor, kind: ScalarKind::Sint, convert: Some(4) });
        if let Some(offset) = &lookup.offset {
            let offset = self.int_vector(offset);
            texel = self.op(BinaryOperator::Add, texel, offset);
        }
        if let Some(offset) = lookup.shift {
            texel = self.op(BinaryOperator::Add, texel, offset);
        }
        let wrapped = match self.low.conventions.texel_wrap {
            _ if rect => self.inside(texel, size, n),
            TexelWrap::ClampToEdge => self.inside(texel, size, n),
            TexelWrap::Repeat => self.repeated(texel, size),
            TexelWrap::MirroredRepeat => self.mirrored(texel, size, n),
        };
        if n > 1 {
            return wrapped;
        }
        let zero = self.int(0);
        let ty = self.low.vector_type(Scalar::Int, 2);
        self.add(Expression::Compose { ty, components: vec![wrapped, zero] })
    }

    /// `texel` modulo twice the size; the second half runs back.
    fn mirrored(&mut self, texel: Handle<Expression>, size: Handle<Expression>, n: u8) -> Handle<Expression> {
        let period = self.op(BinaryOperator::Add, size, size);
        let place = self.repeated(texel, period);
        let one = self.int(1);
        let one = self.splat(one, n);
        let last = self.op(BinaryOperator::Subtract, period, one);
        let back = self.op(BinaryOperator::Subtract, last, place);
        self.math2(MathFunction::Min, place, back)
    }

    /// `texel` modulo `size`, never negative.
    fn repeated(&mut self, texel: Handle<Expression>, size: Handle<Expression>) -> Handle<Expression> {
        let rest = self.op(BinaryOperator::Modulo, texel, size);
        let above = self.op(BinaryOperator::Add, rest, size);
        self.op(BinaryOperator::Modulo, above, size)
    }
}
