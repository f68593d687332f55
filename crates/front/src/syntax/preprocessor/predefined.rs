//! The beginning of every parse: the names of the keywords and of the extensions, and the macros of the extensions.
//!
//! *In:* the tables of keywords and of extensions. *Out:* [`names`], to which a parse adds its own, and the macros.
//!
//! *Holds:* both are made once for all parses. The symbols of [`extension_macros`] are those of [`names`] and of nothing else.

use super::definition::Macro;
use super::{Names, Symbol};
use crate::language::{EXTENSIONS, Extension};
use std::sync::LazyLock;

struct Predefined {
    names: Names,
    macros: Vec<(&'static Extension, Symbol, Macro)>,
}

static PREDEFINED: LazyLock<Predefined> = LazyLock::new(|| {
    let mut names = Names::with_keywords();
    let macros =
        EXTENSIONS.iter().map(|row| (row, names.intern(row.name), Macro::number(&mut names, row.name, "1"))).collect();
    Predefined { names, macros }
});

/// The names that a parse begins with: those of the keywords, in the order of their table, and those of the extensions.
pub(in crate::syntax) fn names() -> Names {
    PREDEFINED.names.clone()
}

/// The macro of each implemented extension (GLSL 1.50 §3.3), with its symbol among [`names`].
pub(super) fn extension_macros() -> impl Iterator<Item = &'static (&'static Extension, Symbol, Macro)> {
    PREDEFINED.macros.iter()
}
