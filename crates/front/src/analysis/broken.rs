//! Analyzes what was understood of statements and declarations that have an error.
//!
//! *In:* a [`Fragment`]. *Out:* types of its variables, and notes of its names. *Holds:* it reports nothing, since the error has been
//! reported, and what the fragment lacks says nothing about the rest.

use super::context::Analyzer;
use super::scope::Entry;
use crate::hir::{Stmt, StmtKind};
use crate::source::Span;
use crate::syntax::ast::{self, ArrayDim, Fragment, Ident, QualifierKind, VariableDecl};

impl Analyzer<'_> {
    /// Analyzes without reporting anything.
    pub(super) fn quietly<R>(&mut self, work: impl FnOnce(&mut Self) -> R) -> R {
        let was_quiet = std::mem::replace(&mut self.is_quiet, true);
        let result = work(self);
        self.is_quiet = was_quiet;
        result
    }

    /// The fragment of a statement.
    pub(super) fn local_fragment(&mut self, fragment: &Fragment, span: Span, out: &mut Vec<Stmt>) {
        if let Some(body) = &mut self.body {
            body.returns |= fragment.variables.is_none();
        }
        if let Some(variables) = self.usable(fragment) {
            self.quietly(|this| this.local_variables(variables, out));
        }
        self.enter_broken(&fragment.names);
        if let Some(rest) = fragment.rest {
            let kind = StmtKind::Expr(self.expr(rest));
            out.push(Stmt { kind, span });
        }
    }

    /// The fragment of a global declaration.
    pub(super) fn global_fragment(&mut self, fragment: &Fragment, span: Span) {
        // Layouts concern other declarations, too.
        let has_layout = |variables: &VariableDecl| {
            variables.qualifiers.iter().any(|qualifier| matches!(qualifier.kind, QualifierKind::Layout(_)))
        };
        if let Some(variables) = self.usable(fragment).filter(|variables| !has_layout(variables)) {
            self.quietly(|this| this.global_variables(variables, span));
        }
        self.enter_broken(&fragment.names);
        if let Some(rest) = fragment.rest {
            self.expr(rest);
        }
    }

    /// The variables of a fragment, if all that their types need is there and none of them is declared yet.
    fn usable<'f>(&self, fragment: &'f Fragment) -> Option<&'f VariableDecl> {
        let variables = fragment.variables.as_ref()?;
        let lacks_size = |dims: &[ArrayDim]| dims.iter().any(|dim| dim.size.is_none());
        let is_usable = variables.declarators.iter().all(|declarator| {
            let sized_by_value = lacks_size(&variables.ty.array) || lacks_size(&declarator.array);
            !(sized_by_value && declarator.initializer.is_none()) && self.is_new(declarator.name)
        });
        (is_usable && !matches!(variables.ty.base, ast::TypeBase::Error)).then_some(variables)
    }

    fn is_new(&self, name: Ident) -> bool {
        !self.name(name).starts_with("gl_") && self.scopes.find_here(name.symbol).is_none()
    }

    /// Enters the names of a broken declaration as poison, so that their uses raise no more messages.
    pub(super) fn enter_broken(&mut self, names: &[Ident]) {
        for name in names {
            if self.scopes.find_here(name.symbol).is_none() {
                self.scopes.enter(name.symbol, Entry::Poison, name.span);
                self.note_entry(name.span, Entry::Poison);
            }
        }
    }
}
