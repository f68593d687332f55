//! [`Bound`]: the error that a function's comment allows.
//!
//! *In:* a comment line above a function, `// bound: 4e-7 abs`, with a reason after a comma where the error is larger than
//! rounding. *Out:* the number, what it is relative to, and the reason. *Holds:* a bound without a unit is an error.

use serde::Serialize;

/// The size that a bound is relative to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BoundUnit {
    /// Nothing: results are of the size 1.
    Abs,
    /// The largest number of the result.
    Rel,
    /// The largest number of the result, or 1 if that is larger.
    Size,
    /// The largest number of the arguments that are colors, or 1: an error of the factor that multiplies them.
    Color,
}

/// The error that is allowed beyond four times the change that moving the inputs by an ULP makes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Bound {
    /// The number.
    pub error: f64,
    /// The size that it is relative to.
    pub unit: BoundUnit,
    /// The reason why it is larger than rounding; may be empty.
    pub reason: String,
}

/// Errors above this are more than rounding, and need a reason: 16 ULP.
pub const ROUNDING: f64 = 16.0 / 8_388_608.0;

impl BoundUnit {
    /// The word in a comment.
    pub fn name(self) -> &'static str {
        match self {
            Self::Abs => "abs",
            Self::Rel => "rel",
            Self::Size => "size",
            Self::Color => "color",
        }
    }
}

impl Bound {
    /// Parses what follows `bound:`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (figures, reason) = text.split_once(',').unwrap_or((text, ""));
        let (number, unit) =
            figures.trim().split_once(' ').ok_or_else(|| format!("`{text}` has no unit: abs, rel, size or color"))?;
        let error = number.parse::<f64>().ok().filter(|error| *error >= 0.0 && error.is_finite());
        let unit = match unit.trim() {
            "abs" => BoundUnit::Abs,
            "rel" => BoundUnit::Rel,
            "size" => BoundUnit::Size,
            "color" => BoundUnit::Color,
            other => return Err(format!("`{other}` is not a unit: abs, rel, size or color")),
        };
        let error = error.ok_or_else(|| format!("`{number}` is not a number from 0 on"))?;
        Ok(Self { error, unit, reason: reason.trim().to_owned() })
    }
}

#[cfg(test)]
mod tests {
    use super::{Bound, BoundUnit};

    #[test]
    fn a_bound_has_a_number_a_unit_and_perhaps_a_reason() {
        let bound = Bound::parse(" 4e-7 abs").expect("it is well-formed");
        assert_eq!((bound.error, bound.unit, bound.reason.as_str()), (4e-7, BoundUnit::Abs, ""));
        let bound = Bound::parse("1e-4 rel, exp of a large number").expect("it is well-formed");
        assert_eq!((bound.unit, bound.reason.as_str()), (BoundUnit::Rel, "exp of a large number"));
        for text in ["", "4e-7", "x abs", "-1 abs", "1 ulp", "nan abs"] {
            assert!(Bound::parse(text).is_err(), "{text}");
        }
    }
}
