//! The operations on the bounds of one lane, without branches, so that loops over lanes compile to vector
//! instructions.
//!
//! *In:* the bounds of operands. *Out:* the bounds of [`EnvelopeFloat`]'s operation, or *special* if only that operation
//! can compute them.
//!
//! *Holds:* both agree in lanes that are not special, except for the sign of a zero.

use crate::domain::envelope::float::{greatest, is_power_of_two, least};
use crate::domain::envelope::round::{BELOW, MAX, OUTWARD, ulps_above, ulps_below};
use crate::domain::envelope::{EnvelopeFloat, powers};
use crate::domain::rules::{self, FLUSH, ulp};

/// The bounds of a lane.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaneBounds {
    pub(super) low: f64,
    pub(super) high: f64,
    /// Whether the bounds mean nothing.
    pub(super) special: bool,
}

/// [`down`](super::super::round::down) of a number up to [`MAX`], moved down first if digits were `lost`.
#[inline(always)]
fn down(x: f64, lost: bool) -> f64 {
    let step = u64::from(lost);
    let moved = if x < 0.0 { BELOW + step } else { step.wrapping_neg() };
    let on_grid = f64::from_bits(x.to_bits().wrapping_add(moved) & !BELOW);
    let flushed = if x < 0.0 { -FLUSH } else { 0.0 };
    if x.abs() < FLUSH { flushed } else { on_grid }
}

#[inline(always)]
fn up(x: f64, lost: bool) -> f64 {
    -down(-x, lost)
}

impl LaneBounds {
    #[inline(always)]
    pub(super) fn of(low: f64, high: f64) -> Self {
        Self { low, high, special: false }
    }

    /// The bounds rounded outward.
    #[inline(always)]
    pub(super) fn rounded(low: f64, high: f64) -> Self {
        // A NaN is special, too.
        let fine = (low.abs() <= MAX) & (high.abs() <= MAX);
        Self { low: down(low, false), high: up(high, false), special: !fine }
    }

    #[inline(always)]
    pub(super) fn or_special(self, special: bool) -> Self {
        Self { special: self.special | special, ..self }
    }

    #[inline(always)]
    fn holds_zero(self) -> bool {
        (self.low <= 0.0) & (self.high >= 0.0)
    }

    #[inline(always)]
    fn is_point(self) -> bool {
        self.low == self.high
    }

    #[inline(always)]
    pub(super) fn neg(self) -> Self {
        Self::of(-self.high, -self.low)
    }

    #[inline(always)]
    pub(super) fn add(self, other: Self) -> Self {
        let (low, high) = (self.low + other.low, self.high + other.high);
        let low_lost = ((low == self.low) & (other.low < 0.0)) | ((low == other.low) & (self.low < 0.0));
        let high_lost = ((high == self.high) & (other.high > 0.0)) | ((high == other.high) & (self.high > 0.0));
        // After lost digits, the largest f32 may be exceeded, too.
        let fine = (low.abs() < MAX) & (high.abs() < MAX);
        Self { low: down(low, low_lost), high: up(high, high_lost), special: !fine }
    }

    #[inline(always)]
    pub(super) fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    #[inline(always)]
    pub(super) fn mul(self, other: Self) -> Self {
        let (ll, lh) = (self.low * other.low, self.low * other.high);
        let (hl, hh) = (self.high * other.low, self.high * other.high);
        let fine = (ll + lh + hl + hh).is_finite();
        Self::rounded(least(least(ll, lh), least(hl, hh)), greatest(greatest(ll, lh), greatest(hl, hh)))
            .or_special(!fine)
    }

