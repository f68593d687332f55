//! Lookups in integer textures, which no target can sample: a texel is loaded by own arithmetic.
//!
//! *Holds:* the filter is NEAREST, the only complete one for integer textures (OpenGL 3.2 §3.8.10 leaves all others
//! incomplete). The wrap mode is OpenGL's default, since a shader cannot see the sampler's state: REPEAT, for rectangles
//! CLAMP_TO_EDGE. The level is the one asked for, rounded; without one it is the base level.

use super::Try;
use super::function::Ctx;
use super::lacking;
use super::textures::{Lookup, dimensions};
use crate::hir::{SamplerDim, Scalar};
use naga::{BinaryOperator, Expression, Handle, ImageQuery, MathFunction, SampleLevel, ScalarKind};

impl Ctx<'_, '_> {
    /// A lookup in an integer texture.
    pub(super) fn integer_lookup(&mut self, lookup: &Lookup) -> Try<Handle<Expression>> {
        if lookup.ty.dim == SamplerDim::Cube {
            return Err(lacking(
                self.here(),
                format!(
                    "no target reads a `{}`: integer cube textures can be neither sampled nor loaded",
                    lookup.ty.name()
                ),
                "use an array of six layers, or a texture of floats",
            ));
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

    /// `clamp(value, 0, size - 1)`
    fn inside(&mut self, value: Handle<Expression>, size: Handle<Expression>, n: u8) -> Handle<Expression> {
        let one = self.int(1);
        let one = self.splat(one, n);
        let last = self.op(BinaryOperator::Subtract, size, one);
        let zero = self.int(0);
        let zero = self.splat(zero, n);
        self.math3(MathFunction::Clamp, value, zero, last)
    }

    /// The level asked for, rounded to the nearest that is there.
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

    /// log2 of the longer of the gradients in texels (OpenGL 3.2 §3.8.9, equation 3.17).
    fn gradient_level(&mut self, lookup: &Lookup, x: Handle<Expression>, y: Handle<Expression>) -> Handle<Expression> {
        let n = dimensions(lookup.ty.dim);
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
        // Below one texel the base level is read anyway, and the logarithm of 0 is not wanted.
        let one = self.float(1.0);
        let longer = self.math2(MathFunction::Max, longer, one);
        self.math1(MathFunction::Log2, longer)
    }

    /// The texel that a coordinate falls into, offset and wrapped.
    fn integer_coordinate(&mut self, lookup: &Lookup, size: Handle<Expression>) -> Handle<Expression> {
        let n = dimensions(lookup.ty.dim);
        let size = if n == 1 { self.add(Expression::AccessIndex { base: size, index: 0 }) } else { size };
        let rect = lookup.ty.dim == SamplerDim::Rect;
        let scaled = if rect {
            lookup.coordinate
        } else {
            let size = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
            self.op(BinaryOperator::Multiply, lookup.coordinate, size)
        };
        let floor = self.math1(MathFunction::Floor, scaled);
        let mut texel = self.add(Expression::As { expr: floor, kind: ScalarKind::Sint, convert: Some(4) });
        if let Some(offset) = &lookup.offset {
            let offset = self.int_vector(offset);
            texel = self.op(BinaryOperator::Add, texel, offset);
        }
        let wrapped = if rect { self.inside(texel, size, n) } else { self.repeated(texel, size) };
        if n > 1 {
            return wrapped;
        }
        let zero = self.int(0);
        let ty = self.low.vector_type(Scalar::Int, 2);
        self.add(Expression::Compose { ty, components: vec![wrapped, zero] })
    }

    /// `texel` modulo `size`, at least 0.
    fn repeated(&mut self, texel: Handle<Expression>, size: Handle<Expression>) -> Handle<Expression> {
        let rest = self.op(BinaryOperator::Modulo, texel, size);
        let above = self.op(BinaryOperator::Add, rest, size);
        self.op(BinaryOperator::Modulo, above, size)
    }
}
