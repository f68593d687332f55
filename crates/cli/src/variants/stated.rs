//! The tables of TOML that state values of macros, and conditions.
//!
//! *In:* tables. *Out:* values and conditions. *Holds:* everything that is wrong is reported at its place.

use super::axes::{Condition, Variant, define};
use glisten_front::diagnostic::codes::general::BAD_CONFIG;
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::source::Span;
use glisten_scene::tables::{Node, Reader};
use std::collections::{BTreeMap, BTreeSet};
use toml::de::{DeTable, DeValue};

/// The keys of `[lint.configurations]`.
const KEYS: &[&str] = &["values", "skip", "only"];

/// Values of a macro: `None` for one that is not defined.
pub(crate) type Values = Vec<Option<String>>;

/// The statements of `[lint.configurations]` about the macros of all programs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Stated {
    /// The values of macros, in place of those that conditions ask about.
    pub(crate) values: BTreeMap<String, Values>,
    /// No configuration has these.
    skip: Vec<Condition>,
    /// Every configuration has one of these, if there are any.
    only: Vec<Condition>,
}

impl Stated {
    /// Reads a table. What is wrong is reported and left out.
    pub(crate) fn read(reader: &mut Reader, table: &DeTable<'_>) -> Self {
        reader.check_keys(table, "`[lint.configurations]`", KEYS);
        let mut read = Self::default();
        for (key, node) in reader.table_at(table, "values").into_iter().flatten() {
            let Some(name) = reader.macro_name(key) else { continue };
            if let Some(values) = values(reader, node, &name).filter(|values| !values.is_empty()) {
                read.values.insert(name, values);
            }
        }
        // A condition may name any macro of the sources.
        let mut conditions_at =
            |key: &str| conditions(reader, table, key, &BTreeSet::new(), &|_: &str| true).unwrap_or_default();
        read.skip = conditions_at("skip");
        read.only = conditions_at("only");
        read
    }

    /// Whether the conditions allow a configuration.
    pub(crate) fn allows(&self, variant: &Variant) -> bool {
        self.broken(variant).is_none()
    }

    /// The macros of each condition.
    pub(crate) fn groups(&self) -> impl Iterator<Item = BTreeSet<String>> + '_ {
        self.skip.iter().chain(&self.only).map(|condition| condition.names().map(str::to_owned).collect())
    }

    /// The reason why a configuration is none.
    pub(crate) fn broken(&self, variant: &Variant) -> Option<Broken<'_>> {
        if let Some(condition) = self.skip.iter().find(|condition| condition.holds(variant)) {
            return Some(Broken::Skipped(condition));
        }
        let is_missing = !self.only.is_empty() && !self.only.iter().any(|condition| condition.holds(variant));
        is_missing.then_some(Broken::Missing(&self.only))
    }
}

/// A condition that forbids a configuration.
pub(crate) enum Broken<'s> {
    /// This condition of `skip` holds.
    Skipped(&'s Condition),
    /// None of these of `only` holds.
    Missing(&'s [Condition]),
}

/// The list of values of a macro.
pub(crate) fn values(reader: &mut Reader, node: &Node<'_>, name: &str) -> Option<Values> {
    let span = reader.span_of(node);
    let Some(list) = node.get_ref().as_array() else {
        let help = format!("write `{name} = [0, 1]` or `{name} = [false, true]`");
        wrong(reader, span, format!("`values.{name}` is not a list of values"), Some(help));
        return None;
    };
    if list.is_empty() {
        wrong(reader, span, format!("`values.{name}` has no value"), None);
    }
    list.iter().map(|node| value(reader, node, name)).collect()
}

/// The value of a macro: `None` in it for `false`, which does not define it.
pub(crate) fn value(reader: &mut Reader, node: &Node<'_>, name: &str) -> Option<Option<String>> {
    let span = reader.span_of(node);
    if let DeValue::Array(_) = node.get_ref() {
        let help = "a list of values, one for each variant, goes under `[program.values]`".to_owned();
        wrong(reader, span, format!("`{name}` has more than one value here"), Some(help));
        return None;
    }
    if let DeValue::Boolean(false) = node.get_ref() {
        return Some(None);
    }
    let text = reader.macro_text(node, name, ["0", "1"])?;
    match define(&format!("{name}={text}")) {
        Ok((_, value)) => Some(Some(value)),
        Err(why) => {
            wrong(reader, span, why, None);
            None
        }
    }
}

/// The conditions under a key, whose macros have to be `known`; `names` are those to name if one is not. `None` if one is wrong.
pub(crate) fn conditions(
    reader: &mut Reader,
    table: &DeTable<'_>,
    key: &str,
    names: &BTreeSet<String>,
    known: &impl Fn(&str) -> bool,
) -> Option<Vec<Condition>> {
    let mut conditions = Vec::new();
    let before = reader.diagnostics.len();
    for (text, span) in reader.texts_at(table, key) {
        let condition = match Condition::new(text) {
            Ok(condition) => condition,
            Err(why) => {
                wrong(reader, span, why, None);
                continue;
            }
        };
        for other in condition.names().filter(|name| !known(name)) {
            let near = did_you_mean(other, names.iter().map(String::as_str));
            let help = near.map(|near| format!("did you mean `{near}`?"));
            wrong(reader, span, format!("no variant has `{other}`"), help);
        }
        conditions.push(condition);
    }
    (reader.diagnostics.len() == before).then_some(conditions)
}

/// Reports what is wrong in a file of settings.
pub(crate) fn wrong(reader: &mut Reader, span: Span, message: impl Into<String>, help: Option<String>) {
    reader.report(Diagnostic::new(&BAD_CONFIG, span, message.into()).maybe_help(help));
}
