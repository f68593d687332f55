//! Reference formulas for shading functions, written from published sources alone.
//!
//! Everything is in `f64` and in the plainest form at hand (angles, triangles, vectors,
//! quadrature), not in the form a shader would use. Directions point away from the surface
//! and are unit vectors.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A vector, or three color channels.
pub(super) type V = [f64; 3];

pub(super) fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: V, b: V) -> V {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `p a + q b`.
pub(super) fn mix(p: f64, a: V, q: f64, b: V) -> V {
    [0, 1, 2].map(|k| p * a[k] + q * b[k])
}

fn length(a: V) -> f64 {
    dot(a, a).sqrt()
}

pub(super) fn unit(a: V) -> V {
    let size = length(a);
    a.map(|x| x / size)
}

/// The angle between two vectors, accurate also near 0 and near pi.
fn angle(a: V, b: V) -> f64 {
    length(cross(a, b)).atan2(dot(a, b))
}

/// The direction in the plane square to the unit vector `n` in which `a` leans; `None` if
/// `a` is parallel to `n`.
fn lean(n: V, a: V) -> Option<V> {
    // n x (a x n) = a - (n.a) n, with no cancellation when `a` is nearly parallel to `n`.
    let flat = cross(n, cross(a, n));
    (length(flat) > 0.0).then(|| unit(flat))
}

// ---------------------------------------------------------------------------------------
// A solid ball of glass (law of refraction: Born & Wolf, Principles of Optics, sec. 1.5.1
// and 3.2.2; the two equal angles at the ends of a chord: Euclid I.5)
// ---------------------------------------------------------------------------------------

/// The ray inside the ball: the angle to the normal outside, its direction inside, and the
/// direction (square to `n`) towards which both travel. `None` for a ray along the normal.
fn enter(n: V, v: V, index: f64) -> Option<(f64, V, V)> {
    let index = index.clamp(1.0, 16.0);
    let back = lean(n, v)?;
    let onward = back.map(|x| -x);
    let cosine = dot(n, v).max(0.0);
    let sine = if dot(n, v) < 0.0 { 1.0 } else { length(cross(n, v)) };
    // Snell: sin(inner) = sin(outer) / index. In the right triangle of hypotenuse `index`
    // and one leg sin(outer), the other leg is sqrt(index^2 - sin^2) and `inner` is its angle.
    let leg = ((index - 1.0) * (index + 1.0) + cosine * cosine).sqrt();
    let inner = sine.atan2(leg);
    let inside = mix(-inner.cos(), n, inner.sin(), onward);
    Some((sine.atan2(cosine), inside, onward))
}

/// Where a ray from `n` on the unit sphere in direction `inside` meets the sphere again.
fn far_end(n: V, inside: V) -> V {
    // |n + s d|^2 = 1 gives s = -2 n.d
    unit(mix(1.0, n, -2.0 * dot(n, inside), inside))
}

/// The direction in which the eye's ray leaves a solid ball of refractive index `index` in
/// vacuum after being refracted in at the point of normal `n` and out at the far side.
/// Source: Snell's law twice (Born & Wolf sec. 1.5.1). The index is clamped to [1, 16]. An
/// eye below the horizon counts as one on the horizon (straight from behind, which has no such
/// counterpart, the ray just goes on).
pub(super) fn sphere_exit(n: V, v: V, index: f64) -> V {
    let Some((outer, inside, _)) = enter(n, v, index) else {
        return v.map(|x| -x);
    };
    let m = far_end(n, inside);
    // The chord meets the sphere at the same angle at both ends, so Snell's law gives the
    // ray the same angle to the normal outside as it came in with.
    match lean(m, inside) {
        Some(onward) => mix(outer.cos(), m, outer.sin(), onward),
        None => m,
    }
}

/// The length of the eye's ray inside that ball over the ball's diameter. Source: Snell's
/// law (Born & Wolf sec. 1.5.1) and the chord between the two ends. An eye with `n.v < 0`
/// counts as grazing.
pub(super) fn sphere_path(n: V, v: V, index: f64) -> f64 {
    match enter(n, v, index) {
        Some((_, inside, _)) => length(mix(1.0, far_end(n, inside), -1.0, n)) / 2.0,
        None if dot(n, v) > 0.0 => 1.0,
        // Straight from behind: grazing, so the inner angle is the critical one.
        None => (1.0 / index.clamp(1.0, 16.0)).asin().cos(),
    }
}

/// The roughness seen through a refracting surface: none at index 1, all of it from index
/// 1.5 on, linear between. Source: `applyIorToRoughness` in `functions.glsl` of the Khronos
/// glTF-Sample-Renderer.
pub(super) fn blurred_roughness(roughness: f64, index: f64) -> f64 {
    if index <= 1.0 {
        0.0
    } else if index >= 1.5 {
        roughness
    } else {
        roughness * (index - 1.0) / 0.5
    }
}

/// The refractive indices of red, green and blue. Source: KHR_materials_dispersion, section
/// "Implementation" (`n_F - n_C = (n_d - 1) / V_d`, `dispersion = 20 / V_d`, red and blue
/// half of that spread away from green), and `getIBLVolumeRefraction` in `ibl.glsl` of the
/// Khronos glTF-Sample-Renderer; the floor of 1 is the specification's remark.
pub(super) fn dispersed(index: f64, dispersion: f64) -> V {
    let abbe = 20.0 / dispersion;
    let spread = (index - 1.0) / abbe;
    [index - spread / 2.0, index, index + spread / 2.0].map(|x| x.max(1.0))
}

// ---------------------------------------------------------------------------------------
// EON: Portsmouth, Kutz, Hill, "EON: A Practical Energy-Preserving Rough Diffuse BRDF",
// arXiv 2410.18026, JCGT 14(1) 2025
// ---------------------------------------------------------------------------------------

/// The coefficient A of the Fujii model. Source: EON listing 1 (`AF`).
fn fon_a(r: f64) -> f64 {
    1.0 / (1.0 + r * (0.5 - 2.0 / (3.0 * PI)))
}

/// The Fujii Oren-Nayar BRDF of unit single-scattering albedo for polar angles `out` and
/// `into` and azimuth difference `turn`. Source: Fujii, "A tiny improvement of Oren-Nayar
/// reflectance model", with A and B of EON listing 1.
pub(super) fn fon(into: f64, out: f64, turn: f64, r: f64) -> f64 {
    let s = into.sin() * out.sin() * turn.cos();
    let t = if s > 0.0 { into.cos().max(out.cos()) } else { 1.0 };
    fon_a(r) * (1.0 + r * s / t) / PI
}

/// The directional albedo of the Fujii Oren-Nayar model in closed form. Source: EON listing
/// 1, `E_FON_exact`, written with the elevation `up` above the surface, in which
/// `tan(theta) (1 - sin^3 theta) = sin(theta) (1 + sin + sin^2) tan(up / 2)` stays exact
/// down to `mu = 0` (where the listing divides by zero). `mu` is clamped to [0, 1].
pub(super) fn eon_albedo(mu: f64, r: f64) -> f64 {
    let up = mu.clamp(0.0, 1.0).asin();
    let theta = FRAC_PI_2 - up;
    let s = up.cos();
    let first = s * (theta - s * up.sin());
    let second = 2.0 / 3.0 * (s * (1.0 + s + s * s) * (up / 2.0).tan() - s);
    fon_a(r) * (1.0 + r * (first + second) / PI)
}

/// The same albedo from its definition, the integral of the Fujii Oren-Nayar BRDF times the
/// cosine over the hemisphere, by Gauss-Legendre quadrature in both angles, split where the
/// two polar angles are equal and where the azimuth difference is a right angle.
pub(super) fn eon_albedo_integral(mu: f64, r: f64) -> f64 {
    let out = mu.clamp(0.0, 1.0).acos();
    let rule = gauss_legendre(24);
    integrate(&rule, &[0.0, out, FRAC_PI_2], |into| {
        let ring = integrate(&rule, &[0.0, FRAC_PI_2, PI], |turn| fon(into, out, turn, r));
        2.0 * ring * into.cos() * into.sin()
    })
}

/// The albedo of the Fujii model averaged over the hemisphere with the cosine. Source: EON
/// listing 1 (`avgEF`).
pub(super) fn eon_average_albedo(r: f64) -> f64 {
    fon_a(r) * (1.0 + r * (2.0 / 3.0 - 28.0 / (15.0 * PI)))
}

/// Light reflected to the eye `v` from a lamp of irradiance pi square on, in direction `l`:
/// pi times `n.l` times the EON BRDF of single-scattering albedo `rho` and roughness `r`.
/// Source: EON listing 1 (`f_EON` with the exact albedo), including its floors of 1e-7.
/// `None` if lamp or eye are not above the horizon.
pub(super) fn eon(n: V, l: V, v: V, rho: V, r: f64) -> Option<V> {
    eon_floored(n, l, v, rho, r, 1e-7)
}

/// [`eon`] with another floor than the listing's for the three factors of the multiple
/// scattering, to see how much it matters; with floor 0 smooth walls scatter once only.
pub(super) fn eon_floored(n: V, l: V, v: V, rho: V, r: f64, floor: f64) -> Option<V> {
    let (mu_l, mu_v) = (dot(n, l), dot(n, v));
    if mu_l <= 0.0 || mu_v <= 0.0 {
        return None;
    }
    // Single scattering. s = sin sin cos(azimuth difference) is the dot product of the two
    // directions' shadows on the plane; t is 1 when they face away from each other.
    let s = match (lean(n, l), lean(n, v)) {
        (Some(a), Some(b)) => length(cross(n, l)) * length(cross(n, v)) * dot(a, b),
        _ => 0.0,
    };
    let t = if s > 0.0 { mu_l.max(mu_v) } else { 1.0 };
    let once = fon_a(r) * (1.0 + r * s / t);
    // Multiple scattering.
    let average = eon_average_albedo(r);
    let lost = |albedo: f64| (1.0 - albedo).max(floor);
    let lobe =
        if lost(average) > 0.0 { lost(eon_albedo(mu_l, r)) * lost(eon_albedo(mu_v, r)) / lost(average) } else { 0.0 };
    Some(rho.map(|rho| {
        let tint = rho * rho * average / (1.0 - rho * (1.0 - average));
        mu_l * (rho * once + tint * lobe)
    }))
}

// ---------------------------------------------------------------------------------------
// three.js, MeshStandardMaterial and MeshPhysicalMaterial
// ---------------------------------------------------------------------------------------

/// The half vector of lamp and eye, if they do not cancel.
fn half(l: V, v: V) -> Option<V> {
    let sum = mix(1.0, l, 1.0, v);
    (length(sum) > 0.0).then(|| unit(sum))
}

/// The Trowbridge-Reitz (GGX) distribution for the angle `theta` between normal and half
/// vector. Source: Walter et al. 2007 eq. (33), which three.js's `D_GGX` cites.
pub(super) fn ggx(theta: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let spread = a2 * theta.cos().powi(2) + theta.sin().powi(2);
    a2 / (PI * spread * spread)
}

/// Smith's auxiliary function of GGX for a direction at the angle `theta`. Source: Walter et
/// al. 2007 (their shadowing is `1 / (1 + lambda)`).
fn smith_lambda(theta: f64, alpha: f64) -> f64 {
    ((1.0 + (alpha * theta.tan()).powi(2)).sqrt() - 1.0) / 2.0
}

/// Light reflected to the eye from a lamp of irradiance pi square on by three.js's
/// `MeshStandardMaterial` of metalness 0 and without environment. Source: `RE_Direct_Physical`
/// = `BRDF_Lambert` + `BRDF_GGX` (`V_GGX_SmithCorrelated` with `EPSILON` 1e-6, `D_GGX`,
/// `F_Schlick` with f90 = 1) of three.js up to about r180, with Schlick's true fifth power.
/// `None` if lamp or eye are not above the horizon.
pub(super) fn three_plastic(n: V, l: V, v: V, diffuse: V, f0: f64, alpha: f64) -> Option<V> {
    let (mu_l, mu_v) = (dot(n, l), dot(n, v));
    if mu_l <= 0.0 || mu_v <= 0.0 {
        return None;
    }
    let h = half(l, v)?;
    let d = ggx(angle(n, h), alpha);
    // Height-correlated shadowing over 4 n.l n.v; the floor of 1e-6 under
    // 0.5 / max(gv + gl, 1e-6) is a ceiling of 5e5 on the whole.
    let shadow = 1.0 + smith_lambda(angle(n, l), alpha) + smith_lambda(angle(n, v), alpha);
    let g = (1.0 / (4.0 * mu_l * mu_v * shadow)).min(0.5 / 1e-6);
    // The half vector halves the angle between lamp and eye; 1 - cos x = 2 sin^2(x / 2).
    let away = 2.0 * (angle(l, v) / 4.0).sin().powi(2);
    let f = f0 + (1.0 - f0) * away.powi(5);
    Some(diffuse.map(|c| mu_l * (c + PI * d * g * f)))
}

/// The "Charlie" sheen distribution for the angle `theta` between normal and half vector.
/// Source: Estevez and Kulla 2017 and three.js's `D_Charlie`, whose floor under the squared
/// sine is 0.0078125.
pub(super) fn charlie(theta: f64, alpha: f64) -> f64 {
    let squared_sine = theta.sin().powi(2).max(0.0078125);
    (2.0 + 1.0 / alpha) * (squared_sine.ln() / (2.0 * alpha)).exp() / TAU
}

/// Light reflected to the eye from a lamp of irradiance pi square on by a white Lambert wall
/// under white sheen, without the dielectric layer. Source: three.js's `BRDF_Sheen`
/// (`D_Charlie`, `V_Neubelt`) and, in its `meshphysical` shader up to about r180,
/// `outgoingLight * (1 - 0.157 max(sheenColor)) + sheenSpecularDirect`. `alpha` is the
/// square of `sheenRoughness`. `None` if lamp or eye are not above the horizon.
pub(super) fn three_sheen(n: V, l: V, v: V, alpha: f64) -> Option<f64> {
    let (mu_l, mu_v) = (dot(n, l), dot(n, v));
    if mu_l <= 0.0 || mu_v <= 0.0 {
        return None;
    }
    let d = charlie(angle(n, half(l, v)?), alpha);
    let neubelt = (0.25 / (mu_l + mu_v - mu_l * mu_v)).clamp(0.0, 1.0);
    Some(mu_l * ((1.0 - 0.157) + PI * d * neubelt))
}

// ---------------------------------------------------------------------------------------
// Quadrature
// ---------------------------------------------------------------------------------------

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1], by Newton's method on the
/// Legendre polynomial.
pub(super) fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let size = count as f64;
    (0..count)
        .map(|k| {
            let mut x = (PI * (k as f64 + 0.75) / (size + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut before, mut value) = (1.0, x);
                for j in 2..=count {
                    let j = j as f64;
                    (before, value) = (value, ((2.0 * j - 1.0) * x * value - (j - 1.0) * before) / j);
                }
                slope = size * (x * value - before) / (x * x - 1.0);
                x -= value / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// The integral of `f` over the intervals between neighboring `ends`.
pub(super) fn integrate(rule: &[(f64, f64)], ends: &[f64], f: impl Fn(f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for pair in ends.windows(2) {
        let (middle, reach) = ((pair[0] + pair[1]) / 2.0, (pair[1] - pair[0]) / 2.0);
        for &(x, weight) in rule {
            sum += reach * weight * f(middle + reach * x);
        }
    }
    sum
}
