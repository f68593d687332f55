//! Primitive assembly (OpenGL 3.2 §2.6.1, table 2.12): primitives from vertices, clipped, with their pixels.
//!
//! *In:* shaded vertices, and their order in a draw. *Out:* [`Prim`]s in order. *Holds:* culling and facing depend on
//! the sign of the snapped area (§3.6.1).

use super::adjacency::{self, Seen};
use super::clip::SIDES;
use super::vertices::Vertices;
use crate::LineRule;
use crate::domain::{Domain, Number};
use crate::raster::{Fixed, NEAR, ONE, Shape, line, point, triangle};
use glisten_scene::{Cull, Primitive, State};

/// The vertices between which the values of a primitive's fragments are interpolated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Corners {
    /// One vertex for all fragments.
    Point(u32),
    /// A segment.
    Line([u32; 2]),
    /// A triangle.
    Triangle([u32; 3]),
}

/// A primitive, or a part of one after clipping.
#[derive(Clone, Debug)]
pub(super) struct Prim {
    pub(super) shape: Shape,
    pub(super) corners: Corners,
    /// The vertex whose values `flat` varyings take.
    pub(super) provoking: u32,
    /// `gl_FrontFacing`
    pub(super) front: bool,
    /// `gl_PrimitiveID`
    pub(super) id: u32,
    /// Whether a branch in the vertex stage is undecided for one of its vertices.
    pub(super) undecided: bool,
    /// Whether the reference does not draw it, and a GPU may: what a clip distance cuts off that may be anything.
    pub(super) perhaps: bool,
    /// The edges beyond which another part of the primitive is: bit `i` is edge `i` of the shape.
    pub(super) inner: u8,
}

/// The vertices of a primitive, and its provoking vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Assembled {
    Point(u32),
    Line([u32; 2]),
    /// The corners, and the index of the provoking one by the first-vertex convention; by the other convention it is
    /// the last.
    Triangle([u32; 3], usize),
}

impl Assembled {
    /// With other numbers for the vertices.
    pub(super) fn map(self, f: impl Fn(u32) -> u32) -> Self {
        match self {
            Self::Point(vertex) => Self::Point(f(vertex)),
            Self::Line(ends) => Self::Line(ends.map(f)),
            Self::Triangle(corners, first) => Self::Triangle(corners.map(f), first),
        }
    }

    /// The provoking vertex.
    pub(super) fn provoking(self, last: bool) -> u32 {
        match self {
            Self::Point(vertex) => vertex,
            Self::Line([from, to]) => {
                if last {
                    to
                } else {
                    from
                }
            }
            Self::Triangle(corners, first) => corners[if last { 2 } else { first }],
        }
    }
}

/// The primitives that `count` vertices form. Adjacent vertices are left out: without a geometry shader, they are ignored
/// (§2.6.1).
pub(super) fn assemble(primitive: Primitive, count: u32) -> Vec<Assembled> {
    let line = |from: u32, to: u32| Assembled::Line([from, to]);
    let triangle = Assembled::Triangle;
    match primitive {
        Primitive::Points => (0..count).map(Assembled::Point).collect(),
        Primitive::Lines => (0..count / 2).map(|i| line(2 * i, 2 * i + 1)).collect(),
        Primitive::LineStrip => (1..count).map(|i| line(i - 1, i)).collect(),
        Primitive::LineLoop => {
            let closing = (count >= 2).then(|| line(count - 1, 0));
            (1..count).map(|i| line(i - 1, i)).chain(closing).collect()
        }
        Primitive::Triangles => (0..count / 3).map(|i| triangle([3 * i, 3 * i + 1, 3 * i + 2], 0)).collect(),
        Primitive::TriangleStrip => (0..count.saturating_sub(2))
            .map(|i| if i % 2 == 1 { triangle([i + 1, i, i + 2], 1) } else { triangle([i, i + 1, i + 2], 0) })
            .collect(),
        Primitive::TriangleFan => (0..count.saturating_sub(2)).map(|i| triangle([0, i + 1, i + 2], 1)).collect(),
        Primitive::LinesAdjacency
        | Primitive::LineStripAdjacency
        | Primitive::TrianglesAdjacency
        | Primitive::TriangleStripAdjacency => {
            let primitives = adjacency::primitives(primitive, count).into_iter();
            primitives.enumerate().map(|(number, all)| inner(primitive, number, all)).collect()
        }
    }
}

