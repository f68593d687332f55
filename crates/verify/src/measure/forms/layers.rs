//! Closed forms of layers: a brush, and a film by Belcour and Barla as KHR_materials_iridescence gives them.

use super::{Form, InputKind, cross, dot, forms};
use crate::measure::vector::{V, add, norm, scale, sub, unit};
use crate::measure::{Answer, Args};
use std::f64::consts::{PI, TAU};

/// The normal of a brushed surface for its surroundings: between the eye's direction in the plane of N and T, and N.
fn bent(a: &Args<'_>) -> Option<Answer> {
    let (n, t, v, roughness, strength) = (a.d(), a.d(), a.d(), a.f(), a.f());
    let b = cross(n, t);
    let across = sub(v, scale(dot(v, b), b));
    let flat = norm(across);
    let k = (1.0 - strength * (1.0 - roughness)).powi(4);
    let mixed = add(scale(1.0 - k, unit(across)), scale(k, n));
    let length = norm(mixed);
    (flat > 1e-6 && length > 1e-6)
        .then(|| Answer::new(unit(mixed), 1.0).conditioned((8.0 + 4.0 * (1.0 - k) / flat) / length))
}

/// Amplitude, wave number per micrometer, and the factor of the square of the path, of the four normal distributions, as the module has
/// them.
static WAVES: [[f64; 3]; 4] = [
    [0.846590002, 1.6810, 0.170854696],
    [1.00022189, 1.7953, 0.367330884],
    [1.00112249, 2.2084, 0.261035245],
    [0.153868307, 2.2399, 0.178766171],
];

/// XYZ to linear RGB, by rows.
static RGB: [[f64; 3]; 3] =
    [[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560], [0.0556434, -0.2040259, 1.0572252]];

/// A number as the module has it.
fn single(number: f64) -> f64 {
    f64::from(number as f32)
}

/// The color of a wave, and its condition number: that of the turns, of the decay and of the sum.
fn sensitivity(path: f64, shift: V) -> (V, f64) {
    let d = path.clamp(0.0, 32768.0) * f64::from(0.001_f32);
    let mut condition = 1.0;
    let mut part = |row: [f64; 3], shift: f64| {
        let [size, wave, decay] = row.map(single);
        let turns = wave * d + shift;
        let left = size * (-decay * d * d).exp();
        condition += 8.0 * left * (2.0 + TAU * turns.abs() + decay * d * d);
        left * (TAU * turns).cos()
    };
    let [x, y, z, more] = WAVES;
    let [u, v, w] = shift;
    let xyz = [part(x, u) + part(more, u), part(y, v), part(z, w)];
    (RGB.map(|row| dot(row.map(single), xyz)), condition)
}

fn schlick(normal: f64, cos: f64) -> f64 {
    normal + (1.0 - normal) * (1.0 - cos).powi(5)
}

/// KHR_materials_iridescence, with indices of refraction, and phases in radians.
fn film(a: &Args<'_>) -> Option<Answer> {
    let (cos1, outside, film, thickness, f0) = (a.f(), a.f(), a.f(), a.f(), a.v());
    let (outside, film) = (outside.clamp(0.0625, 16.0), film.clamp(0.0625, 16.0));
    let thickness = thickness.clamp(0.0, 16384.0);
    let x = (thickness / f64::from(0.03_f32)).min(1.0);
    let film = outside + x * x * (3.0 - 2.0 * x) * (film - outside);
    let sin2 = (outside / film).powi(2) * (1.0 - cos1) * (1.0 + cos1);
    if sin2 >= 1.0 {
        return Some(Answer::new([1.0; 3], 1.0).jumping(sin2 - 1.0));
    }
    let cos2 = (1.0 - sin2).sqrt();
    let r12 = schlick(((film - outside) / (film + outside)).powi(2), cos1);
    let through = 1.0 - r12;
    let mut jump = (1.0 - sin2).min(if film == outside { f64::INFINITY } else { (film - outside).abs() });
    let r23 = f0.map(|f0| {
        let index = (1.0 + f0.sqrt()) / (1.0 - f0.sqrt());
        schlick(if f0 < 1.0 { ((index - film) / (index + film)).powi(2) } else { 1.0 }, cos2)
    });
    let second = f0.map(|f0| {
        jump = jump.min(((1.0 + f0.sqrt()) - film * (1.0 - f0.sqrt())).abs());
        if (1.0 + f0.sqrt()) < film * (1.0 - f0.sqrt()) { PI } else { 0.0 }
    });
    let first = if film < outside { 0.0 } else { PI };
    let path = 2.0 * film * thickness * cos2;
    let turns = |m: f64| second.map(|second| m * (first + second) / TAU);
    let (wave1, condition1) = sensitivity(path, turns(1.0));
    let (wave2, condition2) = sensitivity(2.0 * path, turns(2.0));
    let mut most = 16.0_f64;
    let value: V = std::array::from_fn(|i| {
        let both = r12 * r23[i];
        // At grazing angles nothing comes through.
        let sent = if through > 0.0 { through * through * r23[i] / (1.0 - both) } else { 0.0 };
        let size = (sent - through) * both.sqrt();
        let slope = 4.0 + 2.0 / (cos2 * cos2);
        most = most.max(16.0 + 2.0 * size.abs() * slope * (condition1 + both.sqrt() * condition2));
        (r12 + sent + 2.0 * size * wave1[i] + 2.0 * size * both.sqrt() * wave2[i]).max(0.0)
    });
    Some(Answer::new(value, 1.0).conditioned(most).jumping(jump))
}

