//! [`Qualifiers`]: the macros that stand for qualifiers, such as `VARYING` after `#define VARYING in`.
//!
//! *In:* the files of a tree. *Out:* for each file the macros of the programs that read it. *Holds:* a macro that one of those
//! programs defines as anything else is none of them; what other programs call so does not matter.

use super::Key;
use super::conditions::Conditions;
use super::files::Files;
use std::collections::{BTreeMap, BTreeSet};

/// The words that such a macro may stand for.
const WORDS: &[&str] =
    &["uniform", "in", "out", "flat", "smooth", "centroid", "lowp", "mediump", "highp", "const", "invariant"];

/// The macros of a text: those that stand for qualifiers alone, and the others.
#[derive(Clone, Debug, Default)]
struct Macros {
    plain: BTreeSet<String>,
    others: BTreeSet<String>,
}

impl Macros {
    fn new(text: &str) -> Self {
        let mut macros = Self::default();
        let conditions = Conditions::new(text);
        for one in conditions.list.iter().filter(|one| one.word() == "define") {
            let mut words = one.rest().split_whitespace();
            let Some(name) = words.next() else { continue };
            let is_plain = words.all(|word| WORDS.contains(&word));
            let list = if is_plain { &mut macros.plain } else { &mut macros.others };
            list.insert(name.to_owned());
        }
        macros
    }

    fn add(&mut self, other: &Self) {
        self.plain.extend(other.plain.iter().cloned());
        self.others.extend(other.others.iter().cloned());
    }
}

/// The macros that stand for qualifiers, by the files in which they may be used.
#[derive(Debug, Default)]
pub(super) struct Qualifiers {
    of_files: BTreeMap<Key, BTreeSet<String>>,
    none: BTreeSet<String>,
}

impl Qualifiers {
    pub(super) fn new(files: &Files) -> Self {
        let mut of_units: BTreeMap<usize, Macros> = BTreeMap::new();
        for file in files.all.values() {
            let own = Macros::new(&file.text);
            let units: BTreeSet<usize> = file.readers.iter().map(|(unit, _)| *unit).collect();
            units.into_iter().for_each(|unit| of_units.entry(unit).or_default().add(&own));
        }
        let of_file = |readers: &BTreeSet<(usize, _)>| {
            let mut all = Macros::default();
            readers.iter().filter_map(|(unit, _)| of_units.get(unit)).for_each(|macros| all.add(macros));
            &all.plain - &all.others
        };
        let of_files = files.all.iter().map(|(key, file)| (key.clone(), of_file(&file.readers))).collect();
        Self { of_files, none: BTreeSet::new() }
    }

    /// The macros that a file may use.
    pub(super) fn of(&self, key: &Key) -> &BTreeSet<String> {
        self.of_files.get(key).unwrap_or(&self.none)
    }
}
