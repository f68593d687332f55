//! The envelope domain: an f64 value, and the interval of values that a conforming f32 GPU may have.
//!
//! *In:* the operands of shaders and of the pipeline. *Out:* the value of exact arithmetic with `low`, `high`, and
//! whether it may be NaN.
//!
//! *Holds:* `low <= high`, and both are f32 numbers or infinite: every register of a GPU holds an f32, so bounds are
//! rounded outward to the grid of f32 and not only of f64. An operation yields the hull of what its row of
//! [`rules`](super::rules) allows for each choice of operands. A correctly rounded operation is therefore the exact
//! one with its bounds rounded outward: an exact result stays exact, and a fused product is inside. If a value may be
//! flushed to 0, the hull contains 0; if it overflows, infinity. Selecting functions yield the hull of the values
//! that they may select. Only conditions of branches leave a decision to the executor.
//!
//! | file | contents |
//! | --- | --- |
//! | `round` | rounding outward |
//! | `float` | operators, comparisons, conversions, selecting functions |
//! | `functions` | the functions that have a rule of their own, or inherit one |
//! | `formula` | rules of the table, evaluated |
//! | `vector` | sums of products, in any order |
//! | `powers` | `exp2` and `log2` without calls, only for bounds |
//! | `block` | the same operations on eight numbers at once |
//! | `integer` | intervals of `int`s |

mod bits;
mod block;
mod float;
mod formula;
mod functions;
mod integer;
mod powers;
mod round;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod text_tests;
mod vector;

pub use block::EnvelopeBlock;
pub(crate) use block::take_redone;
pub(crate) use formula::evaluate;
#[cfg(test)]
pub(crate) use formula::{binary, unary};
pub use integer::EnvelopeInt;

use glisten_scene::picture::Interval;
use round::{down, up};

/// A `float` with its envelope.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnvelopeFloat {
    /// The result of exact f64 arithmetic.
    pub value: f64,
    /// The lower bound for a conforming GPU.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
    /// Whether the number may be NaN.
    pub may_be_nan: bool,
}

impl EnvelopeFloat {
    /// An f32 that every GPU computes exactly.
    #[inline(always)]
    fn exact(value: f64) -> Self {
        Self { value, low: value, high: value, may_be_nan: false }
    }

    /// A number that may be anything.
    fn anything(value: f64) -> Self {
        Self { value, low: f64::NEG_INFINITY, high: f64::INFINITY, may_be_nan: true }
    }

    /// A result whose bounds are not rounded yet. Bounds that are NaN say nothing.
    #[inline(always)]
    fn rounded(value: f64, low: f64, high: f64, may_be_nan: bool) -> Self {
        if low <= high { Self { value, low: down(low), high: up(high), may_be_nan } } else { Self::anything(value) }
    }

    /// The envelope with another value inside.
    fn of_value(self, value: f64) -> Self {
        Self { value, ..self }
    }

    /// Limits the bounds to the range of the function.
    fn within(self, least: f64, most: f64) -> Self {
        Self { low: self.low.clamp(least, most), high: self.high.clamp(least, most), ..self }
    }

    /// The hull of both, with this one's value.
    #[inline(always)]
    fn joined(self, other: Self) -> Self {
        Self {
            value: self.value,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            may_be_nan: self.may_be_nan || other.may_be_nan,
        }
    }

    /// Whether all conforming GPUs have the same number.
    #[inline(always)]
    fn is_point(self) -> bool {
        self.low == self.high && !self.may_be_nan
    }

    /// Its bounds as exact numbers.
    fn bounds(self) -> [Self; 2] {
        [Self::exact(self.low), Self::exact(self.high)]
    }

    fn as_range(self) -> Interval {
        Interval { low: self.low, high: self.high, may_be_nan: self.may_be_nan }
    }
}
