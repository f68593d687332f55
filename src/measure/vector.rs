//! Vectors of three f64, with the operations that the closed forms need.

/// A vector.
pub(super) type V = [f64; 3];

pub(super) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn mul(a: V, b: V) -> V {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

pub(super) fn scale(s: f64, a: V) -> V {
    a.map(|x| s * x)
}

pub(super) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(super) fn norm(a: V) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The vector normalized; zero remains zero.
pub(super) fn unit(a: V) -> V {
    let length = norm(a);
    if length > 0.0 { a.map(|x| x / length) } else { a }
}
