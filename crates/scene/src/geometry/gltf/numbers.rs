//! Numbers of extensions, which are JSON without a type.
//!
//! *In:* the table of an extension. *Out:* its members. *Holds:* they are finite as f32.

use gltf::json::Value;

/// A member of an extension that is a number, or the default of one that is not there.
///
/// # Errors
/// It is no number, or none of f32.
pub(super) fn number(table: &Value, key: &str, default: f64) -> Result<f64, String> {
    let Some(value) = table.get(key) else { return Ok(default) };
    let value = value.as_f64().filter(|value| (*value as f32).is_finite());
    value.ok_or_else(|| format!("its `{key}` is not a number"))
}

/// A member of an extension that is a list of two numbers.
///
/// # Errors
/// As of [`number`].
pub(super) fn pair(table: &Value, key: &str, default: [f64; 2]) -> Result<[f64; 2], String> {
    list(table, key, default, "two numbers")
}

/// A member of an extension that is a list of three numbers.
///
/// # Errors
/// As of [`number`].
pub(super) fn triple(table: &Value, key: &str, default: [f64; 3]) -> Result<[f64; 3], String> {
    list(table, key, default, "three numbers")
}

fn list<const N: usize>(table: &Value, key: &str, default: [f64; N], what: &str) -> Result<[f64; N], String> {
    let Some(value) = table.get(key) else { return Ok(default) };
    let numbers: Option<Vec<f64>> = value.as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
    let numbers = numbers.filter(|numbers| numbers.iter().all(|value| (*value as f32).is_finite()));
    let wrong = || format!("its `{key}` is not {what}");
    numbers.and_then(|numbers| <[f64; N]>::try_from(numbers).ok()).ok_or_else(wrong)
}
