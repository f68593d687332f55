//! Lines one pixel wide, by both rules.
//!
//! [`diamond_exit`] is OpenGL's rule (OpenGL 3.2 §3.5.1), decided exactly, including the perturbation of the end
//! points. [`rectangle`] is Vulkan's rule for strict lines: the pixels of a rectangle one pixel wide around the
//! segment, whose corners are snapped as by Mesa's software drivers.

use super::{Edge, Fixed, ONE, Shape, triangle};
use std::cmp::Ordering;

/// The pixels of the rectangle around a segment, from window positions in f32; `None` if it has no length or is not
/// finite.
pub(crate) fn rectangle(from: [f32; 2], to: [f32; 2]) -> Option<Shape> {
    let (dx, dy) = (from[0] - to[0], from[1] - to[1]);
    let squared = dx * dx + dy * dy;
    if squared == 0.0 || !squared.is_finite() {
        return None;
    }
    let scale = 0.5 / squared.sqrt();
    let snap = |value: f32| (value * ONE as f32).round() as i64;
    let (side_x, side_y) = (snap(-dy * scale), snap(dx * scale));
    let place = |p: [f32; 2]| Fixed { x: snap(p[0] - 0.5), y: snap(p[1] - 0.5) };
    let shifted = |p: Fixed, sign: i64| Fixed { x: p.x + sign * side_x, y: p.y + sign * side_y };
    let (from, to) = (place(from), place(to));
    let mut corners = [shifted(from, 1), shifted(to, 1), shifted(to, -1), shifted(from, -1)];
    if triangle::doubled_area([corners[0], corners[1], corners[2]]) < 0 {
        corners.reverse();
    }
    let [a, b, c, d] = corners;
    Some(triangle::convex(&corners, &[Edge::new(a, b), Edge::new(b, c), Edge::new(c, d), Edge::new(d, a)]))
}

/// A number `c + a e + b e^2` with an arbitrarily small `e`, compared lexicographically.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Perturbed(i128, i128, i128);

impl Perturbed {
    fn scaled(self, by: i128) -> Self {
        Self(self.0 * by, self.1 * by, self.2 * by)
    }

    fn minus(self, other: i128) -> Self {
        Self(self.0 - other, self.1, self.2)
    }

    fn negated(self) -> Self {
        self.scaled(-1)
    }
}

/// A point in the coordinates `x + y` and `x - y`, in which a diamond is a square.
#[derive(Clone, Copy)]
struct Turned {
    sum: Perturbed,
    difference: Perturbed,
}

impl Turned {
    /// The perturbed end point: OpenGL moves it by `(-e, -e^2)`; here, y points down.
    fn new(p: Fixed) -> Self {
        let (x, y) = (i128::from(p.x), i128::from(p.y));
        Self { sum: Perturbed(x + y, -1, 1), difference: Perturbed(x - y, -1, -1) }
    }
}

/// Half the width of a diamond in the rotated coordinates.
const HALF: i128 = ONE as i128 / 2;

/// The fragments of a segment from `from` to `to`: those whose diamond it intersects, except one that contains its
/// end.
pub(crate) fn diamond_exit(from: Fixed, to: Fixed) -> Shape {
    let mut pixels = Vec::new();
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let is_x_major = dx.abs() >= dy.abs();
    let (start, end, delta) = if is_x_major { (from.x, to.x, dx) } else { (from.y, to.y, dy) };
    let (low, high) = (start.min(end).div_euclid(ONE) - 1, start.max(end).div_euclid(ONE) + 1);
    for major in low..=high {
        // The minor coordinate at the center of this column, or at the nearer end of the segment.
        let at = (major * ONE).clamp(start.min(end), start.max(end));
        let minor = match (delta, is_x_major) {
            (0, true) => from.y,
            (0, false) => from.x,
            (_, true) => from.y + dy * (at - start) / delta,
            (_, false) => from.x + dx * (at - start) / delta,
        };
        let nearest = (minor + ONE / 2).div_euclid(ONE);
        for offset in -1..=1 {
            let (x, y) = if is_x_major { (major, nearest + offset) } else { (nearest + offset, major) };
            if produces(Turned::new(from), Turned::new(to), x, y) {
                pixels.push((x, y));
            }
        }
    }
    if start > end {
        pixels.reverse();
    }
    Shape::Pixels(pixels)
}

/// Whether the segment intersects the open diamond around a pixel's center and does not end in it.
fn produces(from: Turned, to: Turned, x: i64, y: i64) -> bool {
    let (x, y) = (i128::from(x * ONE), i128::from(y * ONE));
    let axes = [(from.sum, to.sum, x + y), (from.difference, to.difference, x - y)];
    let ends_inside = axes.iter().all(|(_, end, center)| is_inside(*end, *center));
    !ends_inside && meets(axes)
}

fn is_inside(value: Perturbed, center: i128) -> bool {
    let offset = value.minus(center);
    offset < Perturbed(HALF, 0, 0) && offset > Perturbed(-HALF, 0, 0)
}

/// A bound on the part of the segment inside the diamond: a fraction with a positive denominator.
#[derive(Clone, Copy)]
struct Along(Perturbed, i128);

impl Along {
    fn cmp(self, other: Self) -> Ordering {
        self.0.scaled(other.1).cmp(&other.0.scaled(self.1))
    }
}

