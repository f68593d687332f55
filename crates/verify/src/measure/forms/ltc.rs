//! Closed forms of lights with corners under a matrix: the polygon is cut at the horizon by Sutherland and Hodgman, and its edges summed
//! as Lambert did, by arcs.

use super::{Form, InputKind, cross, dot, forms, norm};
use crate::measure::vector::{V, add, scale, sub, unit};
use crate::measure::{Answer, Args, looked_up};
use std::f64::consts::{PI, TAU};

/// A matrix by columns.
type Matrix = [V; 3];

fn times(m: Matrix, v: V) -> V {
    add(add(scale(v[0], m[0]), scale(v[1], m[1])), scale(v[2], m[2]))
}

/// The arc between two directions times the height of the normal of its plane.
fn arc(a: V, b: V) -> f64 {
    let across = cross(a, b);
    let length = norm(across);
    if length > 0.0 { length.atan2(dot(a, b)) * across[2] / length } else { 0.0 }
}

/// The parts of a polygon's edges above the horizon, in order.
fn above(corners: &[V]) -> Vec<[V; 2]> {
    let mut kept = Vec::new();
    for (at, b) in corners.iter().enumerate() {
        let a = corners[(at + corners.len() - 1) % corners.len()];
        let meets = add(a, scale(a[2] / (a[2] - b[2]), sub(*b, a)));
        let meets = [meets[0], meets[1], 0.0];
        match (a[2] > 0.0, b[2] > 0.0) {
            (true, true) => kept.push([a, *b]),
            (true, false) => kept.push([a, meets]),
            (false, true) => kept.push([meets, *b]),
            (false, false) => {}
        }
    }
    kept
}

/// The edges above the horizon, and between the last and the first of these the horizon.
fn polygon(corners: &[V], turn: f64) -> f64 {
    let kept = above(&corners.iter().map(|corner| unit(*corner)).collect::<Vec<_>>());
    let edges: f64 = kept.iter().map(|[a, b]| arc(*a, *b)).sum();
    let open = |at: &usize| {
        let [leaves, enters] = [kept[*at][1], kept[(at + 1) % kept.len()][0]];
        leaves[2] == 0.0 && enters[2] == 0.0
    };
    let cut = (0..kept.len()).find(open).map_or(0.0, |at| {
        let [leaves, enters] = [kept[at][1], kept[(at + 1) % kept.len()][0]];
        norm(cross(leaves, enters)).atan2(dot(leaves, enters))
    });
    ((edges + if turn > 0.0 { cut } else { -cut }).abs() / TAU).min(1.0)
}

fn turn(a: V, b: V, c: V) -> f64 {
    dot(a, cross(b, c))
}

fn parallelogram(m: Matrix, center: V, x: V, y: V) -> f64 {
    let corner = |i: f64, j: f64| times(m, add(center, add(scale(i, x), scale(j, y))));
    polygon(&[corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)], turn(center, x, y))
}

/// Sixteen corners, further out by what makes their area that of the ellipse.
fn ellipse(m: Matrix, center: V, x: V, y: V) -> f64 {
    let out = (PI / 8.0 / (PI / 8.0).sin()).sqrt();
    let corner = |at: i32| {
        let (sin, cos) = (f64::from(at) * PI / 8.0).sin_cos();
        times(m, add(center, add(scale(out * cos, x), scale(out * sin, y))))
    };
    polygon(&(0..16).map(corner).collect::<Vec<_>>(), turn(center, x, y))
}

fn sphere(m: Matrix, center: V, radius: f64) -> f64 {
    let d = norm(center);
    if d <= radius {
        return 1.0;
    }
    let axis = unit(center);
    let half = (radius / d).asin();
    let x = if axis[0].abs() < 0.5 { [0.0, axis[2], -axis[1]] } else { [-axis[2], 0.0, axis[0]] };
    let x = unit(x);
    ellipse(m, axis, scale(half.tan(), x), scale(half.tan(), cross(axis, x)))
}

