//! Builds an [`Index`] from notes, expansions and directives.

use super::stages::{self, Place};
use super::writes::written;
use super::{Index, Inspection, Occurrence, Role, Symbol, SymbolId, SymbolKind, View};
use crate::analysis::{Denoted, NoteRole};
use crate::source::{SourceMap, Span};
use crate::syntax::directives::MacroDefinition;
use rustc_hash::FxHashMap;

/// The identity of a symbol before the stages are compared.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
enum Key {
    /// Something that a view declares, and its name: a prototype may name a parameter as it likes.
    Place(usize, Denoted, String),
    /// A built-in name.
    Builtin(String),
    /// A macro: all definitions of a name are one.
    Macro(String),
    /// A parameter of the macro that is defined at an offset.
    MacroParameter(u32, String),
}

#[derive(Default)]
struct Builder {
    symbols: Vec<Symbol>,
    keys: FxHashMap<Key, u32>,
    /// The symbol that each is one with; itself for the first.
    parents: Vec<u32>,
    /// The symbols by what they are, for the stages.
    places: FxHashMap<Place, u32>,
    /// The symbols by where they are declared.
    declared: FxHashMap<Span, u32>,
    occurrences: Vec<Occurrence>,
}

/// The index of a program.
pub fn index(sources: &SourceMap, inspection: &Inspection) -> Index {
    let mut builder = Builder::default();
    for (number, view) in inspection.views() {
        builder.notes(sources, number, view);
        builder.directives(sources, view);
    }
    builder.expansions(sources);
    let mut pairs = Vec::new();
    stages::unite(inspection, &mut |a, b| pairs.push((a, b)));
    for (a, b) in pairs {
        if let (Some(&a), Some(&b)) = (builder.places.get(&a), builder.places.get(&b)) {
            builder.unite(a, b);
        }
    }
    builder.finish()
}

/// Where a span is written, whatever macro use brought it.
fn plain(span: Span) -> Span {
    Span::new(span.start, span.end)
}

impl Builder {
    fn symbol(&mut self, key: Key) -> u32 {
        if let Some(&known) = self.keys.get(&key) {
            return known;
        }
        let number = self.symbols.len() as u32;
        let (name, kind, places) = match &key {
            Key::Place(view, denoted, name) => (name, SymbolKind::Declared, vec![(*view, *denoted)]),
            Key::Builtin(name) => (name, SymbolKind::Builtin, Vec::new()),
            Key::Macro(name) => (name, SymbolKind::Macro, Vec::new()),
            Key::MacroParameter(_, name) => (name, SymbolKind::MacroParameter, Vec::new()),
        };
        if let Some(&place) = places.first() {
            self.places.entry(place).or_insert(number);
        }
        self.symbols.push(Symbol { name: name.clone(), kind, places, declarations: Vec::new() });
        self.parents.push(number);
        self.keys.insert(key, number);
        number
    }

    fn root(&self, symbol: u32) -> u32 {
        let mut at = symbol;
        while let Some(&parent) = self.parents.get(at as usize).filter(|&&parent| parent != at) {
            at = parent;
        }
        at
    }

    fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (first, second) = (a.min(b), a.max(b));
        if let Some(parent) = self.parents.get_mut(second as usize) {
            *parent = first;
        }
    }

    fn declare(&mut self, symbol: u32, span: Span, first: bool) {
        if let Some(&other) = self.declared.get(&span) {
            self.unite(symbol, other);
        } else {
            self.declared.insert(span, symbol);
        }
        let Some(symbol) = self.symbols.get_mut(symbol as usize) else { return };
        if !symbol.declarations.contains(&span) {
            let at = if first { 0 } else { symbol.declarations.len() };
            symbol.declarations.insert(at, span);
        }
    }

    fn occur(&mut self, span: Span, symbol: u32, role: Role) {
        self.occurrences.push(Occurrence { span, symbol: SymbolId(symbol), role, is_ambiguous: false });
    }

    fn notes(&mut self, sources: &SourceMap, number: usize, view: &View) {
        let written = written(&view.shader);
        // A later note on a name knows more than an earlier one.
        let mut last: FxHashMap<Span, usize> = FxHashMap::default();
        for (index, note) in view.notes.names.iter().enumerate() {
            last.insert(note.span, index);
        }
        for (index, note) in view.notes.names.iter().enumerate() {
            let name = sources.snippet(note.span);
            // What `##` joins is written nowhere.
            let is_name = name.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
                && name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
            if last.get(&note.span) != Some(&index) || !is_name {
                continue;
            }
            let key = match note.denoted {
                Denoted::Components(_) | Denoted::Length(_) => continue,
                Denoted::Builtin => Key::Builtin(name.to_owned()),
                denoted => Key::Place(number, denoted, name.to_owned()),
            };
            let (symbol, span) = (self.symbol(key), plain(note.span));
            let role = match note.role {
                NoteRole::Declares => Role::Declaration,
                NoteRole::Defines => Role::Definition,
                NoteRole::Uses if written.contains(&note.span) => Role::Write,
                NoteRole::Uses => Role::Read,
            };
            if matches!(role, Role::Declaration | Role::Definition) {
                self.declare(symbol, span, role == Role::Definition);
            }
            self.occur(span, symbol, role);
        }
    }

    fn directives(&mut self, sources: &SourceMap, view: &View) {
        let directives = &view.ast.directives;
        for definition in &directives.definitions {
            let symbol = self.symbol(Key::Macro(definition.name.to_string()));
            self.declare(symbol, plain(definition.span), false);
            self.occur(plain(definition.span), symbol, Role::Definition);
            self.parameters(sources, definition);
        }
        for mention in &directives.mentions {
            let symbol = self.symbol(Key::Macro(sources.snippet(mention.span).to_owned()));
            self.occur(plain(mention.span), symbol, Role::Read);
        }
    }

    /// The parameters of a macro, from the name to the end of its body.
    fn parameters(&mut self, sources: &SourceMap, definition: &MacroDefinition) {
        let Some(params) = definition.params.as_ref().filter(|params| !params.is_empty()) else { return };
        let Some(file) = sources.file_of(definition.span).map(|id| sources.file(id)) else { return };
        let from = definition.span.end;
        let line = file.text().get((from - file.base()) as usize..).unwrap_or("");
        let closing = line.find(')').map_or(from, |end| from + end as u32);
        let end = definition.body.end.max(closing);
        let text = sources.snippet(Span::new(from, end));
        for (start, word) in words(text) {
            if params.iter().any(|param| &**param == word) {
                let symbol = self.symbol(Key::MacroParameter(definition.span.start, word.to_owned()));
                let span = Span::new(from + start as u32, from + (start + word.len()) as u32);
                let is_declared = span.end <= closing;
                if is_declared {
                    self.declare(symbol, span, false);
                }
                self.occur(span, symbol, if is_declared { Role::Declaration } else { Role::Read });
            }
        }
    }

    fn expansions(&mut self, sources: &SourceMap) {
        for expansion in sources.expansions() {
            let end = expansion.call.start.saturating_add(expansion.name.len() as u32);
            let span = Span::new(expansion.call.start, end);
            if sources.snippet(span) == &*expansion.name {
                let symbol = self.symbol(Key::Macro(expansion.name.to_string()));
                self.occur(span, symbol, Role::Read);
            }
        }
    }

    fn finish(mut self) -> Index {
        let roots: Vec<u32> = (0..self.symbols.len() as u32).map(|symbol| self.root(symbol)).collect();
        let mut numbers: Vec<Option<u32>> = vec![None; self.symbols.len()];
        let mut symbols: Vec<Symbol> = Vec::new();
        for (index, symbol) in std::mem::take(&mut self.symbols).into_iter().enumerate() {
            let root = roots.get(index).copied().unwrap_or(0) as usize;
            let known = numbers.get(root).copied().flatten();
            match known.and_then(|known| symbols.get_mut(known as usize)) {
                Some(first) => {
                    first.places.extend(symbol.places);
                    for span in symbol.declarations {
                        if !first.declarations.contains(&span) {
                            first.declarations.push(span);
                        }
                    }
                }
                None => {
                    if let Some(number) = numbers.get_mut(root) {
                        *number = Some(symbols.len() as u32);
                    }
                    symbols.push(symbol);
                }
            }
        }
        let number = |symbol: SymbolId| {
            let root = roots.get(symbol.index()).copied().unwrap_or(0);
            SymbolId(numbers.get(root as usize).copied().flatten().unwrap_or(0))
        };
        for occurrence in &mut self.occurrences {
            occurrence.symbol = number(occurrence.symbol);
        }
        self.occurrences.sort_by_key(|found| (found.span, found.role, found.symbol));
        let mut occurrences: Vec<Occurrence> = Vec::with_capacity(self.occurrences.len());
        for found in self.occurrences {
            match occurrences.last_mut().filter(|last| last.span == found.span) {
                Some(last) => last.is_ambiguous |= last.symbol != found.symbol,
                None => occurrences.push(found),
            }
        }
        Index::new(symbols, occurrences)
    }
}

/// The words of a text, with their offsets.
pub(super) fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let mut at = 0;
    std::iter::from_fn(move || {
        let rest = text.get(at..)?;
        let start = at + rest.find(is_part)?;
        let word = text.get(start..)?;
        let end = start + word.find(|letter| !is_part(letter)).unwrap_or(word.len());
        at = end;
        Some((start, text.get(start..end)?))
    })
}
