//! Points (OpenGL 3.2 §3.4.1): the pixels whose centers are inside a square.

use super::{Bounds, Edge, ONE, Shape};
use glisten_scene::picture::Interval;

/// The largest size of a point in pixels.
pub(crate) const MAX_SIZE: f32 = 255.0;

/// The pixels of a point of `size` pixels at a window position; `None` if the position is not finite.
///
/// It is snapped as by Mesa's drivers: the size to 1/256 pixel, at least one pixel; the position is rounded half away
/// from zero.
pub(crate) fn shape(x: f32, y: f32, size: f32) -> Option<Shape> {
    let size = if size.is_nan() { 1.0 } else { f64::from(size) };
    let ((x0, x1), (y0, y1)) = (reach(x, size)?, reach(y, size)?);
    Some(Shape::Convex { bounds: Bounds { x0, x1, y0, y1 }, edges: [NOWHERE; 4], count: 0 })
}

/// The pixels of [`shape`] with a band at each border that is open, as far as an envelope knows: `position` and `sizes` contain
/// what a GPU may compute.
pub(crate) fn shape_of([x, y]: [f32; 2], size: f32, position: [Interval; 2], sizes: Interval) -> Option<Shape> {
    let Shape::Convex { bounds: Bounds { x0, x1, y0, y1 }, .. } = shape(x, y, size)? else { return None };
    let sizes = match sizes.may_be_nan {
        true => [0.0, f64::INFINITY],
        false => [sizes.low, sizes.high],
    };
    let [(left, right, edges_x), (top, bottom, edges_y)] =
        [(position[0], x0, x1), (position[1], y0, y1)].map(|(at, low, high)| borders(at, sizes, [low, high]));
    let is_open = edges_x.iter().chain(&edges_y).any(|near| *near > 0);
    let edge = |offset: i64, step: i64, axis: usize, near: i64| Edge {
        // An odd number at each pixel, so that no center lies on a border.
        origin: 1 - 2 * step * offset,
        step_x: if axis == 0 { 2 * step } else { 0 },
        step_y: if axis == 1 { 2 * step } else { 0 },
        near: 2 * near,
    };
    let [near_x, near_y] = [edges_x, edges_y];
    let edges = [
        edge(x0, 1, 0, near_x[0]),
        edge(x1 - 1, -1, 0, near_x[1]),
        edge(y0, 1, 1, near_y[0]),
        edge(y1 - 1, -1, 1, near_y[1]),
    ];
    let bounds = Bounds { x0: left, x1: right, y0: top, y1: bottom };
    Some(Shape::Convex {
        bounds,
        edges: if is_open { edges } else { [NOWHERE; 4] },
        count: if is_open { 4 } else { 0 },
    })
}

const NOWHERE: Edge = Edge { origin: 0, step_x: 0, step_y: 0, near: 0 };

/// The first pixel of a point along an axis, and the one after its last.
fn reach(at: f32, size: f64) -> Option<(i64, i64)> {
    let snapped = snap(f64::from(at - 0.5))?;
    Some(around(snapped, size))
}

fn snap(value: f64) -> Option<i64> {
    let scaled = value * ONE as f64;
    (scaled.abs() < (1_u64 << 38) as f64).then(|| scaled.round() as i64)
}

/// The pixels along an axis of a point around a snapped position.
fn around(snapped: i64, size: f64) -> (i64, i64) {
    let width = snap(size.clamp(0.0, f64::from(MAX_SIZE))).unwrap_or(ONE).max(ONE);
    let low = snapped - width / 2;
    ((low + ONE - 1).div_euclid(ONE), (low + width + ONE - 1).div_euclid(ONE))
}

/// The first and the last pixel that a point may have along an axis, and by how many pixels each border may be off.
fn borders(at: Interval, [least, most]: [f64; 2], [low, high]: [i64; 2]) -> (i64, i64, [i64; 2]) {
    /// Beyond any window, in pixels.
    const FAR: f64 = (1_u64 << 24) as f64;
    let ends = match at.may_be_nan {
        true => [-FAR, FAR],
        false => [at.low, at.high].map(|end| (end - 0.5).clamp(-FAR, FAR)),
    };
    let all = ends.into_iter().flat_map(|end| [least, most].map(|size| around(snap(end).unwrap_or(0), size)));
    let mut hull = [(low, low), (high, high)];
    for (first, end) in all {
        for ((least, most), border) in hull.iter_mut().zip([first, end]) {
            (*least, *most) = ((*least).min(border), (*most).max(border));
        }
    }
    let [(first, last_first), (first_end, end)] = hull;
    (first, end, [(low - first).max(last_first - low), (high - first_end).max(end - high)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bounds(x: f32, y: f32, size: f32) -> Bounds {
        shape(x, y, size).expect("finite").bounds()
    }

    #[test]
    fn a_point_covers_the_centers_inside_its_square() {
        assert_eq!(bounds(3.5, 4.5, 1.0), Bounds { x0: 3, x1: 4, y0: 4, y1: 5 });
        assert_eq!(bounds(4.0, 4.0, 4.0), Bounds { x0: 2, x1: 6, y0: 2, y1: 6 });
        assert_eq!(bounds(4.0, 4.0, 0.0), bounds(4.0, 4.0, 1.0));
        // A center on the left edge of the square is inside, on the right edge outside.
        assert_eq!(bounds(4.0, 4.0, 1.0), Bounds { x0: 3, x1: 4, y0: 3, y1: 4 });
    }

    #[test]
    fn what_is_open_is_near_a_border() {
        let near = |x: [f64; 2], size: [f64; 2]| {
            let interval = |[low, high]: [f64; 2]| Interval { low, high, may_be_nan: false };
            let shape = shape_of([8.0, 8.0], 4.0, [interval(x), interval([8.0, 8.0])], interval(size)).expect("finite");
            let (mut inside, mut open) = (0, Vec::new());
            let area = Bounds { x0: 0, x1: 16, y0: 0, y1: 16 };
            shape.rows(area, |_, _, set| inside += set.count_ones());
            super::super::band::band(&shape, 0, area, |pixel| open.push((pixel.x, pixel.y, pixel.is_inside)));
            assert_eq!(inside, 16);
            open
        };
        // What does not move a border to another pixel leaves none open.
        assert!(near([7.75, 8.25], [4.0, 4.25]).is_empty());
        // One column at either side, of four rows: moved to the right, the first is left and another is won.
        let moved = near([8.0, 8.75], [4.0, 4.0]);
        assert!(moved.contains(&(6, 8, true)) && moved.contains(&(10, 8, false)), "{moved:?}");
        assert!(moved.iter().all(|(x, ..)| ![7, 8].contains(x)), "{moved:?}");
        let grown = near([8.0, 8.0], [4.0, 6.0]);
        assert!(grown.contains(&(5, 5, false)) && grown.contains(&(10, 10, false)), "{grown:?}");
    }

    #[test]
    fn positions_that_are_not_finite_make_nothing() {
        assert_eq!(shape(f32::NAN, 1.0, 1.0), None);
        assert_eq!(bounds(8.5, 8.5, f32::NAN), bounds(8.5, 8.5, 1.0));
    }
}
