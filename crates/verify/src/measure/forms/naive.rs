//! Closed forms of the naive transcriptions, for ordinary inputs only. The stiff cases show what they return
//! elsewhere.

use super::geometry::{barycentric, interpolated, segment};
use super::{Form, InputKind, cosine_power, cross, dot, forms, half, norm, surroundings};
use crate::measure::vector::{add, mul, scale, sub};
use crate::measure::{Answer, Args};
use std::f64::consts::PI;

/// A power of a cosine as in the literal equation: the exponent multiplies the rounding of the cosine.
fn literal(answer: Option<Answer>, k: f64) -> Option<Answer> {
    answer.map(|answer| Answer { condition: answer.condition + 2.0 * k.max(1.0), ..answer })
}

fn phong(a: &Args<'_>, unlimited: bool) -> Option<Answer> {
    let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
    let r = sub(scale(2.0 * dot(n, l), n), l);
    (k > 0.0 && (!unlimited || dot(r, v) > 0.0)).then(|| literal(cosine_power(r, v, k, 4.0), k))?
}

fn blinn(a: &Args<'_>, unlimited: bool) -> Option<Answer> {
    let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
    let (h, blur) = half(l, v)?;
    (k > 0.0 && (!unlimited || dot(n, h) > 0.0)).then(|| literal(cosine_power(n, h, k, blur), k * blur))?
}

/// The part of the light that a white rough surface returns after one reflection, by the angle: mu tan^2 and so on without 0/0.
fn eon_albedo(mu: f64, r: f64) -> f64 {
    let s = ((1.0 - mu) * (1.0 + mu)).sqrt();
    let g = s * (s.atan2(mu) - s * mu) + 2.0 / 3.0 * (s * mu * (1.0 + s + s * s) / (1.0 + s) - s);
    (1.0 + r * g / PI) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r)
}

/// Listing 1 of EON, where both directions are well above the surface.
fn eon(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, rho, r) = (a.d(), a.d(), a.d(), a.v(), a.f());
    let (nl, nv) = (dot(n, l), dot(n, v));
    if nl < 1e-3 || nv < 1e-3 || nl >= 1.0 || nv >= 1.0 {
        return None;
    }
    let between = dot(l, v) - nl * nv;
    let term = if between > 0.0 { between / nl.max(nv) } else { between };
    let af = 1.0 / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r);
    let mean = af * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * r);
    let tiny = f64::from(1e-7_f32);
    let lost = (1.0 - eon_albedo(nv, r)).max(tiny) * (1.0 - eon_albedo(nl, r)).max(tiny) / (1.0 - mean).max(tiny);
    let value =
        rho.map(|rho| nl * (rho * af * (1.0 + r * term) + rho * rho * mean / (1.0 - rho * (1.0 - mean)) * lost));
    // Few digits are left of 1 - E for a nearly smooth surface.
    Some(Answer::new(value, 1.0).conditioned((64.0 + 64.0 / nv.min(nl)) / (r + 1e-7)))
}

/// A dielectric over a body that gets all of the light.
fn plastic(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, body, f0, alpha) = (a.d(), a.d(), a.d(), a.v(), a.f(), a.f());
    let (h, blur) = half(l, v)?;
    let (nl, nv, sine) = (dot(n, l), dot(n, v), norm(cross(n, h)));
    if nl < 1e-3 || nv < 1e-3 {
        return None;
    }
    let a2 = alpha * alpha;
    let smith = |cos: f64| (a2 + (1.0 - a2) * cos * cos).sqrt();
    let q = sine * sine * (1.0 - a2) + a2;
    let mirrored = f0 + (1.0 - f0) * (1.0 - dot(v, h)).powi(5);
    let gloss = mirrored * a2 / (q * q) * 0.5 / (nl * smith(nv) + nv * smith(nl)).max(1e-6);
    let value = body.map(|body| nl * (body + gloss));
    // 1 - (N.H)^2 has lost what is below its rounding.
    Some(Answer::new(value, 1.0).conditioned(16.0 + gloss * nl * (64.0 + 64.0 * blur / q)))
}

/// Fibers that return the same part of the light at any roughness.
fn velvet(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, alpha) = (a.d(), a.d(), a.d(), a.f());
    let (h, blur) = half(l, v)?;
    let (nl, nv, sine) = (dot(n, l), dot(n, v), norm(cross(n, h)));
    if nl < 1e-3 || nv < 1e-3 {
        return None;
    }
    let sine2 = (sine * sine).max(1.0 / 128.0);
    let density = (2.0 + 1.0 / alpha) * sine2.powf(0.5 / alpha) / 2.0;
    let seen = (0.25 / (nl + nv - nl * nv)).min(1.0);
    let condition = 16.0 + density * nl * (16.0 + 16.0 * blur / (alpha * sine2));
    Some(Answer::new([nl * (1.0 - f64::from(0.157_f32) + density * seen)], 1.0).conditioned(condition))
}

