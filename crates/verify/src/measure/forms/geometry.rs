//! Closed forms of normals, outlines and interpolation: §10.2, and the article's `edge`.

use super::{Form, InputKind, dot, forms, norm};
use crate::measure::vector::{V, add, scale, unit};
use crate::measure::{Answer, Args};

/// The inverse of a matrix of three columns by elimination with pivots, and how much its rounding is amplified;
/// `None` near singular.
fn inverse(columns: [V; 3]) -> Option<([V; 3], f64)> {
    let mut rows: [[f64; 6]; 3] = [[0.0; 6]; 3];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, column) in columns.iter().enumerate() {
            row[j] = column[i];
        }
        row[3 + i] = 1.0;
    }
    for step in 0..3 {
        let best = (step..3).max_by(|a, b| rows[*a][step].abs().total_cmp(&rows[*b][step].abs()))?;
        rows.swap(step, best);
        let pivot = rows[step];
        if pivot[step].abs() < 1e-3 {
            return None;
        }
        let pivot = pivot.map(|x| x / pivot[step]);
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = row[step];
            if i == step {
                *row = pivot;
            } else {
                row.iter_mut().zip(pivot).for_each(|(x, p)| *x -= factor * p);
            }
        }
    }
    // The rows of the inverse, which are the columns of its transpose.
    let inverse = rows.map(|row| [row[3], row[4], row[5]]);
    let size = |m: [V; 3]| m.iter().map(|v| dot(*v, *v)).sum::<f64>().sqrt();
    Some((inverse, size(inverse) * size(columns)))
}

fn normal_matrix(a: &Args<'_>) -> Option<Answer> {
    let columns = [a.v4(), a.v4(), a.v4(), a.v4()].map(|[x, y, z, _]| [x, y, z]);
    let (transposed, condition) = inverse([columns[0], columns[1], columns[2]])?;
    let values: Vec<f64> = transposed.into_iter().flatten().collect();
    Some(Answer { projective: true, ..Answer::new(values, 1.0).conditioned(condition) })
}

fn transformed(a: &Args<'_>) -> Option<Answer> {
    let (columns, n) = ([a.v(), a.v(), a.v()], a.v());
    let moved = add(add(scale(n[0], columns[0]), scale(n[1], columns[1])), scale(n[2], columns[2]));
    let size: f64 = columns.iter().map(|column| norm(*column)).sum();
    let condition = size * norm(n) / norm(moved);
    (condition < 1e9).then(|| Answer::new(unit(moved), 1.0).conditioned(condition))
}

fn outline_direction(a: &Args<'_>) -> Option<Answer> {
    let ([x, y, _, w], [nx, ny, _, nw]) = (a.v4(), a.v4());
    // The derivative of x / w along n, times w^2.
    let along = |p: f64, n: f64| (n - p / w * nw) * w;
    Some(Answer::new([along(x, nx), along(y, ny), 0.0], 50.0))
}

fn outline(a: &Args<'_>) -> Option<Answer> {
    let (position, direction, width, push) = (a.v4(), a.v(), a.f(), a.f());
    Some(Answer::new(moved(position, direction, [width, push, 1.0]), 20.0))
}

fn outline_on_any_picture(a: &Args<'_>) -> Option<Answer> {
    let (position, direction, width, push, aspect) =
        (a.v4(), a.v(), a.f(), a.f(), a.f().clamp(0.5f64.powi(20), 2f64.powi(20)));
    Some(Answer::new(moved(position, direction, [width, push, aspect]), 20.0 + 20.0 / aspect))
}

/// A position moved on the screen by a width in halves of its height, and towards the viewer.
fn moved([x, y, z, w]: [f64; 4], [nx, ny, _]: V, [width, push, aspect]: V) -> [f64; 4] {
    let angle = ny.atan2(aspect * nx);
    [x + width * w * angle.cos() / aspect, y + width * w * angle.sin(), z - push * w, w]
}

