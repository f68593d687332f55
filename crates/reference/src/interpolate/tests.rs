//! Tests equations (102) to (108) against fractions of integers.
//!
//! Each bound is a number of roundings of the equation's terms. In slivers and at small `w`, the condition number of
//! the problem grows; the tests separate it from the error of the result.

use super::*;
use crate::domain::Number;

/// Random numbers from a seed, the same in every run.
fn numbers(seed: u64) -> impl FnMut(i64, i64) -> i64 {
    let mut state = seed;
    move |low, high| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + ((state >> 33) as i64).rem_euclid(high - low + 1)
    }
}

/// A fraction; its conversion to f64 has at most two roundings.
#[derive(Clone, Copy, Debug)]
struct Ratio {
    n: i128,
    d: i128,
}

impl Ratio {
    fn value(self) -> f64 {
        self.n as f64 / self.d as f64
    }
}

/// Positions are in units of 2^-16 pixel, finer than any grid to which a rasterizer snaps.
const UNIT: f64 = 65536.0;

type Point = [i64; 2];

fn pixels<F: Number>(p: Point) -> Vec2<F> {
    p.map(|n| F::from_f64(n as f64 / UNIT))
}

/// `x_a y_b - x_b y_a`
fn cross(a: Point, b: Point) -> i128 {
    i128::from(a[0]) * i128::from(b[1]) - i128::from(b[0]) * i128::from(a[1])
}