pub(super) static FORMS: &[Form] = forms! {
    "naive" "naiveOctahedron(vec3)" [Direction] |a| Some(surroundings::octahedron(a.d()));
    "naive" "naiveLambertUnclamped(vec3,vec3,vec3,vec3)" [Direction, Direction, Color, Intensity]
        |a| Some(Answer::new(scale(dot(a.d(), a.d()), mul(a.v(), a.v())), 4.0));
    "naive" "naiveLambert(vec3,vec3,vec3,vec3)" [Direction, Direction, Color, Intensity]
        |a| Some(Answer::new(scale(dot(a.d(), a.d()).max(0.0), mul(a.v(), a.v())), 4.0));
    "naive" "naiveMirror(vec3,vec3)" [Direction, Direction] |a| {
        let (n, l) = (a.d(), a.d());
        Some(Answer::new(sub(scale(2.0 * dot(n, l), n), l), 1.0))
    };
    "naive" "naivePhongUnclamped(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| phong(a, true);
    "naive" "naivePhong(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| phong(a, false);
    "naive" "naiveHalf(vec3,vec3)" [Direction, Direction] |a| {
        let (h, blur) = half(a.d(), a.d())?;
        Some(Answer::new(h, 1.0).conditioned(blur))
    };
    "naive" "naiveBlinnPhongUnclamped(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| blinn(a, true);
    "naive" "naiveBlinnPhong(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| blinn(a, false);
    "naive" "naivePower(float,float)" [Unit, Exponent] |a| {
        let (c, k) = (a.f(), a.f());
        (k > 0.0).then(|| Answer::new([c.powf(k)], 1.0))
    };
    "naive" "naiveSchlick(float,float)" [Unit, Exponent] |a| {
        let (t, k) = (a.f(), a.f());
        (t > 0.0).then(|| Answer::new([t / (k * (1.0 - t) + t)], 1.0).conditioned(1.0 + k))
    };
    "naive" "naiveThreshold(float,float)" [Unit, Unit] |a| {
        let (c, t) = (a.f(), a.f());
        (c != 0.0 && t != 1.0).then(|| Answer::new([f64::from(u8::from(c > t))], 1.0))
    };
    "naive" "naiveDistance(vec3,vec3)" [Point, Point] |a| Some(Answer::relative([norm(sub(a.v(), a.v()))]));
    "naive" "naiveInverseSquare(float)" [Distance] |a| Some(Answer::relative([a.f().powi(-2)]));
    "naive" "naiveAttenuation(float,vec3)" [Distance, Weights] |a| {
        let (r, s) = (a.f(), a.v());
        Some(Answer::relative([1.0 / dot(s, [1.0, r, r * r])]))
    };
    "naive" "naiveSpot(vec3,vec3,float)" [Opposed, Exponent] |a| {
        let (l, axis, k) = (a.d(), a.d(), a.f());
        (k > 0.0).then(|| literal(cosine_power(scale(-1.0, l), axis, k, 2.0), k))?
    };
    "naive" "naiveBarycentric(vec2,vec2,vec2,vec2)" [Two, Two, Two, Two] barycentric;
    "naive" "naiveSegment(float,vec2,vec2)" [Unit, SegmentEnd, SegmentEnd]
        |a| Some(segment(a.f(), a.v2(), a.v2()).conditioned(4.0));
    "naive" "naivePerspective(vec2,vec3,vec4,vec4,vec4)" [Barycentric, Depths, Four, Four, Four] interpolated;
    "naive" "naiveHemisphere(vec3,vec3,vec3,vec3)" [Direction, Direction, Intensity, Intensity] |a| {
        let (cos, sky, ground) = (dot(a.d(), a.d()), a.v(), a.v());
        Some(Answer::new(add(scale(0.5 + 0.5 * cos, sky), scale(0.5 - 0.5 * cos, ground)), 4.0))
    };
    "naive" "naiveEdge(vec3,vec3)" [Near] |a| {
        let (a, b) = (a.d(), a.d());
        let (sine, cosine) = (norm(cross(a, b)), dot(a, b));
        // An arc cosine of 1 minus rounding has half of its digits, or no value.
        (sine > 1e-7).then(|| Answer::new([sine.atan2(cosine) * cross(a, b)[2] / sine], 1.0).conditioned(8.0 + 16.0 / sine))
    };
    "naive" "naiveEonExact(float,float)" [Unit, Unit] |a| {
        let (mu, r) = (a.f(), a.f());
        (mu > 0.0).then(|| Answer::new([eon_albedo(mu, r)], 1.0).conditioned(16.0 + 8.0 / mu))
    };
    "naive" "naiveEon(vec3,vec3,vec3,vec3,float)" [Lighting, Color, Unit] eon;
    "naive" "naivePlastic(vec3,vec3,vec3,vec3,float,float)" [Lighting, Color, Unit, Alpha] plastic;
    "naive" "naiveSheen(vec3,vec3,vec3,float)" [Lighting, Alpha] velvet;
    "naive" "naiveHalfRange(vec3,vec3)" [Direction, Direction] |a| Some(Answer::new([0.5 + dot(a.d(), a.d()) / 2.0], 1.0));
};
