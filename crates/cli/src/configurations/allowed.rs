//! Configurations that the project's conditions allow.
//!
//! *In:* a configuration, and the conditions of `[lint.configurations]`. *Out:* the configuration, or one like it that the
//! conditions allow, or nothing if none is found.

use super::choices::Choice;
use crate::variants::stated::{Broken, Stated};
use crate::variants::{Condition, Variant};

/// How many conditions are mended, one after the other.
const MAX_MENDED: usize = 8;

/// The configuration, with as few macros changed as are needed for the conditions to allow it.
pub(super) fn allowed(mut variant: Variant, stated: &Stated, choices: &[Choice]) -> Option<Variant> {
    for _ in 0..MAX_MENDED {
        let Some(broken) = stated.broken(&variant) else { return Some(variant) };
        let mended: Vec<Variant> = match broken {
            Broken::Skipped(condition) => without(&variant, condition, choices),
            Broken::Missing(conditions) => conditions.iter().map(|condition| with(&variant, condition)).collect(),
        };
        let best = mended.iter().find(|one| stated.allows(one)).or(mended.first())?;
        variant = best.clone();
    }
    None
}

/// The configuration with one term of a condition turned around, in all ways.
fn without(variant: &Variant, condition: &Condition, choices: &[Choice]) -> Vec<Variant> {
    let mut all = Vec::new();
    for (_, name, _) in condition.terms() {
        let values = choices.iter().filter(|choice| choice.name == name).flat_map(|choice| &choice.values);
        for value in values {
            let mut one = variant.clone();
            match value {
                Some(value) => one.insert(name.to_owned(), value.clone()),
                None => one.remove(name),
            };
            if !condition.holds(&one) {
                all.push(one);
            }
        }
    }
    all
}

/// The configuration with all terms of a condition.
fn with(variant: &Variant, condition: &Condition) -> Variant {
    let mut one = variant.clone();
    for (is_wanted, name, value) in condition.terms() {
        match (is_wanted, value) {
            (true, Some(value)) => _ = one.insert(name.to_owned(), value.to_owned()),
            (true, None) if one.contains_key(name) => {}
            (true, None) => _ = one.insert(name.to_owned(), "1".to_owned()),
            (false, None) => _ = one.remove(name),
            (false, Some(value)) if one.get(name).is_some_and(|own| own == value) => _ = one.remove(name),
            (false, Some(_)) => {}
        }
    }
    one
}
