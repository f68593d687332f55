//! [`CallCost`]: the cost of a call of a built-in function, depending on the sizes of its result and its first
//! argument.

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

/// A count that grows with the sizes: `fixed + result * (components of the result) + first * (components of the first
/// argument)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Linear {
    /// The constant part.
    pub fixed: i32,
    /// The part for each component of the result.
    pub result: i32,
    /// The part for each component of the first argument.
    pub first: i32,
}

/// The number of scalar operations of a call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CallCost {
    /// Divisions, roots, exponentials, logarithms, trigonometry.
    pub special: Linear,
    /// Additions, products, comparisons, minima, maxima, conversions, selections.
    pub arithmetic: Linear,
    /// Texture lookups.
    pub texture: u32,
}

const NONE: Linear = Linear { fixed: 0, result: 0, first: 0 };

impl Linear {
    /// The count for sizes of at least 1.
    pub fn at(self, result: u32, first: u32) -> u32 {
        let count = i64::from(self.fixed)
            + i64::from(self.result) * i64::from(result)
            + i64::from(self.first) * i64::from(first);
        u32::try_from(count.max(0)).unwrap_or(u32::MAX)
    }
}

/// `count` arithmetic operations for each component of the result.
pub(super) const fn each(count: i32) -> CallCost {
    CallCost { special: NONE, arithmetic: Linear { result: count, ..NONE }, texture: 0 }
}

/// For each component of the result, `special` special and `arithmetic` arithmetic operations.
pub(super) const fn special(special: i32, arithmetic: i32) -> CallCost {
    CallCost {
        special: Linear { result: special, ..NONE },
        arithmetic: Linear { result: arithmetic, ..NONE },
        texture: 0,
    }
}

/// For the whole call, `special` special operations, and arithmetic operations depending on the sizes.
pub(super) const fn whole(special: i32, fixed: i32, result: i32, first: i32) -> CallCost {
    CallCost { special: Linear { fixed: special, ..NONE }, arithmetic: Linear { fixed, result, first }, texture: 0 }
}

/// One texture lookup.
pub(super) const LOOKUP: CallCost = CallCost { special: NONE, arithmetic: NONE, texture: 1 };
