//! Closed forms of light from all around: the octahedron as its faces, each with its own map to the square.

use super::ltc::reflected;
use super::{Form, InputKind, dot, forms, norm};
use crate::measure::vector::{V, add, scale, sub};
use crate::measure::{Answer, Args, looked_up};

/// The place of a direction: where its ray meets the octahedron |x| + |y| + |z| = 1. The lower faces are turned over about the edges of
/// the square in the middle.
fn place(d: V) -> [f64; 2] {
    let size = d.iter().map(|x| x.abs()).sum::<f64>();
    let [x, y, z] = d.map(|x| x / size);
    let (right, front) = (if x < 0.0 { -1.0 } else { 1.0 }, if z < 0.0 { -1.0 } else { 1.0 });
    // The mirror image of (x, z) at the line right x + front z = 1.
    let out = if y < 0.0 { 2.0 * (1.0 - right * x - front * z) / 2.0 } else { 0.0 };
    [x + out * right, z + out * front].map(|at| (at + 1.0) / 2.0)
}

/// How far a direction is from where the lower faces are cut apart.
fn cut(d: V) -> f64 {
    if d[1] < 0.0 { d[0].abs().min(d[2].abs()) } else { f64::INFINITY }
}

/// The place of a direction, on the scale of the square.
pub(super) fn octahedron(d: V) -> Answer {
    Answer::new(place(d), 1.0).conditioned(8.0).jumping(cut(d))
}

/// The test table at a direction. It has one row, so that it has one roughness and no second coordinate.
fn radiance(d: V) -> Vec<f64> {
    looked_up(place(d)[0])
}

/// Between the normal and the direction that mirrors the eye.
fn dominant(n: V, v: V, roughness: f64) -> V {
    let alpha = roughness * roughness;
    let share = (1.0 - alpha).powf(1.5) + alpha * (1.0 - alpha);
    let mirror = sub(scale(2.0 * dot(n, v), n), v);
    add(n, scale(share, sub(mirror, n)))
}

fn specular(a: &Args<'_>) -> Option<Answer> {
    let (n, v, roughness, f0) = (a.d(), a.d(), a.f(), a.v());
    let r = dominant(n, v, roughness);
    // Eyes below the surface have directions of nearly no length.
    let length = norm(r);
    if length < 1e-2 {
        return None;
    }
    let (m, condition) = reflected(n, v);
    let light = radiance(r);
    let values: Vec<f64> = f0.iter().zip(&light).map(|(f0, light)| (f0 * m[0] + (1.0 - f0) * m[1]) * light).collect();
    Some(Answer::new(values, 1.0).conditioned((256.0 + condition) / length).jumping(cut(r) / 4.0))
}

pub(super) static FORMS: &[Form] = forms! {
    "environment" "environmentPlace(vec3)" [Direction] |a| Some(octahedron(a.d()));
    "environment" "environmentTexel(sampler2D,vec2,int)" [Two, Octaves]
        |a| Some(Answer::new(looked_up(a.f()), 1.0).conditioned(32.0));
    "environment" "environmentRadiance(sampler2D,vec3,float)" [Direction, Unit] |a| {
        let d = a.d();
        Some(Answer::new(radiance(d), 1.0).conditioned(128.0).jumping(cut(d)))
    };
    "environment" "environmentDominant(vec3,vec3,float)" [Direction, Direction, Unit]
        |a| Some(Answer::new(dominant(a.d(), a.d(), a.f()), 1.0).conditioned(8.0));
    "environment" "environmentSpecular(sampler2D,sampler2D,vec3,vec3,float,vec3)" [Direction, Direction, Unit, Color] specular;
};
