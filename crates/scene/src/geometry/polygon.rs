//! Cuts a polygon into triangles.
//!
//! *In:* the corners of a polygon in space, convex or not. *Out:* triples of corners with its winding. *Holds:* a polygon that cannot
//! be cut by ears (it crosses itself) becomes a fan; so does one with very many corners.

use glam::{DVec2, DVec3};

/// More corners than this make a fan: cutting takes the square of their number.
const MAX_CORNERS: usize = 2048;

/// The triangles of a polygon, as numbers of its corners.
pub(super) fn triangles(corners: &[DVec3]) -> Vec<[usize; 3]> {
    let fan = || (2..corners.len()).map(|k| [0, k - 1, k]).collect();
    if corners.len() <= 3 || corners.len() > MAX_CORNERS {
        return fan();
    }
    let flat = flattened(corners);
    let n = flat.len();
    let is_convex = (0..n).all(|k| turn(flat[k], flat[(k + 1) % n], flat[(k + 2) % n]) >= 0.0);
    if is_convex { fan() } else { ears(&flat).unwrap_or_else(fan) }
}

/// The corners in the plane that shows most of the polygon, counterclockwise.
fn flattened(corners: &[DVec3]) -> Vec<DVec2> {
    let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
    // Newell's method.
    let normal: DVec3 = pairs.map(|(a, b)| a.cross(*b)).sum();
    let size = normal.abs();
    let project = |p: &DVec3| match () {
        () if size.x >= size.y && size.x >= size.z => DVec2::new(p.y, p.z) * DVec2::new(1.0, normal.x.signum()),
        () if size.y >= size.z => DVec2::new(p.z, p.x) * DVec2::new(1.0, normal.y.signum()),
        () => DVec2::new(p.x, p.y) * DVec2::new(1.0, normal.z.signum()),
    };
    corners.iter().map(project).collect()
}

fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - b)
}

/// Cuts off ears: corners whose triangle is inside of the polygon. `None` if there are none left.
fn ears(flat: &[DVec2]) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len());
    while left.len() > 3 {
        let n = left.len();
        let around = |k: usize| [left[(k + n - 1) % n], left[k], left[(k + 1) % n]];
        let ear = (0..n).find(|&k| {
            let [a, b, c] = around(k);
            let is_inside = |p: DVec2| {
                turn(flat[a], flat[b], p) >= 0.0 && turn(flat[b], flat[c], p) >= 0.0 && turn(flat[c], flat[a], p) >= 0.0
            };
            let others = left.iter().filter(|&&other| ![flat[a], flat[b], flat[c]].contains(&flat[other]));
            turn(flat[a], flat[b], flat[c]) > 0.0 && !others.clone().any(|&other| is_inside(flat[other]))
        })?;
        triangles.push(around(ear));
        left.remove(ear);
    }
    triangles.push(left.try_into().ok()?);
    Some(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(corners: &[DVec3], triangles: &[[usize; 3]]) -> f64 {
        let one = |t: &[usize; 3]| {
            let [a, b, c] = t.map(|k| corners[k]);
            assert!((b - a).cross(c - a).y <= 1e-12, "the winding is kept");
            (b - a).cross(c - a).length() / 2.0
        };
        triangles.iter().map(one).sum()
    }

    #[test]
    fn a_concave_polygon_is_cut_inside_of_itself() {
        // An L of area 3, clockwise as seen from above.
        let points = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
        for first in 0..points.len() {
            let corners: Vec<DVec3> =
                (0..6).map(|k| points[(first + k) % 6]).map(|(x, z)| DVec3::new(x, 5.0, z)).collect();
            let triangles = triangles(&corners);
            assert_eq!(triangles.len(), 4);
            assert!((area(&corners, &triangles) - 3.0).abs() < 1e-12, "from {first}: {triangles:?}");
        }
    }

    #[test]
    fn a_convex_polygon_is_a_fan_and_a_crossed_one_does_not_hang() {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
        assert_eq!(triangles(&square), [[0, 1, 2], [0, 2, 3]]);
        let crossed = [square[0], square[2], square[1], square[3]];
        assert_eq!(triangles(&crossed).len(), 2);
        assert_eq!(triangles(&[DVec3::ZERO; 6]).len(), 4);
    }
}
