//! Closed forms of ambient occlusion, units of light, surfaces that dissolve, lit spheres, and the geometry of soft shadows.

use super::{Form, InputKind, cross, dot, forms, norm};
use crate::measure::vector::{V, unit};
use crate::measure::{Answer, Args, looked_up};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Jimenez et al. (7): one side of a slice, the integral of cos(x - n) |sin x| from the eye's direction to the horizon.
fn side(h: f64, n: f64) -> f64 {
    0.25 * (n.cos() - (2.0 * h - n).cos() + 2.0 * h * n.sin())
}

fn slice(a: &Args<'_>) -> Option<Answer> {
    let (low, high, n) = (a.f(), a.f(), a.f().clamp(-FRAC_PI_2, FRAC_PI_2));
    let value = side(low.clamp(n - FRAC_PI_2, 0.0), n) + side(high.clamp(0.0, n + FRAC_PI_2), n);
    Some(Answer::new([value], 1.0).conditioned(8.0))
}

fn bounced(a: &Args<'_>) -> Option<Answer> {
    let (v, color) = (a.f(), a.v());
    let value = |k: f64| {
        let c = f64::from;
        let (x, y, z) =
            (c(2.0404_f32) * k - c(0.3324_f32), c(-4.7951_f32) * k + c(0.6417_f32), c(2.7552_f32) * k + c(0.6903_f32));
        v.max(x * v.powi(3) + y * v * v + z * v)
    };
    Some(Answer::new(color.map(value), 1.0).conditioned(32.0))
}

/// The angle from the axis over half of a turn.
fn angle(l: V, axis: V) -> f64 {
    let back = l.map(|x| -x);
    norm(cross(back, axis)).atan2(dot(back, axis)) / PI
}

fn lit_sphere(a: &Args<'_>) -> Option<Answer> {
    let (n, v) = (a.d(), a.d());
    let flat = v[0].hypot(v[2]);
    let x = unit([v[2], 0.0, -v[0]]);
    let place = [dot(x, n), dot(cross(v, x), n)].map(|s| 0.5 + 0.495 * s);
    (flat > 1e-4).then(|| Answer::new(place, 1.0).conditioned(8.0 / flat))
}

/// Vogel's spiral: the root of the index outwards, the golden angle around.
pub(super) fn spiral(index: f64, count: f64, turn: f64) -> [f64; 2] {
    let golden = (index as u32).wrapping_mul(1_640_531_527) >> 8;
    let radius = ((index + 0.5) / count).min(1.0).sqrt();
    let (sin, cos) = (TAU * (f64::from(golden) / 16_777_216.0 + turn)).sin_cos();
    [radius * cos, radius * sin]
}

fn cascade(a: &Args<'_>) -> Option<Answer> {
    let (depth, ends, share) = (a.f(), a.v4(), a.f().max(1.0 / 1024.0));
    let mut start = 0.0;
    for (index, end) in ends.into_iter().enumerate() {
        if depth < end {
            let t = (depth - start) / (end - start);
            let condition = 8.0 + 8.0 * depth / (end - start) / share;
            return Some(
                Answer::new([index as f64 + ((t - 1.0 + share) / share).clamp(0.0, 1.0)], 1.0).conditioned(condition),
            );
        }
        start = end;
    }
    Some(Answer::new([4.0], 1.0))
}

