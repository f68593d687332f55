//! The noise of numbers, computed: the part of an error that the fragments of a quad do not share.
//!
//! *In:* the operands of an operation with their noise, in all lanes. *Out:* the noise of the result. *Holds:* the errors of a
//! number in two fragments of a quad differ by at most the sum of their noises. So there is an error E that all of them have,
//! and each adds at most its noise to it.
//!
//! Of a product of `A + E + e` and `B + F + f` the part `E F` is the same for all. `A F` is not, because `A` is not: it differs
//! between two fragments by `F` times the difference of their `A`. Of a function `g` it is `E` times the difference of the slopes of `g`,
//! which is at most the difference of the numbers times the largest curvature.

use super::inst::{Noisy, Operand};
use super::registers::Registers;
use crate::domain::{Domain, LANES, Lanes, Number, Source, rules};
use glisten_scene::picture::Interval;

type Float<D> = <D as Domain>::Float;

/// The fragments of a quad.
const QUAD: usize = 4;
/// Roundings of a root and its reciprocal, in ULP: `1.0 / inversesqrt(x)`, and 2.
const ROOT: f64 = 8.0;

/// The largest magnitude of a number.
fn largest<N: Number>(number: N) -> f64 {
    let interval = number.interval();
    interval.low.abs().max(interval.high.abs())
}

/// The noise of a sum of terms: that of each times its factor, and the roundings of the sum itself.
pub(super) fn linear<D: Domain>(
    this: &Registers<D>,
    of: Source<'_, Float<D>>,
    roundings: f64,
    terms: &[Operand],
    out: &mut Lanes<Float<D>>,
) {
    let term = |pair: &[Operand], lane: usize| match pair {
        [noise, factor] => this.float(*noise).at(lane).value() * largest(this.float(*factor).at(lane)),
        _ => f64::INFINITY,
    };
    out.update(|lane, _| {
        let own = roundings * rules::ulp(largest(of.at(lane)));
        let sum: f64 = terms.chunks(2).map(|pair| term(pair, lane)).sum();
        Number::integer_with_interval(sum + own, Interval::point(sum + own))
    });
}

/// A number in the fragments of a quad.
#[derive(Clone, Copy)]
struct InQuad {
    /// The largest difference of its exact values.
    change: f64,
    /// The largest error.
    error: f64,
    /// The bounds of all.
    low: f64,
    high: f64,
    /// The largest noise.
    noise: f64,
}

impl InQuad {
    fn new<N: Number>(number: Source<'_, N>, noise: Source<'_, N>, quad: usize) -> Self {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut found = Self { change: 0.0, error: 0.0, low: f64::INFINITY, high: f64::NEG_INFINITY, noise: 0.0 };
        for lane in quad..quad + QUAD {
            let (number, interval) = (number.at(lane), number.at(lane).interval());
            let value = number.value();
            (least, most) = (least.min(value), most.max(value));
            found.low = found.low.min(interval.low);
            found.high = found.high.max(interval.high);
            found.error = found.error.max(interval.high - value).max(value - interval.low);
            found.noise = found.noise.max(noise.at(lane).value());
            if interval.may_be_nan || value.is_nan() {
                found.error = f64::INFINITY;
            }
        }
        found.change = most - least;
        found
    }

    /// The noise that the shared error gets by a function with these largest slopes and curvatures, and that of a lane.
    fn through(self, (slope, curvature): (f64, f64), noise: f64) -> f64 {
        slope * noise + 0.5 * self.change * self.error * curvature
    }

    /// The least magnitude, less the noise; 0 if there is a change of sign.
    fn least(self) -> f64 {
        let least = if self.low > 0.0 { self.low } else { -self.high };
        (least - self.noise).max(0.0)
    }
}

/// The noise of a result. `operands` are numbers, each followed by its noise.
pub(super) fn of<D: Domain>(
    this: &Registers<D>,
    (op, of): (Noisy, Source<'_, Float<D>>),
    operands: &[Operand],
    out: &mut Lanes<Float<D>>,
) {
    let pair = |pair: &[Operand]| match pair {
        [number, noise] => Some((this.float(*number), this.float(*noise))),
        _ => None,
    };
    let pairs: Vec<_> = operands.chunks(2).filter_map(pair).collect();
    for quad in (0..LANES).step_by(QUAD) {
        let all: Vec<InQuad> = pairs.iter().map(|(number, noise)| InQuad::new(*number, *noise, quad)).collect();
        for lane in quad..quad + QUAD {
            let at = |index: usize| {
                let pair = pairs.get(index);
                pair.map_or((f64::INFINITY, f64::INFINITY), |(number, noise)| {
                    (largest(number.at(lane)), noise.at(lane).value())
                })
            };
            let own = rules::ulp(largest(of.at(lane)));
            let noise = match (op, all.as_slice()) {
                (Noisy::Products, all) => products(all, &at),
                (Noisy::Quotient, [a, b]) => quotient((*a, at(0)), (*b, at(1).1)) + rules::DIV.ulps() * own,
                (Noisy::Root, [a]) => {
                    let least = a.least();
                    a.through((0.5 / least.sqrt(), 0.25 / least.powf(1.5)), at(0).1) + ROOT * own
                }
                (Noisy::InverseRoot, [a]) => {
                    let least = a.least();
                    a.through((0.5 / least.powf(1.5), 0.75 / least.powf(2.5)), at(0).1) + ROOT * own
                }
                _ => f64::INFINITY,
            };
            let noise = if noise >= 0.0 { noise } else { f64::INFINITY };
            out.set(lane, Number::integer_with_interval(noise, Interval::point(noise)));
        }
    }
}

/// The noise of a sum of products: that of each, and the roundings of all products and sums.
fn products(all: &[InQuad], at: &dyn Fn(usize) -> (f64, f64)) -> f64 {
    let (mut noise, mut sizes) = (0.0, 0.0);
    for (index, pair) in all.chunks(2).enumerate() {
        let [a, b] = pair else { return f64::INFINITY };
        let ((size_a, noise_a), (size_b, noise_b)) = (at(2 * index), at(2 * index + 1));
        noise += product((*a, size_a, noise_a), (*b, size_b, noise_b));
        sizes += size_a * size_b;
    }
    noise + all.len() as f64 * rules::ulp(sizes)
}

fn product((a, size_a, noise_a): (InQuad, f64, f64), (b, size_b, noise_b): (InQuad, f64, f64)) -> f64 {
    let shared = 0.5 * (times(a.change, b.error) + times(b.change, a.error));
    times(size_a, noise_b) + times(size_b + noise_b, noise_a) + shared
}

/// A product in which nothing of what has no bound is nothing.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

/// The noise of a number times the reciprocal of another one.
fn quotient((a, (size, noise)): (InQuad, (f64, f64)), (b, divisor_noise): (InQuad, f64)) -> f64 {
    let least = b.least();
    let slope = 1.0 / (least * least);
    let reciprocal = InQuad {
        change: b.change * slope,
        error: b.error * slope,
        low: 0.0,
        high: 1.0 / least,
        noise: b.through((slope, 2.0 * slope / least), divisor_noise),
    };
    product((a, size, noise), (reciprocal, reciprocal.high, reciprocal.noise))
}
