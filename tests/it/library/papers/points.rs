//! Inputs of the closed forms, a thousand and more for each: stiff ones first, the same list on every call.

use super::forms::{V, cross, dot, mix, unit};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Normal, eye and index for the ball.
pub(super) type SpherePoint = (V, V, f64);
/// Normal, lamp, eye, albedo and roughness for EON.
pub(super) type EonPoint = (V, V, V, V, f64);
/// Normal, lamp, eye, diffuse color, reflectance at normal incidence and alpha.
pub(super) type PlasticPoint = (V, V, V, V, f64, f64);
/// Normal, lamp, eye and alpha.
pub(super) type SheenPoint = (V, V, V, f64);

const GRAZING: [f64; 6] = [1e-6, 3e-6, 1e-5, 1e-4, 1e-3, 1e-2];
const UP: V = [0.0, 0.0, 1.0];

/// Steele, Lea, Flood 2014, "SplitMix".
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly in `from .. to`.
    fn within(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * ((self.bits() >> 11) as f64 / (1u64 << 53) as f64)
    }

    /// Evenly in the logarithm.
    fn scaled(&mut self, from: f64, to: f64) -> f64 {
        self.within(from.ln(), to.ln()).exp()
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.bits() % list.len() as u64) as usize]
    }

    fn color(&mut self) -> V {
        [(); 3].map(|()| self.within(0.0, 1.0))
    }

    fn sphere(&mut self) -> V {
        let z: f64 = self.within(-1.0, 1.0);
        let azimuth = self.within(0.0, TAU);
        let ring = ((1.0 - z) * (1.0 + z)).sqrt();
        unit([ring * azimuth.cos(), ring * azimuth.sin(), z])
    }

    /// The z axis (whose dot products are exact) as often as any direction.
    fn normal(&mut self) -> V {
        if self.bits() & 1 == 0 { UP } else { self.sphere() }
    }
}

/// The direction of cosine `cosine` to `n` at an azimuth.
fn raised(n: V, cosine: f64, azimuth: f64) -> V {
    let aside = if n[0].abs() < 0.6 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let b = unit(cross(n, aside));
    let t = cross(b, n);
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    unit(mix(cosine, n, sine, mix(azimuth.cos(), t, azimuth.sin(), b)))
}

/// Balls and eyes above the horizon: 640 stiff ones (grazing, square on, index at the ends
/// of its range), then 1000 others.
pub(super) fn sphere_points() -> Vec<SpherePoint> {
    let mut random = Random(1);
    let mut points = Vec::new();
    for cosine in [1e-6, 1e-5, 1e-4, 1e-3, 0.5, 1.0 - 1e-12, 1.0 - 1e-6, 1.0] {
        for index in [1.0, 1.0 + 1e-6, 1.001, 1.33, 1.5, 2.42, 16.0 - 1e-6, 16.0] {
            for turn in 0..10 {
                let n = if turn < 5 { UP } else { random.sphere() };
                let v = raised(n, cosine, random.within(0.0, TAU));
                points.push((n, if cosine == 1.0 { n } else { v }, index));
            }
        }
    }
    for _ in 0..1000 {
        let n = random.sphere();
        let v = raised(n, random.within(0.01, 1.0), random.within(0.0, TAU));
        let index = if random.bits() & 3 == 0 { random.scaled(1.0, 16.0) } else { random.within(1.0, 2.5) };
        points.push((n, v, index));
    }
    points
}

/// Eyes on or below the horizon, for [`sphere_path`] only.
pub(super) fn sphere_hidden_points() -> Vec<SpherePoint> {
    let mut random = Random(2);
    let mut points: Vec<SpherePoint> = Vec::new();
    for index in [1.0, 1.0 + 1e-6, 1.5, 16.0] {
        points.push((UP, [1.0, 0.0, 0.0], index));
        points.push((UP, [0.0, 0.0, -1.0], index));
        for cosine in GRAZING {
            points.push((UP, raised(UP, -cosine, random.within(0.0, TAU)), index));
        }
    }
    for _ in 0..1000 {
        let n = random.normal();
        let v = raised(n, -random.scaled(1e-6, 1.0), random.within(0.0, TAU));
        points.push((n, v, random.within(1.0, 3.0)));
    }
    points
}

