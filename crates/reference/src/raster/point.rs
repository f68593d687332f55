//! Points (OpenGL 3.2 §3.4.1): the pixels whose centers are inside a square.

use super::{Bounds, Edge, ONE, Shape};

/// The largest size of a point in pixels.
pub(crate) const MAX_SIZE: f32 = 255.0;

/// The pixels of a point of `size` pixels at a window position; `None` if the position is not finite.
///
/// It is snapped as by Mesa's drivers: the size to 1/256 pixel, at least one pixel; the position is rounded half away
/// from zero.
pub(crate) fn shape(x: f32, y: f32, size: f32) -> Option<Shape> {
    let snap = |value: f32| {
        let scaled = value * ONE as f32;
        (scaled.abs() < (1_u64 << 38) as f32).then(|| scaled.round() as i64)
    };
    let size = if size.is_nan() { 1.0 } else { size.min(MAX_SIZE) };
    let width = snap(size)?.max(ONE);
    let reach = |value: f32| {
        let low = snap(value - 0.5)? - width / 2;
        Some(((low + ONE - 1).div_euclid(ONE), (low + width + ONE - 1).div_euclid(ONE)))
    };
    let ((x0, x1), (y0, y1)) = (reach(x)?, reach(y)?);
    const NOWHERE: Edge = Edge { origin: 0, step_x: 0, step_y: 0, near: 0 };
    Some(Shape::Convex { bounds: Bounds { x0, x1, y0, y1 }, edges: [NOWHERE; 4], count: 0 })
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
    fn positions_that_are_not_finite_make_nothing() {
        assert_eq!(shape(f32::NAN, 1.0, 1.0), None);
        assert_eq!(bounds(8.5, 8.5, f32::NAN), bounds(8.5, 8.5, 1.0));
    }
}
