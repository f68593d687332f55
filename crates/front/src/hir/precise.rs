//! The declarations that a shader makes `precise` (GLSL 4.00 §4.7): their values are computed as written, and alike in every stage.

use crate::source::Span;
use std::collections::BTreeSet;

/// The declarations that are `precise`. Those of the shader are known by the places of their names, which stay the same where a pass
/// numbers variables again; built-in variables by their names.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Precise {
    places: BTreeSet<Span>,
    builtins: BTreeSet<String>,
}

impl Precise {
    /// Whether nothing is.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty() && self.builtins.is_empty()
    }

    /// Whether the variable, parameter, member, block or function is whose name is declared at a place.
    pub fn holds(&self, name: Span) -> bool {
        self.places.contains(&name)
    }

    /// Whether a built-in variable is.
    pub fn holds_builtin(&self, name: &str) -> bool {
        self.builtins.contains(name)
    }

    /// Adds the declaration of a name; one without a place is that of a built-in variable.
    pub(crate) fn add(&mut self, name: &str, span: Span) {
        if span.is_known() && !name.starts_with("gl_") {
            self.places.insert(span);
        } else {
            self.builtins.insert(name.to_owned());
        }
    }

    /// Adds all of another shader of the stage.
    pub(crate) fn join(&mut self, other: &Self) {
        self.places.extend(&other.places);
        self.builtins.extend(other.builtins.iter().cloned());
    }
}
