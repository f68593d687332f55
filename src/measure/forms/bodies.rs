//! Closed forms of light that travels in a ball, and of rough mirrors in light of few harmonics.

use super::{Form, InputKind, dot, forms};
use crate::measure::vector::{V, add, scale};
use crate::measure::{Answer, Args};

/// The means of e^-xt and of t^2 e^-xt over t from 0 to 1: sums of positive terms, or closed forms where nothing cancels.
fn moments(x: f64) -> [f64; 2] {
    let e = (-x).exp();
    if x > 4.0 {
        return [(1.0 - e) / x, (2.0 - e * (x * x + 2.0 * x + 2.0)) / x.powi(3)];
    }
    [1.0, 3.0].map(|first| {
        let (mut term, mut sum) = (e / first, 0.0);
        for k in 1..60 {
            sum += term;
            term *= x / (first + f64::from(k));
        }
        sum
    })
}

/// The mean of r^2 over the chords r of a ball of radius 1 under normalized diffusion: 2 pi r R(r) is a sum of two exponentials.
fn reach(d: f64) -> f64 {
    // With r = 2 t, t from 0 to 1.
    let [[n, m], [n3, m3]] = [2.0 / d, 2.0 / (3.0 * d)].map(moments);
    4.0 * (m + m3) / (n + n3)
}

/// A number as the module has it.
fn single(number: f64) -> f64 {
    f64::from(number as f32)
}

/// Christensen and Burley's (6): the distance by the way between two collisions.
fn distance(radius: f64, albedo: f64) -> f64 {
    radius / (single(1.9) - albedo + 3.5 * (albedo - single(0.8)).powi(2))
}

fn factor(a: &Args<'_>) -> Option<Answer> {
    let (cos, reach) = (dot(a.d(), a.d()), a.v());
    let lit = |w: f64| if w <= 1.0 { (cos + w).max(0.0) / (1.0 + w).powi(2) } else { 0.25 + 0.5 * (1.0 - w / 2.0) * cos };
    Some(Answer::new(reach.map(|w| lit(w.min(4.0 / 3.0))), 1.0).conditioned(4.0))
}

/// Powers of the roughness from the second to the sixth, as the module has them.
static FIRST: [f32; 5] = [-0.22766, 3.8422, -6.498, 4.1439, -0.92711];
static SECOND: [f32; 5] = [-0.64218, 11.33742, -21.56136, 15.75818, -4.14206];

/// How much a rough mirror shows of two bands.
fn lobe(roughness: f64) -> [f64; 2] {
    [FIRST, SECOND].map(|terms| {
        let powers = terms.iter().zip(2..).map(|(term, power)| f64::from(*term) * roughness.powi(power));
        (1.0 - powers.sum::<f64>()).clamp(0.0, 1.0)
    })
}

fn mirrored(a: &Args<'_>) -> Option<Answer> {
    let [x, y, z] = a.d();
    let c: [V; 9] = std::array::from_fn(|_| a.v());
    let [first, second] = lobe(a.f());
    // As the module has them.
    let [k0, k1, k2, k3, k4, k5] =
        [0.282_095_f32, 0.488_603, 1.092_548, 0.946_175, 0.315_392, 0.546_274].map(f64::from);
    let weights = [
        k0,
        first * k1 * y,
        first * k1 * z,
        first * k1 * x,
        second * k2 * x * y,
        second * k2 * y * z,
        second * (k3 * z * z - k4),
        second * k2 * x * z,
        second * k5 * (x * x - y * y),
    ];
    let sum = weights.iter().zip(c).fold([0.0; 3], |sum, (w, c)| add(sum, scale(*w, c)));
    Some(Answer::new(sum, 4.0).conditioned(32.0))
}

pub(super) static FORMS: &[Form] = forms! {
    "subsurface" "subsurfaceMoments(float)" [Distance]
        |a| Some(Answer::new(moments(a.f().clamp(0.0, 20.0f64.exp2())), 1.0).conditioned(8.0));
    "subsurface" "subsurfaceReach(float)" [Distance]
        |a| Some(Answer::new([reach(a.f().clamp((-19.0f64).exp2(), 1024.0))], 1.0).conditioned(16.0));
    "subsurface" "subsurfaceReach(vec3,vec3)" [Intensity, Color] |a| {
        let (radius, albedo) = (a.v(), a.v());
        let tiny = (-19.0f64).exp2();
        let values: Vec<f64> =
            radius.iter().zip(albedo).map(|(radius, albedo)| reach(distance(*radius, albedo).max(tiny))).collect();
        Some(Answer::new(values, 1.0).conditioned(32.0))
    };
    "subsurface" "subsurfaceFactor(vec3,vec3,vec3)" [Direction, Direction, Intensity] factor;
    "irradiance" "irradianceLobe(float)" [Unit] |a| Some(Answer::new(lobe(a.f()), 1.0).conditioned(32.0));
    "irradiance" "irradianceMirrored(vec3,vec3[9],float)" [Direction, Harmonics, Unit] mirrored;
};
