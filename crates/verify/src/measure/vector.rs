//! Vectors of three f64, with the operations that the closed forms need.

/// A vector.
pub type V = [f64; 3];

/// The dot product.
pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The sum.
pub fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The difference.
pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(crate) fn mul(a: V, b: V) -> V {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

/// The vector times a number.
pub fn scale(s: f64, a: V) -> V {
    a.map(|x| s * x)
}

/// The cross product.
pub fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn norm(a: V) -> f64 {
    a[0].hypot(a[1]).hypot(a[2])
}

/// The vector normalized; zero remains zero.
pub fn unit(a: V) -> V {
    let length = norm(a);
    if length > 0.0 { a.map(|x| x / length) } else { a }
}
