//! Functions with a rule of their own, and those that inherit one from a formula.
//!
//! *Holds:* a function that inherits its precision from a formula is computed by it (at both bounds of the argument
//! if the function is monotonic), and limited to the range of the function. Arguments with an undefined result may
//! yield NaN.

use super::formula::evaluate;
use super::round::{OUTWARD, ulps_above, ulps_below};
use super::{EnvelopeFloat, powers};
use crate::domain::Number;
use crate::domain::rules::{self, FLUSH, ulp};
use glisten_front::builtin::operations::Formula;
use std::f64::consts::{FRAC_PI_2, PI};

/// The largest error above the maximum of a function: two ULP of 1.
const TOP: f64 = 2.4e-7;

impl EnvelopeFloat {
    /// An increasing function that inherits its error from a formula: the formula at both bounds. Between them the
    /// roundings may be twice as large, if there is a power of two.
    pub(super) fn by_ends(self, f: impl Fn(f64) -> f64, formula: impl Fn(Self) -> Self) -> Self {
        let [low, high] = self.bounds().map(formula);
        let more = |end: Self| if self.low == self.high { 0.0 } else { end.high - end.low };
        let may_be_nan = self.may_be_nan || low.may_be_nan || high.may_be_nan;
        let (least, most) = (low.low.min(high.low), low.high.max(high.high));
        let more = more(low).max(more(high));
        Self::rounded(f(self.value), least - more, most + more, may_be_nan)
    }

    pub(super) fn inverse_square_root(self) -> Self {
        let value = 1.0 / self.value.sqrt();
        let n = rules::INVERSESQRT.ulps();
        if self.low >= FLUSH {
            let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
            return Self::rounded(value, ulps_below(low, high, n), ulps_above(low, high, n), self.may_be_nan);
        }
        if self.high < 0.0 {
            return Self::anything(value);
        }
        let low = 1.0 / self.high.max(FLUSH).sqrt();
        Self {
            high: f64::INFINITY,
            ..Self::rounded(value, ulps_below(low, low, n), low, self.may_be_nan || self.low < 0.0)
        }
    }

    pub(super) fn square_root(self) -> Self {
        if !const { rules::SQRT.inherits(&rules::kernels::SQRT) } {
            return self.rising_by(&rules::SQRT, f64::sqrt);
        }
        let value = self.value.sqrt();
        if self.high < 0.0 {
            return Self::anything(value);
        }
        let (first, second) = (rules::INVERSESQRT.ulps(), rules::DIV.ulps());
        let end = |x: f64, sign: f64| {
            if x <= 0.0 {
                return 0.0;
            }
            let inner = 1.0 / x.sqrt();
            let root = 1.0 / (inner - sign * first * ulp(inner) * (1.0 + 1e-6));
            // Twice the ULP below, since there may be a power of two just above.
            root + sign * second * ulp(root) * (1.0 + 1e-6)
        };
        let flushed = |x: f64| if x < FLUSH { 0.0 } else { x };
        let low = end(flushed(self.low), -1.0);
        let high = end(self.high, 1.0);
        Self::rounded(value, low.max(0.0), high, self.may_be_nan || self.low < 0.0)
    }

