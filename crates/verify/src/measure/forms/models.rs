//! Closed forms of diffuse and specular reflection, the hemisphere and toon shading: (82) to (92), and the article's.

use super::{Form, InputKind, cosine_power, cross, dot, forms, half, lit, rational, tinted};
use crate::measure::vector::{V, add, mul, scale, sub};
use crate::measure::{Answer, Args, looked_up};

/// The mirror direction, by its parts along and across the normal.
fn mirror(n: V, l: V) -> V {
    sub(scale(dot(n, l), n), cross(n, cross(l, n)))
}

/// 0.5 (1 + cos), by the length of the sum.
fn half_range(n: V, l: V) -> f64 {
    let sum = add(n, l);
    dot(sum, sum) / 4.0
}

fn phong(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
    lit(n, l, || cosine_power(mirror(n, l), v, k, 4.0))
}

fn blinn(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
    let (h, blur) = half(l, v)?;
    lit(n, l, || cosine_power(n, h, k, blur))
}

/// (91): 0 or 1.
fn step(a: &Args<'_>) -> Option<Answer> {
    let (n, l, v, t) = (a.d(), a.d(), a.d(), a.f());
    let (h, blur) = half(l, v)?;
    lit(n, l, || above(dot(n, h), t, blur))
}

fn above(cos: f64, t: f64, blur: f64) -> Option<Answer> {
    let cos = cos.max(0.0);
    Some(Answer::new([f64::from(u8::from(cos > t))], 1.0).jumping((cos - t).abs() / blur))
}

fn hemisphere(n: V, axis: V, sky: V, ground: V) -> V {
    let weight = half_range(n, axis);
    add(scale(weight, sky), scale(1.0 - weight, ground))
}

fn directional(a: &Args<'_>) -> V {
    let (n, l, axis, color, light) = (a.d(), a.d(), a.d(), a.v(), a.v());
    let both = add(scale(dot(n, l).max(0.0), light), hemisphere(n, axis, a.v(), a.v()));
    mul(color, both)
}

fn ramp(a: &Args<'_>) -> Option<Answer> {
    let (n, l, edge, width, lit, dark) = (a.d(), a.d(), a.f(), a.f(), a.v(), a.v());
    let x = half_range(n, l) - edge;
    if width <= 0.0 {
        return Some(Answer::new(if x < 0.0 { dark } else { lit }, 1.0).jumping(x.abs()));
    }
    // The smooth step as the integral of 6 t (1 - t), from either end.
    let t = ((x + width) / (2.0 * width)).clamp(0.0, 1.0);
    let s = if t < 0.5 { t * t * (3.0 - 2.0 * t) } else { 1.0 - (1.0 - t) * (1.0 - t) * (1.0 + 2.0 * t) };
    Some(Answer::new(add(scale(s, lit), scale(1.0 - s, dark)), 1.0).conditioned(2.0 + 1.0 / width))
}

fn colored(values: V, scale: f64) -> Option<Answer> {
    Some(Answer::new(values, scale))
}

/// The contents of the table, whose steepest slope is 4.
fn table(x: f64) -> Option<Answer> {
    Some(Answer::new(looked_up(x), 1.0).conditioned(8.0))
}

