//! Takes notes of what each name denotes, as the analysis resolves it.
//!
//! *In:* the names that the traversal meets. *Out:* [`Notes`](super::state::Notes). *Holds:* nothing is noted unless it is asked for.

use super::context::Analyzer;
use super::scope::{Binding, Entry};
use super::state::{Denoted, Note, NoteRole, Probe};
use crate::hir::{StructId, Type, TypeId, VarRef};
use crate::source::Span;
use crate::syntax::ast::Ident;
use crate::syntax::token::Symbol;

impl Analyzer<'_> {
    /// Notes what a name denotes.
    pub(super) fn note(&mut self, span: Span, denoted: Denoted, role: NoteRole) {
        if let Some(taker) = &mut self.notes {
            taker.notes.names.push(Note { span, denoted, role });
        }
    }

    /// Notes the use of a name with this meaning.
    pub(super) fn note_binding(&mut self, span: Span, binding: Binding) {
        if self.notes.is_some()
            && let Some(denoted) = self.denoted(binding)
        {
            self.note(span, denoted, NoteRole::Uses);
        }
    }

    /// Notes the declaration of a name with this meaning.
    pub(super) fn note_entry(&mut self, span: Span, entry: Entry) {
        let binding = Binding { entry, span, level: 0 };
        if self.notes.is_some()
            && let Some(denoted) = self.denoted(binding)
        {
            self.note(span, denoted, NoteRole::Declares);
        }
    }

    /// Notes the use of a member.
    pub(super) fn note_member(&mut self, span: Span, structure: StructId, member: u32, role: NoteRole) {
        self.note(span, Denoted::Member(structure, member), role);
    }

    /// The thing that a binding denotes.
    fn denoted(&self, binding: Binding) -> Option<Denoted> {
        Some(match binding.entry {
            Entry::Variable(VarRef::Global(id)) => {
                let global = self.shader.global(id);
                if global.builtin.is_some() || global.is_fixed() { Denoted::Builtin } else { Denoted::Global(id) }
            }
            Entry::Variable(VarRef::Local(id)) => Denoted::Local(self.body.as_ref()?.function, id),
            Entry::Member(block, member) => {
                let mut ty = self.shader.global(block).ty;
                while let Type::Array(element, _) = self.types.get(ty) {
                    ty = element;
                }
                match self.types.get(ty) {
                    Type::Struct(structure) => Denoted::Member(structure, member),
                    _ => Denoted::Broken(binding.span),
                }
            }
            Entry::Struct(ty) => match self.types.get(ty) {
                Type::Struct(structure) => Denoted::Struct(structure),
                _ => Denoted::Broken(binding.span),
            },
            Entry::Functions(set) => Denoted::Function(*self.scopes.functions(set).first()?),
            Entry::Poison => Denoted::Broken(binding.span),
        })
    }

    /// Whether a name is the probe. If so, notes what is in sight.
    pub(super) fn is_probe(&mut self, name: Ident) -> bool {
        if self.notes.as_ref().is_none_or(|taker| taker.probe != Some(name.symbol)) {
            return false;
        }
        let (names, function) = (self.in_sight(), self.body.as_ref().map(|body| body.function));
        if let Some(taker) = &mut self.notes {
            taker.notes.probe.get_or_insert(Probe { member_of: None, names, function });
        }
        true
    }

    /// Whether the name of a member is the probe. If so, notes the type of the value.
    pub(super) fn is_probe_of_member(&mut self, name: Ident, ty: TypeId) -> bool {
        let function = self.body.as_ref().map(|body| body.function);
        match &mut self.notes {
            Some(taker) if taker.probe == Some(name.symbol) => {
                taker.notes.probe.get_or_insert(Probe { member_of: Some(ty), names: Vec::new(), function });
                true
            }
            _ => false,
        }
    }

    fn in_sight(&self) -> Vec<(Symbol, Denoted)> {
        let names = self.scopes.names();
        names.filter_map(|(symbol, binding)| Some((symbol, self.denoted(binding)?))).collect()
    }

    /// Notes the names at the end.
    pub(super) fn note_end(&mut self) {
        if self.notes.is_some() {
            let names = self.in_sight();
            if let Some(taker) = &mut self.notes {
                taker.notes.at_end = names;
            }
        }
    }
}
