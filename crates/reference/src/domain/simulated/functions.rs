//! Built-in functions of a simulated GPU: by their rules, each with this GPU's error.
//!
//! *In:* a rule of the table, and the exact function. *Out:* an f32 that the rule allows. *Holds:* a GPU that computes a
//! function well rounds the exact result to the nearest; another one has an error that swings between the bounds of the
//! rule. A function that inherits from a formula is either, or the formula step by step.

use super::SimulatedFloat;
use super::gpu::{Form, Function, Gpu, Swing};
use super::llvmpipe;
use crate::domain::rules::{self, ulp};
use crate::domain::{Number, evaluate};
use glisten_front::builtin::operations::precision::{Precision, Rule};

/// The largest error of the sine and the cosine of drivers, where the rule allows 2^-11.
const TYPICAL_ANGLE: f64 = 1.0 / 1_048_576.0;

/// The largest error of other functions of drivers in ULP, where the rule allows more.
const TYPICAL_ULPS: f64 = 64.0;

/// How far a number is in its binade, 0 to 1.
#[inline(always)]
pub(super) fn fraction(x: f64) -> f64 {
    const FRACTION: u64 = (1 << 52) - 1;
    f64::from_bits(x.to_bits() & FRACTION | 1.0_f64.to_bits()) - 1.0
}

/// The f32 near an exact result that is off by the swing of a GPU's error at a place, at most by `allowed`. Zeros, infinities,
/// and what follows from infinities are exact, as on every GPU.
#[inline(always)]
pub(super) fn off(exact: f64, allowed: f64, swing: Swing, place: f64) -> f64 {
    if exact == 0.0 || !exact.is_finite() || !allowed.is_finite() {
        return exact;
    }
    // The rounding to f32 is a part of it.
    let room = (allowed - 0.5 * ulp(exact)).max(0.0);
    f64::from((exact + swing.at(place) * room) as f32)
}

/// `a * (1.0 / b)`, the reciprocal rounded to the nearest. Where it has no f32, the quotient.
#[inline(always)]
pub(super) fn by_reciprocal(a: f64, b: f64) -> f64 {
    let reciprocal = f64::from((1.0 / b) as f32);
    let has_one = (reciprocal.abs() >= f64::from(f32::MIN_POSITIVE)) & reciprocal.is_finite();
    if has_one { a * reciprocal } else { a / b }
}

/// The exact result with this GPU's error, at most `allowed`.
fn with_error(gpu: &Gpu, exact: f64, allowed: f64, function: Function, place: f64) -> f64 {
    let swing = Gpu::swing_of(function);
    gpu.rounded(if swing.is_none() { exact } else { off(exact, allowed, swing, place) })
}

impl SimulatedFloat {
    /// A function of one number.
    pub(super) fn by_rule(self, rule: &Rule, function: Function, f: impl Fn(f64) -> f64) -> Self {
        let gpu = Gpu::current();
        let x = self.read(&gpu);
        let exact = f(x);
        let by_formula = || !Gpu::is_precise(function) && exact.is_finite() && !gpu.has_second(Form::Inherited);
        let allowed = match rule.precision {
            Precision::Ulps(ulps) if gpu.typical => ulps.min(TYPICAL_ULPS) * ulp(exact),
            Precision::Ulps(_) | Precision::UlpsWithArgument { .. } => rule.ulps_at(x) * ulp(exact),
            Precision::UlpsOrWithin { ulps, error, low, high } => {
                let inside = if (low..=high).contains(&x) { error } else { 0.0 };
                inside.max(ulps * ulp(exact))
            }
            Precision::Absolute(error) => error,
            Precision::Angle { .. } if gpu.sine.is_some() && x.is_finite() => {
                let sine = llvmpipe::sine(x, function == Function::Cos, gpu.sine == Some(true));
                return Self(gpu.rounded(sine));
            }
            Precision::Inherited(formula) if gpu.sine.is_some() && function == Function::Tan => {
                return evaluate(formula, &[&[Self(x)]], 0);
            }
            Precision::Angle { error, reduced, lost } => {
                return angular(&gpu, x, exact, function, [error, reduced, lost]);
            }
            Precision::Inherited(formula) if by_formula() => return evaluate(formula, &[&[Self(x)]], 0),
            Precision::InheritedOr(formula, _) if by_formula() && !gpu.is_extreme() => {
                return evaluate(formula, &[&[Self(x)]], 0);
            }
            Precision::InheritedOr(_, error) => error,
            Precision::Inherited(_)
            | Precision::Exact
            | Precision::Correct
            | Precision::EitherHalf
            | Precision::EitherOfNan
            | Precision::EitherDifference
            | Precision::Cofactors => 0.0,
        };
        Self(with_error(&gpu, exact, allowed, function, fraction(x)))
    }

