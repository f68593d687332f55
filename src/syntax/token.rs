//! [`Token`]: what the lexer and the preprocessor hand to the parser.

use crate::source::Span;

/// An interned name; its spelling is in the [`Names`] of the tree it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Symbol(u32);

/// The spellings behind [`Symbol`]s.
#[derive(Clone, Debug, Default)]
pub struct Names {
    set: indexmap::IndexSet<Box<str>, rustc_hash::FxBuildHasher>,
}

impl Names {
    /// The symbol of a spelling.
    pub fn intern(&mut self, name: &str) -> Symbol {
        if let Some(index) = self.set.get_index_of(name) {
            return Symbol(index as u32);
        }
        Symbol(self.set.insert_full(name.into()).0 as u32)
    }

    /// The symbol of a spelling that may not have occurred.
    pub fn get(&self, name: &str) -> Option<Symbol> {
        self.set.get_index_of(name).map(|index| Symbol(index as u32))
    }

    /// The spelling of a symbol.
    pub fn spelling(&self, symbol: Symbol) -> &str {
        self.set.get_index(symbol.0 as usize).map_or("", |name| name)
    }
}