fn meets(axes: [(Perturbed, Perturbed, i128); 2]) -> bool {
    // The segment is closed, 0 <= t <= 1; the diamond is open.
    let mut lower = vec![Along(Perturbed(0, 0, 0), 1)];
    let mut upper = vec![Along(Perturbed(1, 0, 0), 1)];
    for (from, to, center) in axes {
        let delta = to.0 - from.0;
        if delta == 0 {
            if !is_inside(from, center) {
                return false;
            }
            continue;
        }
        let to_low = from.minus(center - HALF).negated();
        let to_high = from.minus(center + HALF).negated();
        let (enter, leave) = if delta > 0 { (to_low, to_high) } else { (to_high.negated(), to_low.negated()) };
        lower.push(Along(enter, delta.abs()));
        upper.push(Along(leave, delta.abs()));
    }
    lower.iter().all(|low| upper.iter().all(|high| low.cmp(*high) == Ordering::Less))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fixed(x: f32, y: f32) -> Fixed {
        Fixed::snap(x, y).expect("finite")
    }

    fn pixels(shape: &Shape) -> Vec<(i64, i64)> {
        match shape {
            Shape::Pixels(pixels) => pixels.clone(),
            Shape::Convex { .. } => Vec::new(),
        }
    }

    #[test]
    fn from_center_to_center_is_bresenham_without_the_last() {
        let line = pixels(&diamond_exit(fixed(1.5, 2.5), fixed(6.5, 2.5)));
        assert_eq!(line, [(1, 2), (2, 2), (3, 2), (4, 2), (5, 2)]);
        let back = pixels(&diamond_exit(fixed(6.5, 2.5), fixed(1.5, 2.5)));
        assert_eq!(back, [(6, 2), (5, 2), (4, 2), (3, 2), (2, 2)]);
        let steep = pixels(&diamond_exit(fixed(1.5, 1.5), fixed(2.5, 5.5)));
        assert_eq!(steep.len(), 4);
    }

    #[test]
    fn a_segment_within_a_diamond_produces_nothing() {
        assert!(pixels(&diamond_exit(fixed(3.4, 3.5), fixed(3.6, 3.5))).is_empty());
        assert!(pixels(&diamond_exit(fixed(3.5, 3.5), fixed(3.5, 3.5))).is_empty());
    }

    /// The rule as written, with an `e` that is small enough for coordinates of 1/256.
    fn transcribed(from: Fixed, to: Fixed) -> Vec<(i64, i64)> {
        let e = 1e-5;
        let moved = |p: Fixed| (p.x as f64 / 256.0 - e, p.y as f64 / 256.0 + e * e);
        let (a, b) = (moved(from), moved(to));
        let within = |p: (f64, f64), x: i64, y: i64| (p.0 - x as f64).abs() + (p.1 - y as f64).abs() < 0.5;
        let mut found = Vec::new();
        for y in -1..18 {
            for x in -1..18 {
                // The distance to the center, in the diamond's norm, is convex along the segment: search for its
                // minimum.
                let norm = |t: f64| {
                    let (px, py) = (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
                    (px - x as f64).abs() + (py - y as f64).abs()
                };
                let mut candidates = vec![0.0, 1.0];
                if b.0 != a.0 {
                    candidates.push(((x as f64 - a.0) / (b.0 - a.0)).clamp(0.0, 1.0));
                }
                if b.1 != a.1 {
                    candidates.push(((y as f64 - a.1) / (b.1 - a.1)).clamp(0.0, 1.0));
                }
                let least = candidates.into_iter().map(norm).fold(f64::INFINITY, f64::min);
                if least < 0.5 && !within(b, x, y) {
                    found.push((x, y));
                }
            }
        }
        found
    }

    #[test]
    fn the_exact_rule_agrees_with_its_transcription() {
        let mut state = 11_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % 4096) as i64
        };
        for round in 0..400 {
            // Every other line runs between centers and half centers, where the perturbation decides.
            let grid = if round % 2 == 0 { 1 } else { 128 };
            let mut point = || Fixed { x: next() / grid * grid, y: next() / grid * grid };
            let (from, to) = (point(), point());
            let mut exact = pixels(&diamond_exit(from, to));
            exact.sort_by_key(|&(x, y)| (y, x));
            assert_eq!(exact, transcribed(from, to), "{from:?} {to:?}");
        }
    }

    #[test]
    fn a_chain_of_segments_draws_each_pixel_once() {
        let points: Vec<Fixed> = (0..9).map(|i| fixed(1.3 + 1.7 * i as f32, 2.2 + 0.9 * i as f32)).collect();
        let mut all: Vec<(i64, i64)> =
            points.windows(2).flat_map(|pair| pixels(&diamond_exit(pair[0], pair[1]))).collect();
        let length = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), length);
    }

    #[test]
    fn the_rectangle_is_one_pixel_wide() {
        let shape = rectangle([2.0, 4.5], [10.0, 4.5]).expect("it has length");
        let mut covered = Vec::new();
        let area = super::super::Bounds { x0: 0, x1: 16, y0: 0, y1: 16 };
        shape.quads(area, |x, y, bits| {
            for bit in 0..4_i64 {
                if bits >> bit & 1 == 1 {
                    covered.push((x + (bit & 1), y + (bit >> 1)));
                }
            }
        });
        covered.sort_unstable();
        assert_eq!(covered, (2..10).map(|x| (x, 4)).collect::<Vec<_>>());
        assert_eq!(rectangle([1.0, 1.0], [1.0, 1.0]), None);
    }
}