pub(super) static FORMS: &[Form] = forms! {
    "ao" "aoSlice(float,float,float)" [Signed, Signed, Signed] slice;
    "ao" "aoBounced(float,vec3)" [Unit, Color] bounced;
    "ao" "aoSpecular(float,float,float)" [Unit, Unit, Unit] |a| {
        let (cosine, v, roughness) = (a.f(), a.f(), a.f());
        let (x, power) = (cosine + v, (-16.0 * roughness - 1.0).exp2());
        let value = if x > 0.0 { (x.powf(power) - 1.0 + v).clamp(0.0, 1.0) } else { 0.0 };
        let slope = if x > 0.0 { power * x.powf(power) * (1.0 + x.ln().abs()) } else { 0.0 };
        Some(Answer::new([value], 1.0).conditioned(8.0 + 16.0 * slope))
    };
    "photometry" "photometryPoint(float)" [Distance] |a| Some(Answer::relative([a.f() / (4.0 * PI)]).conditioned(2.0));
    "photometry" "photometrySpot(float,float)" [Distance, Unit] |a| {
        let (lumen, spread) = (a.f(), a.f().max((-20.0f64).exp2()));
        Some(Answer::relative([lumen / (TAU * spread)]).conditioned(4.0))
    };
    "photometry" "photometryArea(float,float)" [White, White]
        |a| Some(Answer::relative([a.f() / (PI * a.f())]).conditioned(4.0));
    "photometry" "photometryLux(float,float,float)" [White, Unit, White] |a| {
        let (candela, cosine, r) = (a.f(), a.f(), a.f());
        Some(Answer::relative([candela * cosine / (r * r)]).conditioned(4.0))
    };
    "photometry" "photometryNits(float)" [Stops]
        |a| { let ev = a.f(); Some(Answer::relative([2.0_f64.powf(ev) * 12.5 / 100.0]).conditioned(4.0 + ev.abs())) };
    "photometry" "photometryExposure(float)" [Stops]
        |a| { let ev = a.f(); Some(Answer::relative([1.0 / (1.2 * 2.0_f64.powf(ev))]).conditioned(4.0 + ev.abs())) };
    "photometry" "photometryAngle(vec3,vec3)" [Opposed] |a| Some(Answer::new([angle(a.d(), a.d())], 1.0).conditioned(4.0));
    "photometry" "photometryProfile(sampler2D,vec3,vec3)" [Opposed]
        |a| Some(Answer::new(looked_up(angle(a.d(), a.d())), 1.0).conditioned(32.0));
    "dissolve" "dissolveKept(float,float,float)" [Unit, Unit, Width] |a| {
        let (x, t, width) = (a.f(), a.f(), a.f());
        let off = x - t;
        if width <= 0.0 {
            let value = if off > 0.0 { 1.0 } else if off < 0.0 { 0.0 } else { 0.5 };
            return Some(Answer::new([value], 1.0).jumping(if off == 0.0 { f64::INFINITY } else { off.abs() }));
        }
        Some(Answer::new([(off / width + 0.5).clamp(0.0, 1.0)], 1.0).conditioned(4.0 + 4.0 / width))
    };
    "dissolve" "dissolveGlow(float,float,float)" [Unit, Unit, Unit] |a| {
        let (x, t, width) = (a.f(), a.f(), a.f().max((-20.0f64).exp2()));
        let off = ((x - t) / width).clamp(0.0, 1.0);
        Some(Answer::new([(1.0 - off).powi(2)], 1.0).conditioned(8.0 + 8.0 / width))
    };
    "matcap" "matcapCoordinate(vec3,vec3)" [Direction, Direction] lit_sphere;
    "shadow" "shadowTap(int,int,float)" [Octaves, Octaves, Signed]
        |a| Some(Answer::new(spiral(a.f().trunc(), a.f().trunc(), a.f()), 1.0).conditioned(16.0));
    "shadow" "shadowPenumbra(float,float,float)" [White, White, Gain] |a| {
        let (receiver, blocker, size) = (a.f(), a.f(), a.f());
        Some(Answer::new([(receiver - blocker).max(0.0) / blocker * size], 1.0).conditioned(4.0 + 8.0 * receiver / blocker * size))
    };
    "shadow" "shadowSplit(float,float,float,float)" [White, White, Unit, Unit] |a| {
        let (near, far, x, blend) = (a.f(), a.f(), a.f(), a.f());
        let far = far.max(near);
        let value = blend * near * (far / near).powf(x) + (1.0 - blend) * (near + x * (far - near));
        Some(Answer::relative([value]).conditioned(16.0))
    };
    "shadow" "shadowCascade(float,vec4,float)" [White, Ends, Unit] cascade;
};
