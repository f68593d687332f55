//! Closed forms of lights of today: falloffs, cones, lights with a size, irradiance by spherical harmonics, variance shadows.

use super::{Form, InputKind, cross, dot, forms, norm};
use crate::measure::vector::{V, add, scale, unit};
use crate::measure::{Answer, Args};
use std::f64::consts::PI;

fn falloff(a: &Args<'_>) -> Option<Answer> {
    let (r, range) = (a.f(), a.f());
    let x = r / range;
    let window = (1.0 - x.powi(4)).max(0.0);
    let condition = 16.0 + if x < 1.0 { 8.0 / (1.0 - x) } else { 0.0 };
    Some(Answer::relative([window * window / (r * r)]).conditioned(condition))
}

fn cone(a: &Args<'_>) -> Option<Answer> {
    let (l, axis, low, high) = (a.d(), a.d(), a.f(), a.f());
    let back = scale(-1.0, l);
    let (sin, cos) = (norm(cross(back, axis)), dot(back, axis));
    // 1 - cos by half of the angle.
    let u = 2.0 * (0.5 * sin.atan2(cos)).sin().powi(2);
    if high <= low {
        return Some(Answer::new([if u <= low { 1.0 } else { 0.0 }], 1.0).jumping((u - low).abs()));
    }
    let t = ((high - u) / (high - low)).clamp(0.0, 1.0);
    Some(Answer::new([t * t], 1.0).conditioned(4.0 + 16.0 / (high - low)))
}

/// Karis: the point of a sphere nearest to a ray; the part across the ray by two products.
fn sphere(center: V, radius: f64, ray: V) -> Option<(V, f64)> {
    if norm(center) <= radius {
        return Some((ray, 4.0));
    }
    // Behind the ray's origin, that is the nearest of its points.
    let off = if dot(ray, center) > 0.0 { cross(ray, cross(ray, center)) } else { scale(-1.0, center) };
    let share = (radius / norm(off).max(f64::MIN_POSITIVE)).min(1.0);
    let point = add(center, scale(share, off));
    let length = norm(point);
    (length > 1e-3 * norm(center)).then(|| (unit(point), 16.0 * (norm(center) + 1e-6) / length))
}

fn harmonics(a: &Args<'_>) -> Option<Answer> {
    let [x, y, z] = a.d();
    let c: [V; 9] = std::array::from_fn(|_| a.v());
    let [c1, c2, c3, c4, c5] = [0.429_043_f32, 0.511_664, 0.743_125, 0.886_227, 0.247_708].map(f64::from);
    let weights = [
        c4,
        2.0 * c2 * y,
        2.0 * c2 * z,
        2.0 * c2 * x,
        2.0 * c1 * x * y,
        2.0 * c1 * y * z,
        c3 * z * z - c5,
        2.0 * c1 * x * z,
        c1 * (x * x - y * y),
    ];
    let sum = weights.iter().zip(c).fold([0.0; 3], |sum, (w, c)| add(sum, scale(*w, c)));
    Some(Answer::new(scale(1.0 / PI, sum), 2.0).conditioned(8.0))
}

fn variance(a: &Args<'_>) -> Option<Answer> {
    let ([mean, square], depth, least, cut) = (a.v2(), a.f(), a.f(), a.f());
    let m = mean.clamp(-0.5, 0.5);
    let t = depth - 0.5 - m;
    if t <= 0.0 {
        return Some(Answer::new([1.0], 1.0).jumping(t.abs()));
    }
    let (v, cut) = ((square.clamp(0.0, 1.0) - m * m).max(least), cut.min(f64::from(0.99_f32)));
    let p = if v > 0.0 { v / (v + t * t) } else { 0.0 };
    let value = ((p - cut) / (1.0 - cut)).clamp(0.0, 1.0);
    let condition = (8.0 + 2.0 * t / (v + t * t) + 1.0 / (v + t * t)) / (1.0 - cut);
    Some(Answer::new([value], 1.0).conditioned(condition).jumping(t))
}

pub(super) static FORMS: &[Form] = forms! {
    "punctual" "punctualFalloff(float,float)" [White, White] falloff;
    "punctual" "punctualCone(vec3,vec3,float,float)" [Opposed, Unit, Unit] cone;
    "area_light" "areaSphere(vec3,float,vec3)" [Point, Gain, Direction] |a| {
        let (towards, condition) = sphere(a.v(), a.f(), a.d())?;
        Some(Answer::new(towards, 1.0).conditioned(condition))
    };
    "area_light" "areaSphereFactor(vec3,vec3,float)" [Direction, Point, Gain] |a| {
        let (n, center, radius) = (a.d(), a.v(), a.f());
        let sine = (radius / norm(center)).min(1.0);
        Some(Answer::new([sine * sine * dot(n, unit(center)).max(0.0)], 1.0).conditioned(8.0))
    };
    "irradiance" "irradiance(vec3,vec3[9])" [Direction, Harmonics] harmonics;
    "shadow" "shadowMoments(float)" [Unit] |a| {
        let d = a.f() - 0.5;
        Some(Answer::new([d, d * d], 1.0))
    };
    "shadow" "shadowVariance(vec2,float,float,float)" [Two, Unit, Unit, Unit] variance;
};
