//! [`CauseKind`]: how an expression loses precision.
//!
//! *In:* the tallies of a span. *Out:* the kind that fits them. *Holds:* the order of the rules below decides: a result
//! that is not finite comes before a decision, a decision before lost bits.

use super::record::{Act, Tally};
use crate::domain::ShadowFloat;
use crate::exec::Kind;

/// How an expression loses precision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CauseKind {
    /// A sum, difference or product of vectors whose leading digits cancel.
    Cancellation,
    /// Rounding alone: the result is too coarse for what follows.
    Rounding,
    /// A result above the largest f32.
    Overflow,
    /// A result below the smallest normal f32, which becomes 0.
    Underflow,
    /// A division by 0.
    Division,
    /// An argument outside the domain of a function, or so close to its edge that the result has no digits.
    Domain,
    /// A power or an exponential function that multiplies the error of its argument.
    Power,
    /// A trigonometric function of an argument that is too large.
    Argument,
    /// A comparison, `step` or `sign` that f32 decides differently.
    Comparison,
    /// `floor`, `fract`, `mod`, a conversion to an integer, or a texel that f32 decides differently.
    Conversion,
    /// Rounding in each iteration of a loop.
    Accumulation,
}

impl CauseKind {
    /// All kinds.
    pub const ALL: [Self; 11] = [
        Self::Cancellation,
        Self::Rounding,
        Self::Overflow,
        Self::Underflow,
        Self::Division,
        Self::Domain,
        Self::Power,
        Self::Argument,
        Self::Comparison,
        Self::Conversion,
        Self::Accumulation,
    ];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Cancellation => "cancellation",
            Self::Rounding => "rounding",
            Self::Overflow => "overflow",
            Self::Underflow => "underflow",
            Self::Division => "division",
            Self::Domain => "domain",
            Self::Power => "power",
            Self::Argument => "argument",
            Self::Comparison => "comparison",
            Self::Conversion => "conversion",
            Self::Accumulation => "accumulation",
        }
    }

    /// Whether the cause is a decision that f32 takes the other way.
    pub fn is_decision(self) -> bool {
        matches!(self, Self::Comparison | Self::Conversion)
    }

    /// The kind of an act that lost bits, births or decisions.
    pub(super) fn of(act: Act, tally: &Tally) -> Self {
        if let Some(birth) = Birth::most(tally) {
            return birth;
        }
        match act {
            Act::Compare { .. } => Self::Comparison,
            Act::ToInt => Self::Conversion,
            Act::Float(_) if tally.overflows > 0 => Self::Overflow,
            Act::Float(_) if tally.underflows > 0 => Self::Underflow,
            Act::Float(kind) => match kind {
                Kind::Step => Self::Comparison,
                Kind::Whole | Kind::Texture => Self::Conversion,
                Kind::Sum | Kind::Dot | Kind::Pairs | Kind::Vector | Kind::Blend | Kind::Derivative => {
                    Self::Cancellation
                }
                Kind::Power | Kind::Exponential => Self::Power,
                Kind::Angle => Self::Argument,
                Kind::Partial => Self::Domain,
                Kind::Quotient | Kind::InverseRoot => Self::Division,
                Kind::Logarithm | Kind::Product | Kind::Normalize | Kind::Conversion | Kind::Other => Self::Rounding,
            },
        }
    }
}

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
            Kind::Quotient | Kind::InverseRoot if operands.last().is_some_and(is_zero) => match operands.last() {
                Some(divisor) if divisor.wide != 0.0 && divisor.wide.abs() < f64::from(f32::MIN_POSITIVE) => {
                    Self::Underflow
                }
                _ => Self::Division,
            },
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

    /// The kind of the most frequent birth; `None` if there is none.
    fn most(tally: &Tally) -> Option<CauseKind> {
        let (birth, count) =
            Self::ALL.iter().zip(tally.births).rev().max_by_key(|(_, count)| *count)?;
        let kind = match birth {
            Self::Overflow => CauseKind::Overflow,
            Self::Underflow => CauseKind::Underflow,
            Self::Division => CauseKind::Division,
            Self::Domain => CauseKind::Domain,
        };
        (count > 0).then_some(kind)
    }
}
