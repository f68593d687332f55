//! Interpolates values of vertices by the equations (102) to (108) of the first source document and (3.5) to (3.7) of
//! OpenGL 3.2 §3.5.1, over every [`Field`].
//!
//! *In:* positions in window space, values of vertices. *Out:* the value at a fragment.
//!
//! *Holds:* nothing panics. Where the equations are undefined, the results are those of IEEE arithmetic, infinite or
//! NaN: for a triangle without area (`x_u y_v - x_v y_u = 0`, which produces no fragments) and for `w = 0` (which
//! clipping removes). The tests bound the error of each equation by a number of roundings, up to these limits. The
//! names are those of the document: `P` is the fragment, `P0`, `P1`, `P2` the vertices, `u` and `v` the edges from
//! `P0` and the coordinates along them, `C0`, `C1`, `C2` the values of the vertices.

mod field;

pub(crate) use field::{Eight, Field};

/// A point or vector in window space, in pixels.
pub(crate) type Vec2<F> = [F; 2];

/// Equation (102): the edges of a triangle from its first vertex, `u = P1 - P0` and `v = P2 - P0`.
pub(crate) fn edges<F: Field>(p0: Vec2<F>, p1: Vec2<F>, p2: Vec2<F>) -> (Vec2<F>, Vec2<F>) {
    let from_p0 = |p: Vec2<F>| [p[0].sub(p0[0]), p[1].sub(p0[1])];
    (from_p0(p1), from_p0(p2))
}

/// Equations (103) and (104): the point with coordinates `u` and `v` along the edges, `P = u u + v v + P0`.
#[cfg(test)]
pub(crate) fn point<F: Field>(u: F, v: F, edges: (Vec2<F>, Vec2<F>), p0: Vec2<F>) -> Vec2<F> {
    let along = |axis: usize| u.mul(edges.0[axis]).add(v.mul(edges.1[axis])).add(p0[axis]);
    [along(0), along(1)]
}

/// A triangle prepared for equation (105).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<F> {
    /// `P0`
    pub(crate) origin: Vec2<F>,
    /// `u`
    pub(crate) u: Vec2<F>,
    /// `v`
    pub(crate) v: Vec2<F>,
    /// `x_u y_v - x_v y_u`: twice the area, signed.
    pub(crate) determinant: F,
}

impl<F: Field> Frame<F> {
    /// The frame of a triangle.
    pub(crate) fn new(p0: Vec2<F>, p1: Vec2<F>, p2: Vec2<F>) -> Self {
        let (u, v) = edges(p0, p1, p2);
        let determinant = u[0].mul(v[1]).sub(v[0].mul(u[1]));
        Self { origin: p0, u, v, determinant }
    }

    /// The same frame in other numbers.
    #[inline(always)]
    pub(crate) fn map<G>(&self, f: impl Fn(F) -> G + Copy) -> Frame<G> {
        let [origin, u, v] = [self.origin, self.u, self.v].map(|vector| vector.map(f));
        Frame { origin, u, v, determinant: f(self.determinant) }
    }

    /// Equation (105): the coordinates of a point along the edges.
    ///
    /// Undefined (infinite or NaN) for a triangle without area.
    #[inline(always)]
    pub(crate) fn coordinates(&self, p: Vec2<F>) -> (F, F) {
        let x = p[0].sub(self.origin[0]);
        let y = p[1].sub(self.origin[1]);
        let u = x.mul(self.v[1]).sub(y.mul(self.v[0])).div(self.determinant);
        let v = y.mul(self.u[0]).sub(x.mul(self.u[1])).div(self.determinant);
        (u, v)
    }
}

/// The weights of the vertices in (106) and (108): `1 - u - v`, `u`, `v`.
#[inline(always)]
pub(crate) fn weights<F: Field>(u: F, v: F) -> [F; 3] {
    [F::constant(1.0).sub(u).sub(v), u, v]
}

/// Equation (106), in its first form: `C = C0 + u (C1 - C0) + v (C2 - C0)`. It is linear in window space, for
/// `noperspective` and depth. A value that is equal at all vertices is returned exactly, as drivers do: programs
/// compare such values for equality.
#[inline(always)]
pub(crate) fn linear<F: Field>(weights: [F; 3], c: [F; 3]) -> F {
    c[0].add(weights[1].mul(c[1].sub(c[0]))).add(weights[2].mul(c[2].sub(c[0])))
}

/// Equation (107): the value at `t` of the projection of a segment, from the values `a` and `b` and the depths `za`
/// and `zb` of its ends. (3.6) is the same equation with `w` as the depth.
#[cfg(test)]
pub(crate) fn unproject<F: Field>(t: F, a: F, za: F, b: F, zb: F) -> (F, F) {
    let rest = F::constant(1.0).sub(t);
    let one = F::constant(1.0);
    let depth = one.div(one.div(za).mul(rest).add(one.div(zb).mul(t)));
    let value = a.div(za).mul(rest).add(b.div(zb).mul(t)).mul(depth);
    (value, depth)
}

/// Equation (108), second line: `w = 1 / ((1 - u - v) / w0 + u / w1 + v / w2)`, from the reciprocals of the `w`.
#[inline(always)]
pub(crate) fn perspective_w<F: Field>(weights: [F; 3], reciprocals: [F; 3]) -> F {
    F::constant(1.0).div(linear(weights, reciprocals))
}

/// Equation (108), first line: `C = w ((1 - u - v) C0 / w0 + u C1 / w1 + v C2 / w2)`, from `w` and the quotients.
#[inline(always)]
pub(crate) fn perspective<F: Field>(weights: [F; 3], w: F, quotients: [F; 3]) -> F {
    linear(weights, quotients).mul(w)
}

/// Equation (3.5) of OpenGL 3.2: how far along the segment from `a` to `b` a fragment is, by projection onto it.
#[inline(always)]
pub(crate) fn along<F: Field>(p: Vec2<F>, a: Vec2<F>, b: Vec2<F>) -> F {
    let (dx, dy) = (b[0].sub(a[0]), b[1].sub(a[1]));
    let dot = p[0].sub(a[0]).mul(dx).add(p[1].sub(a[1]).mul(dy));
    dot.div(dx.mul(dx).add(dy.mul(dy)))
}

#[cfg(test)]
mod tests;
