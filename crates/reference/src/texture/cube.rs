//! Cube maps: from direction to face and back (OpenGL 3.2 §3.8.9, table 3.21).

use super::BoundedFloat;

/// A face, and the table's s_c, t_c and m_a for a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OnFace {
    /// +X -X +Y -Y +Z -Z
    pub(super) face: usize,
    pub(super) sc: f64,
    pub(super) tc: f64,
    /// The absolute value.
    pub(super) ma: f64,
}

/// The linear forms of the table for a face: (s_c, t_c, m_a) of a vector.
pub(super) fn forms(face: usize, r: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = r;
    match face {
        0 => [-z, -y, x],
        1 => [z, -y, -x],
        2 => [x, z, y],
        3 => [x, -z, -y],
        4 => [x, -y, z],
        _ => [-x, -y, -z],
    }
}

/// The face that a direction hits: that of its longest axis, where z precedes y, and y precedes x, if they are equal.
pub(super) fn face_of(r: [f64; 3]) -> OnFace {
    let [x, y, z] = r.map(f64::abs);
    let axis = if z >= x && z >= y {
        2
    } else if y >= x {
        1
    } else {
        0
    };
    let face = axis * 2 + usize::from(r[axis].is_sign_negative());
    let [sc, tc, ma] = forms(face, r);
    OnFace { face, sc, tc, ma: ma.abs() }
}

/// The part of a face that a direction within intervals may hit: intervals of s_c / m_a and t_c / m_a.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Region {
    pub(super) face: usize,
    pub(super) sc: (f64, f64),
    pub(super) tc: (f64, f64),
}

/// The forms of a face over intervals, each as its least and largest number.
fn forms_between(face: usize, r: [BoundedFloat; 3]) -> [(f64, f64); 3] {
    let (low, high) = (forms(face, r.map(|at| at.low)), forms(face, r.map(|at| at.high)));
    std::array::from_fn(|k| (low[k].min(high[k]), low[k].max(high[k])))
}

/// The quotients of an interval by a positive one.
fn quotients((low, high): (f64, f64), (least, most): (f64, f64)) -> (f64, f64) {
    let (least, most) = (least.max(0.0), most.max(0.0));
    let (low, high) = (low / if low < 0.0 { least } else { most }, high / if high < 0.0 { most } else { least });
    (if low.is_nan() { f64::NEG_INFINITY } else { low }, if high.is_nan() { f64::INFINITY } else { high })
}

/// The part of a face that a direction within intervals may hit; none if another axis is always longer.
pub(super) fn region(face: usize, r: [BoundedFloat; 3]) -> Option<Region> {
    let [sc, tc, ma] = forms_between(face, r);
    let least = |(low, high): (f64, f64)| low.max(-high).max(0.0);
    let longest = least(sc).max(least(tc));
    if ma.1 < longest || ma.1 <= 0.0 {
        return None;
    }
    let ma = (ma.0.max(longest), ma.1);
    let on_face = |(low, high): (f64, f64)| (low.clamp(-1.0, 1.0), high.clamp(-1.0, 1.0));
    Some(Region { face, sc: on_face(quotients(sc, ma)), tc: on_face(quotients(tc, ma)) })
}

/// The intervals of s_c / m_a and t_c / m_a on the plane of a face, also beyond the face's edges.
pub(super) fn on_plane(face: usize, r: [BoundedFloat; 3]) -> [(f64, f64); 2] {
    let [sc, tc, ma] = forms_between(face, r);
    [quotients(sc, ma), quotients(tc, ma)]
}

/// The direction to a point of a face's plane at distance 1.
fn direction(face: usize, sc: f64, tc: f64) -> [f64; 3] {
    match face {
        0 => [1.0, -tc, -sc],
        1 => [-1.0, -tc, sc],
        2 => [sc, 1.0, tc],
        3 => [sc, -1.0, -tc],
        4 => [sc, -tc, 1.0],
        _ => [-sc, -tc, -1.0],
    }
}

/// The texel at (x, y) of a face of `size` texels. If one coordinate is one past an edge, it belongs to the
/// neighboring face. `None` past a corner, where there is no texel.
pub(super) fn across(face: usize, x: i64, y: i64, size: u32) -> Option<(usize, i64, i64)> {
    let n = i64::from(size);
    let (out_x, out_y) = (x < 0 || x >= n, y < 0 || y >= n);
    if out_x && out_y {
        return None;
    }
    if !out_x && !out_y {
        return Some((face, x, y));
    }
    let coordinate = |k: i64| (2.0 * k as f64 + 1.0) / n as f64 - 1.0;
    let there = face_of(direction(face, coordinate(x), coordinate(y)));
    let index = |c: f64| (((c / there.ma + 1.0) * 0.5 * n as f64).floor() as i64).clamp(0, n - 1);
    Some((there.face, index(there.sc), index(there.tc)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_and_faces_are_inverse() {
        for face in 0..6 {
            for (sc, tc) in [(0.0, 0.0), (0.5, -0.25), (-0.75, 0.5)] {
                let there = face_of(direction(face, sc, tc));
                assert_eq!((there.face, there.sc, there.tc, there.ma), (face, sc, tc, 1.0));
            }
        }
    }

    #[test]
    fn a_direction_within_intervals_hits_every_face_that_it_may() {
        let between = |low: f64, high: f64| BoundedFloat { value: (low + high) / 2.0, low, high };
        let boxes = [
            [between(0.9, 1.1), between(-0.1, 0.1), between(0.2, 0.3)],
            [between(-0.84, -0.25), between(-0.37, 0.03), between(-1.03, -0.48)],
            [between(-0.2, 0.3), between(-0.25, 0.1), between(-0.1, 0.2)],
            [between(0.5, 0.5), between(0.5, 0.5), between(0.5, 0.5)],
        ];
        for r in boxes {
            const STEPS: usize = 12;
            for place in 0..STEPS * STEPS * STEPS {
                let part = |axis: usize, k: usize| {
                    let share = (k % STEPS) as f64 / (STEPS - 1) as f64;
                    r[axis].low + share * (r[axis].high - r[axis].low)
                };
                let there = face_of([part(0, place), part(1, place / STEPS), part(2, place / STEPS / STEPS)]);
                let found = region(there.face, r).unwrap_or_else(|| panic!("{there:?} of {r:?}"));
                let inside = |c: f64, (low, high): (f64, f64)| (low - 1e-12..=high + 1e-12).contains(&(c / there.ma));
                assert!(inside(there.sc, found.sc) && inside(there.tc, found.tc), "{there:?}: {found:?}");
            }
        }
        // A narrow direction hits one face, in a narrow part.
        let regions: Vec<Region> = (0..6).filter_map(|face| region(face, boxes[0])).collect();
        assert_eq!(regions.len(), 1);
        assert!(regions[0].tc.1 - regions[0].tc.0 < 0.25, "{regions:?}");
    }

    #[test]
    fn stepping_over_an_edge_and_back_is_no_step() {
        for size in [1, 2, 5, 8] {
            for face in 0..6 {
                for k in 0..i64::from(size) {
                    let (other, x, y) = across(face, -1, k, size).expect("no corner");
                    assert_ne!(other, face);
                    let n = i64::from(size);
                    let back = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].map(|(x, y)| across(other, x, y, size));
                    let home = back.iter().flatten().any(|(f, x, y)| (*f, *x, *y) == (face, 0, k));
                    assert!(home, "size {size}, face {face}, row {k} of {n}");
                }
            }
        }
    }
}
