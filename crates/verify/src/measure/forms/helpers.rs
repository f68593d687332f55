//! Closed forms of `safe` and `lut`.

use super::{Form, InputKind, cosine_power, cross, dot, forms, norm};
use crate::measure::{Answer, looked_up, vector};

const MOST: f64 = f32::MAX as f64;

fn exact(values: impl Into<Vec<f64>>) -> Option<Answer> {
    Some(Answer::relative(values))
}

/// The power of two that scales an extent to about 1.
fn power_of_two(extent: f64) -> f64 {
    match extent {
        x if x > 60.0f64.exp2() => (-100.0f64).exp2(),
        x if x < (-40.0f64).exp2() => 100.0f64.exp2(),
        _ => 1.0,
    }
}

/// e^(k log) of a number whose logarithm is known up to rounding.
fn power(log: f64, k: f64) -> Option<Answer> {
    let exponent = if k > 0.0 { k * log } else { 0.0 };
    let value = exponent.exp();
    Some(Answer::new([value], 1.0).conditioned((value * (2.0 + exponent.abs())).max(f64::MIN_POSITIVE)))
}

pub(super) static FORMS: &[Form] = forms! {
    "safe" "safeLargest()" [] |_| exact([MOST]);
    "safe" "safeLimit(float)" [Any] |a| exact([a.f()]);
    "safe" "safeLimit(vec3)" [Any3] |a| exact(a.v());
    "safe" "safeLimit(vec4)" [Any4] |a| exact(a.v4());
    "safe" "safeFinite(float)" [Any] |a| exact([a.f()]);
    "safe" "safeFinite(vec3)" [Any3] |a| exact(a.v());
    "safe" "safePositive(float)" [Any] |a| exact([a.f().max(0.0)]);
    "safe" "safeUnit(float)" [Signed] |a| exact([a.f().clamp(0.0, 1.0)]);
    "safe" "safeExtent(vec3)" [Any3] |a| exact([a.v().iter().fold(0.0, |most: f64, x| most.max(x.abs()))]);
    "safe" "safeScale(float)" [Any] |a| exact([power_of_two(a.f())]);
    "safe" "safeLength(vec3)" [Any3] |a| exact([norm(a.v()).min(MOST)]);
    "safe" "safeNormalize(vec3)" [Any3] |a| Some(Answer::new(vector::unit(a.v()), 1.0));
    "safe" "safeLogOneMinus(float)" [Distance01] |a| exact([(-a.f()).ln_1p().max(-MOST)]);
    "safe" "safePowOneMinus(float,float)" [Distance01, Exponent] |a| power((-a.f()).ln_1p(), a.f());
    "safe" "safePow(float,float)" [Unit, Exponent] |a| power(a.f().ln(), a.f());
    "safe" "safeOneMinusCos(vec3,vec3)" [Near] |a| {
        let (a, b) = (a.d(), a.d());
        let half = 0.5 * norm(cross(a, b)).atan2(dot(a, b));
        let distance = 2.0 * half.sin().powi(2);
        // Vectors closer to each other than their rounding have a distance of about its square.
        Some(Answer::new([distance], 1.0).conditioned(2.0 * half + distance + f64::EPSILON))
    };
    "safe" "safeCosPow(vec3,vec3,float)" [Near, Exponent] |a| cosine_power(a.d(), a.d(), a.f(), 2.0);
    "lut" "lutCoordinate(float,float)" [Unit, Size] |a| {
        let (x, n) = (a.f(), a.f());
        Some(Answer::new([0.5 / n + x * (1.0 - 1.0 / n)], 1.0))
    };
    "lut" "lutColor(sampler2D,float)" [Signed] |a| Some(Answer::new(looked_up(a.f()), 1.0).conditioned(8.0));
};
