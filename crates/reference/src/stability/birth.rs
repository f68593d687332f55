//! [`Birth`]: how a result that is not finite comes from finite operands.
//!
//! *In:* an operation with its operands and its result. *Out:* the origin of the infinity or NaN.

use crate::domain::{ShadowFloat, rounded};
use crate::exec::Kind;

/// How a result that is not finite comes from finite operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Birth {
    Overflow,
    Underflow,
    Division,
    Domain,
}

impl Birth {
    pub(super) const ALL: [Self; 4] = [Self::Overflow, Self::Underflow, Self::Division, Self::Domain];

    /// The origin of a result that is not finite.
    pub(super) fn of(kind: Kind, operands: &[ShadowFloat], result: ShadowFloat) -> Self {
        let is_zero = |number: &ShadowFloat| number.single == 0.0;
        match kind {
            Kind::Quotient | Kind::InverseRoot if operands.last().is_some_and(is_vanished) => Self::Underflow,
            Kind::Logarithm | Kind::Power | Kind::Partial if operands.first().is_some_and(is_vanished) => {
                Self::Underflow
            }
            Kind::Quotient | Kind::InverseRoot if operands.last().is_some_and(is_zero) => Self::Division,
            Kind::Power if operands.first().is_some_and(|base| base.single <= 0.0) => Self::Domain,
            Kind::Partial | Kind::InverseRoot | Kind::Logarithm => Self::Domain,
            Kind::Whole | Kind::Blend => Self::Division,
            Kind::Normalize => match operands.iter().map(|part| part.single.abs()).fold(0.0, f64::max) {
                0.0 if operands.iter().all(|part| part.wide == 0.0) => Self::Division,
                largest if largest < 1.0 => Self::Underflow,
                _ => Self::Overflow,
            },
            // The inverse of a singular matrix.
            Kind::Vector if result.single.is_nan() => Self::Division,
            _ => Self::Overflow,
        }
    }
}

/// Whether a number is 0 only because f32 has none so small.
pub(super) fn is_vanished(number: &ShadowFloat) -> bool {
    number.single == 0.0 && number.wide != 0.0 && rounded(number.wide) == 0.0
}
