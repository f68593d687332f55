//! [`Shared`]: the results of variants, for other variants that must have the same.
//!
//! *In:* a variant, its result, and the macros that the result depends on. *Out:* the result for any variant that defines those
//! macros alike. *Holds:* what a macro does is decided where its name is read in text that is not skipped; a macro that no
//! text asks for cannot change anything. A macro whose definition is odd in itself counts as asked for.

use crate::variants::Variant;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, PoisonError, RwLock};

/// For some macros, each way to define them, and its result.
type Results<T> = BTreeMap<Vec<Option<String>>, Arc<T>>;

/// The results of variants.
pub(super) struct Shared<T> {
    by_names: RwLock<BTreeMap<Vec<String>, Results<T>>>,
    /// Macros that count as asked for by all.
    always: BTreeSet<String>,
}

impl<T> Shared<T> {
    /// No results yet, for these variants. With `nothing_is_shared`, each variant has its own.
    pub(super) fn new(names: &BTreeSet<String>, variants: &[Variant], nothing_is_shared: bool) -> Self {
        let is_odd = |name: &&String| {
            let reserved = name.contains("__") || name.to_ascii_lowercase().starts_with("gl_");
            let values = variants.iter().filter_map(|variant| variant.get(*name));
            reserved || nothing_is_shared || values.into_iter().any(|value| !is_plain(value))
        };
        Self { by_names: RwLock::default(), always: names.iter().filter(is_odd).cloned().collect() }
    }

    /// The result of another variant that is this one's, too.
    pub(super) fn find(&self, variant: &Variant) -> Option<Arc<T>> {
        let known = self.by_names.read().unwrap_or_else(PoisonError::into_inner);
        known.iter().find_map(|(names, results)| results.get(&values(names, variant)).map(Arc::clone))
    }

    /// Keeps the result of a variant. Of two equal ones, the first is kept, and returned.
    pub(super) fn keep(&self, variant: &Variant, asked: &BTreeSet<String>, result: T) -> Arc<T> {
        let names: Vec<String> = asked.union(&self.always).cloned().collect();
        let values = values(&names, variant);
        let mut known = self.by_names.write().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(known.entry(names).or_default().entry(values).or_insert_with(|| Arc::new(result)))
    }
}

fn values(names: &[String], variant: &Variant) -> Vec<Option<String>> {
    names.iter().map(|name| variant.get(name).cloned()).collect()
}

/// Whether a value is a number or a name, with which nothing can be wrong unless it is used.
fn is_plain(value: &str) -> bool {
    value.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_' || letter == '.')
}

#[cfg(test)]
mod tests {
    use super::{Shared, Variant};
    use std::collections::BTreeSet;

    fn variant(names: &[(&str, &str)]) -> Variant {
        names.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
    }

    fn names(names: &[&str]) -> BTreeSet<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn a_result_is_for_all_that_agree_on_what_was_asked_for() {
        let all = [variant(&[("A", "1"), ("B", "1")]), variant(&[("A", "1")]), variant(&[("B", "1")]), variant(&[])];
        let shared = Shared::new(&names(&["A", "B"]), &all, false);
        assert_eq!(shared.find(&all[0]), None);
        shared.keep(&all[0], &names(&["A"]), "with A");
        assert_eq!(shared.find(&all[1]).as_deref(), Some(&"with A"));
        assert_eq!(shared.find(&all[2]), None, "A is asked for, and not defined");
        shared.keep(&all[2], &names(&["A", "B"]), "B alone");
        assert_eq!(shared.find(&all[3]), None);
        assert_eq!(*shared.keep(&all[1], &names(&["A"]), "again"), "with A");
    }

    #[test]
    fn odd_definitions_are_never_shared() {
        for (name, value) in [("GL_x", "1"), ("a__b", "1"), ("A", "\"text\""), ("A", "1 +")] {
            let all = [variant(&[(name, value)]), variant(&[])];
            let shared = Shared::new(&names(&[name]), &all, false);
            shared.keep(&all[0], &names(&[]), ());
            assert_eq!(shared.find(&all[1]), None, "{name}={value}");
        }
        let all = [variant(&[("A", "1")]), variant(&[])];
        let apart = Shared::new(&names(&["A"]), &all, true);
        apart.keep(&all[0], &names(&[]), ());
        assert_eq!(apart.find(&all[1]), None);
    }
}
