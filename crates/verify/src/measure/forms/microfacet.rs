//! Closed forms of microfacets: Fresnel's equations, and the models of Trowbridge and Reitz, of Beckmann, of Charlie, and of a coat, by
//! the equations of their papers.

use super::{Form, InputKind, cross, dot, forms, half, lit};
use crate::measure::vector::{V, add, mul, scale, sub};
use crate::measure::{Answer, Args};
use std::f64::consts::PI;

/// A rounding of f32, whose square matters next to a highlight as narrow as it.
const SINGLE: f64 = f32::EPSILON as f64;

/// The width as the models limit it.
fn width(alpha: f64) -> f64 {
    alpha.clamp((-20.0f64).exp2(), 1.0)
}

/// The cosine and the squared sine between two unit vectors, by their distance.
fn angle(a: V, b: V) -> (f64, f64) {
    let apart = sub(a, b);
    let distance = dot(apart, apart) / 2.0;
    (dot(a, b), (distance * (2.0 - distance)).max(0.0))
}

/// A density: its value, the condition number of that, and the largest value that the model has.
#[derive(Clone, Copy)]
struct Density {
    value: f64,
    condition: f64,
    most: f64,
}

/// Walter et al. (33); 0 behind the surface. `blur` is how much more uncertain the half vector is than rounding.
fn trowbridge(n: V, h: V, alpha: f64, blur: f64) -> Density {
    let (cos, sin2) = angle(n, h);
    let (a, most) = (width(alpha), 1.0 / (PI * width(alpha).powi(2)));
    if cos <= 0.0 {
        return Density { value: 0.0, condition: 1.0, most };
    }
    let tan2 = sin2 / (cos * cos);
    let value = a * a / (PI * cos.powi(4) * (a * a + tan2).powi(2));
    let core = sin2 + a * a * cos * cos;
    let condition = 8.0 + 4.0 * blur * sin2.sqrt() / core + 4.0 * blur * blur * SINGLE / core;
    Density { value, condition, most }
}

/// Heitz 2014 (85): two widths, along the tangent and across it.
fn stretched(n: V, t: V, h: V, alpha: [f64; 2], blur: f64) -> Density {
    let [a, b] = alpha.map(width);
    let (x, y, z) = (dot(t, h), dot(cross(n, t), h), dot(n, h));
    let most = 1.0 / (PI * a * b);
    if z <= 0.0 {
        return Density { value: 0.0, condition: 1.0, most };
    }
    let slopes = (x / (z * a)).powi(2) + (y / (z * b)).powi(2);
    let value = 1.0 / (PI * a * b * z.powi(4) * (1.0 + slopes).powi(2));
    let core = (x / a).powi(2) + (y / b).powi(2) + z * z;
    let slope = ((x / a / a).powi(2) + (y / b / b).powi(2)).sqrt();
    let condition = 8.0 + 4.0 * blur * (slope + 1.0) / core + 4.0 * blur * blur * SINGLE / (a.min(b).powi(2) * core);
    Density { value, condition, most }
}

/// Walter et al. (25).
fn sandblasted(n: V, h: V, alpha: f64, blur: f64) -> Density {
    let (cos, sin2) = angle(n, h);
    let (a, most) = (width(alpha), 1.0 / (PI * width(alpha).powi(2)));
    if cos <= 0.0 {
        return Density { value: 0.0, condition: 1.0, most };
    }
    let tan2 = sin2 / (cos * cos);
    let value = (-tan2 / (a * a)).exp() / (PI * a * a * cos.powi(4));
    let slope = (2.0 * tan2.sqrt() / (a * a) + 4.0 * tan2.sqrt()) / (cos * cos);
    let condition = 8.0 + tan2 / (a * a) + blur * slope + blur * blur * SINGLE / (a * a);
    Density { value, condition, most: most.max(value) }
}

