//! The pixels of a bin near edges of primitives, and who may own them.
//!
//! *In:* the primitives that touch a bin. *Out:* for each of them its pixels within the band around an edge
//! ([`band`]), each with a [`Role`].
//!
//! *Holds:* an edge that two primitives share has the same snapped ends in both, on every conforming GPU, so exactly one
//! of them draws a pixel that lies near it (OpenGL 3.2 §3.6.1). A pixel is *interior* if each edge near it is shared by
//! two primitives that are near it, in opposite directions. All others are at a silhouette: there, every primitive may or
//! may not draw.

use super::assembly::{Corners, Prim};
use super::fragment_tests::Role;
use super::target::local;
use super::vertices::Vertices;
use crate::domain::Domain;
use crate::raster::band::band;
use crate::raster::{Bounds, Fixed, triangle};
use smallvec::SmallVec;

/// A fragment near an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct EdgeFragment {
    /// The index of the pixel in the bin.
    pub(super) place: u32,
    /// Whether the reference's coverage has it.
    pub(super) is_inside: bool,
    pub(super) role: Role,
    edges: u8,
}

/// The fragments near edges in a bin, primitive by primitive.
#[derive(Debug, Default)]
pub(super) struct EdgeFragments {
    fragments: Vec<EdgeFragment>,
    /// The number of fragments before each primitive of the list, and of all.
    starts: Vec<u32>,
}

impl EdgeFragments {
    /// The fragments of the primitives in `list`.
    pub(super) fn of<D: Domain>(prims: &[Prim], list: &[u32], vertices: &Vertices<D>, area: Bounds) -> Self {
        let mut fragments = Vec::new();
        let mut starts = vec![0];
        for prim in list.iter().map(|&index| prims.get(index as usize)) {
            if let Some(prim) = prim {
                band(&prim.shape, 0, area, |near| {
                    let (place, is_inside) = (local(area, near.x, near.y), near.is_inside);
                    fragments.push(EdgeFragment { place, is_inside, role: Role::Open, edges: near.edges });
                });
            }
            starts.push(fragments.len() as u32);
        }
        let mut found = Self { fragments, starts };
        found.find_owners(|number| {
            let prim = prims.get(*list.get(number)? as usize)?;
            ends(prim, vertices)
        });
        found
    }

    /// The fragments of a primitive, by its number in the list.
    pub(super) fn of_prim(&self, number: usize) -> &[EdgeFragment] {
        let range = self.starts.get(number).zip(self.starts.get(number + 1));
        range.and_then(|(&start, &end)| self.fragments.get(start as usize..end as usize)).unwrap_or(&[])
    }

    /// Finds the pixels that exactly one primitive owns, given the ends of each primitive's edges.
    fn find_owners(&mut self, ends: impl Fn(usize) -> Option<[[Fixed; 2]; 3]>) {
        let mut order: Vec<(u32, u32)> = (0..).zip(&self.fragments).map(|(index, one)| (one.place, index)).collect();
        order.sort_unstable();
        for group in order.chunk_by(|a, b| a.0 == b.0) {
            let members: SmallVec<[u32; 8]> = group.iter().map(|(_, index)| *index).collect();
            if self.is_closed(&members, &ends) {
                for index in members {
                    self.fragments[index as usize].role = Role::Owner;
                }
            }
        }
    }

    /// Whether the primitives close around the pixel: each edge has its opposite, and one of them covers the pixel.
    fn is_closed(&self, members: &[u32], ends: &impl Fn(usize) -> Option<[[Fixed; 2]; 3]>) -> bool {
        let fragments = || members.iter().map(|&index| (index, self.fragments[index as usize]));
        if members.len() < 2 || fragments().filter(|(_, one)| one.is_inside).count() != 1 {
            return false;
        }
        let mut edges: SmallVec<[[Fixed; 2]; 16]> = SmallVec::new();
        for (index, fragment) in fragments() {
            let prim = self.starts.partition_point(|start| *start <= index).saturating_sub(1);
            let Some(ends) = ends(prim) else { return false };
            edges.extend(ends.iter().enumerate().filter(|(edge, _)| fragment.edges >> edge & 1 == 1).map(|(_, e)| *e));
        }
        let count = |wanted: [Fixed; 2]| edges.iter().filter(|edge| **edge == wanted).count();
        edges.iter().all(|&[from, to]| count([from, to]) == 1 && count([to, from]) == 1)
    }
}

/// The ends of a triangle's edges, in the order and direction of its shape's.
fn ends<D: Domain>(prim: &Prim, vertices: &Vertices<D>) -> Option<[[Fixed; 2]; 3]> {
    let Corners::Triangle(corners) = prim.corners else { return None };
    let snapped = corners.map(|vertex| {
        let &[x, y, _] = vertices.window32.get(vertex as usize)?;
        Fixed::snap(x, y)
    });
    let [Some(a), Some(b), Some(c)] = snapped else { return None };
    let (b, c) = if triangle::doubled_area([a, b, c]) > 0 { (b, c) } else { (c, b) };
    Some([[a, b], [b, c], [c, a]])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: i64, y: i64) -> Fixed {
        Fixed { x, y }
    }

    /// The roles at one pixel, for primitives with these near edges of a triangle each.
    fn roles(members: &[(bool, u8, [Fixed; 3])]) -> Vec<Role> {
        let fragment = |&(is_inside, edges, _): &(bool, u8, [Fixed; 3])| EdgeFragment {
            place: 5,
            is_inside,
            role: Role::Open,
            edges,
        };
        let mut found = EdgeFragments {
            fragments: members.iter().map(fragment).collect(),
            starts: (0..=members.len() as u32).collect(),
        };
        found.find_owners(|number| {
            let [a, b, c] = members[number].2;
            Some([[a, b], [b, c], [c, a]])
        });
        (0..members.len()).map(|number| found.of_prim(number)[0].role).collect()
    }

    #[test]
    fn a_shared_edge_has_one_owner_and_a_silhouette_none() {
        let (a, b, c, d) = (at(0, 0), at(9, 0), at(9, 9), at(0, 9));
        // Two triangles of a square, near the diagonal: edge 2 of the first, edge 0 of the second.
        let upper = (true, 0b100, [a, b, c]);
        let lower = (false, 0b001, [a, c, d]);
        assert_eq!(roles(&[upper, lower]), [Role::Owner; 2]);
        assert_eq!(roles(&[upper]), [Role::Open]);
        // At the corner of the square, two edges more, which nothing shares.
        assert_eq!(roles(&[(true, 0b101, [a, b, c]), (false, 0b101, [a, c, d])]), [Role::Open; 2]);
        // The front and the back of a mesh meet in an edge of one direction.
        assert_eq!(roles(&[upper, (false, 0b001, [c, a, at(5, 0)])]), [Role::Open; 2]);
        // Two layers: both cover the pixel.
        assert_eq!(roles(&[upper, lower, upper, lower]), [Role::Open; 4]);
    }

    #[test]
    fn a_fan_is_closed_around_its_hub() {
        let (hub, rim) = (at(0, 0), [at(9, 0), at(0, 9), at(-9, 0), at(0, -9)]);
        let fan: Vec<_> = (0..4).map(|i| (i == 1, 0b101, [hub, rim[i], rim[(i + 1) % 4]])).collect();
        assert_eq!(roles(&fan), [Role::Owner; 4]);
        assert_eq!(roles(&fan[..3]), [Role::Open; 3]);
    }
}
