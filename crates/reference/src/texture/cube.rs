//! Cube maps: from direction to face and back (OpenGL 3.2 §3.8.9, table 3.21).

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
