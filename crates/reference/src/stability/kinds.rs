//! [`CauseKind`]: how an expression loses precision.
//!
//! *In:* the tallies of a span. *Out:* the kind that fits them. *Holds:* the order of the rules below decides: a result
//! that is not finite comes before a decision, a decision before lost bits.

use super::birth::Birth;
use super::record::{Act, Tally};
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
        if let Some(birth) = most_frequent_birth(tally) {
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

/// The kind of the most frequent birth; `None` if there is none.
fn most_frequent_birth(tally: &Tally) -> Option<CauseKind> {
    let (birth, count) = Birth::ALL.iter().zip(tally.births).rev().max_by_key(|(_, count)| *count)?;
    let kind = match birth {
        Birth::Overflow => CauseKind::Overflow,
        Birth::Underflow => CauseKind::Underflow,
        Birth::Division => CauseKind::Division,
        Birth::Domain => CauseKind::Domain,
    };
    (count > 0).then_some(kind)
}