    /// `a / b`. Drivers divide, or multiply by the reciprocal.
    pub(super) fn quotient(self, other: Self) -> Self {
        let gpu = Gpu::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        let exact = a / b;
        if gpu.typical && !Gpu::is_precise(Function::Divide) {
            return Self(gpu.rounded(by_reciprocal(a, b)));
        }
        Self(with_error(&gpu, exact, rules::DIV.ulps() * ulp(exact), Function::Divide, fraction(b)))
    }

    /// `1.0 / inversesqrt(x)`, or the exact root.
    pub(super) fn root(self) -> Self {
        let gpu = Gpu::current();
        if Gpu::is_precise(Function::Sqrt) || gpu.has_second(Form::Inherited) {
            return Self(gpu.rounded(self.read(&gpu).sqrt()));
        }
        Self(1.0).div(self.inversesqrt())
    }

    /// `exp2(y log2(x))`, or the exact power.
    pub(super) fn power(self, exponent: Self) -> Self {
        let gpu = Gpu::current();
        let (x, y) = (self.read(&gpu), exponent.read(&gpu));
        if Gpu::is_precise(Function::Pow) || x < 0.0 {
            return Self(gpu.rounded(Number::pow(x, y)));
        }
        Self(y).mul(Self(x).log2()).exp2()
    }

    /// `atan(y, x)`
    pub(super) fn angle(self, x: Self) -> Self {
        let gpu = Gpu::current();
        let (y, x) = (self.read(&gpu), x.read(&gpu));
        let exact = y.atan2(x);
        let ulps = rules::ATAN.ulps().min(if gpu.typical { TYPICAL_ULPS } else { f64::INFINITY });
        Self(with_error(&gpu, exact, ulps * ulp(exact), Function::Atan, fraction(y / x)))
    }
}