fn cross2(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// (105), by the areas of the triangles with P in place of a corner.
pub(super) fn barycentric(a: &Args<'_>) -> Option<Answer> {
    let points = [a.v2(), a.v2(), a.v2(), a.v2()];
    let area = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| cross2(a, b) + cross2(b, c) + cross2(c, a);
    let [p, p0, p1, p2] = points;
    let whole = area(p0, p1, p2);
    (whole.abs() > 0.5).then(|| {
        let condition = (8.0 / whole).powi(2).max(1.0);
        Answer::new([area(p0, p, p2) / whole, area(p0, p1, p) / whole], 1.0).conditioned(condition)
    })
}

fn mean(weights: V, corners: [[f64; 4]; 3]) -> Vec<f64> {
    (0..4).map(|i| dot(weights, [corners[0][i], corners[1][i], corners[2][i]])).collect()
}

/// (108) with only one division, at the end: b_i times the other two w; and the effect of the rounding of 1 - u - v.
fn perspective(uv: [f64; 2], w: V) -> (V, f64) {
    let b = [1.0 - uv[0] - uv[1], uv[0], uv[1]];
    let q = [b[0] * w[1] * w[2], b[1] * w[2] * w[0], b[2] * w[0] * w[1]];
    let sum = q[0] + q[1] + q[2];
    (scale(1.0 / sum, q), 1.0 + w[1] * w[2] / sum)
}

/// (107), by the parameter of the point on the segment.
pub(super) fn segment(t: f64, a: [f64; 2], b: [f64; 2]) -> Answer {
    let s = t * a[1] / ((1.0 - t) * b[1] + t * a[1]);
    let value = [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
    let size = a[0].abs().max(b[0].abs()).max(a[1]).max(b[1]);
    Answer::new(value, size)
}

pub(super) fn interpolated(a: &Args<'_>) -> Option<Answer> {
    let (weights, condition) = perspective(a.v2(), a.v());
    Some(Answer::new(mean(weights, [a.v4(), a.v4(), a.v4()]), 2.0).conditioned(condition))
}

pub(super) static FORMS: &[Form] = forms! {
    "normal" "normalMatrix(mat4)" [Matrix4] normal_matrix;
    "normal" "transformNormal(mat3,vec3)" [Matrix3, Vector] transformed;
    "outline" "outlineDirection(vec4,vec4)" [Clip, Four] outline_direction;
    "outline" "outlinePosition(vec4,vec3,float,float,float)" [Clip, Point, Unit, Unit, Gain] outline_on_any_picture;
    "outline" "outlinePosition(vec4,vec3,float,float)" [Clip, Point, Unit, Unit] outline;
    "outline" "outlinePixels(float,float)" [White, Size] |a| Some(Answer::relative([a.f() / (a.f() / 2.0)]).conditioned(2.0));
    "outline" "outlineThinned(float,float,float,float)" [Distance, Gain, White, Unit] |a| {
        let (distance, width, start, least) = (a.f(), a.f(), a.f(), a.f());
        // The model's size on the screen, relative to that at the start.
        let size = (1.0 / distance.max(start)) / (1.0 / start);
        Some(Answer::relative([(width * size).max(least.min(width))]).conditioned(4.0))
    };
    "interpolation" "barycentric(vec2,vec2,vec2,vec2)" [Two, Two, Two, Two] barycentric;
    "interpolation" "interpolateLinear(vec2,vec4,vec4,vec4)" [Barycentric, Four, Four, Four] |a| {
        let [u, v] = a.v2();
        Some(Answer::new(mean([1.0 - u - v, u, v], [a.v4(), a.v4(), a.v4()]), 2.0))
    };
    "interpolation" "perspectiveWeights(vec2,vec3)" [Barycentric, Depths]
        |a| { let (weights, condition) = perspective(a.v2(), a.v()); Some(Answer::new(weights, 1.0).conditioned(condition)) };
    "interpolation" "interpolatePerspective(vec2,vec3,vec4,vec4,vec4)" [Barycentric, Depths, Four, Four, Four]
        interpolated;
    "interpolation" "segmentPoint(float,vec2,vec2)" [Unit, SegmentEnd, SegmentEnd]
        |a| Some(segment(a.f(), a.v2(), a.v2()));
};
