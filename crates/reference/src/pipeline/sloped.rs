//! [`SlopedPlane`]: a value that is linear in the window as a number at a point and two slopes, as GPUs compute it.
//!
//! *In:* the values at the vertices of a triangle. *Out:* the value at a fragment.

use crate::domain::Planes;
use crate::interpolate::{Field, Frame, Vec2};

/// The plane of a value over a triangle.
pub(super) struct SlopedPlane<F> {
    at: Vec2<F>,
    value: F,
    slopes: Vec2<F>,
}

impl<F: Field> SlopedPlane<F> {
    pub(super) fn new(frame: &Frame<F>, c: [F; 3], planes: Planes) -> Self {
        let (to_second, to_third) = (c[1].sub(c[0]), c[2].sub(c[0]));
        let per_area = F::constant(1.0).div(frame.determinant);
        let slope = |a: F, b: F, a_side: F, b_side: F| a.mul(a_side).sub(b.mul(b_side)).mul(per_area);
        let slopes =
            [slope(to_second, to_third, frame.v[1], frame.u[1]), slope(to_third, to_second, frame.u[0], frame.v[0])];
        if planes == Planes::FromVertex {
            return Self { at: frame.origin, value: c[0], slopes };
        }
        let [x, y] = frame.origin;
        let value = c[0].sub(slopes[0].mul(x)).sub(slopes[1].mul(y));
        Self { at: [F::constant(0.0); 2], value, slopes }
    }

    /// The value at a position.
    #[inline(always)]
    pub(super) fn at(&self, [x, y]: Vec2<F>) -> F {
        let [x, y] = [x.sub(self.at[0]), y.sub(self.at[1])];
        self.value.add(self.slopes[0].mul(x)).add(self.slopes[1].mul(y))
    }

    /// The same plane in other numbers.
    #[inline(always)]
    pub(super) fn map<G>(&self, f: impl Fn(F) -> G + Copy) -> SlopedPlane<G> {
        SlopedPlane { at: self.at.map(f), value: f(self.value), slopes: self.slopes.map(f) }
    }
}
