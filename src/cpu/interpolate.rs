//! Interpolation of what vertices carry, by the equations (102) to (108) of the first source document and (3.5) to (3.7)
//! of OpenGL 3.2 §3.5.1, over every [`Number`].
//!
//! *In:* places in the window, values of vertices. *Out:* the value at a fragment.
//!
//! *Holds:* nothing panics. Where the equations are undefined the results are IEEE's, infinite or NaN: a triangle without
//! area (`x_u y_v - x_v y_u = 0`, which produces no fragments) and `w = 0` (which clipping removes).
//! The names are those of the document: `P` is the fragment, `P0`, `P1`, `P2` the vertices, `u` and `v` the edges from
//! `P0` and the coordinates along them, `C0`, `C1`, `C2` the values of the vertices.

use super::domain::Number;

/// A point or vector in the window, in pixels.
pub(crate) type Vec2<F> = [F; 2];

/// Equation (102): the edges of a triangle from its first vertex, `u = P1 - P0` and `v = P2 - P0`.
pub(crate) fn edges<F: Number>(p0: Vec2<F>, p1: Vec2<F>, p2: Vec2<F>) -> (Vec2<F>, Vec2<F>) {
    let from_p0 = |p: Vec2<F>| [p[0].sub(p0[0]), p[1].sub(p0[1])];
    (from_p0(p1), from_p0(p2))
}

/// Equations (103) and (104): the point with coordinates `u` and `v` along the edges, `P = u u + v v + P0`.
#[cfg(test)]
pub(crate) fn point<F: Number>(u: F, v: F, edges: (Vec2<F>, Vec2<F>), p0: Vec2<F>) -> Vec2<F> {
    let along = |axis: usize| u.mul(edges.0[axis]).add(v.mul(edges.1[axis])).add(p0[axis]);
    [along(0), along(1)]
}

/// A triangle ready for equation (105).
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

