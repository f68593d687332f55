//! Closed forms of light that travels in a ball, and of rough mirrors in light of few harmonics.

use super::{Form, InputKind, dot, forms};
use crate::measure::vector::{V, add, scale};
use crate::measure::{Answer, Args};

/// The means of e^-xt, of t^2 e^-xt and of t^4 e^-xt over t from 0 to 1: sums of positive terms, or closed forms where nothing cancels.
fn moments(x: f64) -> [f64; 3] {
    let e = (-x).exp();
    if x > 6.0 {
        let fourth = 24.0 - e * (x.powi(4) + 4.0 * x.powi(3) + 12.0 * x * x + 24.0 * x + 24.0);
        return [(1.0 - e) / x, (2.0 - e * (x * x + 2.0 * x + 2.0)) / x.powi(3), fourth / x.powi(5)];
    }
    [1.0, 3.0, 5.0].map(|first| {
        let (mut term, mut sum) = (e / first, 0.0);
        for k in 1..60 {
            sum += term;
            term *= x / (first + f64::from(k));
        }
        sum
    })
}

/// The parts of two harmonics that normalized diffusion on a ball of radius 1 takes, by the mean squares and fourth powers of its chords: 2 pi r R(r) is a
/// sum of two exponentials.
fn bands(d: f64) -> [f64; 2] {
    // With r = 2 t, t from 0 to 1.
    let [[n, m, k], [n3, m3, k3]] = [2.0 / d, 2.0 / (3.0 * d)].map(moments);
    let [square, fourth] = [4.0 * (m + m3) / (n + n3), 16.0 * (k + k3) / (n + n3)];
    [square / 2.0, 1.5 * square - 0.375 * fourth]
}

/// The mean of Lambert's factor, a wrapped one and light from everywhere that lacks these parts.
fn lit(c: f64, a: f64, b: f64) -> f64 {
    let a = a.clamp(0.0, 2.0 / 3.0);
    let b = b.clamp(a, (3.0 * a).min(1.0));
    let lambert = c.max(0.0);
    if a == 0.0 {
        return lambert;
    }
    let w = (2.0 - b / (2.0 * a)).min(1.0);
    // Of the third harmonic, the wrapped factor has (1 - w)^2, and of the second one 1 - w / 2.
    let [q, p] = if w < 1.0 { [2.0 * a / w, 1.0 - 2.0 * a / w] } else { [2.0 * (b - a), 1.0 - b] };
    p * lambert + q * (c + w).max(0.0) / (1.0 + w).powi(2) + (1.0 - p - q) / 4.0
}

/// A number as the module has it.
fn single(number: f64) -> f64 {
    f64::from(number as f32)
}

/// Christensen and Burley's (6): the distance by the way between two collisions.
fn distance(radius: f64, albedo: f64) -> f64 {
    radius / (single(1.9) - albedo + 3.5 * (albedo - single(0.8)).powi(2))
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
    "subsurface" "subsurfaceBands(float)" [Distance]
        |a| Some(Answer::new(bands(a.f().clamp((-19.0f64).exp2(), 1024.0)), 1.0).conditioned(16.0));
    "subsurface" "subsurfaceBands(vec3,vec3)" [Intensity, Color] |a| {
        let (radius, albedo) = (a.v(), a.v());
        let tiny = (-19.0f64).exp2();
        let mut values = [0.0; 6];
        for (k, (radius, albedo)) in radius.into_iter().zip(albedo).enumerate() {
            let taken = bands(distance(radius, albedo).max(tiny));
            for (band, taken) in taken.into_iter().enumerate() {
                if let Some(value) = values.get_mut(3 * band + k) {
                    *value = taken;
                }
            }
        }
        Some(Answer::new(values, 1.0).conditioned(32.0))
    };
    "subsurface" "subsurfaceLit(float,float,float)" [Signed, Unit, Unit]
        |a| Some(Answer::new([lit(a.f().clamp(-1.0, 1.0), a.f(), a.f())], 1.0).conditioned(8.0));
    "subsurface" "subsurfaceFactor(vec3,vec3,mat2x3)" [Direction, Direction, Color, Color] |a| {
        let (c, first, second) = (dot(a.d(), a.d()), a.v(), a.v());
        let values: Vec<f64> = first.iter().zip(second).map(|(first, second)| lit(c, *first, second)).collect();
        Some(Answer::new(values, 1.0).conditioned(8.0))
    };
    "irradiance" "irradianceLobe(float)" [Unit] |a| Some(Answer::new(lobe(a.f()), 1.0).conditioned(32.0));
    "irradiance" "irradianceMirrored(vec3,vec3[9],float)" [Direction, Harmonics, Unit] mirrored;
};
