//! Declares structs (§4.1.8).

use super::super::context::Analyzer;
use super::super::qualifiers::DeclarationContext;
use super::super::scope::Entry;
use super::super::state::NoteRole;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{general, names, types};
use crate::hir::{ArraySize, Member, StructType, Type, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{Declarator, Ident, MemberDecl, StructSpec, TypeBase};
use crate::syntax::token::Symbol;
use rustc_hash::FxHashMap;

/// The members of a struct so far, with their indices by name.
#[derive(Default)]
pub(super) struct MemberList {
    members: Vec<Member>,
    indices: FxHashMap<Symbol, u32>,
}

impl MemberList {
    /// The members, in order.
    pub(super) fn list(&self) -> &[Member] {
        &self.members
    }

    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.members.is_empty()
    }
}

/// Up to this many members are searched one by one.
const FEW_MEMBERS: usize = 16;

/// How deep structs may nest; all traversals of types recurse along them.
const MAX_DEPTH: u32 = 64;

impl Analyzer<'_> {
    /// `struct S { .. }`: the type, entered under its name.
    pub(in crate::analysis) fn structure(&mut self, spec: &StructSpec, span: Span) -> TypeId {
        let name = spec.name.map_or("", |name| self.ast.name(name));
        let declared = spec.name.map_or(span, |name| name.span);
        if spec.name.is_none() {
            self.require(Feature::NamelessStructs, span);
        }
        let good_name = spec.name.is_none_or(|name| self.check_name(name));
        let (mut members, mut precisions) = (MemberList::default(), Vec::new());
        for row in &spec.members {
            let record = self.qualifiers(&row.qualifiers, DeclarationContext::StructMember);
            let base = self.member_base(row);
            self.check_precision(record.precision, base, row.ty.span);
            for declarator in &row.declarators {
                self.note_precise(&row.qualifiers, declarator.name);
                let ty = self.member_type(declarator, base, row);
                let member = Member::plain(self.name(declarator.name), ty, declarator.name.span);
                precisions.push(self.precision_of(record.precision, ty));
                self.add_member(&mut members, declarator.name, member);
            }
        }
        if members.is_empty() {
            self.report(Diagnostic::new(&types::STRUCT, declared, "a struct must have a member").here("empty"));
        }
        let ty = self.add_structure(name, members, false, declared);
        self.note_members(ty, &spec.members);
        if let (Type::Struct(id), true) = (self.types.get(ty), self.ast.version.is_es()) {
            self.declared.add_precisions(id, precisions);
        }
        if let Some(name) = spec.name {
            if self.scopes.is_global() {
                self.check_builtin_scope(name);
            }
            let good_name = good_name && self.check_block_name(name);
            self.enter(name, if good_name { Entry::Struct(ty) } else { Entry::Poison });
        }
        ty
    }

    /// Notes the names of the members of a struct or a block.
    pub(super) fn note_members(&mut self, ty: TypeId, rows: &[MemberDecl]) {
        if self.notes.is_none() {
            return;
        }
        let Type::Struct(id) = self.types.get(ty) else { return };
        for declarator in rows.iter().flat_map(|row| &row.declarators) {
            if let Some(index) = self.member_index(id, declarator.name) {
                self.note_member(declarator.name.span, id, index, NoteRole::Declares);
            }
        }
    }

    fn member_base(&mut self, row: &MemberDecl) -> TypeId {
        if let TypeBase::Struct(inner) = &row.ty.base {
            let at = inner.name.map_or(row.ty.span, |name| name.span);
            self.report(
                Diagnostic::new(&types::STRUCT, at, "a struct cannot be declared inside a struct or block")
                    .here("declare it before"),
            );
            return TypeId::ERROR;
        }
        if row.declarators.is_empty() {
            self.report(
                Diagnostic::new(&types::STRUCT, row.span, "a member needs a name").here("a type without a name"),
            );
        }
        self.type_spec(&row.ty)
    }

    /// The type of a member, which must have a size and must not be `void`.
    fn member_type(&mut self, declarator: &Declarator, base: TypeId, row: &MemberDecl) -> TypeId {
        self.no_member_initializer(declarator);
        let ty = self.with_array(base, &declarator.array);
        if ty == TypeId::VOID {
            self.report(
                Diagnostic::new(&types::VOID_VALUE, row.ty.span, "a member cannot be `void`").here("not a value"),
            );
            return TypeId::ERROR;
        }
        if let Type::Array(_, ArraySize::Unsized) = self.types.get(ty) {
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, declarator.name.span, "an array in a struct must have a size")
                    .here("no size given"),
            );
            return TypeId::ERROR;
        }
        ty
    }

    pub(super) fn no_member_initializer(&mut self, declarator: &Declarator) {
        if let Some(initializer) = declarator.initializer {
            let span = self.ast.expr(initializer).span;
            self.report(
                Diagnostic::new(&types::STRUCT, span, "a member cannot have an initializer")
                    .here("remove it, and initialize the variable"),
            );
        }
    }

    /// Adds a member, unless its name is taken.
    pub(super) fn add_member(&mut self, list: &mut MemberList, name: Ident, member: Member) {
        self.check_name(name);
        let index = list.members.len() as u32;
        let taken = *list.indices.entry(name.symbol).or_insert(index);
        if let Some(earlier) = list.members.get(taken as usize) {
            let spelling = &member.name;
            self.report(
                Diagnostic::new(&names::REDEFINED, name.span, format!("the member `{spelling}` is declared twice"))
                    .here("declared again here")
                    .label(earlier.span, "first declared here"),
            );
            return;
        }
        list.members.push(member);
    }

    /// Adds a struct or the type of a block; poison if it is too deep or too large.
    pub(super) fn add_structure(&mut self, name: &str, list: MemberList, is_block: bool, span: Span) -> TypeId {
        let many = list.members.len() > FEW_MEMBERS;
        let declaration = StructType { name: name.to_owned(), members: list.members, is_block, span };
        let ty = self.types.add_struct(declaration);
        if let (true, Type::Struct(id)) = (many, self.types.get(ty)) {
            self.declared.add_members(id, list.indices);
        }
        if self.types.summary(ty).depth > MAX_DEPTH {
            self.report(
                Diagnostic::new(&general::TOO_DEEP, span, format!("structs nest more than {MAX_DEPTH} levels deep"))
                    .here("one level too many"),
            );
            return TypeId::ERROR;
        }
        if self.check_size(ty, span) { ty } else { TypeId::ERROR }
    }
}
