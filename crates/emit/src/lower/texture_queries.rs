//! Lowers questions about levels: `textureQueryLod` (GLSL 4.00 §8.9.1) and `textureQueryLevels` (GLSL 4.30 §8.9.1).
//!
//! *Holds:* naga has no level of detail, so it is computed from derivatives, by equation 3.21 of OpenGL 3.2 §3.8.11. The level
//! that is used is the one of a trilinear filter. The smallest level of detail is -126.

use super::function::Ctx;
use super::slots::SamplerValue;
use super::{Try, lacking};
use glisten_front::hir::{ExprId, SamplerDim, SamplerType};
use naga::{
    BinaryOperator, DerivativeAxis, DerivativeControl, Expression, Handle, ImageQuery, MathFunction, ScalarKind,
};

/// The smallest normal float: the smallest step whose logarithm is computed.
const LEAST_STEP: f32 = f32::MIN_POSITIVE;

impl Ctx<'_, '_> {
    /// The number of levels as an `int`.
    pub(super) fn level_count(&mut self, value: SamplerValue) -> Handle<Expression> {
        let levels = self.add(Expression::ImageQuery { image: value.texture, query: ImageQuery::NumLevels });
        self.add(Expression::As { expr: levels, kind: ScalarKind::Sint, convert: Some(4) })
    }

    /// The level that is read, and the level of detail.
    pub(super) fn query_lod(
        &mut self,
        ty: SamplerType,
        value: SamplerValue,
        p: Option<ExprId>,
    ) -> Try<Handle<Expression>> {
        let Some(p) = p else { return Err(self.internal_error("a level of detail without a coordinate")) };
        if ty.dim == SamplerDim::Cube {
            return Err(lacking(
                self.here(),
                format!("`textureQueryLod` of a `{}`: no target has it", ty.name()),
                "compute the level from the derivatives of the direction",
            ));
        }
        let p = self.value(p)?;
        let zero = self.int(0);
        let size = self.texture_dimensions(value.texture, Some(zero));
        let mut size = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
        if ty.dim == SamplerDim::D1 {
            size = self.add(Expression::AccessIndex { base: size, index: 0 });
        }
        let texels = self.op(BinaryOperator::Multiply, p, size);
        let length = if ty.dim == SamplerDim::D1 { MathFunction::Abs } else { MathFunction::Length };
        let [x, y] = [DerivativeAxis::X, DerivativeAxis::Y].map(|axis| {
            let step = self.add(Expression::Derivative { axis, ctrl: DerivativeControl::None, expr: texels });
            self.math1(length, step)
        });
        let least = self.float(LEAST_STEP);
        let longest = self.math2(MathFunction::Max, x, y);
        let step = self.math2(MathFunction::Max, longest, least);
        let level = self.math1(MathFunction::Log2, step);
        let levels = self.add(Expression::ImageQuery { image: value.texture, query: ImageQuery::NumLevels });
        let levels = self.add(Expression::As { expr: levels, kind: ScalarKind::Float, convert: Some(4) });
        let (one, none) = (self.float(1.0), self.float(0.0));
        let last = self.op(BinaryOperator::Subtract, levels, one);
        let above = self.math2(MathFunction::Max, level, none);
        let used = self.math2(MathFunction::Min, above, last);
        Ok(self.float_vector(vec![used, level]))
    }
}
