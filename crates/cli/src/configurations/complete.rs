//! Configurations that have given values of some macros, and that nobody forbids.
//!
//! *In:* the values that some macros must have, the groups of macros that forbid each other (those of an `#error`, those of a
//! condition of the project), and configurations that are good. *Out:* configurations to try, the likeliest first. *Holds:* each has
//! the given values, and the project's conditions allow it.

use super::allowed::allowed;
use super::choices::Choice;
use crate::variants::Variant;
use crate::variants::stated::Stated;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// The most configurations that are offered for the same values.
const MAX_OFFERED: usize = 24;
/// The most combinations of related macros that are looked at.
const MAX_COMBINED: usize = 256;

/// Values that macros must have: `None` for one that must not be defined.
pub(super) type Fixed = BTreeMap<String, Option<String>>;

/// The facts that configurations are completed by.
pub(super) struct Completion<'a> {
    pub(super) stated: &'a Stated,
    pub(super) choices: &'a [Choice],
    /// Macros that together may forbid a configuration.
    pub(super) groups: Vec<BTreeSet<String>>,
    /// Configurations that nothing forbids.
    pub(super) good: Vec<&'a Variant>,
}

impl Completion<'_> {
    /// Configurations with these values.
    pub(super) fn of(&self, fixed: &Fixed) -> Vec<Variant> {
        let mut all: Vec<Variant> = Vec::new();
        let related = self.related(fixed);
        let alone = with(&Variant::new(), fixed);
        let over_good = self.good.iter().take(MAX_OFFERED / 3).map(|good| with(good, fixed));
        for one in std::iter::once(alone.clone()).chain(self.combined(&alone, &related)).chain(over_good) {
            let Some(one) = allowed(one, self.stated, self.choices).filter(|one| has(one, fixed)) else { continue };
            if !all.contains(&one) {
                all.push(one);
            }
            if all.len() >= MAX_OFFERED {
                break;
            }
        }
        all
    }

    /// The macros that the groups of these lead to.
    fn related(&self, fixed: &Fixed) -> Vec<&Choice> {
        let mut names: BTreeSet<&str> = fixed.keys().map(String::as_str).collect();
        loop {
            let before = names.len();
            for group in &self.groups {
                if group.iter().any(|name| names.contains(name.as_str())) {
                    names.extend(group.iter().map(String::as_str));
                }
            }
            if names.len() == before {
                break;
            }
        }
        let related = |choice: &&Choice| names.contains(choice.name.as_str()) && !fixed.contains_key(&choice.name);
        self.choices.iter().filter(related).collect()
    }

    /// A configuration with all values of related macros: all of them defined, then as few as possible, for what one needs another
    /// defines, and what forbids another is seldom needed.
    fn combined(&self, alone: &Variant, related: &[&Choice]) -> Vec<Variant> {
        let mut all = vec![alone.clone()];
        for choice in related {
            let with_each = |one: &Variant| {
                let values = choice.values.iter().map(|value| {
                    let mut one = one.clone();
                    one.extend(value.clone().map(|value| (choice.name.clone(), value)));
                    one
                });
                values.collect::<Vec<_>>()
            };
            if all.len() * choice.values.len() > MAX_COMBINED {
                break;
            }
            all = all.iter().flat_map(with_each).collect();
        }
        let most = all.iter().map(Variant::len).max().unwrap_or(0);
        all.sort_by_key(|one| (Reverse(one.len() == most), one.len()));
        all
    }
}

/// A configuration with these values in place of its own.
fn with(variant: &Variant, fixed: &Fixed) -> Variant {
    let mut one = variant.clone();
    for (name, value) in fixed {
        match value {
            Some(value) => _ = one.insert(name.clone(), value.clone()),
            None => _ = one.remove(name),
        }
    }
    one
}

/// Whether a configuration has these values.
pub(super) fn has(variant: &Variant, fixed: &Fixed) -> bool {
    fixed.iter().all(|(name, value)| variant.get(name) == value.as_ref())
}