/// The vertices of a primitive of an instance, by its `gl_PrimitiveID`; none if a geometry stage makes the primitives.
#[cfg(any(test, feature = "stability"))]
pub(in super::super) fn vertices_of(draw: &glisten_scene::Draw, primitive: u32) -> Vec<u32> {
    if draw.program.stage(glisten_front::hir::Stage::Geometry).is_some() {
        return Vec::new();
    }
    let all = assemble(draw.state.primitive, draw.vertex_count);
    let vertex = |position: u32| match &draw.indices {
        Some(indices) => indices.get(position as usize).copied().unwrap_or(position),
        None => position,
    };
    match all.get(primitive as usize).map(|one| one.map(vertex)) {
        Some(Assembled::Point(vertex)) => vec![vertex],
        Some(Assembled::Line(ends)) => ends.to_vec(),
        Some(Assembled::Triangle(corners, _)) => corners.to_vec(),
        None => Vec::new(),
    }
}

/// The primitive without its adjacent vertices.
pub(super) fn inner(primitive: Primitive, number: usize, all: Seen) -> Assembled {
    let at = |place: usize| all.get(place).copied().unwrap_or(0);
    match primitive {
        Primitive::LinesAdjacency | Primitive::LineStripAdjacency => Assembled::Line([at(1), at(2)]),
        _ => {
            let odd = primitive == Primitive::TriangleStripAdjacency && number % 2 == 1;
            Assembled::Triangle([at(0), at(2), at(4)], usize::from(odd))
        }
    }
}

/// The primitives of one instance: assembled from shaded vertices, each with its `gl_PrimitiveID`.
pub(super) fn primitives<D: Domain>(
    vertices: &mut Vertices<D>,
    assembled: impl Iterator<Item = (Assembled, u32)>,
    state: &State,
    lines: LineRule,
) -> Vec<Prim> {
    // The provoking vertex comes first, as the runner has it, whether or not something is flat. Interpolated values depend on
    // which vertex comes first, if only by rounding, so the order must be the same for a program that has lost a varying.
    let last_first = state.provoking_last;
    let mut list = Vec::with_capacity(assembled.size_hint().0);
    for (assembled, id) in assembled {
        let provoking = assembled.provoking(state.provoking_last);
        match assembled {
            Assembled::Point(vertex) => list.extend(point_prim(vertices, vertex, id, lines)),
            Assembled::Line([from, to]) => {
                let turned = last_first && lines == LineRule::Vulkan;
                let ends = if turned { [to, from] } else { [from, to] };
                let whole = Whole::of(vertices, &ends, provoking, id);
                list.extend(
                    whole.both().into_iter().flatten().filter_map(|part| line_prim(vertices, ends, part, lines)),
                );
            }
            Assembled::Triangle(mut corners, first) => {
                corners.rotate_left(if last_first { 2 } else { first });
                let whole = Whole::of(vertices, &corners, provoking, id);
                for part in whole.both().into_iter().flatten() {
                    triangle_prims(vertices, corners, part, state, &mut list);
                }
            }
        }
    }
    list
}

/// The triangles of one instance after clipping, whichever way they face; `None` if a vertex has no finite position.
pub(super) fn clipped_triangles<D: Domain>(
    vertices: &mut Vertices<D>,
    order: &[u32],
    state: &State,
) -> Option<Vec<[u32; 3]>> {
    let mut list = Vec::new();
    for assembled in assemble(state.primitive, order.len() as u32) {
        let Assembled::Triangle(corners, _) = assembled else { continue };
        let corners = corners.map(|position| order.get(position as usize).copied().unwrap_or(0));
        for vertex in corners {
            vertices.outside(vertex)?;
        }
        let polygon = vertices.clip_triangle(corners, 0);
        let Some((&hub, rim)) = polygon.split_first() else { continue };
        list.extend(rim.windows(2).filter_map(|pair| Some([hub, *pair.first()?, *pair.get(1)?])));
    }
    Some(list)
}

