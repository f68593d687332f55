//! Directions as `ggx` distributes them: about a mirror direction, and for a normal and an eye.
//!
//! *In:* a width. *Out:* directions that cover the distribution evenly, with the weight of each. *Holds:* the sets are fixed: spirals by the golden angle.

use crate::measure::vector::{V, add, cross, dot, scale, unit};
use std::f64::consts::{PI, TAU};

/// A point of a set that covers a disk evenly as radius squared and angle: Fibonacci's spiral.
fn spread(index: usize, count: usize) -> [f64; 2] {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    [(index as f64 + 0.5) / count as f64, (index as f64 * GOLDEN).fract()]
}

/// A frame with this z.
pub(super) fn frame(z: V) -> [V; 3] {
    let other = if z[0].abs() < 0.5 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let y = unit(cross(z, other));
    [cross(y, z), y, z]
}

/// A vector of a frame's coordinates.
pub(super) fn placed([x, y, z]: &[V; 3], [a, b, c]: V) -> V {
    add(add(scale(a, *x), scale(b, *y)), scale(c, *z))
}

/// A light's direction, about z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) light: V,
    pub(super) weight: f64,
    /// The angle, in radians, that this direction stands for.
    pub(super) angle: f64,
}

/// The density of the normals at a cosine.
fn density(cosine: f64, alpha: f64) -> f64 {
    let core = (1.0 - cosine * cosine) + (alpha * cosine).powi(2);
    (alpha / core).powi(2) / PI
}

/// The directions that a prefiltered map of this width takes about z, where normal, eye and mirror direction are one (Karis 2013). The
/// weights have the sum 1.
pub(super) fn mirrored(alpha: f64, count: usize) -> Vec<Ray> {
    let ray = |index: usize| {
        let [s, t] = spread(index, count);
        let square = (1.0 - s) / (1.0 + (alpha * alpha - 1.0) * s);
        let (cosine, sine) = (square.sqrt(), (1.0 - square).max(0.0).sqrt());
        let up = 2.0 * square - 1.0;
        let across = 2.0 * cosine * sine;
        let (sin, cos) = (TAU * t).sin_cos();
        // The density of the light's directions is a quarter of the normals'.
        let solid = 4.0 / (density(cosine, alpha) * count as f64);
        Ray { light: [across * cos, across * sin, up], weight: up.max(0.0), angle: solid.sqrt() }
    };
    let rays: Vec<Ray> = (0..count).map(ray).filter(|ray| ray.weight > 0.0).collect();
    let sum: f64 = rays.iter().map(|ray| ray.weight).sum();
    rays.into_iter().map(|ray| Ray { weight: ray.weight / sum, ..ray }).collect()
}

/// The directions that a surface reflects to an eye at a cosine from its normal z, in the plane of x, with f N.L over their density for a
/// Fresnel term of 1 (Heitz, Sampling the GGX Distribution of Visible Normals, JCGT 2018). The mean of all weights is the albedo.
pub(super) fn reflected(cosine: f64, alpha: f64, count: usize) -> Vec<Ray> {
    let eye = [(1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine];
    let lambda = |cosine: f64| {
        let tangent = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
        ((1.0 + alpha * alpha * tangent).sqrt() - 1.0) / 2.0
    };
    let stretched = unit([alpha * eye[0], 0.0, eye[2]]);
    let y = [0.0, 1.0, 0.0];
    let x = cross(y, stretched);
    let ray = |index: usize| {
        let [s, t] = spread(index, count);
        let (sin, cos) = (TAU * t).sin_cos();
        let (a, plain) = (s.sqrt() * sin, s.sqrt() * cos);
        let share = (1.0 + stretched[2]) / 2.0;
        let b = (1.0 - share) * (1.0 - a * a).max(0.0).sqrt() - share * plain;
        let up = (1.0 - a * a - b * b).max(0.0).sqrt();
        let h = placed(&[scale(-1.0, x), y, stretched], [b, a, up]);
        let h = unit([alpha * h[0], alpha * h[1], h[2].max(1e-12)]);
        let half = dot(eye, h);
        let light = add(scale(2.0 * half, h), scale(-1.0, eye));
        let (l, v) = (lambda(light[2]), lambda(cosine));
        let weight = if light[2] > 0.0 { (1.0 + v) / (1.0 + l + v) / count as f64 } else { 0.0 };
        Ray { light, weight, angle: 0.0 }
    };
    (0..count).map(ray).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of f N.L for a normal in the middle, by a grid of directions, against that of the rays.
    #[test]
    fn rays_reflect_what_the_model_does() {
        for (cosine, alpha) in [(1.0, 0.5), (0.7, 0.25), (0.4, 0.6), (0.25, 0.9)] {
            let rays = reflected(cosine, alpha, 1 << 14);
            let found: f64 = rays.iter().map(|ray| ray.weight).sum();
            let sideways: f64 = rays.iter().map(|ray| ray.weight * ray.light[0]).sum();
            let eye = [(1.0_f64 - cosine * cosine).sqrt(), 0.0, cosine];
            let (mut all, mut across) = (0.0, 0.0);
            let (rows, columns) = (400, 800);
            for row in 0..rows {
                let up: f64 = (f64::from(row) + 0.5) / f64::from(rows);
                for column in 0..columns {
                    let (sin, cos) = (TAU * (f64::from(column) + 0.5) / f64::from(columns)).sin_cos();
                    let side = (1.0 - up * up).sqrt();
                    let light = [side * cos, side * sin, up];
                    let h = unit(add(light, eye));
                    let smith = |c: f64| (alpha * alpha + (1.0 - alpha * alpha) * c * c).sqrt();
                    let visible = 0.5 / (up * smith(cosine) + cosine * smith(up));
                    let value = density(h[2], alpha) * visible * up * TAU / f64::from(rows * columns);
                    all += value;
                    across += value * light[0];
                }
            }
            assert!((found - all).abs() < 2e-3, "{cosine} {alpha}: {found} {all}");
            assert!((sideways - across).abs() < 4e-3, "{cosine} {alpha}: {sideways} {across}");
        }
    }
}
