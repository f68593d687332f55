//! Functions with a rule of their own, and those that inherit one from a formula.
//!
//! *Holds:* a function that inherits its precision from a formula may be off to either side by as much as the formula
//! is to one of them (Vulkan: Precision and Operation); it is computed at both bounds of the argument if the function
//! is monotonic. No result is cut to the range of the function where a rule allows more. Arguments with a result that
//! GLSL leaves undefined yield [`EnvelopeFloat::anything`].

use super::formula::evaluate;
use super::round::{OUTWARD, ulps_above, ulps_below};
use super::{EnvelopeFloat, powers};
use crate::domain::Number;
use crate::domain::rules::{self, FLUSH, ulp};
use glisten_front::builtin::operations::Formula;
use std::f64::consts::{FRAC_PI_2, PI};

impl EnvelopeFloat {
    /// An increasing function that inherits its error from a formula: the error of the formula at both bounds, to
    /// either side. Between them it may be twice as large, if there is a power of two.
    pub(super) fn between_ends(self, f: impl Fn(f64) -> f64, [low, high]: [Self; 2]) -> Self {
        let (least, most) = (f(self.low), f(self.high));
        let off = |exact: f64, end: Self| (exact - end.low).max(end.high - exact);
        let may_be_nan = self.may_be_nan || low.may_be_nan || high.may_be_nan;
        let error = off(least, low).max(off(most, high)) * if self.low == self.high { 1.0 } else { 2.0 };
        Self::rounded(f(self.value), least - error, most + error, may_be_nan)
    }

    pub(super) fn inverse_square_root(self) -> Self {
        let value = 1.0 / self.value.sqrt();
        let n = rules::INVERSESQRT.ulps();
        if self.low >= FLUSH {
            let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
            return Self::rounded(value, ulps_below(low, high, n), ulps_above(low, high, n), self.may_be_nan);
        }
        // Undefined up to 0 (GLSL 1.50 §8.2), and a subnormal may be 0.
        Self::anything(value)
    }

    /// The reciprocal of a vector's length, for its components: [`Self::inverse_square_root`], or with the error of
    /// `1.0 / length`, which WGSL allows.
    pub(super) fn unit_scale(self) -> Self {
        let value = 1.0 / self.value.sqrt();
        if self.low < FLUSH {
            return Self::anything(value);
        }
        let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
        Self::rounded(value, low * (1.0 - Self::UNIT_SCALE), high * (1.0 + Self::UNIT_SCALE), self.may_be_nan)
    }

    /// A component times a [scale](Self::unit_scale): a product, or a quotient by the length.
    pub(super) fn scaled(self, scale: Self) -> Self {
        let product = self.mul(scale);
        let n = rules::DIV.ulps();
        let (below, above) = (ulps_below(product.low, product.high, n), ulps_above(product.low, product.high, n));
        if !(below.is_finite() && above.is_finite()) {
            return product;
        }
        Self::rounded(product.value, below, above, product.may_be_nan)
    }

    pub(super) fn square_root(self) -> Self {
        if !const { rules::SQRT.inherits(&rules::kernels::SQRT) } {
            return self.rising_by(&rules::SQRT, f64::sqrt);
        }
        let value = self.value.sqrt();
        // Undefined below 0 (§8.2).
        if self.low < 0.0 {
            return Self::anything(value);
        }
        let (first, second) = (rules::INVERSESQRT.ulps(), rules::DIV.ulps());
        // The formula is farther off above than below.
        let off = |x: f64| {
            if x <= 0.0 {
                return 0.0;
            }
            let (inner, exact) = (1.0 / x.sqrt(), x.sqrt());
            let root = 1.0 / (inner - first * ulp(inner) * (1.0 + 1e-6));
            root + second * ulp(root) * (1.0 + 1e-6) - exact
        };
        let flushed = if self.low < FLUSH { 0.0 } else { self.low };
        Self::rounded(value, flushed.sqrt() - off(flushed), self.high.sqrt() + off(self.high), self.may_be_nan)
    }

    /// An exponential function, with the exact value and the function for its bounds.
    pub(super) fn exponential(self, value: f64, f: impl Fn(f64) -> f64) -> Self {
        self.exponential_off(0.0, value, f)
    }