/// The sum of the absolute values instead: the rounding of the products and the difference is proportional to it.
fn size(a: Point, b: Point) -> f64 {
    (a[0] as f64 * b[1] as f64).abs() + (b[0] as f64 * a[1] as f64).abs()
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// A triangle and a point in it.
struct Case {
    corners: [Point; 3],
    p: Point,
}

impl Case {
    /// From half the window to less than a thousandth of a pixel across, never without area; `width` is in units.
    fn random(next: &mut impl FnMut(i64, i64) -> i64, width: i64) -> Option<Self> {
        let mut corner = || [next(0, 1 << 25), next(0, 1 << 25)];
        let (a, b) = (corner(), corner());
        let along = next(0, 64);
        // Off the line from a to b.
        let c = [0, 1].map(|axis| a[axis] + (b[axis] - a[axis]) * along / 64 + next(-width, width));
        let k = [next(1, 9), next(1, 9), next(1, 9)];
        let corners = [a, b, c];
        let p = [0, 1].map(|axis| (0..3).map(|i| corners[i][axis] * k[i]).sum::<i64>() / k.iter().sum::<i64>());
        let case = Self { corners, p };
        (case.determinant() != 0).then_some(case)
    }

    fn edges(&self) -> (Point, Point) {
        (minus(self.corners[1], self.corners[0]), minus(self.corners[2], self.corners[0]))
    }

    fn determinant(&self) -> i128 {
        let (u, v) = self.edges();
        cross(u, v)
    }

    /// The numerators of `1 - u - v`, `u` and `v` of (105), over the determinant.
    fn weights(&self) -> [i128; 3] {
        let ((u, v), x) = (self.edges(), minus(self.p, self.corners[0]));
        let (first, second) = (cross(x, v), cross(u, x));
        [self.determinant() - first - second, first, second]
    }

    /// How far each coordinate of (105) may be off by a few roundings of its numerator and of the determinant.
    fn slack(&self, rounding: f64) -> [f64; 2] {
        let ((u, v), x) = (self.edges(), minus(self.p, self.corners[0]));
        let determinant = (self.determinant() as f64).abs();
        let [_, first, second] = self.weights().map(|n| (n as f64 / determinant).abs());
        // A position in single precision is rounded, too: by half a unit in the last place of its coordinate.
        let places = 2.0 * rounding * 33_554_432.0;
        let lost = |a: Point, b: Point| {
            4.0 * rounding * size(a, b) + places * (a[0].abs() + a[1].abs() + b[0].abs() + b[1].abs()) as f64
        };
        let area = lost(u, v) / determinant;
        if area > 0.25 {
            // The determinant has no correct digits.
            return [f64::INFINITY; 2];
        }
        [(first, lost(x, v)), (second, lost(u, x))]
            .map(|(weight, numerator)| numerator / determinant + weight * area * 2.0 + 2.0 * rounding * weight)
    }

    fn coordinates<F: Number>(&self) -> (f64, f64) {
        let frame = Frame::<F>::new(pixels(self.corners[0]), pixels(self.corners[1]), pixels(self.corners[2]));
        let (u, v) = frame.coordinates(pixels(self.p));
        (u.value(), v.value())
    }
}

/// Widths of triangles, in units.
const WIDTHS: [i64; 5] = [1 << 24, 1 << 16, 1 << 10, 64, 2];

#[test]
fn equation_102_is_exact_on_the_grid() {
    let mut next = numbers(102);
    for _ in 0..500 {
        let case = Case::random(&mut next, 1 << 20).unwrap_or(Case { corners: [[0, 0], [1, 0], [0, 1]], p: [0, 0] });
        let (u, v) = edges::<f64>(pixels(case.corners[0]), pixels(case.corners[1]), pixels(case.corners[2]));
        let (exact_u, exact_v) = case.edges();
        assert_eq!((u, v), (pixels(exact_u), pixels(exact_v)));
    }
}

#[test]
fn equations_103_and_104_give_the_point_back() {
    let mut next = numbers(104);
    for width in WIDTHS {
        for case in (0..200).filter_map(|_| Case::random(&mut next, width)) {
            let (u, v) = case.coordinates::<f64>();
            let frame = Frame::new(pixels(case.corners[0]), pixels(case.corners[1]), pixels(case.corners[2]));
            let back = point(u, v, (frame.u, frame.v), frame.origin);
            let [off_u, off_v] = case.slack(f64::EPSILON / 2.0);
            for (axis, back) in back.into_iter().enumerate() {
                let off = off_u * frame.u[axis].abs() + off_v * frame.v[axis].abs() + 8.0 * f64::EPSILON * 512.0;
                let found = (back - case.p[axis] as f64 / UNIT).abs();
                assert!(found <= off, "{width}: {found} over {off}");
            }
        }
    }
}

/// The largest error of (105), absolute and relative to what its roundings allow.
fn worst_105<F: Number>(width: i64, rounding: f64) -> (f64, f64) {
    let mut next = numbers(105);
    let mut worst = (0.0_f64, 0.0_f64);
    for case in (0..400).filter_map(|_| Case::random(&mut next, width)) {
        let [_, u, v] = case.weights().map(|n| Ratio { n, d: case.determinant() }.value());
        let (found_u, found_v) = case.coordinates::<F>();
        for ((found, exact), slack) in [(found_u, u), (found_v, v)].into_iter().zip(case.slack(rounding)) {
            // A determinant that rounds to 0 has no finite result; its slack is infinite.
            let error = if found.is_finite() { (found - exact).abs() } else { f64::MAX };
            worst = (worst.0.max(error), worst.1.max(if slack.is_finite() { error / slack } else { 0.0 }));
        }
    }
    worst
}

#[test]
fn equation_105_loses_no_more_than_its_roundings_down_to_slivers() {
    for width in WIDTHS {
        let (error, share) = worst_105::<f64>(width, f64::EPSILON / 2.0);
        assert!(share <= 1.0, "f64, {width}: {error}, {share} of what is allowed");
        // On this grid the products are exact in f64, so only the division rounds, even in the thinnest sliver.
        assert!(error <= 4.0 * f64::EPSILON, "f64, {width}: {error}");
        let (error, share) = worst_105::<f32>(width, f64::from(f32::EPSILON) / 2.0);
        assert!(share <= 1.0, "f32, {width}: {error}, {share} of what is allowed");
    }
}

#[test]
fn a_triangle_without_area_has_no_coordinates() {
    for corners in [[[0, 0], [512, 512], [1024, 1024]], [[7, 9], [7, 9], [40, 3]], [[1, 1], [1, 1], [1, 1]]] {
        let (u, v) = Case { corners, p: [256, 300] }.coordinates::<f64>();
        assert!(!u.is_finite() && !v.is_finite(), "{corners:?}: {u}, {v}");
        let (u, v) = Case { corners, p: [256, 300] }.coordinates::<f32>();
        assert!(!u.is_finite() && !v.is_finite(), "{corners:?}: {u}, {v}");
    }
}

/// A `w` as an integer times a power of two.
#[derive(Clone, Copy, Debug)]
struct Depth {
    factor: i64,
    exponent: i32,
}

impl Depth {
    fn value(self) -> f64 {
        self.factor as f64 * 2.0_f64.powi(self.exponent)
    }
}

/// `w` and `C` of (108), or of (106) if all `w` are 1, and the sum of the absolute values of the terms of `C`.
fn exact_108(case: &Case, c: [i64; 3], w: [Depth; 3]) -> (f64, f64, f64) {
    let most = w.iter().map(|w| w.exponent).max().unwrap_or(0);
    // Times all factors and 2^most, so that everything is an integer.
    let factors: i128 = w.iter().map(|w| i128::from(w.factor)).product();
    let reciprocal = |i: usize| (factors / i128::from(w[i].factor)) << (most - w[i].exponent);
    let b = case.weights();
    let sign = case.determinant().signum();
    let below: i128 = (0..3).map(|i| b[i] * reciprocal(i)).sum();
    let above: i128 = (0..3).map(|i| b[i] * reciprocal(i) * i128::from(c[i])).sum();
    let terms: i128 = (0..3).map(|i| b[i].abs() * reciprocal(i) * i128::from(c[i].abs())).sum();
    let depth = Ratio { n: case.determinant() * sign, d: below * sign }.value() * factors as f64 * 2.0_f64.powi(most);
    (depth, Ratio { n: above, d: below }.value(), Ratio { n: terms, d: below * sign }.value())
}

/// (105) to (108), combined as in the rasterizer: `w` and `C`.
fn computed<F: Number>(case: &Case, c: [i64; 3], w: [f64; 3]) -> (f64, f64) {
    let frame = Frame::<F>::new(pixels(case.corners[0]), pixels(case.corners[1]), pixels(case.corners[2]));
    let (u, v) = frame.coordinates(pixels(case.p));
    let weights = weights(u, v);
    let reciprocals = w.map(|w| F::from_f64(1.0).div(F::from_f64(w)));
    let quotients = std::array::from_fn(|i| F::from_f64(c[i] as f64).mul(reciprocals[i]));
    let depth = perspective_w(weights, reciprocals);
    (depth.value(), perspective(weights, depth, quotients).value())
}

#[test]
fn equation_106_is_exact_but_for_its_roundings() {
    let mut next = numbers(106);
    let one = [Depth { factor: 1, exponent: 0 }; 3];
    for case in WIDTHS
        .into_iter()
        .flat_map(|width| (0..200).map(move |_| width))
        .filter_map(|width| Case::random(&mut next, width))
        .collect::<Vec<_>>()
    {
        let c = [(); 3].map(|()| next(-1000, 1000));
        let (_, exact, _) = exact_108(&case, c, one);
        let (u, v) = case.coordinates::<f64>();
        let found = linear(weights(u, v), c.map(|c| c as f64));
        let rise = |i: usize| (c[i] - c[0]).abs() as f64;
        let terms = c[0].abs() as f64 + u.abs() * rise(1) + v.abs() * rise(2);
        assert!((found - exact).abs() <= 4.0 * f64::EPSILON * terms, "{found} for {exact}");
        // A constant value remains exactly constant.
        assert_eq!(linear(weights(u, v), [c[0] as f64; 3]), c[0] as f64);
    }
}

#[test]
fn equation_107_is_exact_but_for_its_roundings() {
    let mut next = numbers(107);
    for _ in 0..1000 {
        let (t, a, b) = (next(0, 64), next(-1000, 1000), next(-1000, 1000));
        let (za, zb) = (next(1, 1 << 20), next(1, 1 << 20));
        let shift = next(-40, 40) as i32;
        // Multiplying both depths by a power of two changes only the depth.
        let scale = 2.0_f64.powi(shift);
        let (value, depth) = unproject(t as f64 / 64.0, a as f64, za as f64 * scale, b as f64, zb as f64 * scale);
        let below = i128::from((64 - t) * zb + t * za);
        let above = i128::from((64 - t) * zb) * i128::from(a) + i128::from(t * za) * i128::from(b);
        let terms = i128::from((64 - t) * zb) * i128::from(a.abs()) + i128::from(t * za) * i128::from(b.abs());
        let off = 8.0 * f64::EPSILON * Ratio { n: terms, d: below }.value();
        assert!((value - Ratio { n: above, d: below }.value()).abs() <= off);
        let exact = Ratio { n: 64 * i128::from(za) * i128::from(zb), d: below }.value() * scale;
        assert!((depth - exact).abs() <= 8.0 * f64::EPSILON * exact, "{depth} for {exact}");
    }
}

#[test]
fn equation_108_is_exact_but_for_its_roundings_from_large_w_to_small() {
    let mut next = numbers(108);
    for spread in [0, 4, 20, 40] {
        let mut worst = [0.0_f64; 2];
        for _ in 0..400 {
            let width = WIDTHS[next(0, 2) as usize];
            let Some(case) = Case::random(&mut next, width) else { continue };
            let c = [(); 3].map(|()| next(-100, 100));
            let w = [(); 3].map(|()| Depth { factor: next(1, 9), exponent: next(-spread, spread) as i32 / 2 });
            let (depth, exact, terms) = exact_108(&case, c, w);
            let (found_depth, found) = computed::<f64>(&case, c, w.map(Depth::value));
            // The sum consists of differences from the first vertex, which may be larger than the terms of the sum
            // itself.
            let b = case.weights().map(|n| (n as f64 / case.determinant() as f64).abs());
            let reciprocals = w.map(|w| 1.0 / w.value());
            let largest = reciprocals[0] + b[1] * reciprocals[1] + b[2] * reciprocals[2];
            let condition = largest * depth.abs();
            worst[0] = worst[0].max((found_depth / depth - 1.0).abs() / condition);
            worst[1] = worst[1].max((found - exact).abs() / ((terms + 100.0) * condition));
        }
        assert!(worst.iter().all(|worst| *worst <= 16.0 * f64::EPSILON), "2^{spread}: {worst:?}");
    }
}

#[test]
fn a_vertex_near_the_eye_draws_everything_to_itself() {
    let case = Case { corners: [[0, 0], [1 << 24, 0], [0, 1 << 24]], p: [1 << 22, 1 << 22] };
    for exponent in [-10, -20, -40, -60] {
        let near = Depth { factor: 1, exponent };
        let one = Depth { factor: 1, exponent: 0 };
        let (depth, exact, _) = exact_108(&case, [5, -7, 11], [near, one, one]);
        let (found_depth, found) = computed::<f64>(&case, [5, -7, 11], [near.value(), 1.0, 1.0]);
        assert!((found - exact).abs() <= 8.0 * f64::EPSILON * 11.0, "2^{exponent}: {found} for {exact}");
        assert!((found_depth / depth - 1.0).abs() <= 8.0 * f64::EPSILON);
        assert!((exact - 5.0).abs() <= 40.0 * 2.0_f64.powi(exponent));
    }
    // At w = 0 the equation is undefined, and no finite value is invented.
    let (_, value) = computed::<f64>(&case, [5, -7, 11], [0.0, 1.0, 1.0]);
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