/// Estevez and Kulla (2).
fn charlie(n: V, h: V, alpha: f64, blur: f64) -> Density {
    let k = 1.0 / width(alpha);
    let (cos, sin2) = angle(n, h);
    let most = (2.0 + k) / (2.0 * PI);
    // The logarithm of the sine from whichever of the two is small.
    let log = if cos * cos < 0.5 { (-cos * cos).ln_1p() / 2.0 } else { sin2.ln() / 2.0 };
    let value = most * (k * log).exp();
    let sin = sin2.sqrt().max(f64::MIN_POSITIVE);
    let condition = 8.0 + (k * log).abs().min(1e30) + 2.0 * blur * k * cos.abs() / sin;
    Density { value, condition: condition.min(most / value.max(f64::MIN_POSITIVE) * 64.0 * blur), most }
}

/// A density as an answer whose errors are relative to its largest value.
fn told(Density { value, condition, most }: Density, jump: f64) -> Option<Answer> {
    let share = value / most;
    let answer = Answer::new([value], most).conditioned((share * condition).max(f64::MIN_POSITIVE));
    Some(if jump == 0.0 { answer } else { answer.jumping(jump) })
}

/// Smith's Lambda of the model of Trowbridge and Reitz: Heitz (72).
fn lambda(cos: f64, alpha: f64) -> f64 {
    let tan2 = (1.0 - cos * cos).max(0.0) / (cos * cos);
    ((1.0 + alpha * alpha * tan2).sqrt() - 1.0) / 2.0
}

/// The rational fit of Beckmann's.
fn lambda_beckmann(cos: f64, alpha: f64) -> f64 {
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    let a = cos / (alpha * sin);
    let [b, c, d, e, f] = [1.259_f32, 0.396, 3.535, 2.181, 1.6].map(f64::from);
    if sin == 0.0 || a >= f { 0.0 } else { (1.0 - b * a + c * a * a).max(0.0) / (d * a + e * a * a) }
}

/// pi D G_2 / (4 N.V), Heitz (99), for the lambdas of the light and the eye; at N.V = 0 by its limit.
fn specular(
    density: impl FnOnce(V, f64) -> Density,
    (n, l, v): (V, V, V),
    (lambda_l, hidden_v): (f64, impl Fn(f64) -> f64),
    sharpest: f64,
) -> Option<Answer> {
    let (h, blur) = half(l, v)?;
    lit(n, l, || {
        let (nl, nv) = (dot(n, l), dot(n, v).max(0.0));
        let density = density(h, blur);
        // N.V (1 + Lambda + Lambda) with N.V Lambda(V) as one function.
        let seen = nv * (1.0 + lambda_l) + hidden_v(nv);
        let value = PI * density.value / (4.0 * seen);
        let most = PI * density.most / (4.0 * seen);
        let condition = density.condition + 4.0 / (nv + sharpest) + 2.0 * nv * lambda_l / (nl * seen);
        let answer = Answer::new([value], most).conditioned((value / most * condition).max(f64::MIN_POSITIVE));
        Some(answer.jumping(dot(n, h).abs() / blur))
    })
}

pub(super) fn factor(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, alpha) = (a.d(), a.d(), a.d(), a.f());
    let w = width(alpha);
    let hidden = |nv: f64| if nv > 1e-9 { nv * lambda(nv, w) } else { ((w * w + nv * nv).sqrt() - nv) / 2.0 };
    specular(|h, blur| trowbridge(n, h, alpha, blur), (n, l, v), (lambda(dot(n, l), w), hidden), w)
}

fn brushed(a: &Args<'_>) -> Option<Answer> {
    let (n, t, l, v, alpha) = (a.d(), a.d(), a.d(), a.d(), a.v2());
    let b = cross(n, t);
    let [x, y] = alpha.map(width);
    // The width in the direction of a vector, from the slopes: Heitz (80).
    let lambda = |u: V| {
        let z = dot(n, u).max(f64::MIN_POSITIVE);
        ((1.0 + ((x * dot(t, u)).powi(2) + (y * dot(b, u)).powi(2)) / (z * z)).sqrt() - 1.0) / 2.0
    };
    // An eye below the surface counts as grazing: at a right angle to the normal, in the plane of both.
    let is_below = dot(n, v) <= 0.0;
    let flat = dot(t, v).hypot(dot(b, v));
    if is_below && flat < 1e-6 {
        return None;
    }
    let long = if is_below { flat } else { 1.0 };
    let hidden = |nv: f64| {
        let across = ((x * dot(t, v)).powi(2) + (y * dot(b, v)).powi(2)) / (long * long);
        if nv > 1e-9 { nv * lambda(v) } else { ((across + nv * nv).sqrt() - nv) / 2.0 }
    };
    let answer = specular(|h, blur| stretched(n, t, h, alpha, blur), (n, l, v), (lambda(l), hidden), x.min(y))?;
    let condition = answer.condition / long;
    Some(answer.conditioned(condition))
}