    #[inline(always)]
    pub(super) fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let low = if self.holds_zero() { 0.0 } else { least(a, b) };
        Self::rounded(low, greatest(a, b))
    }

    #[inline(always)]
    pub(super) fn div(self, other: Self) -> Self {
        let (ll, lh) = (self.low / other.low, self.low / other.high);
        let (hl, hh) = (self.high / other.low, self.high / other.high);
        let (low, high) = (least(least(ll, lh), least(hl, hh)), greatest(greatest(ll, lh), greatest(hl, hh)));
        let (a, b) = (other.low.abs(), other.high.abs());
        let inside = (least(a, b) >= FLUSH) & (greatest(a, b) <= 1.0 / FLUSH) & (ll + lh + hl + hh).is_finite();
        let exact = other.is_point() & is_power_of_two(other.low);
        let n = rules::DIV.ulps();
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n) };
        let above = if high == 0.0 { 0.0 } else { ulps_above(low, high, n) };
        Self::rounded(below, above).or_special(other.holds_zero() | exact | !inside)
    }

    #[inline(always)]
    pub(super) fn abs(self) -> Self {
        let (a, b) = (self.low.abs(), self.high.abs());
        Self::of(if self.holds_zero() { 0.0 } else { least(a, b) }, greatest(a, b))
    }

    #[inline(always)]
    pub(super) fn min(self, other: Self) -> Self {
        Self::of(least(self.low, other.low), least(self.high, other.high))
    }

    #[inline(always)]
    pub(super) fn max(self, other: Self) -> Self {
        Self::of(greatest(self.low, other.low), greatest(self.high, other.high))
    }

    /// A function without rounding that never decreases.
    #[inline(always)]
    pub(super) fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Self::of(f(self.low), f(self.high))
    }

    #[inline(always)]
    pub(super) fn fract(self) -> Self {
        let whole = self.low.floor();
        let same = (whole == self.high.floor()) & self.low.is_finite();
        Self::rounded(self.low - whole, self.high - whole).or_special(!same)
    }

    #[inline(always)]
    pub(super) fn inverse_square_root(self) -> Self {
        let n = rules::INVERSESQRT.ulps();
        let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
        let fine = (self.low >= FLUSH) & (self.high <= MAX);
        Self::rounded(ulps_below(low, high, n), ulps_above(low, high, n)).or_special(!fine)
    }

    #[inline(always)]
    pub(super) fn unit_scale(self) -> Self {
        let (low, high) = (1.0 / self.high.sqrt(), 1.0 / self.low.sqrt());
        let fine = (self.low >= FLUSH) & (self.high <= MAX);
        let error = EnvelopeFloat::UNIT_SCALE;
        Self::rounded(low * (1.0 - error), high * (1.0 + error)).or_special(!fine)
    }

    #[inline(always)]
    pub(super) fn scaled(self, scale: Self) -> Self {
        let product = self.mul(scale);
        let n = rules::DIV.ulps();
        Self::rounded(ulps_below(product.low, product.high, n), ulps_above(product.low, product.high, n))
            .or_special(product.special)
    }

    #[inline(always)]
    pub(super) fn square_root(self) -> Self {
        let (first, second) = (rules::INVERSESQRT.ulps(), rules::DIV.ulps());
        let off = |x: f64, exact: f64| {
            let inner = 1.0 / exact;
            let root = 1.0 / (inner - first * ulp(inner) * (1.0 + 1e-6));
            let off = root + second * ulp(root) * (1.0 + 1e-6) - exact;
            if x <= 0.0 { 0.0 } else { off }
        };
        let flushed = if self.low < FLUSH { 0.0 } else { self.low };
        let (least, most) = (flushed.sqrt(), self.high.sqrt());
        let by_rule = const { rules::SQRT.inherits(&rules::kernels::SQRT) };
        let fine = by_rule & (self.low >= 0.0) & (self.high <= MAX);
        Self::rounded(least - off(flushed, least), most + off(self.high, most)).or_special(!fine)
    }

    #[inline(always)]
    pub(super) fn cosine_at_most(self) -> Self {
        let finite = (self.high - self.low).is_finite();
        Self::of(greatest(self.low, -EnvelopeFloat::COSINE), least(self.high, EnvelopeFloat::COSINE))
            .or_special(!finite)
    }

    /// An exponential function, with the function for its bounds.
    #[inline(always)]
    pub(super) fn exponential(self, f: impl Fn(f64) -> f64) -> Self {
        self.exponential_off(0.0, f)
    }

    #[inline(always)]
    fn exponential_off(self, off: f64, f: impl Fn(f64) -> f64) -> Self {
        let n = |x: f64| rules::EXP.ulps_at(x);
        let (low, high) = (f(self.low), f(self.high));
        let below = if low == 0.0 { 0.0 } else { ulps_below(low, high, n(self.low)) };
        // `mirrored` of a number that is not special.
        let share = 1.0 - EnvelopeFloat::ROUND_TRIP * off * off;
        let mirrored = low * share - (n(self.low) + 4.0 * off) * OUTWARD * ulp(low * (1.0 + 2.0 * off));
        let below = greatest(below, 0.0);
        let below = if (off == 0.0) | (low == 0.0) { below } else { least(below, mirrored) };
        Self::rounded(below, ulps_above(low, high, n(self.high)))
    }

    /// The bounds of a logarithm before rounding, of which the lower one may be infinite, and the exact ones.
    #[inline(always)]
    fn logarithm_bounds(self, f: impl Fn(f64) -> f64) -> (f64, f64, (f64, f64)) {
        let (from, to) = const { rules::LOG.within() };
        let near_one = (self.high >= from) & (self.low <= to);
        let absolute = if near_one { rules::LOG.absolute() * OUTWARD } else { 0.0 };
        let positive = |x: f64| if x < FLUSH { FLUSH } else { x };
        let (bottom, top) = (f(positive(self.low)), f(positive(self.high)));
        let n = rules::LOG.ulps();
        let below = least(ulps_below(bottom, top, n), bottom - absolute);
        let above = greatest(ulps_above(bottom, top, n), top + absolute);
        let low = if self.low < FLUSH { f64::NEG_INFINITY } else { below };
        (low, above, (bottom, top))
    }

    #[inline(always)]
    pub(super) fn logarithm(self, f: impl Fn(f64) -> f64) -> Self {
        let (low, high, _) = self.logarithm_bounds(f);
        Self::rounded(low, high).or_special(!((self.low >= FLUSH) & (self.high <= MAX)))
    }

    #[inline(always)]
    pub(super) fn power(self, exponent: Self) -> Self {
        let (low, high, ends) = self.logarithm_bounds(powers::log2);
        // The lower bound may be infinite. Rounding, and a factor above 0, leave it unchanged.
        let (low, high) = (down(low, false), up(high, false));
        let (ll, lh) = (exponent.low * low, exponent.low * high);
        let (hl, hh) = (exponent.high * low, exponent.high * high);
        let product = Self::of(
            down(least(least(ll, lh), least(hl, hh)), false),
            up(greatest(greatest(ll, lh), greatest(hl, hh)), false),
        );
        let fine = const { rules::POW.inherits(&rules::kernels::POW) }
            & (self.low >= 0.0)
            & (self.high <= MAX)
            & (exponent.low >= FLUSH)
            & (exponent.high <= MAX)
            & (product.high.abs() <= MAX);
        // As far below as the formula is above.
        let error = greatest(ends.0 - low, high - ends.1);
        let off = exponent.high * error + ulp(greatest(product.low.abs(), product.high.abs()));
        let bounded = product.low >= -MAX;
        let far = bounded & (off > EnvelopeFloat::FAR_OFF);
        // The product may be rounded to either side, and so the result be off to either side.
        let rounding = if bounded & (off != 0.0) { ulp(greatest(product.low.abs(), product.high.abs())) } else { 0.0 };
        let product = Self::of(product.low - rounding, product.high + rounding);
        product.exponential_off(if bounded { off } else { 0.0 }, powers::exp2).or_special(far | !fine)
    }

    /// `x (1 - a) + y a` or `x + (y - x) a`.
    #[inline(always)]
    pub(super) fn mixed(self, y: Self, a: Self) -> Self {
        let rest = Self::of(1.0, 1.0).sub(a);
        let (left, right) = (self.mul(rest), y.mul(a));
        let gap = y.sub(self);
        let step = gap.mul(a);
        let (first, second) = (left.add(right), self.add(step));
        let either = Self::of(least(first.low, second.low), greatest(first.high, second.high));
        let special =
            rest.special | left.special | right.special | gap.special | step.special | first.special | second.special;
        let corner = |x: f64, y: f64, a: f64| x + (y - x) * a;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for at in [
            corner(self.low, y.low, a.low),
            corner(self.low, y.low, a.high),
            corner(self.low, y.high, a.low),
            corner(self.low, y.high, a.high),
            corner(self.high, y.low, a.low),
            corner(self.high, y.low, a.high),
            corner(self.high, y.high, a.low),
            corner(self.high, y.high, a.high),
        ] {
            low = least(low, at);
            high = greatest(high, at);
        }
        let size = |of: Self| greatest(of.low.abs(), of.high.abs());
        let one = size(self) * ulp(size(rest)) + ulp(size(left)) + ulp(size(right)) + ulp(size(left) + size(right));
        let other = size(a) * ulp(size(gap)) + ulp(size(step)) + ulp(size(self) + size(step));
        let roundings = greatest(one, other) * (1.0 + 1e-6);
        let found = Self::rounded(greatest(low - roundings, either.low), least(high + roundings, either.high));
        let points = self.is_point() & y.is_point() & a.is_point();
        Self {
            low: if points { either.low } else { found.low },
            high: if points { either.high } else { found.high },
            special: !const { rules::MIX.inherits(&rules::kernels::MIX) }
                | special
                | found.special
                | (found.low > found.high),
        }
    }
}
