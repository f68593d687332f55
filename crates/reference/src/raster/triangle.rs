//! Triangles (OpenGL 3.2 §3.6.1).

use super::{Bounds, Edge, Fixed, ONE, Shape};

/// Twice the signed area in units of the grid squared: positive if the corners are clockwise in the picture.
pub(crate) fn doubled_area(corners: [Fixed; 3]) -> i64 {
    let [a, b, c] = corners;
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// The pixels of a triangle; `None` if it has no area.
pub(crate) fn shape(corners: [Fixed; 3]) -> Option<Shape> {
    let area = doubled_area(corners);
    let [a, b, c] = corners;
    let (b, c) = match area {
        0 => return None,
        1.. => (b, c),
        _ => (c, b),
    };
    let edges = [Edge::new(a, b), Edge::new(b, c), Edge::new(c, a)];
    Some(convex(&[a, b, c], &edges))
}

/// The pixels inside all edges, of a polygon with these corners.
pub(super) fn convex(corners: &[Fixed], list: &[Edge]) -> Shape {
    const NOWHERE: Edge = Edge { origin: 0, step_x: 0, step_y: 0, near: 0 };
    let mut edges = [NOWHERE; 4];
    for (slot, edge) in edges.iter_mut().zip(list) {
        *slot = *edge;
    }
    let reach = |value: fn(&Fixed) -> i64| {
        let low = corners.iter().map(value).min().unwrap_or(0);
        let high = corners.iter().map(value).max().unwrap_or(0);
        // Two units more than the corners, for the pixels near an edge.
        ((low - 2).div_euclid(ONE), (high + 2).div_euclid(ONE) + 1)
    };
    let ((x0, x1), (y0, y1)) = (reach(|p| p.x), reach(|p| p.y));
    Shape::Convex { bounds: Bounds { x0, x1, y0, y1 }, edges, count: list.len().min(4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Bounds = Bounds { x0: 0, x1: 16, y0: 0, y1: 16 };

    /// How often each pixel of a 16x16 picture is covered.
    fn count(triangles: &[[(f32, f32); 3]]) -> Vec<u32> {
        let mut counts = vec![0; 256];
        for triangle in triangles {
            let corners = triangle.map(|(x, y)| Fixed::snap(x, y).expect("finite"));
            if let Some(shape) = shape(corners) {
                let emit = |x: i64, y: i64, covered: u32| {
                    for bit in 0..4 {
                        if covered >> bit & 1 == 1 {
                            counts[((y + i64::from(bit >> 1)) * 16 + x + i64::from(bit & 1)) as usize] += 1;
                        }
                    }
                };
                shape.quads(AREA, emit);
            }
        }
        counts
    }

    #[test]
    fn top_and_left_edges_are_in_and_the_others_out() {
        // A square from center to center: pixels 2..6 in both directions.
        let counts = count(&[[(2.5, 2.5), (6.5, 2.5), (2.5, 6.5)], [(6.5, 2.5), (6.5, 6.5), (2.5, 6.5)]]);
        for (index, &count) in counts.iter().enumerate() {
            let (x, y) = (index % 16, index / 16);
            assert_eq!(count, u32::from((2..6).contains(&x) && (2..6).contains(&y)), "({x}, {y})");
        }
    }

    #[test]
    fn both_windings_cover_the_same() {
        let one = count(&[[(1.3, 2.7), (14.1, 5.2), (6.6, 13.9)]]);
        let other = count(&[[(1.3, 2.7), (6.6, 13.9), (14.1, 5.2)]]);
        assert_eq!(one, other);
        assert!(one.iter().sum::<u32>() > 60);
    }

    #[test]
    fn a_fan_covers_every_pixel_once() {
        let mut state = 7_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32 * 16.0
        };
        for _ in 0..200 {
            let hub = (next(), next());
            let rim =
                [(0.0, 0.0), (next(), 0.0), (16.0, 0.0), (16.0, next()), (16.0, 16.0), (0.0, 16.0), (0.0, next())];
            let mut sorted = rim;
            if sorted[6].1 > 16.0 {
                sorted[6].1 = 16.0;
            }
            let triangles: Vec<_> = (0..7).map(|i| [hub, sorted[i], sorted[(i + 1) % 7]]).collect();
            let counts = count(&triangles);
            assert!(counts.iter().all(|&count| count == 1), "{hub:?}");
        }
    }

    #[test]
    fn coverage_is_that_of_a_direct_transcription() {
        // Inside by exact signs; ties are decided by the kind of the edge.
        let triangle = [(1.5, 1.5), (12.5, 3.5), (4.5, 14.5)];
        let counts = count(&[triangle]);
        for y in 0..16 {
            for x in 0..16 {
                let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                let inside = (0..3).all(|i| {
                    let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                    let (dx, dy) = (f64::from(b.0 - a.0), f64::from(b.1 - a.1));
                    let side = dx * (py - f64::from(a.1)) - dy * (px - f64::from(a.0));
                    side > 0.0 || (side == 0.0 && (dy < 0.0 || (dy == 0.0 && dx > 0.0)))
                });
                assert_eq!(counts[(y * 16 + x) as usize], u32::from(inside), "({x}, {y})");
            }
        }
    }

    #[test]
    fn rows_and_quads_cover_the_same() {
        // Wider and higher than a block; and areas that begin at odd pixels.
        let corners = [(-3.0, 1.25), (139.5, 20.0), (60.75, 70.5)].map(|(x, y)| Fixed::snap(x, y).expect("finite"));
        let shape = shape(corners).expect("it has area");
        for (x0, y0) in [(0, 0), (1, 0), (0, 3), (33, 5)] {
            let area = Bounds { x0, x1: 131, y0, y1: 67 };
            let (mut by_rows, mut by_quads) = (Vec::new(), Vec::new());
            shape.rows(area, |y, x, pixels| {
                by_rows.extend((0..64).filter(|bit| pixels >> bit & 1 == 1).map(|bit| (x + bit, y)));
            });
            shape.quads(area, |x, y, covered| {
                assert!(x % 2 == 0 && y % 2 == 0);
                let pixels = (0..4).filter(|bit| covered >> bit & 1 == 1);
                by_quads.extend(pixels.map(|bit| (x + (bit & 1), y + (bit >> 1))));
            });
            by_rows.sort_unstable();
            by_quads.sort_unstable();
            assert_eq!(by_rows, by_quads);
            assert!(by_rows.len() > 1000);
            let inside = |(x, y): &(i64, i64)| (x0..131).contains(x) && (y0..67).contains(y);
            assert!(by_rows.iter().all(inside) && by_rows.windows(2).all(|pair| pair[0] != pair[1]));
        }
    }

    #[test]
    fn nothing_without_area_and_nothing_that_is_not_finite() {
        assert!(count(&[[(1.0, 1.0), (5.0, 5.0), (9.0, 9.0)]]).iter().all(|&count| count == 0));
        assert_eq!(Fixed::snap(f32::NAN, 0.0), None);
        assert_eq!(Fixed::snap(f32::INFINITY, 0.0), None);
    }
}