    /// An exponential function, with the exact value and the function for its bounds.
    pub(super) fn exponential(self, value: f64, f: impl Fn(f64) -> f64) -> Self {
        let n = |x: f64| rules::EXP.ulps_at(x);
        let (low, high) = (f(self.low), f(self.high));
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n(self.low)) };
        let above = if high.is_finite() { ulps_above(low, high, n(self.high)) } else { high };
        // The number of ULPs decreases toward 0, but the result increases faster, so its bounds are at those of the
        // interval.
        Self::rounded(value, below.max(0.0), above, self.may_be_nan)
    }

    /// A logarithm, with the exact value and the function for its bounds.
    pub(super) fn logarithm(self, value: f64, f: impl Fn(f64) -> f64) -> Self {
        if self.high < 0.0 {
            return Self::anything(value);
        }
        let (from, to) = const { rules::LOG.within() };
        let near_one = self.high >= from && self.low <= to;
        let error = |result: f64| {
            let outside = rules::LOG.ulps() * ulp(result);
            let error = if near_one { outside.max(rules::LOG.absolute()) } else { outside };
            error * OUTWARD
        };
        let least = if self.low < FLUSH { f64::NEG_INFINITY } else { f(self.low) };
        let most = if self.high < FLUSH { f(FLUSH) } else { f(self.high) };
        let low = if least.is_finite() { least - error(least) } else { least };
        let high = if most.is_finite() { most + error(most) } else { most };
        Self::rounded(value, low, high, self.may_be_nan || self.low < 0.0)
    }

    pub(super) fn power(self, exponent: Self) -> Self {
        let value = Number::pow(self.value, exponent.value);
        if !const { rules::POW.inherits(&rules::kernels::POW) } {
            return Self::by_formula(&rules::POW, value, &[self, exponent]);
        }
        if self.high < 0.0 {
            return Self::anything(value);
        }
        let product = exponent.mul(self.logarithm(0.0, powers::log2));
        if product.low > product.high || (self.high == 0.0 && exponent.low <= 0.0) {
            return Self::anything(value);
        }
        let power = product.exponential(value, powers::exp2);
        // 0^0 is undefined (§8.2).
        let undefined = self.low <= 0.0 && exponent.low <= 0.0;
        let top = if undefined { power.high.max(1.0) } else { power.high };
        Self { high: top, may_be_nan: power.may_be_nan || undefined, ..power }
    }

    /// The extremes of a cosine between two angles.
    fn cosine_hull(low: f64, high: f64) -> (f64, f64) {
        let width = high - low;
        let (_, lost) = const { rules::SIN.within() };
        if width.is_nan() || width >= 2.0 * PI || low.abs().max(high.abs()) >= lost {
            return (-1.0, 1.0);
        }
        let (a, b) = (low.cos(), high.cos());
        let (mut least, mut most) = (a.min(b), a.max(b));
        let first = (low / PI).ceil();
        for turn in [first, first + 1.0] {
            if turn * PI <= high {
                if turn.rem_euclid(2.0) == 0.0 {
                    most = 1.0;
                } else {
                    least = -1.0;
                }
            }
        }
        (least, most)
    }

    fn wave(self, value: f64, (least, most): (f64, f64)) -> Self {
        let largest = self.low.abs().max(self.high.abs());
        // Above pi the argument is reduced. That loses as much as rounding an f32 of that size.
        let (reduced_beyond, _) = const { rules::SIN.within() };
        let reduced = if largest > reduced_beyond { ulp(largest) } else { 0.0 };
        let error = rules::SIN.absolute() + reduced;
        let may_be_nan = self.may_be_nan || largest.is_infinite();
        Self::rounded(value, least - error, most + error, may_be_nan).within(-1.0 - TOP, 1.0 + TOP)
    }

    pub(super) fn sine(self) -> Self {
        self.wave(self.value.sin(), Self::cosine_hull(self.low - FRAC_PI_2, self.high - FRAC_PI_2))
    }

    pub(super) fn cosine(self) -> Self {
        self.wave(self.value.cos(), Self::cosine_hull(self.low, self.high))
    }

    pub(super) fn arc_tangent(self) -> Self {
        self.rising_by(&rules::ATAN, f64::atan)
    }

    pub(super) fn angle(self, x: Self) -> Self {
        let value = self.value.atan2(x.value);
        let n = rules::ATAN.ulps();
        let full = ulps_above(PI, PI, n);
        let may_be_nan = self.may_be_nan || x.may_be_nan;
        let over_cut = self.low <= 0.0 && self.high >= 0.0 && x.low <= 0.0;
        if over_cut
            || (self.low.is_infinite() || self.high.is_infinite()) && (x.low.is_infinite() || x.high.is_infinite())
        {
            // The branch cut along negative x, and the origin, which GLSL leaves undefined (§8.1).
            let origin = x.high >= 0.0 && over_cut;
            return Self { value, low: -full, high: full, may_be_nan: may_be_nan || origin };
        }
        let corners = [(self.low, x.low), (self.low, x.high), (self.high, x.low), (self.high, x.high)];
        let angles = corners.map(|(y, x)| y.atan2(x));
        let low = angles.iter().copied().fold(f64::INFINITY, f64::min);
        let high = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n) };
        let above = if high == 0.0 { 0.0 } else { ulps_above(low, high, n) };
        Self::rounded(value, below, above, may_be_nan)
    }

    /// `asin` and `acos` at a point inherit from `atan2` and the root of `1 - x x`. WGSL's table also allows an
    /// absolute error.
    fn arc(self, value: f64, f: impl Fn(f64) -> f64, rule: &rules::Rule) -> Self {
        if self.low > 1.0 || self.high < -1.0 {
            return Self::anything(value);
        }
        let inside = Self { low: self.low.max(-1.0), high: self.high.min(1.0), ..self };
        let at = |x: f64| Self::by_formula(rule, f(x), &[Self::exact(x)]);
        let (a, b) = (at(inside.low), at(inside.high));
        let (fa, fb) = (f(inside.low), f(inside.high));
        let error = |end: Self, exact: f64| {
            let inherited = (exact - end.low).max(end.high - exact);
            if inherited.is_finite() { inherited.max(rule.absolute()) } else { rule.absolute() }
        };
        // Between the bounds a ULP may be twice as large.
        let error = error(a, fa).max(error(b, fb)) * if self.low == self.high { 1.0 } else { 2.0 };
        let may_be_nan = self.may_be_nan || self.low < -1.0 || self.high > 1.0;
        Self::rounded(value, fa.min(fb) - error, fa.max(fb) + error, may_be_nan)
    }

    pub(super) fn arc_sine(self) -> Self {
        self.arc(self.value.asin(), f64::asin, &rules::ASIN)
    }

    pub(super) fn arc_cosine(self) -> Self {
        let most = ulps_above(PI, PI, rules::ATAN.ulps());
        self.arc(self.value.acos(), f64::acos, &rules::ACOS).within(-rules::ACOS.absolute(), most)
    }

    pub(super) fn hyperbolic_cosine(self) -> Self {
        let value = self.value.cosh();
        let size = self.abs();
        let found = size.rising_by(&rules::COSH, f64::cosh);
        // The sum of a number and its reciprocal, both with an error.
        Self { low: found.low.max(1.0 - 1e-6), ..found.of_value(value) }
    }

    /// `x (1 - a) + y a`, or by distributivity `x + (y - x) a`: linear in each argument, so the extremes are at the
    /// corners, plus the roundings of the formulas.
    pub(super) fn mixed(self, y: Self, a: Self) -> Self {
        let value = self.value * (1.0 - a.value) + y.value * a.value;
        if !const { rules::MIX.inherits(&rules::kernels::MIX) } {
            return Self::by_formula(&rules::MIX, value, &[self, y, a]);
        }
        let rest = Self::exact(1.0).sub(a);
        let (left, right) = (self.mul(rest), y.mul(a));
        let gap = y.sub(self);
        let step = gap.mul(a);
        let either = left.add(right).joined(self.add(step));
        if (a.low == a.high && self.low == self.high && y.low == y.high) || !(either.high - either.low).is_finite() {
            return either.of_value(value);
        }
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for x in [self.low, self.high] {
            for y in [y.low, y.high] {
                for a in [a.low, a.high] {
                    let corner = x + (y - x) * a;
                    low = low.min(corner);
                    high = high.max(corner);
                }
            }
        }
        let size = |of: Self| of.low.abs().max(of.high.abs());
        let first = size(self) * ulp(size(rest)) + ulp(size(left)) + ulp(size(right)) + ulp(size(left) + size(right));
        let second = size(a) * ulp(size(gap)) + ulp(size(step)) + ulp(size(self) + size(step));
        let roundings = first.max(second) * (1.0 + 1e-6);
        let low = (low - roundings).max(either.low);
        let high = (high + roundings).min(either.high);
        Self::rounded(value, low, high, either.may_be_nan)
    }

    /// A formula of `t`, which increases between 0 and 1, with `t = clamp((x - edge0) / (edge1 - edge0), 0, 1)`.
    pub(super) fn smooth_step(edge0: Self, edge1: Self, x: Self) -> Self {
        let Some(Formula::With(curve, t)) = rules::SMOOTHSTEP.formula() else {
            let value = Number::smoothstep(edge0.value, edge1.value, x.value);
            return Self::by_formula(&rules::SMOOTHSTEP, value, &[edge0, edge1, x]);
        };
        let t = evaluate(t, &[&[edge0], &[edge1], &[x]], 0);
        t.by_ends(|t| evaluate(curve, &[&[t]], 0), |t| evaluate(curve, &[&[t]], 0)).within(0.0, 1.0 + TOP)
    }
}