/// Roughness and index for [`blurred_roughness`].
pub(super) fn roughness_points() -> Vec<(f64, f64)> {
    let mut random = Random(3);
    let mut points = Vec::new();
    for roughness in [0.0, 1e-4, 1e-3, 0.1, 0.25, 0.5, 0.999, 1.0] {
        for index in [1.0, 1.0 + 1e-6, 1.0001, 1.01, 1.25, 1.33, 1.5 - 1e-6, 1.5, 1.5 + 1e-6, 1.8, 2.42, 16.0] {
            points.push((roughness, index));
        }
    }
    while points.len() < 500 {
        let roughness = random.pick(&[0.0, 1e-4, 1e-3, 1.0]);
        points.push((roughness, random.scaled(1.0, 16.0)));
    }
    for _ in 0..1000 {
        points.push((random.within(0.0, 1.0), random.within(1.0, 2.0)));
    }
    points
}

/// Index and dispersion for [`dispersed`]; beyond a dispersion of 40 red is held at 1.
pub(super) fn dispersion_points() -> Vec<(f64, f64)> {
    let mut random = Random(4);
    let mut points = Vec::new();
    for index in [1.0, 1.0 + 1e-6, 1.001, 1.33, 1.5, 2.42, 4.0, 16.0] {
        for dispersion in [0.0, 1e-6, 1e-3, 0.1, 0.36, 1.0, 2.04, 10.0, 39.9, 40.0, 40.1, 100.0] {
            points.push((index, dispersion));
        }
    }
    while points.len() < 500 {
        let index = random.pick(&[1.0, 1.0 + 1e-6, 16.0]);
        points.push((index, random.scaled(1e-4, 100.0)));
    }
    for _ in 0..1000 {
        points.push((random.within(1.0, 3.0), random.within(0.0, 3.0)));
    }
    points
}

/// Cosine and roughness for [`eon_albedo`].
pub(super) fn albedo_points() -> Vec<(f64, f64)> {
    let mut random = Random(5);
    let mut points = Vec::new();
    for mu in [1e-6, 1e-5, 1e-4, 1e-3, 0.5, 1.0 - 1e-6, 1.0 - 1e-12, 1.0] {
        for r in [0.0, 1e-6, 1e-4, 1e-3, 0.5, 1.0] {
            points.push((mu, r));
        }
    }
    while points.len() < 300 {
        let r = random.pick(&[0.0, 1e-4, 1e-3, 1.0]);
        points.push((random.scaled(1e-6, 1e-2), r));
    }
    while points.len() < 600 {
        let r = random.pick(&[0.0, 1e-4, 1e-3, 1.0]);
        points.push((1.0 - random.scaled(1e-12, 1e-2), r));
    }
    for _ in 0..1000 {
        points.push((random.within(0.0, 1.0), random.within(0.0, 1.0)));
    }
    points
}

/// Stiff normals, lamps and eyes; the last 32 have a lamp or an eye on or below the horizon.
/// `near` is the tangent by which the half vector strays from the normal near a mirror image.
fn stiff_pairs(random: &mut Random, near: f64) -> Vec<(V, V, V)> {
    let mut points = Vec::new();
    // Lamp and eye both grazing, from the same side, from aside, and nearly or fully opposed.
    for a in GRAZING {
        for b in [1e-6, 1e-4, 1e-2] {
            for turn in [0.0, FRAC_PI_2, 2.0, PI - 1e-3, PI - 1e-6, PI] {
                let (n, azimuth) = (random.normal(), random.within(0.0, TAU));
                points.push((n, raised(n, a, azimuth), raised(n, b, azimuth + turn)));
            }
        }
    }
    // One of them grazing.
    for k in 0..80 {
        let n = random.normal();
        let low = raised(n, random.pick(&GRAZING), random.within(0.0, TAU));
        let high = raised(n, random.within(0.05, 1.0), random.within(0.0, TAU));
        points.push(if k % 2 == 0 { (n, low, high) } else { (n, high, low) });
    }
    // The eye or the lamp square on, and both.
    for k in 0..80 {
        let n = random.normal();
        let cosine = if k % 4 < 2 { random.pick(&GRAZING) } else { random.within(0.05, 1.0) };
        let other = raised(n, cosine, random.within(0.0, TAU));
        points.push(match k % 8 {
            0 => (n, n, n),
            1 | 3 | 5 => (n, n, other),
            _ => (n, other, n),
        });
    }
    // The lamp in the eye.
    for k in 0..80 {
        let n = random.normal();
        let cosine = if k % 2 == 0 { random.pick(&GRAZING) } else { random.within(0.05, 1.0) };
        let v = raised(n, cosine, random.within(0.0, TAU));
        points.push((n, v, v));
    }
    // The lamp nearly opposite to the eye, as far as the horizon allows.
    for _ in 0..80 {
        let n = random.normal();
        let v = raised(n, random.scaled(1e-6, 1e-3), random.within(0.0, TAU));
        let lift = random.scaled(1e-6, 1e-3);
        points.push((n, unit(mix(lift + 2.0 * dot(n, v), n, -1.0, v)), v));
    }
    // The lamp in or near the mirror image of the eye.
    for k in 0..80 {
        let n = random.normal();
        let cosine = if k % 4 == 0 { random.pick(&GRAZING) } else { random.within(0.05, 1.0) };
        let azimuth = random.within(0.0, TAU);
        let v = raised(n, cosine, azimuth);
        let stray = random.pick(&[0.0, 0.3, 1.0, 3.0]) * near;
        let m = unit(mix(1.0, n, stray, raised(n, 0.0, random.within(0.0, TAU))));
        let l = unit(mix(2.0 * dot(m, v), m, -1.0, v));
        let l = if dot(n, l) > 1e-7 { l } else { raised(n, cosine, azimuth + PI) };
        points.push((n, l, v));
    }
    // Not above the horizon.
    for k in 0..32 {
        let n = if k < 8 { UP } else { random.normal() };
        let above = raised(n, random.within(0.05, 1.0), random.within(0.0, TAU));
        let below = match k {
            0..4 => [(TAU / 4.0 * f64::from(k)).cos().round(), (TAU / 4.0 * f64::from(k)).sin().round(), 0.0],
            _ => raised(n, -random.scaled(1e-6, 1.0), random.within(0.0, TAU)),
        };
        points.push(match k % 4 {
            0 => (n, below, above),
            1 => (n, above, below),
            2 => (n, below, below),
            _ => (n, above, above.map(|x| -x)),
        });
    }
    points
}

