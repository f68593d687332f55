//! Each finding once, with the macros under which it comes.
//!
//! *In:* the units of configurations. *Out:* the units without what an earlier one tells; findings that not all configurations have
//! carry a note. *Holds:* the note names as few macros as tell the configurations that have the finding from those that
//! have not, with those that the conditions around the finding name. A finding of a rule is compared among programs without
//! errors, since rules look at no others. A finding that some configurations do not have has no fix: it might break those.

use super::choices::Conditions;
use crate::session::Unit;
use crate::variants::Variant;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::write::{Finding, Region};
use glisten_front::source::SourceMap;
use std::collections::{BTreeMap, BTreeSet};

/// The identity of a finding.
type Key = (Region, &'static str, String);

/// The units, each of the configuration in `variants`; `tried` has all configurations with the numbers of their units.
pub(super) fn merged(
    mut units: Vec<Unit>,
    variants: &[Variant],
    tried: &[(&Variant, usize)],
    texts: &BTreeMap<String, Conditions>,
) -> Vec<Unit> {
    let mut having: BTreeMap<Key, BTreeSet<usize>> = BTreeMap::new();
    let keys: Vec<Vec<Key>> = units.iter().map(keys).collect();
    for (number, keys) in keys.iter().enumerate() {
        keys.iter().for_each(|key| {
            having.entry(key.clone()).or_default().insert(number);
        });
    }
    let is_program: Vec<bool> = units.iter().map(|unit| unit.program.is_some()).collect();
    let is_kept: BTreeSet<usize> = tried.iter().map(|(_, result)| *result).collect();
    let mut told: BTreeSet<Key> = BTreeSet::new();
    for (number, (unit, keys)) in units.iter_mut().zip(&keys).enumerate() {
        let found = std::mem::take(&mut unit.batch.diagnostics);
        for (mut diagnostic, key) in found.into_iter().zip(keys) {
            if !is_kept.contains(&number) || !told.insert(key.clone()) {
                continue;
            }
            let is_of_rule = diagnostic.code.id.starts_with('L');
            let counts = |result: usize| !is_of_rule || is_program.get(result).copied().unwrap_or_default();
            let with = having.get(key).cloned().unwrap_or_default();
            let compared: Vec<(&Variant, bool)> = tried
                .iter()
                .filter(|(_, result)| counts(*result))
                .map(|(variant, result)| (*variant, with.contains(result)))
                .collect();
            let around = around(&key.0, texts);
            if let Some(note) = note(variants.get(number), &compared, &around) {
                diagnostic.fixes.clear();
                diagnostic = diagnostic.note(note);
            }
            unit.batch.diagnostics.push(diagnostic);
        }
    }
    units
}

fn keys(unit: &Unit) -> Vec<Key> {
    unit.batch.diagnostics.iter().map(|one| key_of(&unit.batch.sources, one)).collect()
}

fn key_of(sources: &SourceMap, diagnostic: &Diagnostic) -> Key {
    let finding = Finding::new(sources, diagnostic);
    (finding.region, finding.code.id, finding.message)
}

/// The macros of the conditions around a place, and those that an `#error` asks of these.
fn around(region: &Region, texts: &BTreeMap<String, Conditions>) -> BTreeSet<String> {
    let line = region.line.saturating_sub(1) as usize;
    let branches = texts.get(&region.file).into_iter().flat_map(|text| &text.branches);
    let around = branches.filter(|one| one.directive < line && line < one.end);
    let mut names: BTreeSet<String> = around.flat_map(|one| one.names.iter().cloned()).collect();
    // What an `#error` asks of them is needed to see the finding.
    let errors = texts.values().flat_map(|text| &text.branches).filter(|one| one.is_error);
    let asked: Vec<&String> =
        errors.filter(|one| !names.is_disjoint(&one.names)).flat_map(|one| one.names.iter()).collect();
    names.extend(asked.into_iter().cloned());
    names
}

/// The macros under which a finding comes; `None` if all configurations have it.
fn note(first: Option<&Variant>, compared: &[(&Variant, bool)], around: &BTreeSet<String>) -> Option<String> {
    let first = first?;
    let without: Vec<&Variant> = compared.iter().filter(|(_, has)| !has).map(|(variant, _)| *variant).collect();
    if without.is_empty() {
        return None;
    }
    let with: Vec<&Variant> = compared.iter().filter(|(_, has)| *has).map(|(variant, _)| *variant).collect();
    let names: BTreeSet<&String> = compared.iter().flat_map(|(variant, _)| variant.keys()).collect();
    let mut terms: Vec<(&String, Option<&String>)> = names
        .into_iter()
        .filter(|name| with.iter().all(|variant| variant.get(*name) == first.get(*name)))
        .map(|name| (name, first.get(name)))
        .collect();
    let tells = |terms: &[(&String, Option<&String>)]| {
        let fits = |variant: &Variant| terms.iter().all(|(name, value)| variant.get(*name) == *value);
        !without.iter().any(|variant| fits(variant))
    };
    if !tells(&terms) {
        let all = first.iter().map(|(name, value)| format!("`{name}={value}`")).collect::<Vec<_>>().join(", ");
        let such = if all.is_empty() { "without any of the macros".to_owned() } else { format!("such as {all}") };
        return Some(format!("in {} of {} configurations, {such}", with.len(), compared.len()));
    }
    // What goes first is what the conditions around it do not name.
    terms.sort_by_key(|(name, value)| (around.contains(*name), value.is_some()));
    let mut at = 0;
    while at < terms.len() {
        // A reader who defines what the note names sees the finding.
        if terms.get(at).is_some_and(|(name, value)| value.is_some() && around.contains(*name)) {
            at += 1;
            continue;
        }
        let mut fewer = terms.clone();
        let term = fewer.remove(at);
        if tells(&fewer) {
            terms = fewer;
        } else {
            terms.retain(|one| *one != term);
            terms.insert(at, term);
            at += 1;
        }
    }
    terms.sort();
    let part = |is_with: bool| {
        let shown = terms.iter().filter(|(_, value)| value.is_some() == is_with);
        let shown = shown.map(|(name, value)| value.map_or(format!("`{name}`"), |value| format!("`{name}={value}`")));
        let shown = shown.collect::<Vec<_>>().join(if is_with { " and " } else { " or " });
        (!shown.is_empty()).then(|| format!("{} {shown}", if is_with { "with" } else { "without" }))
    };
    let parts: Vec<String> = [part(true), part(false)].into_iter().flatten().collect();
    Some(format!("only {}", parts.join(" and ")))
}