fn beckmann(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, alpha) = (a.d(), a.d(), a.d(), a.f());
    let w = width(alpha);
    let hidden = |nv: f64| if nv > 1e-9 { nv * lambda_beckmann(nv, w) } else { w / f64::from(3.535_f32) };
    specular(|h, blur| sandblasted(n, h, alpha, blur), (n, l, v), (lambda_beckmann(dot(n, l), w), hidden), w / 4.0)
}

fn sheen(a: &Args<'_>) -> Option<Answer> {
    fibers((a.d(), a.d(), a.d()), a.f())
}

/// Estevez and Kulla's density with the visibility of Neubelt and Pettineo.
fn fibers((n, l, v): (V, V, V), alpha: f64) -> Option<Answer> {
    let (h, blur) = half(l, v)?;
    lit(n, l, || {
        let (nl, nv) = (dot(n, l), dot(n, v).max(0.0));
        let density = charlie(n, h, alpha, blur);
        let seen = PI * nl / (4.0 * (nl + nv - nl * nv));
        let condition = density.value / density.most * (density.condition + 4.0 / (nl + nv));
        let answer = Answer::new([density.value * seen], density.most);
        Some(answer.conditioned(condition.max(f64::MIN_POSITIVE)))
    })
}

/// The extension of glTF: the base loses what the fibers return.
fn covered(a: &Args<'_>) -> Option<Answer> {
    let (base, n, l, v) = (a.v(), a.d(), a.d(), a.d());
    let (roughness, color, light) = (a.f(), a.v(), a.v());
    let alone = fibers((n, l, v), roughness * roughness)?;
    let factor = alone.values.first().copied()?;
    let (table, condition) = super::ltc::reflected(n, v);
    let left = 1.0 - color.iter().fold(0.0, |most: f64, k| most.max(*k)) * table.first()?;
    let value = add(scale(left, base), scale(factor, mul(color, light)));
    let brightest = base.iter().chain(&light).fold(1.0, |most: f64, x| most.max(*x));
    let scale = brightest * alone.scale.max(1.0);
    Some(Answer::new(value, scale).conditioned(condition + alone.condition).jumping(alone.jump))
}

/// Schlick 1994 (15), for each channel.
fn schlick(cos: f64, f0: V, f90: V) -> V {
    let p = (1.0 - cos.clamp(0.0, 1.0)).powi(5);
    add(f0, scale(p, sub(f90, f0)))
}

/// An answer times a color: errors stay relative to the same largest value.
fn colored(answer: Option<Answer>, color: V) -> Option<Answer> {
    let Answer { values, condition, jump, scale: most, .. } = answer?;
    let value = values.first().copied()?;
    let brightest = color.iter().fold(f64::MIN_POSITIVE, |most: f64, x| most.max(x.abs()));
    let answer = Answer::new(scale(value, color), most * brightest);
    Some(answer.conditioned(condition + 8.0 * value / most).jumping(jump))
}

fn reflected(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, alpha, f0, light) = (a.d(), a.d(), a.d(), a.f(), a.v(), a.v());
    let numbers: Vec<f64> = [n, l, v].iter().flatten().copied().chain([alpha]).collect();
    let (h, _) = half(l, v)?;
    let color = schlick(dot(v, h), f0, [1.0; 3]);
    colored(factor(&Args::of(&numbers)), std::array::from_fn(|i| color[i] * light[i]))
}