/// An ordinary normal, lamp and eye.
fn easy_pair(random: &mut Random) -> (V, V, V) {
    let n = random.sphere();
    let l = raised(n, random.within(0.01, 1.0), random.within(0.0, TAU));
    let v = raised(n, random.within(0.01, 1.0), random.within(0.0, TAU));
    (n, l, v)
}

/// Points for [`eon`]: 540 stiff ones, then 1000 others.
pub(super) fn eon_points() -> Vec<EonPoint> {
    let mut random = Random(6);
    let mut points = Vec::new();
    for (k, (n, l, v)) in stiff_pairs(&mut random, 1e-3).into_iter().enumerate() {
        let rho = match k % 4 {
            0 => [0.0; 3],
            1 => [1.0; 3],
            2 => [0.0, 1.0, random.within(0.0, 1.0)],
            _ => random.color(),
        };
        let r = random.pick(&[0.0, 1e-6, 1e-4, 1e-3, 0.5, 1.0, 1.0]);
        points.push((n, l, v, rho, r));
    }
    for _ in 0..1000 {
        let (n, l, v) = easy_pair(&mut random);
        points.push((n, l, v, random.color(), random.within(0.0, 1.0)));
    }
    points
}

/// Points for [`three_plastic`]: three times 540 stiff ones (one round for each of the
/// alphas 1e-4, 1e-3 and 1), then 1000 others.
pub(super) fn plastic_points() -> Vec<PlasticPoint> {
    let mut random = Random(7);
    let mut points = Vec::new();
    for alpha in [1e-4, 1e-3, 1.0] {
        for (k, (n, l, v)) in stiff_pairs(&mut random, f64::min(alpha, 0.1)).into_iter().enumerate() {
            let diffuse = match k % 3 {
                0 => [0.0; 3],
                1 => [1.0; 3],
                _ => random.color(),
            };
            let f0 = random.pick(&[0.0, 0.02, 0.04, 0.16, 1.0]);
            points.push((n, l, v, diffuse, f0, alpha));
        }
    }
    for _ in 0..1000 {
        let (n, l, v) = easy_pair(&mut random);
        let f0 = random.within(0.0, 0.2);
        points.push((n, l, v, random.color(), f0, random.within(0.003, 1.0)));
    }
    points
}

/// Points for [`three_sheen`]: 540 stiff ones, then 1000 others.
pub(super) fn sheen_points() -> Vec<SheenPoint> {
    let mut random = Random(8);
    let mut points = Vec::new();
    for (n, l, v) in stiff_pairs(&mut random, 0.09) {
        points.push((n, l, v, random.pick(&[1e-4, 1e-3, 0.0049, 0.25, 1.0])));
    }
    for _ in 0..1000 {
        let (n, l, v) = easy_pair(&mut random);
        points.push((n, l, v, random.within(0.005, 1.0)));
    }
    points
}
