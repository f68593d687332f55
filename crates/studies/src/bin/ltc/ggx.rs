//! The reflection that the tables are fitted to: the model of `shader_lib/ggx.glsl` with a Fresnel term of 1, in f64, and directions
//! distributed as it reflects.
//!
//! *Holds:* the normal is z. Samples are those of the normals that the eye sees (Heitz, Sampling the GGX Distribution of Visible
//! Normals, JCGT 2018), so that the weight of each is the shadowing alone.

use std::f64::consts::{PI, TAU};

/// A vector.
pub(crate) type V = [f64; 3];

pub(crate) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn scale(s: f64, a: V) -> V {
    a.map(|x| s * x)
}

pub(crate) fn add(a: V, b: V) -> V {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(crate) fn unit(a: V) -> V {
    scale(1.0 / dot(a, a).sqrt(), a)
}

/// A point of a set that covers the unit square evenly: multiples of the plastic number's powers.
pub(crate) fn spread(index: u32) -> [f64; 2] {
    const G: f64 = 1.324_717_957_244_746;
    let at = f64::from(index);
    [(0.5 + at / G).fract(), (0.5 + at / (G * G)).fract()]
}

/// The model for one eye and one width.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ggx {
    pub(crate) eye: V,
    pub(crate) alpha: f64,
}

/// A direction of the light with what the model says about it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub(crate) light: V,
    /// f N.L over the density of the sample.
    pub(crate) weight: f64,
    /// The cosine between the half vector and the eye.
    pub(crate) half: f64,
}

impl Ggx {
    pub(crate) fn new(cosine: f64, alpha: f64) -> Self {
        Self { eye: [(1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine], alpha }
    }

    fn lambda(self, cosine: f64) -> f64 {
        let tan2 = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        ((1.0 + self.alpha * self.alpha * tan2).sqrt() - 1.0) / 2.0
    }

    /// The density of the normals.
    fn normals(self, h: V) -> f64 {
        let core = h[0] * h[0] + h[1] * h[1] + (self.alpha * h[2]).powi(2);
        (self.alpha / core).powi(2) / PI
    }

    /// f N.L, and the density of [`Ggx::sample`].
    pub(crate) fn eval(self, light: V) -> [f64; 2] {
        if light[2] <= 0.0 {
            return [0.0; 2];
        }
        let density = self.normals(unit(add(light, self.eye)));
        let seen = density / (4.0 * self.eye[2]);
        let (l, v) = (self.lambda(light[2]), self.lambda(self.eye[2]));
        [seen / (1.0 + l + v), seen / (1.0 + v)]
    }

    /// A direction of the light for a point of the unit square.
    pub(crate) fn sample(self, [s, t]: [f64; 2]) -> Sample {
        let stretched = unit([self.alpha * self.eye[0], self.alpha * self.eye[1], self.eye[2]]);
        let flat = (stretched[0].powi(2) + stretched[1].powi(2)).sqrt();
        let x = if flat > 0.0 { [-stretched[1] / flat, stretched[0] / flat, 0.0] } else { [1.0, 0.0, 0.0] };
        let y = cross(stretched, x);
        let (radius, angle) = (s.sqrt(), TAU * t);
        let (a, plain) = (radius * angle.cos(), radius * angle.sin());
        let share = (1.0 + stretched[2]) / 2.0;
        let b = (1.0 - share) * (1.0 - a * a).max(0.0).sqrt() + share * plain;
        let up = (1.0 - a * a - b * b).max(0.0).sqrt();
        let h = add(add(scale(a, x), scale(b, y)), scale(up, stretched));
        let h = unit([self.alpha * h[0], self.alpha * h[1], h[2].max(1e-12)]);
        let half = dot(self.eye, h);
        let light = add(scale(2.0 * half, h), scale(-1.0, self.eye));
        let (l, v) = (self.lambda(light[2]), self.lambda(self.eye[2]));
        let weight = if light[2] > 0.0 { (1.0 + v) / (1.0 + l + v) } else { 0.0 };
        Sample { light, weight, half }
    }
}