fn window<D: Domain>(vertices: &Vertices<D>, vertex: u32) -> Option<[f32; 2]> {
    vertices.window32.get(vertex as usize).map(|&[x, y, _]| [x, y])
}

fn is_undecided<D: Domain>(vertices: &Vertices<D>, corners: &[u32]) -> bool {
    corners.iter().any(|&vertex| vertices.undecided.get(vertex as usize).copied().unwrap_or(false))
}

/// By how much the band around the edges between these vertices is wider than that of Mesa's grid, in units of the
/// grid: by the device's snapping, and by the envelopes of the positions.
fn freedom<D: Domain>(vertices: &Vertices<D>, corners: &[u32]) -> f64 {
    if !D::HAS_INTERVALS {
        return 0.0;
    }
    let off = |vertex: &u32| {
        let [x, y] = vertices.window.get(*vertex as usize).map_or([0.0; 2], |[x, y, _, _]| [x.error(), y.error()]);
        x.hypot(y)
    };
    let moved = corners.iter().map(off).fold(0.0, f64::max);
    // A position without a bound is undecided as a whole.
    let moved = if moved.is_finite() { moved } else { 0.0 };
    (vertices.profile.edge_band() + moved) * ONE as f64 - NEAR
}

/// A primitive before it is clipped, and what of that is open.
#[derive(Clone, Copy)]
struct Whole {
    provoking: u32,
    id: u32,
    undecided: bool,
    perhaps: bool,
    /// The planes that may cut it or not.
    open: u32,
    /// The planes that do not cut it.
    without: u32,
}

impl Whole {
    fn of<D: Domain>(vertices: &Vertices<D>, corners: &[u32], provoking: u32, id: u32) -> Self {
        let open = vertices.open_planes(corners);
        let undecided = is_undecided(vertices, corners) || open != 0;
        Self { provoking, id, undecided, perhaps: false, open, without: 0 }
    }

    /// The primitive as the reference cuts it, after the one that a GPU may draw if it is cut by other planes.
    fn both(self) -> [Option<Self>; 2] {
        let uncut = Self { perhaps: true, without: self.open, ..self };
        [(self.open != 0).then_some(uncut), Some(self)]
    }

    fn prim(self, shape: Shape, corners: Corners, front: bool) -> Prim {
        let Self { provoking, id, undecided, perhaps, .. } = self;
        Prim { shape, corners, provoking, front, id, undecided, perhaps, inner: 0 }
    }
}

fn point_prim<D: Domain>(vertices: &Vertices<D>, vertex: u32, id: u32, rule: LineRule) -> Option<Prim> {
    // OpenGL discards a point whose center is outside (§2.19); Vulkan may draw the part inside the window.
    let counted = match rule {
        LineRule::OpenGl => u32::MAX,
        LineRule::Vulkan => !SIDES,
    };
    let (outside, open) = (vertices.outside(vertex)? & counted, vertices.open_planes_of_point(vertex) & counted);
    if outside & !open != 0 {
        return None;
    }
    let [x, y] = window(vertices, vertex)?;
    let size32 = vertices.size32.get(vertex as usize).copied()?;
    let &[own_x, own_y, ..] = vertices.window.get(vertex as usize)?;
    let size = vertices.size.get(vertex as usize)?;
    let shape = match D::HAS_INTERVALS {
        true => point::shape_of([x, y], size32, [own_x, own_y].map(Number::interval), size.interval())?,
        false => point::shape(x, y, size32)?,
    };
    let undecided = is_undecided(vertices, &[vertex]) || open != 0 || D::HAS_INTERVALS && size.error() > OPEN_SIZE;
    let whole = Whole { provoking: vertex, id, undecided, perhaps: outside != 0, open, without: 0 };
    Some(whole.prim(shape, Corners::Point(vertex), true))
}

/// The error of a point's size from which the pixels at its border are not near an edge, but undecided, in pixels.
const OPEN_SIZE: f64 = 0.25;