pub(super) static FORMS: &[Form] = forms! {
    "lambert" "lambertFactor(vec3,vec3)" [Direction, Direction] |a| Some(Answer::new([dot(a.d(), a.d()).max(0.0)], 1.0));
    "lambert" "lambert(vec3,vec3,vec3,vec3)" [Direction, Direction, Color, Intensity]
        |a| colored(scale(dot(a.d(), a.d()).max(0.0), mul(a.v(), a.v())), 4.0);
    "lambert" "lambertUnclamped(vec3,vec3,vec3,vec3)" [Direction, Direction, Color, Intensity]
        |a| colored(scale(dot(a.d(), a.d()), mul(a.v(), a.v())), 4.0);
    "half_lambert" "halfLambertFactor(vec3,vec3)" [Near] |a| Some(Answer::new([half_range(a.d(), a.d())], 1.0));
    "half_lambert" "halfLambertRegister(vec3)" [Direction] |a| {
        let l = a.d();
        Some(Answer::new([l[0] / 2.0, l[1] / 2.0, l[2] / 2.0, 0.5], 1.0))
    };
    "half_lambert" "halfLambertDot(vec3,vec4)" [Direction, Four] |a| {
        let (n, [x, y, z, w]) = (a.d(), a.v4());
        Some(Answer::new([(dot(n, [x, y, z]) + w).clamp(0.0, 1.0)], 4.0))
    };
    "half_lambert" "halfLambert(vec3,vec3,vec3,vec3)" [Near, Color, Intensity]
        |a| colored(scale(half_range(a.d(), a.d()), mul(a.v(), a.v())), 4.0);
    "phong" "mirrorDirection(vec3,vec3)" [Direction, Direction] |a| Some(Answer::new(mirror(a.d(), a.d()), 1.0));
    "phong" "phongFactor(vec3,vec3,vec3,float)" [Lighting, Exponent] phong;
    "phong" "phong(vec3,vec3,vec3,float,vec3,vec3)" [Lighting, Exponent, Color, Intensity]
        |a| { let factor = phong(a); tinted(factor, mul(a.v(), a.v())) };
    "blinn_phong" "halfVector(vec3,vec3)" [Direction, Direction] |a| {
        let (h, blur) = half(a.d(), a.d())?;
        Some(Answer::new(h, 1.0).conditioned(blur))
    };
    "blinn_phong" "blinnPhongFactor(vec3,vec3,vec3,float)" [Lighting, Exponent] blinn;
    "blinn_phong" "blinnPhong(vec3,vec3,vec3,float,vec3,vec3)" [Lighting, Exponent, Color, Intensity]
        |a| { let factor = blinn(a); tinted(factor, mul(a.v(), a.v())) };
    "schlick" "schlick(float,float)" [Unit, Exponent] |a| {
        let (t, k) = (a.f(), a.f());
        if t == 0.0 { return Some(Answer::new([0.0], 1.0)); }
        Some(Answer::new([1.0 / (k * (1.0 - t) / t + 1.0)], 1.0))
    };
    "schlick" "schlickBetween(vec3,vec3,float)" [Near, Exponent] |a| rational(a.d(), a.d(), a.f(), 2.0);
    "schlick" "schlickBlinnFactor(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| {
        let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
        let (h, blur) = half(l, v)?;
        lit(n, l, || rational(n, h, k, blur))
    };
    "schlick" "schlickPhongFactor(vec3,vec3,vec3,float)" [Lighting, Exponent] |a| {
        let (n, l, v, k) = (a.d(), a.d(), a.d(), a.f());
        lit(n, l, || rational(mirror(n, l), v, k, 4.0))
    };
    "threshold" "thresholdStep(float,float)" [Unit, Unit] |a| above(a.f(), a.f(), 1.0);
    "threshold" "thresholdFactor(vec3,vec3,vec3,float)" [Lighting, Unit] step;
    "threshold" "threshold(vec3,vec3,vec3,float,vec3,vec3)" [Lighting, Unit, Color, Intensity]
        |a| { let factor = step(a); tinted(factor, mul(a.v(), a.v())) };
    "quartic" "quartic(float)" [Signed] |a| Some(Answer::new([a.f().clamp(0.0, 1.0).powf(4.0)], 1.0));
    "quartic" "quarticFactor(vec3,vec3,vec3)" [Lighting] |a| {
        let (n, l, v) = (a.d(), a.d(), a.d());
        lit(n, l, || Some(Answer::new([dot(mirror(n, l), v).max(0.0).powf(4.0)], 1.0).conditioned(4.0)))
    };
    "specular_lut" "specularLutHalf(sampler2D,vec3,vec3,vec3)" [Lighting] |a| {
        let (n, l, v) = (a.d(), a.d(), a.d());
        let (h, blur) = half(l, v)?;
        let cos = dot(n, l);
        let gloss = if cos > 0.0 { table(dot(n, h))?.conditioned(8.0 * blur) } else { Answer::new([0.0; 3], 1.0) };
        Some(if cos == 0.0 { gloss } else { gloss.jumping(cos.abs()) })
    };
    "specular_lut" "specularLutLight(sampler2D,vec3,vec3)" [Direction, Direction] |a| table(dot(a.d(), a.d()));
    "ambient" "ambient(vec3,vec3)" [Color, Intensity] |a| Some(Answer::relative(mul(a.v(), a.v())));
    "hemisphere" "hemisphereWeight(vec3,vec3)" [Near] |a| Some(Answer::new([half_range(a.d(), a.d())], 1.0));
    "hemisphere" "hemisphere(vec3,vec3,vec3,vec3)" [Near, Intensity, Intensity]
        |a| colored(hemisphere(a.d(), a.d(), a.v(), a.v()), 4.0);
    "hemisphere" "hemisphereLut(sampler2D,vec3,vec3)" [Near] |a| table(half_range(a.d(), a.d()));
    "hemisphere" "hemisphereDirectional(vec3,vec3,vec3,vec3,vec3,vec3,vec3)"
        [Direction, Direction, Direction, Color, Intensity, Intensity, Intensity] |a| colored(directional(a), 8.0);
    "hemisphere" "hemisphereSpecular(vec3,vec3,vec3,vec3,vec3,vec3,vec3,vec3)"
        [Direction, Direction, Direction, Color, Intensity, Intensity, Intensity, Intensity]
        |a| { let sum = directional(a); colored(add(sum, a.v()), 12.0) };
    "toon" "toonSoft(sampler2D,vec3,vec3)" [Direction, Direction] |a| table(half_range(a.d(), a.d()));
    "toon" "toonHard(vec3,vec3,float,vec3,vec3)" [Direction, Direction, Signed, Color, Color] |a| {
        let (cos, edge) = (dot(a.d(), a.d()), a.f());
        let (lit, dark) = (a.v(), a.v());
        Some(Answer::new(if cos > edge { lit } else { dark }, 1.0).jumping((cos - edge).abs()))
    };
    "toon" "toonRamp(vec3,vec3,float,float,vec3,vec3)" [Near, Unit, Width, Color, Color] ramp;
};