impl<F: Number> Frame<F> {
    /// The frame of a triangle.
    pub(crate) fn new(p0: Vec2<F>, p1: Vec2<F>, p2: Vec2<F>) -> Self {
        let (u, v) = edges(p0, p1, p2);
        let determinant = u[0].mul(v[1]).sub(v[0].mul(u[1]));
        Self { origin: p0, u, v, determinant }
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
pub(crate) fn weights<F: Number>(u: F, v: F) -> [F; 3] {
    [F::from_f64(1.0).sub(u).sub(v), u, v]
}

/// Equation (106), in its first form: `C = C0 + u (C1 - C0) + v (C2 - C0)`. Linear in the window: `noperspective`, depth.
/// What is the same at all vertices comes back exactly, as drivers have it: programs compare such values for equality.
#[inline(always)]
pub(crate) fn linear<F: Number>(weights: [F; 3], c: [F; 3]) -> F {
    c[0].add(weights[1].mul(c[1].sub(c[0]))).add(weights[2].mul(c[2].sub(c[0])))
}

/// Equation (107): what stands at `t` of the projection of a segment, from the values `a` and `b` and the depths `za` and
/// `zb` of its ends. (3.6) is the same with `w` for the depth.
#[cfg(test)]
pub(crate) fn unproject<F: Number>(t: F, a: F, za: F, b: F, zb: F) -> (F, F) {
    let rest = F::from_f64(1.0).sub(t);
    let one = F::from_f64(1.0);
    let depth = one.div(one.div(za).mul(rest).add(one.div(zb).mul(t)));
    let value = a.div(za).mul(rest).add(b.div(zb).mul(t)).mul(depth);
    (value, depth)
}

/// Equation (108), its second line: `w = 1 / ((1 - u - v) / w0 + u / w1 + v / w2)`, from the reciprocals of the `w`.
#[inline(always)]
pub(crate) fn perspective_w<F: Number>(weights: [F; 3], reciprocals: [F; 3]) -> F {
    F::from_f64(1.0).div(linear(weights, reciprocals))
}

/// Equation (108), its first line: `C = w ((1 - u - v) C0 / w0 + u C1 / w1 + v C2 / w2)`, from `w` and the quotients.
#[inline(always)]
pub(crate) fn perspective<F: Number>(weights: [F; 3], w: F, quotients: [F; 3]) -> F {
    linear(weights, quotients).mul(w)
}

/// Equation (3.5) of OpenGL 3.2: how far along the segment from `a` to `b` a fragment lies, by projection onto it.
#[inline(always)]
pub(crate) fn along<F: Number>(p: Vec2<F>, a: Vec2<F>, b: Vec2<F>) -> F {
    let (dx, dy) = (b[0].sub(a[0]), b[1].sub(a[1]));
    let dot = p[0].sub(a[0]).mul(dx).add(p[1].sub(a[1]).mul(dy));
    dot.div(dx.mul(dx).add(dy.mul(dy)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact fractions of integers, as a second opinion.
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Ratio {
        n: i128,
        d: i128,
    }

    fn gcd(a: i128, b: i128) -> i128 {
        if b == 0 { a.abs().max(1) } else { gcd(b, a % b) }
    }

    impl Ratio {
        fn new(n: i128, d: i128) -> Self {
            let g = gcd(n, d) * if d < 0 { -1 } else { 1 };
            Self { n: n / g, d: d / g }
        }
        fn int(n: i128) -> Self {
            Self::new(n, 1)
        }
        fn add(self, o: Self) -> Self {
            Self::new(self.n * o.d + o.n * self.d, self.d * o.d)
        }
        fn sub(self, o: Self) -> Self {
            Self::new(self.n * o.d - o.n * self.d, self.d * o.d)
        }
        fn mul(self, o: Self) -> Self {
            Self::new(self.n * o.n, self.d * o.d)
        }
        fn div(self, o: Self) -> Self {
            Self::new(self.n * o.d, self.d * o.n)
        }
        fn value(self) -> f64 {
            self.n as f64 / self.d as f64
        }
    }

    /// A small generator of integers, the same ones every run.
    fn numbers(seed: u64) -> impl FnMut(i64, i64) -> i64 {
        let mut state = seed;
        move |low, high| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + ((state >> 33) as i64).rem_euclid(high - low + 1)
        }
    }

    /// `C` of (108) in exact arithmetic; coordinates are in 1/256 pixel.
    fn exact(p: [i64; 2], corners: [[i64; 2]; 3], c: [i64; 3], w: [i64; 3]) -> Ratio {
        let r = |n: i64| Ratio::int(i128::from(n));
        let sub = |a: [i64; 2], b: [i64; 2]| [r(a[0] - b[0]), r(a[1] - b[1])];
        let (u, v, d) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]), sub(p, corners[0]));
        let det = u[0].mul(v[1]).sub(v[0].mul(u[1]));
        let s = d[0].mul(v[1]).sub(d[1].mul(v[0])).div(det);
        let t = d[1].mul(u[0]).sub(d[0].mul(u[1])).div(det);
        let b = [r(1).sub(s).sub(t), s, t];
        let quotient = |i: usize| b[i].mul(r(c[i])).div(r(w[i]));
        let reciprocal = |i: usize| b[i].div(r(w[i]));
        let top = quotient(0).add(quotient(1)).add(quotient(2));
        top.div(reciprocal(0).add(reciprocal(1)).add(reciprocal(2)))
    }

    fn computed<F: Number>(p: [i64; 2], corners: [[i64; 2]; 3], c: [i64; 3], w: [i64; 3]) -> f64 {
        let place = |p: [i64; 2]| p.map(|n| F::from_f64(n as f64 / 256.0));
        let frame = Frame::new(place(corners[0]), place(corners[1]), place(corners[2]));
        let (u, v) = frame.coordinates(place(p));
        let weights = weights(u, v);
        let reciprocals = w.map(|w| F::from_f64(1.0).div(F::from_f64(w as f64)));
        let quotients = std::array::from_fn(|i| F::from_f64(c[i] as f64).mul(reciprocals[i]));
        perspective(weights, perspective_w(weights, reciprocals), quotients).value()
    }

    /// A point inside, from integer weights.
    fn inside(corners: [[i64; 2]; 3], k: [i64; 3]) -> [i64; 2] {
        let sum = k[0] + k[1] + k[2];
        [0, 1].map(|axis| (0..3).map(|i| corners[i][axis] * k[i]).sum::<i64>() / sum)
    }

