//! Numbers of a trace, for JSON and for people.

use serde::{Serialize, Serializer};

/// A number that JSON may not have: `"NaN"`, `"Infinity"` and `"-Infinity"` are strings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number(pub(super) f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            number if number.is_nan() => serializer.serialize_str("NaN"),
            number if number.is_infinite() => {
                serializer.serialize_str(if number > 0.0 { "Infinity" } else { "-Infinity" })
            }
            number => serializer.serialize_f64(number),
        }
    }
}

/// A number of f32 as few digits as tell it from its neighbors.
pub(super) fn short(number: f64) -> String {
    let number = number as f32;
    let size = number.abs();
    if number == 0.0 || !number.is_finite() || (1e-4..1e7).contains(&size) {
        format!("{number}")
    } else {
        format!("{number:e}")
    }
}
