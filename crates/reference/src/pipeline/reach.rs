//! [`reach`]: how far beyond the values at the vertices the fragments of a draw may be interpolated.
//!
//! *In:* a draw. *Out:* a factor: a varying with values from `low` to `high` at the vertices is, at all fragments of all
//! conforming targets, between `low - f (high - low)` and `high + f (high - low)`, but for the rounding of the result.
//!
//! A fragment's center may be outside of the triangle by as much as positions are rounded to a grid, which is 1/16 pixel or
//! finer (Vulkan, `subPixelPrecisionBits`), and as targets may compute positions differently, which the envelope knows. By the
//! height of the triangle that is a negative weight `e`; perspective makes it larger by the ratio of the largest to the
//! smallest 1/w. *Holds:* triangles without fragments do not count. Whoever may cull them counts: a target may see their
//! other side.

use super::assembly::clipped_triangles;
use super::plan::Plan;
use super::unique_vertices;
use super::vertices::{Invocation, ShadeOptions, Vertices, shade};
use super::watch::{Study, Watch};
use super::{MAX_INVOCATIONS, RenderOptions};
use crate::domain::{Envelope, Number};
use crate::exec::Code;
use glisten_front::hir::Stage;
use glisten_scene::picture::Interval;
use glisten_scene::{Draw, Framebuffer, Primitive};
use std::sync::OnceLock;

/// Half the diagonal of a cell of the coarsest grid that a position is rounded to, in pixels.
const SNAP: f64 = 0.044_195;
/// The rounding of weights in f32, by the length of an edge over the height.
const ROUNDING: f64 = 9.6e-7;
/// The largest ratio of 1/w within a triangle: the rounding of quotients grows with it.
const STEEPEST: f64 = 64.0;
/// Bounds of 1/w: quotients by w neither overflow nor vanish.
const RECIPROCALS: [f64; 2] = [1e-6, 1e6];
/// Of more pixels around a triangle without height it is not asked whether it covers any.
const MOST_PIXELS: f64 = 65_536.0;

/// A corner in the window.
#[derive(Clone, Copy)]
struct Corner {
    x: f64,
    y: f64,
    /// How far from there a target may have it.
    off: f64,
    /// 1/w
    low: f64,
    high: f64,
}

/// The factor of a draw; `None` if nothing bounds it.
pub(crate) fn reach(draw: &Draw, framebuffer: Framebuffer, options: &RenderOptions) -> Option<f64> {
    if draw.program.stage(Stage::Geometry).is_some() {
        return None;
    }
    match draw.state.primitive {
        Primitive::Points => return Some(0.0),
        Primitive::Lines
        | Primitive::LineStrip
        | Primitive::LineLoop
        | Primitive::LinesAdjacency
        | Primitive::LineStripAdjacency => return None,
        Primitive::Triangles
        | Primitive::TriangleStrip
        | Primitive::TriangleFan
        | Primitive::TrianglesAdjacency
        | Primitive::TriangleStripAdjacency => {}
    }
    let code = Code::compile(&draw.program, Stage::Vertex).ok()?;
    let plan = Plan::new(&draw.program);
    let viewport = [framebuffer.width as f32, framebuffer.height as f32];
    let (order, unique) = unique_vertices(draw);
    if unique.len().saturating_mul(draw.instances as usize) > MAX_INVOCATIONS {
        return None;
    }
    let instances = 0..draw.instances;
    let invocations: Vec<Invocation> =
        instances.clone().flat_map(|instance| unique.iter().map(move |&vertex| (vertex, instance))).collect();
    let endless = OnceLock::new();
    let watch = Watch { study: Study::NONE, draw: 0, instance: 0, surface: 0 };
    let shaded =
        ShadeOptions { viewport, faults: options.faults, profile: options.profile, positions: options.positions };
    let mut vertices = shade::<Envelope>(draw, &code, &plan, &invocations, shaded, &endless, &watch);
    if endless.get().is_some() {
        return None;
    }
    let mut factor = 0.0_f64;
    for instance in instances {
        let base = instance * unique.len() as u32;
        let order: Vec<u32> = order.iter().map(|&position| base + position).collect();
        for triangle in clipped_triangles(&mut vertices, &order, &draw.state)? {
            factor = factor.max(of_triangle(&vertices, triangle, viewport)?);
        }
    }
    Some(factor)
}

fn of_triangle(vertices: &Vertices<Envelope>, triangle: [u32; 3], viewport: [f32; 2]) -> Option<f64> {
    let [a, b, c] = triangle.map(|vertex| corner(vertices, vertex));
    let corners = [a?, b?, c?];
    let off = SNAP + corners.iter().fold(0.0, |off: f64, corner| off.max(corner.off));
    let lengths = [[0, 1], [1, 2], [2, 0]].map(|[i, j]| {
        let (from, to) = (corners[i], corners[j]);
        (to.x - from.x).hypot(to.y - from.y)
    });
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let [a, b, c] = corners;
    let doubled = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs();
    let height = doubled / longest;
    let weight = (off + ROUNDING * longest) / height;
    let smallest = corners.iter().fold(f64::INFINITY, |low, corner| low.min(corner.low));
    let largest = corners.iter().fold(0.0, |high: f64, corner| high.max(corner.high));
    let ratio = largest / smallest;
    let factor = 4.0 * weight * ratio;
    if factor <= 1.0 && ratio <= STEEPEST {
        return Some(factor);
    }
    (!may_cover(&corners, off, viewport)?).then_some(0.0)
}