fn line_prim<D: Domain>(vertices: &mut Vertices<D>, ends: [u32; 2], whole: Whole, rule: LineRule) -> Option<Prim> {
    let ends = vertices.clip_line(ends, whole.without)?;
    let [from, to] = ends.map(|vertex| window(vertices, vertex));
    let (from, to) = (from?, to?);
    let shape = match rule {
        LineRule::Vulkan => line::rectangle(from, to)?,
        LineRule::OpenGl => line::diamond_exit(Fixed::snap(from[0], from[1])?, Fixed::snap(to[0], to[1])?),
    };
    let shape = shape.widened(freedom(vertices, &ends));
    Some(whole.prim(shape, Corners::Line(ends), true))
}

fn triangle_prims<D: Domain>(
    vertices: &mut Vertices<D>,
    corners: [u32; 3],
    whole: Whole,
    state: &State,
    list: &mut Vec<Prim>,
) {
    let polygon = vertices.clip_triangle(corners, whole.without);
    let Some((&hub, rim)) = polygon.split_first() else { return };
    // The part before, if it is there: its place in the list, and the number of the part.
    let mut before: Option<(usize, usize)> = None;
    for (part, pair) in rim.windows(2).enumerate() {
        let &[second, third] = pair else { continue };
        let corners = [hub, second, third];
        let snapped = corners.map(|vertex| window(vertices, vertex).and_then(|[x, y]| Fixed::snap(x, y)));
        let [Some(a), Some(b), Some(c)] = snapped else { continue };
        let is_clockwise = triangle::doubled_area([a, b, c]) > 0;
        let front = is_clockwise != state.front_ccw;
        let culled = match state.cull {
            Cull::None => false,
            Cull::Front => front,
            Cull::Back => !front,
        };
        if culled {
            continue;
        }
        if let Some(shape) = triangle::shape([a, b, c]) {
            let shape = shape.widened(freedom(vertices, &corners));
            let mut prim = whole.prim(shape, Corners::Triangle(corners), front);
            if let Some((place, number)) = before
                && number + 1 == part
                && let Some(known) = list.get_mut(place)
                && known.front == front
            {
                known.inner |= to_hub(is_clockwise)[1];
                prim.inner |= to_hub(is_clockwise)[0];
            }
            before = Some((list.len(), part));
            list.push(prim);
        }
    }
}

/// The edges of a part's shape from the hub to its second corner and to its third, a bit each: a shape runs clockwise.
fn to_hub(is_clockwise: bool) -> [u8; 2] {
    if is_clockwise { [0b001, 0b100] } else { [0b100, 0b001] }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provoking(primitive: Primitive, count: u32, last: bool) -> Vec<u32> {
        assemble(primitive, count).into_iter().map(|assembled| assembled.provoking(last)).collect()
    }

    #[test]
    fn table_2_12() {
        // Vertex indices from 0: first-vertex convention, then last-vertex convention.
        let rows: [(Primitive, u32, &[u32], &[u32]); 11] = [
            (Primitive::Points, 3, &[0, 1, 2], &[0, 1, 2]),
            (Primitive::Lines, 5, &[0, 2], &[1, 3]),
            (Primitive::LineStrip, 3, &[0, 1], &[1, 2]),
            (Primitive::LineLoop, 3, &[0, 1, 2], &[1, 2, 0]),
            (Primitive::Triangles, 7, &[0, 3], &[2, 5]),
            (Primitive::TriangleStrip, 5, &[0, 1, 2], &[2, 3, 4]),
            (Primitive::TriangleFan, 5, &[1, 2, 3], &[2, 3, 4]),
            (Primitive::LinesAdjacency, 9, &[1, 5], &[2, 6]),
            (Primitive::LineStripAdjacency, 5, &[1, 2], &[2, 3]),
            (Primitive::TrianglesAdjacency, 12, &[0, 6], &[4, 10]),
            (Primitive::TriangleStripAdjacency, 10, &[0, 2, 4], &[4, 6, 8]),
        ];
        for (primitive, count, first, last) in rows {
            assert_eq!(provoking(primitive, count, false), first, "{primitive:?}");
            assert_eq!(provoking(primitive, count, true), last, "{primitive:?}");
        }
    }

    #[test]
    fn strips_keep_their_winding() {
        let corners: Vec<_> = assemble(Primitive::TriangleStrip, 5)
            .into_iter()
            .filter_map(|assembled| match assembled {
                Assembled::Triangle(corners, _) => Some(corners),
                _ => None,
            })
            .collect();
        assert_eq!(corners, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    }
}