/// The outline of a tube: the lines of contact, and between them of each rim the arc that bounds it, in edges of the arc's area.
fn tube(m: Matrix, a: V, b: V, radius: f64) -> f64 {
    let along = unit(sub(b, a));
    let ends = [dot(along, a), dot(along, b)];
    // From the point to the axis.
    let off = sub(a, scale(ends[0], along));
    let d = norm(off);
    if radius <= 0.0 || norm(sub(b, a)) == 0.0 {
        return 0.0;
    }
    if d <= radius {
        if ends[0] <= 0.0 && ends[1] >= 0.0 {
            return 1.0;
        }
        let x = if along[0].abs() < 0.5 { [0.0, along[2], -along[1]] } else { [-along[2], 0.0, along[0]] };
        let x = scale(radius, unit(x));
        return ellipse(m, if ends[0] > 0.0 { a } else { b }, x, cross(along, x));
    }
    let up = scale(-1.0 / d, off);
    let side = cross(up, along);
    let touch = (radius / d).acos();
    let at = |height: f64, out: f64, angle: f64| {
        let rim = add(scale(angle.cos(), up), scale(angle.sin(), side));
        times(m, add(add(off, scale(height, along)), scale(out * radius, rim)))
    };
    let mut corners = Vec::new();
    for (end, way) in [(ends[0], 1.0), (ends[1], -1.0)] {
        let is_seen = way * end > 0.0;
        let (edges, whole) = if is_seen { (8, -(TAU - 2.0 * touch)) } else { (4, 2.0 * touch) };
        let step = whole / f64::from(edges);
        // Two triangles at the lines of contact, and the others between the corners that are pushed out.
        let inner = f64::from(edges - 2);
        let out = ((1.0 + inner * f64::from(edges) * step / step.sin()).sqrt() - 1.0) / inner;
        for at_edge in 0..=edges {
            let out = if at_edge == 0 || at_edge == edges { 1.0 } else { out };
            corners.push(at(end, out, way * (f64::from(at_edge) * step - touch)));
        }
        corners.push(at(ends[0].max(0.0).min(ends[1]), 1.0, way * touch));
    }
    polygon(&corners, 1.0)
}

/// A value with a condition number by moving its arguments.
pub(super) fn moved(a: &Args<'_>, value: impl Fn(&Args<'_>) -> f64) -> Option<Answer> {
    const STEP: f64 = 1e-7;
    let found = value(a);
    let slope = (0..6_usize).fold(0.0, |most: f64, turn| {
        let by = |at: usize| if (at * (turn + 3) + at / 3 + turn).is_multiple_of(3) { 1.0 - STEP } else { 1.0 + STEP };
        let numbers: Vec<f64> = a.numbers.iter().enumerate().map(|(at, number)| number * by(at)).collect();
        most.max((value(&Args::of(&numbers)) - found).abs() / STEP)
    });
    Some(Answer::new([found], 1.0).conditioned(16.0 + 16.0 * slope))
}

fn matrix(a: &Args<'_>) -> Matrix {
    [a.v(), a.v(), a.v()]
}

/// The rows of the frame, and how uncertain it is; `None` for an eye straight above.
fn frame(n: V, v: V) -> Option<(Matrix, f64)> {
    let across = cross(n, v);
    let sine = norm(across);
    let y = unit(across);
    (sine > 1e-4).then(|| ([cross(y, n), y, n], 8.0 / sine))
}

/// sqrt(1 - cos) of the angle between two unit vectors.
fn angle(n: V, v: V) -> f64 {
    2.0_f64.sqrt() * (0.5 * norm(cross(n, v)).atan2(dot(n, v))).sin()
}

/// The test table at the root of a cosine, and how uncertain that is near the horizon.
pub(super) fn reflected(n: V, v: V) -> (Vec<f64>, f64) {
    let cos = dot(n, v);
    let x = cos.max(0.0).sqrt();
    (looked_up(x), 64.0 + 64.0 / cos.abs().sqrt().max(1e-9))
}