fn corner(vertices: &Vertices<Envelope>, vertex: u32) -> Option<Corner> {
    let index = vertex as usize;
    if vertices.undecided.get(index).copied().unwrap_or(true) {
        return None;
    }
    let [x, y, _, reciprocal] = vertices.window.get(index).copied()?;
    let [x, y, reciprocal]: [Interval; 3] = [x.interval(), y.interval(), reciprocal.interval()];
    let [along, down, _] = vertices.window32.get(index).map(|window| window.map(f64::from))?;
    let finite = [x, y, reciprocal].iter().all(|one| !one.may_be_nan && one.low.is_finite() && one.high.is_finite());
    // From the place where the reference has it to the farthest where a target may.
    let off = |range: Interval, at: f64| (range.high - at).abs().max((at - range.low).abs());
    let off = off(x, along).hypot(off(y, down));
    let moderate = reciprocal.low >= RECIPROCALS[0] && reciprocal.high <= RECIPROCALS[1];
    (finite && off.is_finite() && moderate).then_some(Corner {
        x: along,
        y: down,
        off,
        low: reciprocal.low,
        high: reciprocal.high,
    })
}

/// Whether the center of a pixel is within a distance of a triangle; `None` if these are too many to ask.
fn may_cover(corners: &[Corner; 3], off: f64, viewport: [f32; 2]) -> Option<bool> {
    let reach = |value: fn(&Corner) -> f64, side: f32| {
        let low = corners.iter().map(value).fold(f64::INFINITY, f64::min) - off - 0.5;
        let high = corners.iter().map(value).fold(f64::NEG_INFINITY, f64::max) + off - 0.5;
        (low.ceil().max(0.0), high.floor().min(f64::from(side) - 1.0))
    };
    let (x, y) = (reach(|corner| corner.x, viewport[0]), reach(|corner| corner.y, viewport[1]));
    if x.0 > x.1 || y.0 > y.1 {
        return Some(false);
    }
    if (x.1 - x.0 + 1.0) * (y.1 - y.0 + 1.0) > MOST_PIXELS {
        return None;
    }
    let mut row = y.0;
    while row <= y.1 {
        let mut column = x.0;
        while column <= x.1 {
            if distance(corners, [column + 0.5, row + 0.5]) <= off {
                return Some(true);
            }
            column += 1.0;
        }
        row += 1.0;
    }
    Some(false)
}

/// The distance of a point from a triangle that is thin, or small: from its edges.
fn distance(corners: &[Corner; 3], [x, y]: [f64; 2]) -> f64 {
    let side = |i: usize, j: usize| {
        let (from, to) = (corners[i], corners[j]);
        (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x)
    };
    let sides = [side(0, 1), side(1, 2), side(2, 0)];
    if sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0) {
        // Inside, or on the line of a triangle without area: then the edges tell.
        if sides.iter().any(|side| *side != 0.0) {
            return 0.0;
        }
    }
    let from_edge = |[i, j]: [usize; 2]| {
        let (from, to) = (corners[i], corners[j]);
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let square = dx * dx + dy * dy;
        let along = if square > 0.0 { ((x - from.x) * dx + (y - from.y) * dy) / square } else { 0.0 };
        let along = along.clamp(0.0, 1.0);
        (x - from.x - along * dx).hypot(y - from.y - along * dy)
    };
    [[0, 1], [1, 2], [2, 0]].map(from_edge).into_iter().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::{Corner, distance, may_cover};

    fn corners(list: [(f64, f64); 3]) -> [Corner; 3] {
        list.map(|(x, y)| Corner { x, y, off: 0.0, low: 1.0, high: 1.0 })
    }

    #[test]
    fn only_pixels_near_a_thin_triangle_are_covered() {
        // Between two rows of centers, along one, and around one.
        let between = corners([(1.0, 2.0), (9.0, 2.0), (9.0, 2.01)]);
        assert_eq!(may_cover(&between, 0.05, [16.0, 16.0]), Some(false));
        let along = corners([(1.0, 2.5), (9.0, 2.5), (9.0, 2.5)]);
        assert_eq!(may_cover(&along, 0.05, [16.0, 16.0]), Some(true));
        let small = corners([(3.48, 3.48), (3.52, 3.48), (3.5, 3.52)]);
        assert_eq!(may_cover(&small, 0.05, [16.0, 16.0]), Some(true));
        assert_eq!(may_cover(&along, 0.05, [16.0, 2.0]), Some(false));
    }

    #[test]
    fn the_distance_from_a_triangle_is_that_from_its_edges() {
        let triangle = corners([(0.0, 0.0), (4.0, 0.0), (0.0, 4.0)]);
        assert_eq!(distance(&triangle, [1.0, 1.0]), 0.0);
        assert_eq!(distance(&triangle, [2.0, -3.0]), 3.0);
        assert_eq!(distance(&corners([(1.0, 1.0), (1.0, 1.0), (1.0, 1.0)]), [1.0, 3.0]), 2.0);
    }
}