/// A sine or cosine: its error is a function of the angle within the period, and beyond the first one the angle is
/// rounded once more. It does not leave the range of the function, although the rule lets it.
fn angular(gpu: &Gpu, x: f64, exact: f64, function: Function, [error, reduced, lost]: [f64; 3]) -> SimulatedFloat {
    if !exact.is_finite() {
        return SimulatedFloat(exact);
    }
    let turn = (x / std::f64::consts::TAU).fract().abs();
    let swing = Gpu::swing_of(function);
    if x.abs() >= lost && !swing.is_none() && !gpu.typical {
        return SimulatedFloat(f64::from(swing.at(turn) as f32));
    }
    let error = if gpu.typical { error.min(TYPICAL_ANGLE) } else { error };
    let angle = if x.abs() > reduced { ulp(x) } else { 0.0 };
    SimulatedFloat(with_error(gpu, exact, error + angle, function, turn).clamp(-1.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{EnvelopeFloat, binary, unary};
    use glisten_front::builtin::operations::{Binary, Unary};

    fn arguments() -> impl Iterator<Item = f64> {
        (1..400).map(|k| {
            let bits = glisten_scene::random::mixed(k);
            let unit = (bits >> 40) as f64 / (1_u64 << 24) as f64;
            let scale = 2f64.powi((bits % 13) as i32 - 8);
            f64::from(((unit * 2.0 - 1.0) * scale) as f32)
        })
    }

    /// Checks results against their envelopes, and keeps one that is outside of each function's.
    #[derive(Default)]
    struct Checked {
        /// The results that have room.
        counted: u32,
        outside: std::collections::BTreeMap<&'static str, String>,
    }

    impl Checked {
        fn add(&mut self, name: &'static str, arguments: &[f64], found: SimulatedFloat, envelope: EnvelopeFloat) {
            let (found, interval) = (found.value(), envelope.interval());
            let holds =
                if found.is_nan() { interval.may_be_nan } else { found >= interval.low && found <= interval.high };
            if !holds {
                let told = format!("{name}{arguments:?} is {found}, outside of {interval:?}, by {:?}", Gpu::current());
                self.outside.entry(name).or_insert(told);
            }
            self.counted += u32::from(interval.low < interval.high);
        }
    }

    /// A result of an infinity has no error: `pow(0.0, 16.0)` is 0 on every GPU.
    #[test]
    fn infinities_have_no_error() {
        for number in 0..48 {
            Gpu::of(3, number).enter();
            let of = |value: f64| SimulatedFloat::from_f64(value);
            assert_eq!(of(0.0).pow(of(16.0)).value(), 0.0, "{:?}", Gpu::current());
            assert_eq!(of(f64::NEG_INFINITY).exp2().value(), 0.0);
            assert_eq!(of(f64::INFINITY).inversesqrt().value(), 0.0);
            assert_eq!(of(6.0).div(of(f64::INFINITY)).value(), 0.0);
        }
        Gpu::STRICT.enter();
    }

    /// Drivers that multiply by the reciprocal divide a number by itself, and by a power of two, without an error.
    #[test]
    fn gpus_that_are_as_drivers_are_divide_as_they_do() {
        for number in 0..Gpu::TYPICAL {
            Gpu::of(1, number).enter();
            let divided = |a: f64, b: f64| SimulatedFloat::from_f64(a).div(SimulatedFloat::from_f64(b)).value();
            assert_eq!([(2.0, 2.0), (5.0, 4.0)].map(|(a, b)| divided(a, b)), [1.0, 1.25]);
            assert!(divided(3.0, 3.0) >= 1.0, "so that `mod` is 0");
        }
        Gpu::STRICT.enter();
    }

    /// Every function of every GPU of the population is inside of the envelope of the same function.
    #[test]
    fn functions_are_inside_of_their_envelopes() {
        let mut checked = Checked::default();
        let numbers: Vec<f64> = arguments().collect();
        for number in 0..48 {
            Gpu::of(3, number).enter();
            for (x, y) in numbers.iter().zip(numbers.iter().skip(1)) {
                let [a, b] = [*x, *y].map(SimulatedFloat::from_f64);
                let [wide_a, wide_b] = [*x, *y].map(EnvelopeFloat::from_f64);
                for op in Unary::ALL {
                    checked.add(op.name(), &[*x], unary(*op, a), unary(*op, wide_a));
                }
                for op in Binary::ALL {
                    checked.add(op.name(), &[*x, *y], binary(*op, a, b), binary(*op, wide_a, wide_b));
                }
                let half = [*x, *y].map(|number| SimulatedFloat::from_f64(number).mix(b, a));
                let wide = [*x, *y].map(|number| EnvelopeFloat::from_f64(number).mix(wide_b, wide_a));
                half.into_iter().zip(wide).for_each(|(found, wide)| checked.add("mix", &[*x, *y], found, wide));
            }
        }
        Gpu::STRICT.enter();
        assert!(checked.outside.is_empty(), "{:#?}", checked.outside);
        assert!(checked.counted > 100_000, "{} of them have room", checked.counted);
    }
}
