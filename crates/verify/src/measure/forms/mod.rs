//! The closed forms, with one file for each group of modules.

mod bodies;
mod color;
mod diffuse;
mod equations;
mod geometry;
mod helpers;
mod layers;
mod looks;
mod ltc;
mod microfacet;
mod models;
mod naive;
mod shadows;
mod shapes;
mod sources;
mod surroundings;
mod today;
mod tone;

use super::vector::{V, cross, dot, norm};
use super::{Answer, Form, InputKind};

/// All tables.
pub(super) static ALL: &[&[Form]] = &[
    helpers::FORMS,
    models::FORMS,
    equations::FORMS,
    geometry::FORMS,
    color::FORMS,
    microfacet::FORMS,
    layers::FORMS,
    diffuse::FORMS,
    tone::FORMS,
    looks::FORMS,
    sources::FORMS,
    ltc::FORMS,
    surroundings::FORMS,
    bodies::FORMS,
    today::FORMS,
    shadows::FORMS,
    shapes::FORMS,
    naive::FORMS,
];

/// A table of rows: module, signature, kinds of the inputs, closed form.
macro_rules! forms {
    ($($module:literal $signature:literal [$($kind:ident),*] $answer:expr;)*) => {
        &[$(Form { module: $module, signature: $signature, inputs: &[$(InputKind::$kind),*], answer: $answer }),*]
    };
}
use forms;

/// max(cos, 0)^k of the angle between two unit vectors, each `blur` times as uncertain as its rounding. Near 0
/// degrees it uses the sine, where the modules use the distance of the vectors.
fn cosine_power(a: V, b: V, k: f64, blur: f64) -> Option<Answer> {
    let (cos, sin) = (dot(a, b), norm(cross(a, b)));
    if k <= 0.0 {
        return Some(Answer::new([1.0], 1.0));
    }
    // Small exponents have a steep slope at a right angle.
    let jump = if cos == 0.0 { f64::INFINITY } else { cos.abs() / blur };
    if cos <= 0.0 {
        return Some(Answer::new([0.0], 1.0).jumping(jump));
    }
    let log = if sin * sin < 0.5 { 0.5 * (-sin * sin).ln_1p() } else { cos.ln() };
    let value = (k * log).exp();
    // By the rounding of the exponent, and by that of the vectors through the derivative.
    let condition = value * (1.0 + (k * log).abs()) + blur * k * value * sin / cos;
    Some(Answer::new([value], 1.0).conditioned(condition.max(f64::MIN_POSITIVE)).jumping(jump))
}

/// (90) of the angle between two unit vectors.
fn rational(a: V, b: V, k: f64, blur: f64) -> Option<Answer> {
    let (cos, sin) = (dot(a, b), norm(cross(a, b)));
    if cos <= 0.0 {
        return Some(Answer::new([0.0], 1.0).jumping(cos.abs() / blur));
    }
    let distance = sin * sin / (1.0 + cos);
    let value = cos / (k * distance + cos);
    let slope = k * sin / (k * distance + cos).powi(2);
    Some(Answer::new([value], 1.0).conditioned(4.0 * value + blur * slope).jumping(cos / blur))
}

/// The half vector of two unit vectors, and how much more uncertain it is than they are; `None` where they cancel.
fn half(l: V, v: V) -> Option<(V, f64)> {
    let sum = super::vector::add(l, v);
    let length = norm(sum);
    (length > 1e-6).then(|| (super::vector::unit(sum), 2.0 / length.min(1.0)))
}

/// The value of a factor behind the gate N.L > 0.
fn lit(n: V, l: V, factor: impl FnOnce() -> Option<Answer>) -> Option<Answer> {
    let cos = dot(n, l);
    let answer = if cos > 0.0 { factor()? } else { Answer::new([0.0], 1.0) };
    Some(if cos == 0.0 { answer } else { answer.jumping(cos.abs()) })
}

/// A factor times a color.
fn tinted(factor: Option<Answer>, color: V) -> Option<Answer> {
    let Answer { values, condition, jump, .. } = factor?;
    let value = values.first().copied()?;
    let most = color.iter().fold(f64::MIN_POSITIVE, |most: f64, x| most.max(x.abs()));
    Some(Answer::new(color.map(|x| value * x), most).conditioned(condition.max(value) * 2.0).jumping(jump))
}
