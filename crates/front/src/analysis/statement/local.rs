//! Analyzes local variables (§4.2, §4.3).

use super::super::context::Analyzer;
use super::super::qualifiers::{DeclarationContext, Qualifiers};
use super::super::scope::Entry;
use super::super::state::ArrayKey;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{qualifiers, types};
use crate::hir::{
    ArraySize, Condition, ExprId, ExprKind, Local, LocalId, LocalKind, Stmt, StmtKind, Type, TypeId, Value, VarRef,
};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{Declarator, VariableDecl};

/// The effect of a declarator.
enum Declared {
    /// A local, unless it is in error, and its initializer.
    New(Option<LocalId>, Option<ExprId>),
    /// An array of before, with its size now; the assignment of its initializer.
    Again(Option<ExprId>),
}

impl Analyzer<'_> {
    /// `vec3 a = b, c;` inside a function.
    pub(in crate::analysis) fn local_variables(&mut self, declaration: &VariableDecl, out: &mut Vec<Stmt>) {
        let record = self.qualifiers(&declaration.qualifiers, DeclarationContext::Local);
        let base = self.declared_type(declaration);
        self.check_precision(record.precision, base, declaration.ty.span);
        if declaration.declarators.is_empty() {
            self.require_size(base, declaration.ty.span);
        }
        for declarator in &declaration.declarators {
            let kind = match self.local_variable(declarator, base, &record, declaration) {
                Declared::New(local, initializer) => local.map(|local| StmtKind::Local(local, initializer)),
                Declared::Again(assignment) => assignment.map(StmtKind::Expr),
            };
            out.extend(kind.map(|kind| Stmt { kind, span: declarator.name.span }));
        }
    }

    fn local_variable(
        &mut self,
        declarator: &Declarator,
        base: TypeId,
        record: &Qualifiers,
        declaration: &VariableDecl,
    ) -> Declared {
        let name = declarator.name;
        let good_name = self.check_name(name);
        self.note_precise(&declaration.qualifiers, name);
        let ty = self.arrays(base, &declarator.array, declarator.initializer.is_some());
        let ty = self.check_local_type(ty, record, declaration, declarator);
        let ty = if self.check_local_size(ty, name.span) { ty } else { TypeId::ERROR };
        let constant = record.constant.is_some();
        let declared = ty;
        let (ty, initializer, value) = self.local_initializer(declarator, ty, constant);
        // An array that its initializer sizes counts with that size.
        let fits = ty == declared || self.check_local_size(ty, name.span);
        let ty = if fits { ty } else { TypeId::ERROR };
        self.require_declared_size(declarator, ty);
        if !constant && let Some(known) = self.resizes_local(declarator, ty) {
            let assignment = initializer.map(|value| self.assign_local(known, ty, value, name.span));
            return Declared::Again(assignment);
        }
        // Of an unknown type, `retrun y;` may declare nothing.
        if base.is_error() && self.scopes.find_here(name.symbol).is_some() {
            return Declared::New(None, initializer);
        }
        let kind = if constant { LocalKind::Const } else { LocalKind::Variable };
        let local = Local { name: self.name(name).to_owned(), ty, kind, value, span: name.span };
        let id = self.add_local(local);
        let entry = match id {
            Some(id) if good_name && !ty.is_error() => Entry::Variable(VarRef::Local(id)),
            _ => Entry::Poison,
        };
        self.enter(name, entry);
        Declared::New(id.filter(|_| !ty.is_error()), initializer)
    }

    fn assign_local(&mut self, local: LocalId, ty: TypeId, value: ExprId, span: Span) -> ExprId {
        let place = self.shader.push(ExprKind::Var(VarRef::Local(local)), ty, span);
        self.shader.push(ExprKind::Assign(None, place, value), ty, span)
    }

    /// The array without a size in this scope that this declares again with one (§4.1.9).
    fn resizes_local(&mut self, declarator: &Declarator, ty: TypeId) -> Option<LocalId> {
        let found = self.scopes.find_here(declarator.name.symbol).map(|binding| binding.entry);
        let Some(Entry::Variable(VarRef::Local(id))) = found else { return None };
        let earlier = self.local(id).map(|local| local.ty)?;
        let (Type::Array(element, ArraySize::Unsized), Type::Array(other, size)) =
            (self.types.get(earlier), self.types.get(ty))
        else {
            return None;
        };
        if element != other {
            return None;
        }
        if let ArraySize::Sized(size) = size {
            self.check_resize(ArrayKey::Local(id), size, declarator.name.span);
        }
        if let Some(local) = self.current_function().and_then(|function| function.locals.get_mut(id.index())) {
            local.ty = ty;
        }
        Some(id)
    }

    fn check_local_type(
        &mut self,
        ty: TypeId,
        record: &Qualifiers,
        declaration: &VariableDecl,
        declarator: &Declarator,
    ) -> TypeId {
        if ty == TypeId::VOID {
            let span = declaration.ty.span;
            self.report(Diagnostic::new(&types::VOID_VALUE, span, "a variable cannot be `void`").here("not a value"));
            return TypeId::ERROR;
        }
        if self.types.contains_sampler(ty) {
            if !record.belongs_outside {
                let help = "declare it at global scope, as a `uniform`, or make it a parameter";
                self.report_sampler(ty, declaration.ty.span, declarator.name.span, help);
            }
            return TypeId::ERROR;
        }
        ty
    }

    fn local_initializer(
        &mut self,
        declarator: &Declarator,
        ty: TypeId,
        constant: bool,
    ) -> (TypeId, Option<ExprId>, Option<Value>) {
        let Some(initializer) = declarator.initializer else {
            if constant && !ty.is_error() {
                let name = self.name(declarator.name);
                self.report(
                    Diagnostic::new(
                        &qualifiers::CONST_WITHOUT_VALUE,
                        declarator.name.span,
                        format!("`{name}` needs a value"),
                    )
                    .here("declared `const` and never given one")
                    .help(format!("write `{name} = ...`")),
                );
                return (TypeId::ERROR, None, None);
            }
            return (ty, None, None);
        };
        let expr = self.initializer(initializer, ty);
        let (ty, expr) = self.fit_initializer(declarator, ty, expr);
        if self.ty(expr).is_error() {
            return (if constant { TypeId::ERROR } else { ty }, None, None);
        }
        self.require_array_value(expr, self.span(expr));
        if !constant {
            return (ty, Some(expr), None);
        }
        let value = self.evaluate(expr);
        let span = self.span(expr);
        if value.is_none() && !self.allows(Feature::DynamicConstants, span) {
            self.report(self.not_constant_value(expr, "the value of a constant"));
            return (TypeId::ERROR, None, None);
        }
        (ty, Some(expr), value)
    }

    /// `while (bool b = f())`: declares the variable again in each iteration.
    pub(super) fn condition_variable(&mut self, declaration: &VariableDecl) -> Condition {
        let record = self.qualifiers(&declaration.qualifiers, DeclarationContext::Local);
        let base = self.type_spec(&declaration.ty);
        let Some(declarator) = declaration.declarators.first() else {
            return Condition { local: None, expr: self.poison(declaration.ty.span) };
        };
        let Declared::New(local, initializer) = self.local_variable(declarator, base, &record, declaration) else {
            return Condition { local: None, expr: self.poison(declarator.name.span) };
        };
        let span = declarator.name.span;
        let expr = initializer.unwrap_or_else(|| self.poison(span));
        self.require_bool(expr, "the condition of a loop");
        Condition { local, expr }
    }
}
