//! [`Scopes`]: which name means what at a place in the text (§4.2).
//!
//! Names of variables, structs and functions share one space. The built-in names stand in a scope of their own outside
//! the global one; they are not entered here but asked of the tables when nothing here answers.

use crate::hir::{FunctionId, GlobalId, TypeId, VarRef};
use crate::source::Span;
use crate::syntax::token::Symbol;
use rustc_hash::FxHashMap;

/// A set of overloads in [`Scopes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OverloadSet(u32);

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Entry {
    /// A variable.
    Variable(VarRef),
    /// A member of a block without an instance name.
    Member(GlobalId, u32),
    /// A struct.
    Struct(TypeId),
    /// The functions of that name.
    Functions(OverloadSet),
    /// Something whose declaration was in error: it agrees with everything.
    Poison,
}

/// A declared name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binding {
    /// What it means.
    pub(super) entry: Entry,
    /// The name in its declaration; nowhere for what is built in.
    pub(super) span: Span,
    /// The scope: 0 is global.
    pub(super) level: u32,
}

struct Row {
    symbol: Symbol,
    binding: Binding,
    hidden: Option<u32>,
}

/// The names in sight.
#[derive(Default)]
pub(super) struct Scopes {
    rows: Vec<Row>,
    visible: FxHashMap<Symbol, u32>,
    starts: Vec<usize>,
    overloads: Vec<Vec<FunctionId>>,
}

impl Scopes {
    /// Opens a scope.
    pub(super) fn open(&mut self) {
        self.starts.push(self.rows.len());
    }

    /// Closes the innermost scope; its names are forgotten and those they hid are back.
    pub(super) fn close(&mut self) {
        let start = self.starts.pop().unwrap_or(0);
        for row in self.rows.drain(start..).rev() {
            match row.hidden {
                Some(hidden) => self.visible.insert(row.symbol, hidden),
                None => self.visible.remove(&row.symbol),
            };
        }
    }

    /// Whether the innermost scope is the global one.
    pub(super) fn is_global(&self) -> bool {
        self.starts.is_empty()
    }

    /// What a name means here.
    pub(super) fn find(&self, symbol: Symbol) -> Option<Binding> {
        let row = *self.visible.get(&symbol)?;
        self.rows.get(row as usize).map(|row| row.binding)
    }

    /// What a name means if it was declared in the innermost scope itself.
    pub(super) fn find_here(&self, symbol: Symbol) -> Option<Binding> {
        self.find(symbol).filter(|binding| binding.level == self.level())
    }

    /// Enters a name into the innermost scope, where it hides what it meant before.
    pub(super) fn enter(&mut self, symbol: Symbol, entry: Entry, span: Span) {
        let binding = Binding { entry, span, level: self.level() };
        let hidden = self.visible.insert(symbol, self.rows.len() as u32);
        self.rows.push(Row { symbol, binding, hidden });
    }

    /// Gives a name of the innermost scope another meaning.
    pub(super) fn replace(&mut self, symbol: Symbol, entry: Entry) {
        if let Some(row) = self.visible.get(&symbol).and_then(|&row| self.rows.get_mut(row as usize)) {
            row.binding.entry = entry;
        }
    }

    /// How many names are declared in all open scopes.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// A new set of overloads with one function.
    pub(super) fn overload_set(&mut self, first: FunctionId) -> OverloadSet {
        self.overloads.push(vec![first]);
        OverloadSet(self.overloads.len() as u32 - 1)
    }

    /// The functions of a set.
    pub(super) fn functions(&self, set: OverloadSet) -> &[FunctionId] {
        self.overloads.get(set.0 as usize).map_or(&[], Vec::as_slice)
    }

    /// Adds a function to a set.
    pub(super) fn add_overload(&mut self, set: OverloadSet, function: FunctionId) {
        if let Some(functions) = self.overloads.get_mut(set.0 as usize) {
            functions.push(function);
        }
    }

    /// All names in sight, in the order of their declarations.
    pub(super) fn names(&self) -> impl Iterator<Item = (Symbol, Binding)> {
        let in_sight = |(index, row): &(usize, &Row)| self.visible.get(&row.symbol) == Some(&(*index as u32));
        self.rows.iter().enumerate().filter(in_sight).map(|(_, row)| (row.symbol, row.binding))
    }

    fn level(&self) -> u32 {
        self.starts.len() as u32
    }
}