    /// An exponential inherited by a function whose exponent is wrong by up to `off`.
    fn exponential_off(self, off: f64, value: f64, f: impl Fn(f64) -> f64) -> Self {
        let n = |x: f64| rules::EXP.ulps_at(x);
        let (low, high) = (f(self.low), f(self.high));
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n(self.low)) };
        let above = if high.is_finite() { ulps_above(low, high, n(self.high)) } else { high };
        // The number of ULPs decreases toward 0, but the result increases faster, so its bounds are at those of the
        // interval.
        let below = Self::mirrored(below.max(0.0), low, off, n(self.low));
        Self::rounded(value, below, above, self.may_be_nan)
    }

    /// A logarithm, with the exact value and the function for its bounds.
    pub(super) fn logarithm(self, value: f64, f: impl Fn(f64) -> f64) -> Self {
        // Undefined up to 0 (§8.2), and a subnormal may be 0.
        if self.low < FLUSH {
            return Self::anything(value);
        }
        self.logarithm_in_power(value, f)
    }

    /// The logarithm inside `pow`, which is defined at 0: minus infinity.
    fn logarithm_in_power(self, value: f64, f: impl Fn(f64) -> f64) -> Self {
        let (from, to) = const { rules::LOG.within() };
        let near_one = self.high >= from && self.low <= to;
        let absolute = if near_one { rules::LOG.absolute() * OUTWARD } else { 0.0 };
        let least = if self.low < FLUSH { f64::NEG_INFINITY } else { f(self.low) };
        let most = if self.high < FLUSH { f(FLUSH) } else { f(self.high) };
        let n = rules::LOG.ulps();
        let low = if least.is_finite() { ulps_below(least, most, n).min(least - absolute) } else { least };
        let high = if most.is_finite() { ulps_above(least, most, n).max(most + absolute) } else { most };
        Self::rounded(value, low, high, self.may_be_nan)
    }

    pub(super) fn power(self, exponent: Self) -> Self {
        let value = Number::pow(self.value, exponent.value);
        if !const { rules::POW.inherits(&rules::kernels::POW) } {
            return Self::by_formula(&rules::POW, value, &[self, exponent]);
        }
        // Undefined below 0, and at 0 unless the exponent is greater than 0 (§8.2).
        if self.low < 0.0 || self.low < FLUSH && exponent.low <= 0.0 {
            return Self::anything(value);
        }
        let logarithm = self.logarithm_in_power(0.0, powers::log2);
        let product = exponent.mul(logarithm);
        if product.low > product.high {
            return Self::anything(value);
        }
        let off = if product.low.is_finite() && product.high.is_finite() {
            let ends = [self.low, self.high].map(powers::log2);
            let error = (ends[0] - logarithm.low).max(logarithm.high - ends[1]);
            let largest = exponent.low.abs().max(exponent.high.abs());
            largest * error + ulp(product.low.abs().max(product.high.abs()))
        } else {
            0.0
        };
        // The product may be rounded to either side, and so the result be off to either side.
        let rounding = if off == 0.0 { 0.0 } else { ulp(product.low.abs().max(product.high.abs())) };
        let product = Self { low: product.low - rounding, high: product.high + rounding, ..product };
        product.exponential_off(off, value, powers::exp2)
    }

    /// The lower bound of a power whose exponent is wrong by up to `off`, where the formula's is `below`, from a result
    /// of `low`: the result may be as far below the exact one as the formula is above, `2 - 2^off` of it and ULPs of
    /// that.
    #[inline(always)]
    pub(super) fn mirrored(below: f64, low: f64, off: f64, ulps: f64) -> f64 {
        if off == 0.0 || low == 0.0 {
            return below;
        }
        let share = if off <= Self::FAR_OFF {
            1.0 - Self::ROUND_TRIP * off * off
        } else {
            let above = off.exp2();
            above * (2.0 - above * (1.0 + 1e-4))
        };
        // The formula's result is below `low 2^(2 off)`.
        let upper = low * if off <= Self::FAR_OFF { 1.0 + 2.0 * off } else { (2.0 * off).exp2() };
        below.min(low * share - (ulps + 4.0 * off) * OUTWARD * ulp(upper))
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
        // Where glisten's own rule adds to the error, it does not add above the function's range.
        let (under, over) = (-1.0 - rules::SIN.absolute(), 1.0 + rules::SIN.absolute());
        Self::rounded(value, (least - error).max(under), (most + error).min(over), may_be_nan)
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
            return if origin { Self::anything(value) } else { Self { value, low: -full, high: full, may_be_nan } };
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
        // Undefined beyond 1 (§8.1).
        if self.low < -1.0 || self.high > 1.0 {
            return Self::anything(value);
        }
        let at = |x: f64| Self::by_formula(rule, f(x), &[Self::exact(x)]);
        let (a, b) = (at(self.low), at(self.high));
        let (fa, fb) = (f(self.low), f(self.high));
        let error = |end: Self, exact: f64| {
            let inherited = (exact - end.low).max(end.high - exact);
            if inherited.is_finite() { inherited.max(rule.absolute()) } else { rule.absolute() }
        };
        // Between the bounds a ULP may be twice as large.
        let error = error(a, fa).max(error(b, fb)) * if self.low == self.high { 1.0 } else { 2.0 };
        Self::rounded(value, fa.min(fb) - error, fa.max(fb) + error, self.may_be_nan)
    }

    pub(super) fn arc_sine(self) -> Self {
        self.arc(self.value.asin(), f64::asin, &rules::ASIN)
    }

    pub(super) fn arc_cosine(self) -> Self {
        self.arc(self.value.acos(), f64::acos, &rules::ACOS)
    }

    /// Undefined below 1 (§8.1). The ends are those of the rule's formula.
    pub(super) fn area_cosine(self, ends: [Self; 2]) -> Self {
        let value = Number::acosh(self.value);
        let inside = self.low >= 1.0;
        if inside { self.rising_between(&rules::ACOSH, Number::acosh, ends) } else { Self::anything(value) }
    }

    /// Undefined from 1 on (§8.1). The ends are those of the rule's formula.
    pub(super) fn area_tangent(self, ends: [Self; 2]) -> Self {
        let value = Number::atanh(self.value);
        let inside = self.low > -1.0 && self.high < 1.0;
        if inside { self.rising_between(&rules::ATANH, Number::atanh, ends) } else { Self::anything(value) }
    }

    /// By its formula, whose error at a point counts to either side.
    pub(super) fn tangent(self) -> Self {
        let value = self.value.tan();
        let found = Self::by_formula(&rules::TAN, value, &[self]);
        if !self.is_point() {
            return found;
        }
        let error = (value - found.low).max(found.high - value);
        Self::rounded(value, value - error, value + error, found.may_be_nan)
    }

    /// By its formula, or with WGSL's absolute error. Where the formula's powers overflow, its result is not limited:
    /// there the range is that of the absolute error, and NaN, which infinity over infinity is.
    pub(super) fn hyperbolic_tangent(self, ends: [Self; 2]) -> Self {
        let found = self.rising_between(&rules::TANH, f64::tanh, ends);
        let most = 1.0 + rules::TANH.absolute();
        if found.low.is_finite() && found.high.is_finite() { found } else { found.within(-most, most) }
    }

    pub(super) fn hyperbolic_cosine(self) -> Self {
        let value = self.value.cosh();
        self.abs().rising_by(&rules::COSH, f64::cosh).of_value(value)
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

    /// A formula of `t`, which increases between 0 and 1, with `t = clamp((x - edge0) / (edge1 - edge0), 0, 1)`. It is
    /// undefined unless `edge0 < edge1` (§8.3).
    pub(super) fn smooth_step(edge0: Self, edge1: Self, x: Self) -> Self {
        if edge0.high >= edge1.low || edge0.may_be_nan || edge1.may_be_nan {
            return Self::anything(Number::smoothstep(edge0.value, edge1.value, x.value));
        }
        let Some(Formula::With(curve, t)) = rules::SMOOTHSTEP.formula() else {
            let value = Number::smoothstep(edge0.value, edge1.value, x.value);
            return Self::by_formula(&rules::SMOOTHSTEP, value, &[edge0, edge1, x]);
        };
        let t = evaluate(t, &[&[edge0], &[edge1], &[x]], 0);
        let found = t.between_ends(|t| evaluate(curve, &[&[t]], 0), t.bounds().map(|t| evaluate(curve, &[&[t]], 0)));
        if t.low == t.high || t.may_be_nan {
            return found;
        }
        // Exact at both ends of the curve, but not between them. The error is a share of the result: that of `t t`, of
        // `3 - 2 t`, which is half as large at most, and of their product.
        const SHARE: f64 = 5.0 / (1 << 23) as f64;
        let of = |t: f64| t * t * (3.0 - 2.0 * t);
        let (low, high) = (of(t.low) * (1.0 - SHARE), of(t.high) * (1.0 + SHARE));
        Self::rounded(found.value, low.min(found.low).max(0.0), high.max(found.high), found.may_be_nan)
    }
}
