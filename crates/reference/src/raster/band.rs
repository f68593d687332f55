//! The band around the edges of a shape: the pixels for which a conforming GPU may decide coverage differently.
//!
//! *In:* a [`Shape`]. *Out:* the pixels of a rectangle whose centers are within the band ([`band`]), each with whether it
//! is covered, and near which edges. *Holds:* each pixel is reported once, row by row; the cost is that of the edges, not
//! of the area. How wide the band is belongs to the edges ([`Edge::near`]).

use super::{Bounds, Edge, Shape};
use smallvec::SmallVec;

/// A pixel near an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct EdgePixel {
    pub(crate) x: i64,
    pub(crate) y: i64,
    /// Whether the shape covers the pixel.
    pub(crate) is_inside: bool,
    /// Near which edges: bit `i` is edge `i`.
    pub(crate) edges: u8,
}

/// Calls `visit` with each pixel of `area` whose center is near an edge of the shape, and not beyond another one. Edges of the set
/// `inner`, bit `i` for edge `i`, have no band: they part the shape from another of the same primitive.
pub(crate) fn band(shape: &Shape, inner: u8, area: Bounds, mut visit: impl FnMut(EdgePixel)) {
    let Shape::Convex { bounds, edges, count } = shape else { return };
    let area = bounds.intersect(area);
    let edges = edges.get(..*count).unwrap_or(&[]);
    let mut columns: SmallVec<[i64; 16]> = SmallVec::new();
    for y in area.y0..area.y1 {
        columns.clear();
        outer(edges, inner).for_each(|edge| columns.extend(columns_near(edge, area, y)));
        columns.sort_unstable();
        columns.dedup();
        columns.iter().filter_map(|&x| edge_pixel(edges, inner, x, y)).for_each(&mut visit);
    }
}

/// The edges that have a band.
fn outer(edges: &[Edge], inner: u8) -> impl Iterator<Item = &Edge> {
    edges.iter().enumerate().filter(move |(index, _)| inner >> index & 1 == 0).map(|(_, edge)| edge)
}

/// The columns of a row near a line.
fn columns_near(edge: &Edge, area: Bounds, y: i64) -> std::ops::Range<i64> {
    let at_zero = edge.at(0, y);
    let (low, high) = match edge.step_x {
        0 if at_zero.abs() <= edge.near => (area.x0, area.x1),
        0 => (0, 0),
        step => {
            let ends = [-edge.near - at_zero, edge.near - at_zero];
            let [low, high] = if step > 0 { ends } else { [-ends[1], -ends[0]] };
            // From the first column not below `low` to the last one not above `high`.
            (-(-low).div_euclid(step.abs()), high.div_euclid(step.abs()) + 1)
        }
    };
    low.max(area.x0)..high.min(area.x1)
}

fn edge_pixel(edges: &[Edge], inner: u8, x: i64, y: i64) -> Option<EdgePixel> {
    let mut found = EdgePixel { x, y, is_inside: true, edges: 0 };
    for (index, edge) in edges.iter().enumerate() {
        let value = edge.at(x, y);
        let is_outer = inner >> index & 1 == 0;
        if value < if is_outer { -edge.near } else { 0 } {
            return None;
        }
        found.is_inside &= value >= 0;
        found.edges |= u8::from(is_outer && value.abs() <= edge.near) << index;
    }
    (found.edges != 0).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::super::{Fixed, triangle};
    use super::*;

    const AREA: Bounds = Bounds { x0: 0, x1: 16, y0: 0, y1: 16 };

    fn shape(corners: [(f32, f32); 3]) -> Shape {
        triangle::shape(corners.map(|(x, y)| Fixed::snap(x, y).expect("finite"))).expect("it has area")
    }

    #[test]
    fn pixels_near_an_edge_are_found() {
        let mut found = Vec::new();
        band(&shape([(2.495, 0.0), (12.0, 0.0), (2.495, 12.0)]), 0, AREA, |near| found.push(near));
        assert!(found.iter().any(|near| (near.x, near.y, near.is_inside) == (2, 5, true)), "{found:?}");
        assert!(found.iter().all(|near| near.x != 3 || near.y != 5));
        found.clear();
        // Just to the right of the center.
        band(&shape([(2.505, 0.0), (12.0, 0.0), (2.505, 12.0)]), 0, AREA, |near| found.push(near));
        assert!(found.iter().any(|near| (near.x, near.y, near.is_inside) == (2, 5, false)), "{found:?}");
    }

    #[test]
    fn the_parts_of_a_polygon_have_its_band() {
        // A square in two parts; the centers of the diagonal's pixels are on it.
        let [a, b, c, d] = [(2.5, 2.5), (12.5, 2.5), (12.5, 12.5), (2.5, 12.5)];
        let mut found = Vec::new();
        band(&shape([a, b, c]), 0b100, AREA, |near| found.push((near.x, near.y)));
        band(&shape([a, c, d]), 0b001, AREA, |near| found.push((near.x, near.y)));
        let on_rim = |x: i64, y: i64| {
            let is_end = |at: i64| at == 2 || at == 12;
            (2..=12).contains(&x) && (2..=12).contains(&y) && (is_end(x) || is_end(y))
        };
        assert!(found.iter().all(|&(x, y)| on_rim(x, y)), "{found:?}");
        found.sort_unstable();
        found.dedup();
        assert_eq!(found.len(), 40, "{found:?}");
    }

    #[test]
    fn the_band_is_that_of_a_search_of_all_pixels() {
        let mut state = 3_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            // Multiples of an eighth of a pixel, so that centers lie on edges.
            ((state >> 8) % 160) as f32 / 8.0 - 2.0
        };
        let mut total = 0;
        for _ in 0..300 {
            let corners = [(next(), next()), (next(), next()), (next(), next())];
            let corners = corners.map(|(x, y)| Fixed::snap(x, y).expect("finite"));
            let Some(shape) = triangle::shape(corners) else { continue };
            let Shape::Convex { edges, count, .. } = &shape else { continue };
            let mut found = Vec::new();
            band(&shape, 0, AREA, |near| found.push(near));
            let all = (0..16).flat_map(|y| (0..16).map(move |x| (x, y)));
            let expected: Vec<EdgePixel> = all.filter_map(|(x, y)| edge_pixel(&edges[..*count], 0, x, y)).collect();
            assert_eq!(found, expected);
            total += found.len();
        }
        assert!(total > 100, "{total}");
    }
}