fn coated(a: &Args<'_>) -> Option<Answer> {
    let (base, n, l, v, strength, alpha, light) = (a.v(), a.d(), a.d(), a.d(), a.f(), a.f(), a.v());
    let numbers: Vec<f64> = [n, l, v].iter().flatten().copied().chain([alpha]).collect();
    let weight = strength * schlick(dot(n, v).abs(), [0.04; 3], [1.0; 3])[0];
    let Answer { values, condition, jump, scale: most, .. } = factor(&Args::of(&numbers))?;
    let gloss = values.first().copied()? * weight;
    let sum = add(scale(1.0 - weight, base), scale(gloss, light));
    let size = 4.0 * (1.0 + most * weight);
    let answer = Answer::new(sum, size);
    Some(answer.conditioned(1.0 + condition * most * weight / (1.0 + most * weight)).jumping(jump))
}

/// Both amplitudes by the angles of both sides: Born and Wolf (1.5.2).
fn dielectric(cos: f64, n: f64) -> Option<Answer> {
    let sin2 = (1.0 - cos) * (1.0 + cos);
    let inside2 = 1.0 - sin2 / (n * n);
    let jump = (n * n * inside2).abs();
    let value = if n == 1.0 {
        0.0
    } else if inside2 <= 0.0 {
        1.0
    } else {
        let inside = inside2.sqrt();
        let s = (cos - n * inside) / (cos + n * inside);
        let p = (n * cos - inside) / (n * cos + inside);
        (s * s + p * p) / 2.0
    };
    let answer = Answer::new([value], 1.0).conditioned(8.0 + 4.0 / jump.sqrt());
    Some(if n > 1.0 { answer } else { answer.jumping(jump) })
}

/// The amplitudes with the complex refractive index: Born and Wolf (14.2), the root by its length and its angle.
fn metal(cos: f64, n: f64, k: f64) -> (f64, f64) {
    let sin2 = (1.0 - cos) * (1.0 + cos);
    let (re, im) = (n * n - k * k - sin2, 2.0 * n * k);
    let (length, turn) = (re.hypot(im).sqrt(), im.atan2(re) / 2.0);
    let (a, b) = (length * turn.cos(), length * turn.sin());
    let s = ((cos - a).powi(2) + b * b) / ((cos + a).powi(2) + b * b);
    let tan_sin = sin2 / cos.max(1e-40);
    let p = s * ((a - tan_sin).powi(2) + b * b) / ((a + tan_sin).powi(2) + b * b);
    ((s + p) / 2.0, 8.0 + 4.0 / length)
}

fn conductor(a: &Args<'_>) -> Option<Answer> {
    let (cos, n, k) = (a.f(), a.v(), a.v());
    let channels: [(f64, f64); 3] = std::array::from_fn(|i| metal(cos, n[i], k[i]));
    let condition = channels.iter().fold(0.0, |most: f64, (_, condition)| most.max(*condition));
    Some(Answer::new(channels.map(|(value, _)| value), 1.0).conditioned(condition))
}

