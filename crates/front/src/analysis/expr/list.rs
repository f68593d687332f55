//! Analyzes initializer lists `{a, b}` (ARB_shading_language_420pack).

use super::super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{syntax, types};
use crate::hir::{ArraySize, ConstructKind, ExprId, ExprKind, Scalar, Type, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

impl Analyzer<'_> {
    /// The initializer of a variable of type `ty`: an expression or a list.
    pub(in crate::analysis) fn initializer(&mut self, id: ast::ExprId, ty: TypeId) -> ExprId {
        let expr = self.ast.expr(id);
        let ast::ExprKind::List(elements) = &expr.kind else { return self.expr(id) };
        if !self.allows(Feature::InitializerLists, expr.span) {
            let brace = Span { end: expr.span.start + 1, ..expr.span };
            let version = self.ast.version;
            let lacks_constructor =
                matches!(self.types.get(ty), Type::Array(..)) && !version.has(Feature::ArrayObjects);
            let message = match version.is_es() {
                true => format!("initializer lists are not in {}", version.name()),
                false => "initializer lists need GL_ARB_shading_language_420pack".to_owned(),
            };
            let help = match (lacks_constructor, version.is_es()) {
                (true, _) => "assign the elements one by one: this version has no constructors of arrays",
                (false, true) => "write a constructor",
                _ => "write a constructor, or `#extension GL_ARB_shading_language_420pack : require`",
            };
            let finding = Diagnostic::new(&syntax::LIST_WITHOUT_EXTENSION, brace, message);
            self.report(finding.here("a list begins here").help(help));
            return self.poison(expr.span);
        }
        self.list(elements, ty, expr.span)
    }

    /// Reports a list anywhere but after the `=` of a declaration.
    pub(super) fn misplaced_list(&mut self, _: &[ast::ExprId], span: Span) -> ExprId {
        self.report(
            Diagnostic::new(&types::LIST, span, "a list in braces only initializes a variable")
                .here("use a constructor here"),
        );
        self.poison(span)
    }

    fn list(&mut self, elements: &[ast::ExprId], ty: TypeId, span: Span) -> ExprId {
        if elements.is_empty() {
            // The grammar has "{ initializer_list }", which has at least one initializer (4.20 §9).
            let finding = Diagnostic::new(&types::LIST, span, "an initializer list is empty").here("no value");
            self.report(finding.help("write a value for each part, or leave the initializer out"));
            return self.poison(span);
        }
        match self.types.get(ty) {
            Type::Struct(id) => {
                let members: Vec<TypeId> = self.types.structure(id).members.iter().map(|member| member.ty).collect();
                let values = self.values(elements, &members);
                self.list_of(&values, ty, ConstructKind::Struct, &members, span)
            }
            Type::Array(element, size) => {
                let given = elements.len() as u32;
                let count = if let ArraySize::Sized(count) = size { count } else { given };
                let values = self.values(elements, &vec![element; elements.len()]);
                // The first element tells the sizes that an array of arrays leaves out (4.60 §4.1.9).
                let first = values.first().map_or(element, |first| self.ty(*first));
                let element = if self.leaves_sizes_to(element, first) { first } else { element };
                let ty = self.types.array(element, ArraySize::Sized(count));
                let wanted = vec![element; count as usize];
                self.list_of(&values, ty, ConstructKind::Array, &wanted, span)
            }
            Type::Vector(scalar, size) => {
                let wanted = vec![TypeId::vector(scalar, 1); usize::from(size)];
                let values = self.values(elements, &wanted);
                self.list_of(&values, ty, ConstructKind::Compose, &wanted, span)
            }
            Type::Matrix(columns, rows) => {
                let wanted = vec![TypeId::vector(Scalar::Float, rows); usize::from(columns)];
                let values = self.values(elements, &wanted);
                self.list_of(&values, ty, ConstructKind::Compose, &wanted, span)
            }
            Type::Error => self.poison(span),
            Type::Scalar(_) | Type::Void | Type::Sampler(_) => {
                let name = self.type_name(ty);
                self.report(
                    Diagnostic::new(&types::LIST, span, format!("a `{name}` cannot be initialized by a list"))
                        .here("remove the braces"),
                );
                self.poison(span)
            }
        }
    }

    /// The elements of a list. One that is a list, too, is of the type that is wanted in its place.
    fn values(&mut self, elements: &[ast::ExprId], wanted: &[TypeId]) -> Vec<ExprId> {
        let wanted = wanted.iter().copied().chain(std::iter::repeat(TypeId::ERROR));
        elements
            .iter()
            .zip(wanted)
            .map(|(&element, wanted)| match &self.ast.expr(element).kind {
                ast::ExprKind::List(inner) => self.list(inner, wanted, self.ast.expr(element).span),
                _ => self.expr(element),
            })
            .collect()
    }

    fn list_of(
        &mut self,
        elements: &[ExprId],
        ty: TypeId,
        kind: ConstructKind,
        wanted: &[TypeId],
        span: Span,
    ) -> ExprId {
        if elements.len() != wanted.len() {
            let (name, n_wanted, given) = (self.type_name(ty), wanted.len(), elements.len());
            self.report(
                Diagnostic::new(&types::LIST, span, format!("a `{name}` takes a list of {n_wanted}, not of {given}"))
                    .here(format!("{given} given")),
            );
            return self.poison(span);
        }
        let mut arguments = Vec::with_capacity(elements.len());
        for (&value, &wanted) in elements.iter().zip(wanted) {
            arguments.push(self.convert_or_report(value, wanted, "the element"));
        }
        if arguments.iter().any(|&argument| self.ty(argument).is_error()) {
            return self.poison(span);
        }
        self.push(ExprKind::Construct(kind, arguments), ty, span)
    }
}