    #[test]
    fn equation_108_agrees_with_rational_arithmetic() {
        let mut next = numbers(1);
        let (mut worst64, mut worst32) = (0.0_f64, 0.0_f64);
        for _ in 0..500 {
            let corners = [(); 3].map(|()| [next(0, 65536), next(0, 65536)]);
            let c = [(); 3].map(|()| next(-100, 100));
            let w = [(); 3].map(|()| next(1, 10));
            let area = (corners[1][0] - corners[0][0]) * (corners[2][1] - corners[0][1])
                - (corners[2][0] - corners[0][0]) * (corners[1][1] - corners[0][1]);
            if area.abs() < 1 << 22 {
                continue;
            }
            let p = inside(corners, [next(1, 9), next(1, 9), next(1, 9)]);
            let truth = exact(p, corners, c, w).value();
            worst64 = worst64.max((computed::<f64>(p, corners, c, w) - truth).abs());
            worst32 = worst32.max((computed::<f32>(p, corners, c, w) - truth).abs());
        }
        assert!(worst64 < 1e-11, "{worst64}");
        assert!(worst32 < 1e-2 && worst32 > 1e-6, "{worst32}");
    }

    #[test]
    fn coordinates_give_the_point_back() {
        let corners = [[3.0, 4.0], [40.0, 7.0], [11.0, 90.0]];
        let frame = Frame::new(corners[0], corners[1], corners[2]);
        let (u, v) = frame.coordinates([20.5, 30.5]);
        let back = point(u, v, (frame.u, frame.v), frame.origin);
        assert!((back[0] - 20.5_f64).abs() < 1e-13 && (back[1] - 30.5_f64).abs() < 1e-13);
    }

    #[test]
    fn slivers_stay_accurate_in_f64_until_they_have_no_area() {
        // From one pixel to 1/256 pixel wide: the error grows with the condition, not past it.
        for width in [256, 16, 4, 1] {
            let corners = [[0, 0], [65536, 0], [0, width]];
            let truth = exact([256, 0], corners, [0, 1, 2], [1, 1, 1]).value();
            let error = (computed::<f64>([256, 0], corners, [0, 1, 2], [1, 1, 1]) - truth).abs();
            assert!(error < 1e-15, "{width}: {error}");
        }
        let flat = [[0, 0], [512, 512], [1024, 1024]];
        assert!(!computed::<f64>([256, 256], flat, [0, 1, 2], [1, 1, 1]).is_finite());
    }

    #[test]
    fn small_and_large_w_are_carried() {
        let corners = [[0, 0], [65536, 0], [0, 65536]];
        for w in [[1, 1, 1_000_000], [1, 1_000_000_000, 1], [1_000_000, 1_000_000, 1_000_000]] {
            let truth = exact([16384, 16384], corners, [0, 1, 2], w).value();
            let error = (computed::<f64>([16384, 16384], corners, [0, 1, 2], w) - truth).abs();
            assert!(error < 1e-14, "{w:?}: {error}");
        }
        // w = 0: one over nothing; no finite value is invented.
        let value = computed::<f64>([16384, 16384], corners, [0, 1, 2], [0, 1, 1]);
        assert!(value.is_nan());
    }

    #[test]
    fn equation_107_is_108_along_an_edge() {
        let (a, za, b, zb) = (3.0_f64, 2.0, 5.0, 8.0);
        for t in [0.0, 0.25, 0.5, 1.0] {
            let (value, depth) = unproject(t, a, za, b, zb);
            let weights = weights(t, 0.0);
            let w = perspective_w(weights, [1.0 / za, 1.0 / zb, 1.0]);
            assert!((w - depth).abs() < 1e-15);
            assert!((perspective(weights, w, [a / za, b / zb, 0.0]) - value).abs() < 1e-15);
        }
    }

    #[test]
    fn equation_106_is_108_with_equal_w() {
        let weights = weights(0.25_f64, 0.5);
        assert_eq!(linear(weights, [1.0, 3.0, 9.0]), 0.25 + 0.75 + 4.5);
        let w = perspective_w(weights, [0.5; 3]);
        assert_eq!(perspective(weights, w, [0.5, 1.5, 4.5]), 5.5);
    }

    #[test]
    fn a_fragment_beside_a_segment_counts_by_its_projection() {
        assert_eq!(along([2.0_f64, 5.0], [0.0, 0.0], [8.0, 0.0]), 0.25);
        assert!(along([2.0_f64, 5.0], [1.0, 1.0], [1.0, 1.0]).is_nan());
    }
}