pub(super) static FORMS: &[Form] = forms! {
    "ltc" "ltcFrame(vec3,vec3)" [Direction, Direction] |a| {
        let (rows, condition) = frame(a.d(), a.d())?;
        let columns: Vec<f64> = (0..9).map(|at| rows[at % 3][at / 3]).collect();
        Some(Answer::new(columns, 1.0).conditioned(condition))
    };
    "ltc" "ltcTexel(sampler2D,vec2)" [Two] |a| {
        let mut texel = looked_up(a.f());
        texel.push(1.0);
        Some(Answer::new(texel, 1.0).conditioned(32.0))
    };
    "ltc" "ltcMatrix(sampler2D,vec3,vec3,float)" [Direction, Direction, Unit] |a| {
        let (n, v) = (a.d(), a.d());
        let (rows, condition) = frame(n, v)?;
        let m = looked_up(angle(n, v));
        // The first and the last row of the matrix have two numbers, the one in the middle is 1.
        let made = [
            add(scale(m[0], rows[0]), scale(m[1], rows[2])),
            rows[1],
            add(scale(m[2], rows[0]), rows[2]),
        ];
        let columns: Vec<f64> = (0..9).map(|at| made[at % 3][at / 3]).collect();
        Some(Answer::new(columns, 1.0).conditioned(16.0 + 2.0 * condition))
    };
    "ltc" "ltcAlbedo(sampler2D,vec3,vec3,float,vec3)" [Direction, Direction, Unit, Color] |a| {
        let (n, v, _, f0) = (a.d(), a.d(), a.f(), a.v());
        let (m, condition) = reflected(n, v);
        Some(Answer::new(f0.map(|f0| f0 * m[0] + (1.0 - f0) * m[1]), 1.0).conditioned(condition))
    };
    "ltc" "ltcArc(vec3,vec3)" [Near] |a| {
        let (a, b) = (a.d(), a.d());
        let half = 0.5 * norm(cross(a, b)).atan2(dot(a, b));
        Some(Answer::new([if half > 0.0 { half / half.sin() } else { 1.0 }], 1.0).conditioned(4.0))
    };
    "ltc" "ltcTurn(vec3,vec3,vec3)" [Point, Point, Point]
        |a| Some(Answer::new([dot(cross(unit(a.v()), unit(a.v())), unit(a.v()))], 1.0).conditioned(4.0));
    "energy" "energyFactor(sampler2D,vec3,vec3,vec3,float,vec3)" [Lighting, Unit, Color] |a| {
        let (n, l, v, _, f0) = (a.d(), a.d(), a.d(), a.f(), a.v());
        let ((light, one), (eye, other)) = (reflected(n, l), reflected(n, v));
        let mean = eye[2];
        let factor = |f0: f64| {
            let f = f0 + (1.0 - f0) / 21.0;
            let many = f * f * mean / (1.0 - f + f * mean);
            many * dot(n, l).max(0.0) * (1.0 - light[0]) * (1.0 - eye[0]) / (1.0 - mean)
        };
        Some(Answer::new(f0.map(factor), 1.0).conditioned(one + other))
    };
    "energy" "energyCompensation(sampler2D,vec3,vec3,float,vec3)" [Direction, Direction, Unit, Color] |a| {
        let (n, v, _, f0) = (a.d(), a.d(), a.f(), a.v());
        let (m, condition) = reflected(n, v);
        let e = m[0].max((-10.0f64).exp2());
        Some(Answer::relative(f0.map(|f0| 1.0 + f0 * (1.0 / e - 1.0))).conditioned(condition / e))
    };
    "ltc" "ltcEdge(vec3,vec3)" [Near] |a| {
        let (a, b) = (a.d(), a.d());
        let sum = norm(add(a, b));
        (sum > 1e-6).then(|| Answer::new([arc(a, b)], 1.0).conditioned(8.0 + 16.0 / sum))
    };
    "ltc" "ltcPolygon(vec3[16],int,float)" [Corners] |a| moved(a, |a| {
        let corners: Vec<V> = (0..16).map(|_| a.v()).collect();
        let count = (a.f() as usize).clamp(3, 16);
        polygon(&corners.into_iter().take(count).collect::<Vec<_>>(), a.f())
    });
    "ltc" "ltcRectangle(mat3,vec3,vec3,vec3)" [Warp, Place, Place, Place]
        |a| moved(a, |a| parallelogram(matrix(a), a.v(), a.v(), a.v()));
    "ltc" "ltcDisk(mat3,vec3,vec3,vec3)" [Warp, Place, Place, Place]
        |a| moved(a, |a| ellipse(matrix(a), a.v(), a.v(), a.v()));
    "ltc" "ltcSphere(mat3,vec3,float)" [Warp, Point, Gain] |a| moved(a, |a| sphere(matrix(a), a.v(), a.f()));
    "ltc" "ltcTube(mat3,vec3,vec3,float)" [Warp, Place, Place, Unit] |a| moved(a, |a| tube(matrix(a), a.v(), a.v(), a.f()));
};
