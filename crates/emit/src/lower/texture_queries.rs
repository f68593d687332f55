//! Lowers questions about levels: `textureQueryLod` (GLSL 4.00 §8.9.1) and `textureQueryLevels` (GLSL 4.30 §8.9.1).
//!
//! *Holds:* naga has no level of detail, so it is computed from derivatives, by equation 3.21 of OpenGL 3.2 §3.8.11. The level
//! that is used is the one of a trilinear filter. The smallest level of detail is -126.

use super::Try;
use super::function::Ctx;
use super::slots::SamplerValue;
use glisten_front::hir::{ExprId, SamplerDim, SamplerType};
use naga::{
    BinaryOperator, DerivativeAxis, DerivativeControl, Expression, Handle, ImageQuery, MathFunction, ScalarKind,
};

/// The smallest normal float: the smallest step whose logarithm is computed.
const LEAST_STEP: f32 = f32::MIN_POSITIVE;

/// The axes of the window.
const AXES: [DerivativeAxis; 2] = [DerivativeAxis::X, DerivativeAxis::Y];

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
        let p = self.value(p)?;
        let zero = self.int(0);
        let size = self.texture_dimensions(value.texture, Some(zero));
        let mut size = self.add(Expression::As { expr: size, kind: ScalarKind::Float, convert: Some(4) });
        if ty.dim == SamplerDim::D1 {
            size = self.add(Expression::AccessIndex { base: size, index: 0 });
        }
        let [x, y] = if ty.dim == SamplerDim::Cube {
            self.steps_on_face(p, size)
        } else {
            let texels = self.op(BinaryOperator::Multiply, p, size);
            let length = if ty.dim == SamplerDim::D1 { MathFunction::Abs } else { MathFunction::Length };
            AXES.map(|axis| {
                let step = self.add(Expression::Derivative { axis, ctrl: DerivativeControl::None, expr: texels });
                self.math1(length, step)
            })
        };
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

    /// The lengths in texels of the steps on the face that a direction p hits (OpenGL 3.2 §3.8.6): with the longest axis m and
    /// another one a, a coordinate of the face is a / (2 m) + 1/2 up to its sign, which changes by (da m - a dm) / (2 m^2).
    fn steps_on_face(&mut self, p: Handle<Expression>, size: Handle<Expression>) -> [Handle<Expression>; 2] {
        use naga::SwizzleComponent::{X, Y, Z};
        let [x, y, z] = [0, 1, 2].map(|index| self.add(Expression::AccessIndex { base: p, index }));
        let [ax, ay, az] = [x, y, z].map(|axis| self.math1(MathFunction::Abs, axis));
        let [over_x, over_y] = [ax, ay].map(|other| self.op(BinaryOperator::GreaterEqual, az, other));
        let is_z = self.op(BinaryOperator::LogicalAnd, over_x, over_y);
        let is_y = self.op(BinaryOperator::GreaterEqual, ay, ax);
        let longest_first = |this: &mut Self, vector: Handle<Expression>| {
            let size = naga::VectorSize::Tri;
            let [z_first, y_first] =
                [[Z, X, Y, X], [Y, X, Z, X]].map(|pattern| this.add(Expression::Swizzle { size, vector, pattern }));
            let off_z = this.add(Expression::Select { condition: is_y, accept: y_first, reject: vector });
            this.add(Expression::Select { condition: is_z, accept: z_first, reject: off_z })
        };
        let at = longest_first(self, p);
        let parts = |this: &mut Self, vector: Handle<Expression>| {
            let m = this.add(Expression::AccessIndex { base: vector, index: 0 });
            let others = [Y, Z, X, X];
            let others = this.add(Expression::Swizzle { size: naga::VectorSize::Bi, vector, pattern: others });
            (m, others)
        };
        let (m, a) = parts(self, at);
        let squared = self.op(BinaryOperator::Multiply, m, m);
        let half = self.float(0.5);
        let scale = self.op(BinaryOperator::Divide, half, squared);
        let width = self.add(Expression::AccessIndex { base: size, index: 0 });
        let scale = self.op(BinaryOperator::Multiply, scale, width);
        AXES.map(|axis| {
            let step = self.add(Expression::Derivative { axis, ctrl: DerivativeControl::None, expr: p });
            let step = longest_first(self, step);
            let (dm, da) = parts(self, step);
            let gained = self.op(BinaryOperator::Multiply, da, m);
            let lost = self.op(BinaryOperator::Multiply, a, dm);
            let change = self.op(BinaryOperator::Subtract, gained, lost);
            let texels = self.op(BinaryOperator::Multiply, change, scale);
            self.math1(MathFunction::Length, texels)
        })
    }
}