/// A light behind the surface, mirrored at it: what the closed form of `ggx` makes of that direction.
fn through(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, alpha) = (a.d(), a.d(), a.d(), a.f());
    let across = sub(l, scale(2.0 * dot(n, l), n));
    let numbers: Vec<f64> = [n, across, v].iter().flatten().copied().chain([alpha]).collect();
    let answer = super::microfacet::factor(&Args::of(&numbers))?;
    let condition = 2.0 * answer.condition;
    Some(answer.conditioned(condition))
}

/// The angles to the normal of the eye and of what it sees in a body.
fn bent_in(n: V, v: V, index: f64) -> (f64, f64) {
    let (sine, cosine) = (norm(cross(n, v)), dot(n, v));
    let k = index.max(1.0);
    (sine.atan2(cosine), sine.atan2(((k - 1.0) * (k + 1.0) + cosine * cosine).sqrt()))
}

/// Snell's law at both sides of a ball, by the angles: the eye's direction turns by 2 (a - b) in the plane of both.
fn through_ball(a: &Args<'_>) -> Option<Answer> {
    let (n, v, index) = (a.d(), a.d(), a.f());
    let (outside, inside) = bent_in(n, v, index);
    let across = sub(v, scale(dot(n, v), n));
    let turned = 2.0 * inside - outside;
    let flat = norm(across);
    let along = scale(-turned.cos(), n);
    let value = if flat > 1e-300 { sub(along, scale(turned.sin() / flat, across)) } else { along };
    Some(Answer::new(value, 1.0).conditioned(64.0))
}

pub(super) static FORMS: &[Form] = forms! {
    "ggx" "ggxBrushed(float,float)" [Unit, Unit] |a| {
        let (roughness, strength) = (a.f(), a.f());
        let across = roughness * roughness;
        let along = across * (1.0 - strength * strength) + strength * strength;
        Some(Answer::new([along, across], 1.0).conditioned(4.0))
    };
    "ggx" "ggxBent(vec3,vec3,vec3,float,float)" [Tangent, Direction, Unit, Unit] bent;
    "energy" "energyRoughness(vec2)" [Alpha, Alpha] |a| {
        let [along, across] = a.v2().map(|alpha| alpha.clamp((-20.0f64).exp2(), 1.0));
        Some(Answer::new([((along * along + across * across) / 2.0).powf(0.25)], 1.0).conditioned(4.0))
    };
    "iridescence" "iridescenceSensitivity(float,vec3)" [Film, Color] |a| {
        let (value, condition) = sensitivity(a.f(), a.v());
        Some(Answer::new(value, 1.0).conditioned(condition))
    };
    "iridescence" "iridescenceFresnel(float,float,float,float,vec3)" [Unit, Index, Index, Film, Color] film;
    "iridescence" "iridescenceNormal(vec3,float)" [Color, Unit] |a| {
        let (f, cos) = (a.v(), a.f());
        let p = (1.0 - cos).powi(5).min(f64::from(0.9999_f32));
        let value = f.map(|f| ((f - p) / (1.0 - p)).clamp(0.0, 1.0));
        Some(Answer::new(value, 1.0).conditioned(8.0 / (1.0 - p)))
    };
    "transmission" "transmissionMirrored(vec3,vec3)" [Direction, Direction] |a| {
        let (n, l) = (a.d(), a.d());
        Some(Answer::new(sub(l, scale(2.0 * dot(n, l), n)), 1.0).conditioned(6.0))
    };
    "transmission" "transmissionFactor(vec3,vec3,vec3,float)" [Direction, Direction, Direction, Alpha] through;
    "transmission" "transmissionLeft(vec3)" [Intensity]
        |a| Some(Answer::new(a.v().map(|depth| (-depth).exp()), 1.0).conditioned(4.0));
    "transmission" "transmissionPath(vec3,vec3,float)" [Direction, Direction, Index]
        |a| {
            let (n, v, index) = (a.d(), a.d(), a.f());
            // An eye behind the surface counts as grazing.
            let inside = if dot(n, v) > 0.0 { bent_in(n, v, index).1 } else { (1.0 / index.max(1.0)).asin() };
            Some(Answer::new([inside.cos()], 1.0).conditioned(16.0))
        };
    "transmission" "transmissionSphere(vec3,vec3,float)" [Direction, Direction, Index] through_ball;
    "transmission" "transmissionRoughness(float,float)" [Unit, Index]
        |a| Some(Answer::new([a.f() * (2.0 * a.f().max(1.0) - 2.0).min(1.0)], 1.0).conditioned(4.0));
    "transmission" "transmissionIndices(float,float)" [Index, Gain] |a| {
        let (n, dispersion) = (a.f().max(1.0), a.f());
        let spread = (n - 1.0) * dispersion / 20.0;
        Some(Answer::relative([(n - spread / 2.0).max(1.0), n, n + spread / 2.0]).conditioned(4.0))
    };
};
