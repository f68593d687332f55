//! The thing that each name of a program's texts denotes, over all of its stages and files, for editors and other readers of texts.
//!
//! *In:* an [`Inspection`]: trees, typed shaders and notes of all stages, with errors or without. *Out:* an [`Index`]: symbols, and
//! where each occurs. *Holds:* declarations of one text that several stages include are one symbol, and so are the two sides of
//! what passes between stages (GLSL 1.50 §4.3.4 to §4.3.7). An occurrence is where the name is written: in the body of a macro, if
//! it comes from there.

mod builder;
mod stages;
mod writes;

use crate::analysis::{Denoted, Notes};
use crate::hir::{Shader, Types};
use crate::source::{FileId, Span};
use crate::syntax::ast::Ast;

pub use builder::index;

/// All that is known of one source.
#[derive(Clone, Debug)]
pub struct View {
    /// Its own text.
    pub file: FileId,
    /// The tree.
    pub ast: Ast,
    /// The typed shader, before the link.
    pub shader: Shader,
    /// The things that its names denote.
    pub notes: Notes,
}

/// All that is known of a program before the link.
#[derive(Clone, Debug, Default)]
pub struct Inspection {
    /// The types of all stages.
    pub types: Types,
    /// The sources; `None` for one that there was no room for.
    pub views: Vec<Option<View>>,
}

impl Inspection {
    /// The views that there are, with their numbers.
    pub fn views(&self) -> impl Iterator<Item = (usize, &View)> {
        self.views.iter().enumerate().filter_map(|(number, view)| Some((number, view.as_ref()?)))
    }

    /// A view by its number.
    pub fn view(&self, number: usize) -> Option<&View> {
        self.views.get(number)?.as_ref()
    }
}

/// The handle of a symbol in an [`Index`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SymbolId(u32);

impl SymbolId {
    /// The index among the symbols.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// The kind of a symbol.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SymbolKind {
    /// Something of the shaders.
    Declared,
    /// Something that the language has.
    Builtin,
    /// A macro.
    Macro,
    /// A parameter of a macro.
    MacroParameter,
}

/// A named thing of a program.
#[derive(Clone, Debug)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// Its kind.
    pub kind: SymbolKind,
    /// The thing in each view, by the view's number; empty for a macro.
    pub places: Vec<(usize, Denoted)>,
    /// Where it is declared, the definition of a function first; written outside of macros or in a macro's body.
    pub declarations: Vec<Span>,
}

/// How a name occurs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Role {
    /// Declared.
    Declaration,
    /// Defined.
    Definition,
    /// Written to.
    Write,
    /// Used in any other way.
    Read,
}

/// A name where it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The place, outside of any macro use.
    pub span: Span,
    /// The symbol.
    pub symbol: SymbolId,
    /// How it occurs.
    pub role: Role,
    /// Whether another use of the same macro gives the name another meaning.
    pub is_ambiguous: bool,
}

/// All names of a program.
#[derive(Clone, Debug, Default)]
pub struct Index {
    symbols: Vec<Symbol>,
    /// Sorted by their places.
    occurrences: Vec<Occurrence>,
    /// For each symbol, where its occurrences are in that list.
    by_symbol: Vec<Vec<u32>>,
}

impl Index {
    fn new(symbols: Vec<Symbol>, occurrences: Vec<Occurrence>) -> Self {
        let mut by_symbol = vec![Vec::new(); symbols.len()];
        for (index, found) in occurrences.iter().enumerate() {
            if let Some(own) = by_symbol.get_mut(found.symbol.index()) {
                own.push(index as u32);
            }
        }
        Self { symbols, occurrences, by_symbol }
    }

    /// The symbol of a handle of this index.
    pub fn symbol(&self, id: SymbolId) -> &Symbol {
        &self.symbols[id.index()]
    }

    /// All symbols with their handles.
    pub fn symbols(&self) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.symbols.iter().enumerate().map(|(index, symbol)| (SymbolId(index as u32), symbol))
    }

    /// All occurrences, in the order of the texts.
    pub fn occurrences(&self) -> &[Occurrence] {
        &self.occurrences
    }

    /// The occurrence at an offset, or one that ends there.
    pub fn at(&self, offset: u32) -> Option<&Occurrence> {
        let after = self.occurrences.partition_point(|found| found.span.start <= offset);
        let before = after.checked_sub(1).and_then(|index| self.occurrences.get(index))?;
        (offset <= before.span.end).then_some(before)
    }

    /// The occurrences in a range of offsets.
    pub fn within(&self, start: u32, end: u32) -> &[Occurrence] {
        let first = self.occurrences.partition_point(|found| found.span.start < start);
        let last = self.occurrences.partition_point(|found| found.span.start < end);
        self.occurrences.get(first..last).unwrap_or(&[])
    }

    /// The occurrences of a symbol, in the order of the texts.
    pub fn of(&self, symbol: SymbolId) -> impl Iterator<Item = &Occurrence> {
        let own = self.by_symbol.get(symbol.index()).into_iter().flatten();
        own.filter_map(|index| self.occurrences.get(*index as usize))
    }
}
