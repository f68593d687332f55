//! Closed forms of rough diffuse surfaces: Oren and Nayar, EON, Burley, Lommel and Seeliger, by the angles of their papers.

use super::{Form, InputKind, dot, forms, lit, norm};
use crate::measure::vector::{V, scale, sub};
use crate::measure::{Answer, Args};
use std::f64::consts::PI;

/// The paper's polynomial, in the digits that f32 has of them.
const FIT: [f32; 4] = [0.057_108_53, 0.491_881_88, -0.332_181_45, 0.071_443];

/// The cosine of the azimuth between two directions, and the sines of their angles to the normal.
fn azimuth(n: V, l: V, v: V) -> (f64, f64, f64) {
    let (across_l, across_v) = (sub(l, scale(dot(n, l), n)), sub(v, scale(dot(n, v), n)));
    let (sin_l, sin_v) = (norm(across_l), norm(across_v));
    let both = sin_l * sin_v;
    (if both > 1e-14 { dot(across_l, across_v) / both } else { 0.0 }, sin_l, sin_v)
}

fn oren_nayar(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, sigma) = (a.d(), a.d(), a.d(), a.f());
    let (nl, nv) = (dot(n, l), dot(n, v));
    if nl.max(nv) < 1e-6 && nl > 0.0 {
        return None;
    }
    lit(n, l, || {
        let (third, nine) = (f64::from(0.33_f32), f64::from(0.09_f32));
        let (s2, b) = (sigma * sigma, f64::from(0.45_f32));
        let (big_a, big_b) = (1.0 - 0.5 * s2 / (s2 + third), b * s2 / (s2 + nine));
        // An eye below the surface counts as grazing.
        let term = term(n, l, v).max(0.0);
        Some(Answer::new([big_a * nl + big_b * term], 1.0).conditioned(uncertain(nl, nv)))
    })
}

/// cos phi sin a tan b N.L where it is positive, else cos phi sin a sin b N.L.
fn term(n: V, l: V, v: V) -> f64 {
    let (nl, nv) = (dot(n, l), dot(n, v));
    if nv < 0.0 {
        // Only the cosine between light and eye is left of it.
        return if dot(l, v) > 0.0 { dot(l, v) } else { dot(l, v) * nl };
    }
    let (cos_phi, sin_l, sin_v) = azimuth(n, l, v);
    let between = cos_phi * sin_l * sin_v;
    if between > 0.0 { between * nl / nl.max(nv) } else { between * nl }
}

/// How uncertain that is: near grazing, its two cosines decide.
fn uncertain(nl: f64, nv: f64) -> f64 {
    let most = nl.max(nv.max(0.0));
    16.0 + 4.0 * nl / (most * most)
}

fn albedo(cos: f64, r: f64) -> f64 {
    let m = 1.0 - cos;
    let g: f64 = FIT.iter().zip(1..).map(|(g, power)| f64::from(*g) * m.powi(power)).sum();
    (1.0 + r * g) / (1.0 + (0.5 - 2.0 / (3.0 * PI)) * r)
}

fn eon(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, rho, r) = (a.d(), a.d(), a.d(), a.v(), a.f());
    let (nl, nv) = (dot(n, l), dot(n, v).max(0.0));
    lit(n, l, || {
        let (c1, c2) = (0.5 - 2.0 / (3.0 * PI), 2.0 / 3.0 - 28.0 / (15.0 * PI));
        let af = 1.0 / (1.0 + c1 * r);
        let (out, inside, mean) = (albedo(nv, r), albedo(nl, r), af * (1.0 + c2 * r));
        let multiple = if r > 1e-9 { (1.0 - out).max(0.0) * (1.0 - inside).max(0.0) / (1.0 - mean) } else { 0.0 };
        let channel = |rho: f64| {
            let again = rho * rho * mean / (1.0 - rho * (1.0 - mean));
            (rho * af * (nl + r * term(n, l, v)) + again * multiple * nl).max(0.0)
        };
        Some(Answer::new(rho.map(channel), 1.0).conditioned(2.0 * uncertain(nl, nv)))
    })
}

fn burley(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, roughness) = (a.d(), a.d(), a.d(), a.f());
    lit(n, l, || {
        let nl = dot(n, l);
        let half = super::half(l, v).map_or(0.0, |(h, _)| dot(l, h));
        let f90 = 0.5 + 2.0 * roughness * half * half;
        let side = |cos: f64| 1.0 + (f90 - 1.0) * (1.0 - cos.clamp(0.0, 1.0)).powi(5);
        Some(Answer::new([nl * side(nl) * side(dot(n, v))], 1.0).conditioned(24.0))
    })
}

/// McEwen's mean of the laws of Lommel and Seeliger, and of Lambert.
fn lunar(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, s) = (a.d(), a.d(), a.d(), a.f());
    let (nl, nv) = (dot(n, l), dot(n, v).max(0.0));
    lit(n, l, || {
        let value = s * 2.0 * nl / (nl + nv) + (1.0 - s) * nl;
        // Where both graze, their difference decides.
        Some(Answer::new([value], 2.0).conditioned(8.0 + 4.0 / (nl + nv)))
    })
}

pub(super) static FORMS: &[Form] = forms! {
    "oren_nayar" "orenNayarTerm(float,float,float)" [Unit, Unit, Signed] |a| {
        let (nl, nv, lv) = (a.f(), a.f(), a.f().clamp(-1.0, 1.0));
        let s = lv - nl * nv;
        if nl == 0.0 { return Some(Answer::new([0.0], 1.0)); }
        let value = if s > 0.0 { s / (nl.max(nv) / nl) } else { s * nl };
        Some(Answer::new([value], 1.0).conditioned(4.0))
    };
    "oren_nayar" "orenNayarFactor(vec3,vec3,vec3,float)" [Lighting, Gain] oren_nayar;
    "oren_nayar" "eonSingle(float,float)" [Unit, Unit] |a| Some(Answer::new([albedo(a.f(), a.f())], 1.0).conditioned(4.0));
    "oren_nayar" "eonFactor(vec3,vec3,vec3,vec3,float)" [Lighting, Color, Unit] eon;
    "lunar" "lunarTerm(float,float)" [Unit, Unit] |a| {
        let (nl, nv) = (a.f(), a.f());
        let value = if nl > 0.0 { 2.0 * nl / (nl + nv) } else { 0.0 };
        Some(Answer::new([value], 2.0).conditioned(4.0))
    };
    "lunar" "lunarFactor(vec3,vec3,vec3,float)" [Lighting, Unit] lunar;
    "burley" "burleyFactor(vec3,vec3,vec3,float)" [Lighting, Unit] burley;
};
