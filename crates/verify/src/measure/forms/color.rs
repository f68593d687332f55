//! Closed forms of the transfer function: IEC 61966-2-1.

use super::{Form, InputKind, forms};
use crate::measure::vector::V;
use crate::measure::{Answer, Args};

/// The linear value at which the two pieces meet, and the encoded one.
const JOINT: [f64; 2] = [0.003_130_8, 0.040_45];

fn encoded(c: f64) -> f64 {
    if c <= JOINT[0] { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
}

fn decoded(v: f64) -> f64 {
    if v <= JOINT[1] { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// A channel of a color, and its distance from the joint.
fn channel(x: f64, curve: impl Fn(f64) -> f64, joint: f64) -> (f64, f64) {
    let x = x.clamp(0.0, 1.0);
    (curve(x), if x == joint { f64::INFINITY } else { (x - joint).abs() })
}

fn one(a: &Args<'_>, curve: impl Fn(f64) -> f64, joint: f64) -> Option<Answer> {
    let (value, jump) = channel(a.f(), curve, joint);
    Some(Answer::new([value], 1.0).conditioned(4.0).jumping(jump))
}

fn three(a: &Args<'_>, curve: impl Fn(f64) -> f64, joint: f64) -> Option<Answer> {
    let parts: V = a.v();
    let parts = parts.map(|x| channel(x, &curve, joint));
    let jump = parts.iter().fold(f64::INFINITY, |least: f64, (_, jump)| least.min(*jump));
    Some(Answer::new(parts.map(|(value, _)| value), 1.0).conditioned(4.0).jumping(jump))
}

pub(super) static FORMS: &[Form] = forms! {
    "srgb" "srgbEncode(float)" [Signed] |a| one(a, encoded, JOINT[0]);
    "srgb" "srgbEncode(vec3)" [Color] |a| three(a, encoded, JOINT[0]);
    "srgb" "srgbDecode(float)" [Signed] |a| one(a, decoded, JOINT[1]);
    "srgb" "srgbDecode(vec3)" [Color] |a| three(a, decoded, JOINT[1]);
};
