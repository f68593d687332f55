//! [`Scopes`]: the meaning of each name at a position in the text (§4.2).
//!
//! Variables, structs and functions share one name space, except in GLSL 1.10, whose functions have their own (1.10
//! §4.2). Built-in names are in a scope outside the global one. They are not entered here; the caller looks them up in the
//! tables if nothing is found here.

use crate::hir::{FunctionId, GlobalId, TypeId, VarRef};
use crate::source::Span;
use crate::syntax::token::Symbol;
use rustc_hash::FxHashMap;

/// The handle of a set of overloads in [`Scopes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OverloadSet(u32);

/// The meaning of a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Entry {
    /// A variable.
    Variable(VarRef),
    /// A member of a block without an instance name.
    Member(GlobalId, u32),
    /// A struct.
    Struct(TypeId),
    /// The functions of this name.
    Functions(OverloadSet),
    /// Something whose declaration was in error; it is compatible with everything.
    Poison,
}

/// A declared name.
#[derive(Clone, Copy, Debug)]
pub(super) struct Binding {
    /// The meaning.
    pub(super) entry: Entry,
    /// The name in its declaration; unknown for built-in names.
    pub(super) span: Span,
    /// The level of the scope: 0 is global.
    pub(super) level: u32,
}

struct Row {
    symbol: Symbol,
    binding: Binding,
    hidden: Option<u32>,
}

/// The names in scope.
#[derive(Default)]
pub(super) struct Scopes {
    rows: Vec<Row>,
    visible: FxHashMap<Symbol, u32>,
    starts: Vec<usize>,
    overloads: Vec<Vec<FunctionId>>,
    /// The functions of a language whose functions have a name space of their own.
    functions: Option<FxHashMap<Symbol, Binding>>,
}

impl Scopes {
    /// Scopes in which functions share the name space of variables, or, if they are `apart`, have their own.
    pub(super) fn new(apart: bool) -> Self {
        Self { functions: apart.then(FxHashMap::default), ..Self::default() }
    }

    /// Opens a scope.
    pub(super) fn open(&mut self) {
        self.starts.push(self.rows.len());
    }

    /// Closes the innermost scope: forgets its names, and reveals those that they hid.
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

    /// The meaning of a name here.
    pub(super) fn find(&self, symbol: Symbol) -> Option<Binding> {
        let row = *self.visible.get(&symbol)?;
        self.rows.get(row as usize).map(|row| row.binding)
    }

    /// The meaning of a name, if it was declared in the innermost scope.
    pub(super) fn find_here(&self, symbol: Symbol) -> Option<Binding> {
        self.find(symbol).filter(|binding| binding.level == self.level())
    }

    /// The meaning of a name that is called.
    pub(super) fn find_called(&self, symbol: Symbol) -> Option<Binding> {
        let Some(functions) = &self.functions else { return self.find(symbol) };
        let constructor = || self.find(symbol).filter(|binding| matches!(binding.entry, Entry::Struct(_)));
        functions.get(&symbol).copied().or_else(constructor)
    }

    /// The meaning that a declaration of a function in the innermost scope finds there.
    pub(super) fn find_function_here(&self, symbol: Symbol) -> Option<Binding> {
        match &self.functions {
            Some(functions) => functions.get(&symbol).copied(),
            None => self.find_here(symbol),
        }
    }

    /// Enters the name of a function.
    pub(super) fn enter_function(&mut self, symbol: Symbol, entry: Entry, span: Span) {
        match &mut self.functions {
            Some(functions) => {
                functions.insert(symbol, Binding { entry, span, level: 0 });
            }
            None => self.enter(symbol, entry, span),
        }
    }

    /// Enters a name into the innermost scope, where it hides its outer meaning.
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

    /// The number of names declared in all open scopes.
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

    /// All names in scope, in order of declaration.
    pub(super) fn names(&self) -> impl Iterator<Item = (Symbol, Binding)> {
        let in_sight = |(index, row): &(usize, &Row)| self.visible.get(&row.symbol) == Some(&(*index as u32));
        let rows = self.rows.iter().enumerate().filter(in_sight).map(|(_, row)| (row.symbol, row.binding));
        rows.chain(self.functions_apart())
    }

    /// The functions of a name space of their own, in order of declaration.
    fn functions_apart(&self) -> impl Iterator<Item = (Symbol, Binding)> {
        let mut found: Vec<(Symbol, Binding)> =
            self.functions.iter().flatten().map(|(symbol, binding)| (*symbol, *binding)).collect();
        found.sort_unstable_by_key(|(_, binding)| binding.span);
        found.into_iter()
    }

    fn level(&self) -> u32 {
        self.starts.len() as u32
    }
}