pub(super) static FORMS: &[Form] = forms! {
    "fresnel" "fresnelSchlick(float,vec3,vec3)" [Unit, Color, Color]
        |a| Some(Answer::new(schlick(a.f(), a.v(), a.v()), 1.0).conditioned(4.0));
    "fresnel" "fresnelNormal(float)" [Index] |a| {
        let n = a.f();
        // 1 - 4 n / (n + 1)^2, whose digits are fewer where n is near 1.
        let value = 1.0 - 4.0 * n / (n + 1.0).powi(2);
        Some(Answer::new([value], 1.0).conditioned(4.0))
    };
    "fresnel" "fresnelDielectric(float,float)" [Unit, Index] |a| dielectric(a.f(), a.f());
    "fresnel" "fresnelConductor(float,vec3,vec3)" [Unit, Metal, Metal] conductor;
    "ggx" "ggxLimit(float)" [Alpha] |a| Some(Answer::relative([width(a.f())]));
    "ggx" "ggxDistribution(vec3,vec3,float)" [Near, Alpha] |a| {
        let (n, h) = (a.d(), a.d());
        told(trowbridge(n, h, a.f(), 2.0), dot(n, h).abs())
    };
    "ggx" "ggxDistribution(vec3,vec3,vec3,vec2)" [Tangent, Direction, Alpha, Alpha] |a| {
        let (n, t, h) = (a.d(), a.d(), a.d());
        told(stretched(n, t, h, a.v2(), 2.0), dot(n, h).abs())
    };
    "ggx" "ggxVisibility(float,float,float)" [Unit, Unit, Alpha] |a| {
        let (l, v, w) = (a.f(), a.f(), width(a.f()));
        // Heitz (99) over 4 N.L N.V.
        let value = 1.0 / (4.0 * l * v * (1.0 + lambda(l, w) + lambda(v, w)));
        (l > 1e-9 && v > 1e-9).then(|| Answer::relative([value]).conditioned(8.0))
    };
    "ggx" "ggxFactor(vec3,vec3,vec3,float)" [Lighting, Alpha] factor;
    "ggx" "ggxFactor(vec3,vec3,vec3,vec3,vec2)" [Tangent, Direction, Direction, Alpha, Alpha] brushed;
    "ggx" "ggxAlbedo(float,float,vec3)" [Unit, Unit, Color] |a| {
        let (cos, r, f0) = (a.f(), a.f(), a.v());
        // Karis 2014, listing of EnvBRDFApprox.
        let [c0, c1, c2, c3] = [0.0275_f32, 0.572, 0.022, 9.28].map(f64::from);
        let [d1, d2, d3] = [0.0425_f32, 1.04, 0.04].map(f64::from);
        let first = 1.0 - r;
        let a004 = (first * first).min((-c3 * cos).exp2()) * first + d1 - c0 * r;
        let (scale, bias) = (d2 - c1 * r - d2 * a004, d2 * a004 + c2 * r - d3);
        Some(Answer::new(f0.map(|f0| (f0 * scale + bias).max(0.0)), 1.0).conditioned(16.0))
    };
    "ggx" "ggx(vec3,vec3,vec3,float,vec3,vec3)" [Lighting, Alpha, Color, Intensity] reflected;
    "beckmann" "beckmannDistribution(vec3,vec3,float)" [Near, Alpha] |a| {
        let (n, h) = (a.d(), a.d());
        told(sandblasted(n, h, a.f(), 2.0), dot(n, h).abs())
    };
    "beckmann" "beckmannHidden(float,float)" [Unit, Alpha] |a| {
        let (cos, w) = (a.f(), width(a.f()));
        let value = if cos == 0.0 { w / f64::from(3.535_f32) } else { cos * lambda_beckmann(cos, w) };
        Some(Answer::new([value], 1.0).conditioned(4.0))
    };
    "beckmann" "beckmannFactor(vec3,vec3,vec3,float)" [Lighting, Alpha] beckmann;
    "sheen" "sheenDistribution(vec3,vec3,float)" [Near, Alpha] |a| {
        let (n, h) = (a.d(), a.d());
        told(charlie(n, h, a.f(), 2.0), 0.0)
    };
    "sheen" "sheenFactor(vec3,vec3,vec3,float)" [Lighting, Alpha] sheen;
    "sheen" "sheenAlbedo(sampler2D,vec3,vec3,float)" [Direction, Direction, Unit] |a| {
        let (table, condition) = super::ltc::reflected(a.d(), a.d());
        Some(Answer::new([*table.first()?], 1.0).conditioned(condition))
    };
    "sheen" "sheen(sampler2D,vec3,vec3,vec3,vec3,float,vec3,vec3)" [Intensity, Lighting, Unit, Color, Intensity] covered;
    "clearcoat" "clearcoatWeight(vec3,vec3,float)" [Direction, Direction, Unit]
        |a| Some(Answer::new([schlick(dot(a.d(), a.d()).abs(), [0.04; 3], [1.0; 3])[0] * a.f()], 1.0).conditioned(5.0));
    "clearcoat" "clearcoat(vec3,vec3,vec3,vec3,float,float,vec3)" [Intensity, Lighting, Unit, Alpha, Intensity] coated;
};
