//! Analyzes constructors (§5.4) and brings them into the normal forms of [`ConstructKind`].

use super::super::context::Analyzer;
use crate::diagnostic::codes::types;
use crate::diagnostic::{Diagnostic, plural};
use crate::hir::{ArraySize, ConstructKind, ExprId, ExprKind, Scalar, StructId, Swizzle, Type, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{self, TypeSpec};

impl Analyzer<'_> {
    /// `vec4(a)`, `float[2](a, b)`, `S[](a, b)`
    pub(super) fn construct_spec(&mut self, spec: &TypeSpec, arguments: &[ast::ExprId], span: Span) -> ExprId {
        let ty = self.constructor_type(spec);
        self.construct(ty, arguments, spec.span, span)
    }

    /// A constructor of a type; `head` is the type's name.
    pub(super) fn construct(&mut self, ty: TypeId, arguments: &[ast::ExprId], head: Span, span: Span) -> ExprId {
        let arguments: Vec<ExprId> = arguments.iter().map(|&argument| self.expr(argument)).collect();
        if ty.is_error() || arguments.iter().any(|&argument| self.ty(argument).is_error()) {
            return self.poison(span);
        }
        for &argument in &arguments {
            if !self.is_whole_value(argument) {
                return self.poison(span);
            }
        }
        match self.types.get(ty) {
            Type::Scalar(scalar) => self.construct_scalar(ty, scalar, &arguments, head, span),
            Type::Vector(scalar, _) => self.construct_components(ty, scalar, arguments, head, span),
            Type::Matrix(..) => self.construct_components(ty, Scalar::Float, arguments, head, span),
            Type::Array(element, size) => self.construct_array((element, size), arguments, head, span),
            Type::Struct(id) => self.construct_struct((ty, id), arguments, head, span),
            Type::Error => self.poison(span),
            Type::Void | Type::Sampler(_) => {
                let name = self.type_name(ty);
                self.report(
                    Diagnostic::new(&types::CONSTRUCTOR, head, format!("`{name}` has no constructor"))
                        .here("no value of this type can be constructed"),
                );
                self.poison(span)
            }
        }
    }

    /// `float(a)`: takes the first component of its one argument.
    fn construct_scalar(&mut self, ty: TypeId, scalar: Scalar, arguments: &[ExprId], head: Span, span: Span) -> ExprId {
        let name = self.type_name(ty);
        let &[argument] = arguments else {
            let message = format!("`{name}` takes one argument, not {}", arguments.len());
            self.report(Diagnostic::new(&types::CONSTRUCTOR, self.past(arguments, 1, head), message));
            return self.poison(span);
        };
        if !self.is_numeric(argument, head) {
            return self.poison(span);
        }
        let first = self.first_component(argument);
        let converted = self.with_scalar(first, scalar);
        if converted != argument {
            // What is found about the value is about the whole call.
            if let Some(expr) = self.shader.exprs.get_mut(converted.index()) {
                expr.span = span;
            }
            return converted;
        }
        // `float(x)` of a float is `x`, but not an l-value.
        self.push(ExprKind::Convert(argument), ty, span)
    }

    fn first_component(&mut self, id: ExprId) -> ExprId {
        let span = self.span(id);
        match self.types.get(self.ty(id)) {
            Type::Vector(scalar, _) => {
                let swizzle = Swizzle { len: 1, components: [0; 4] };
                self.push(ExprKind::Swizzle(id, swizzle), TypeId::vector(scalar, 1), span)
            }
            Type::Matrix(_, rows) => {
                let zero = self.literal(crate::hir::ScalarValue::Int(0), span);
                let column = self.push(ExprKind::Index(id, zero), TypeId::vector(Scalar::Float, rows), span);
                self.first_component(column)
            }
            _ => id,
        }
    }

    /// Constructors of vectors and matrices.
    fn construct_components(
        &mut self,
        ty: TypeId,
        scalar: Scalar,
        arguments: Vec<ExprId>,
        head: Span,
        span: Span,
    ) -> ExprId {
        if !arguments.iter().all(|&argument| self.is_numeric(argument, head)) {
            return self.poison(span);
        }
        let is_matrix = matches!(self.types.get(ty), Type::Matrix(..));
        if let &[only] = arguments.as_slice() {
            match self.types.get(self.ty(only)) {
                Type::Scalar(_) => {
                    let kind = if is_matrix { ConstructKind::Diagonal } else { ConstructKind::Splat };
                    let only = self.with_scalar(only, scalar);
                    return self.push(ExprKind::Construct(kind, vec![only]), ty, span);
                }
                Type::Matrix(..) if is_matrix => {
                    self.require(Feature::MatrixFromMatrix, head);
                    return self.push(ExprKind::Construct(ConstructKind::Resize, vec![only]), ty, span);
                }
                _ => {}
            }
        }
        if !self.check_components(ty, &arguments, is_matrix, head) {
            return self.poison(span);
        }
        let arguments = arguments.into_iter().map(|argument| self.component_argument(argument, scalar)).collect();
        self.push(ExprKind::Construct(ConstructKind::Compose, arguments), ty, span)
    }

    /// An argument as components of the wanted scalar type. A matrix in a vector of integers contributes its columns.
    fn component_argument(&mut self, argument: ExprId, scalar: Scalar) -> ExprId {
        match self.types.get(self.ty(argument)) {
            Type::Matrix(columns, rows) if scalar != Scalar::Float => {
                let span = self.span(argument);
                // A vector has at most four components. `check_components` has made sure that a 2x2 matrix is the
                // only one that fits whole; the excess components of a larger one are not read.
                let floats = columns.saturating_mul(rows).min(4);
                let ty = TypeId::vector(Scalar::Float, floats);
                let kind = ExprKind::Construct(ConstructKind::Compose, vec![argument]);
                let vector = self.push(kind, ty, span);
                self.with_scalar(vector, scalar)
            }
            _ => self.with_scalar(argument, scalar),
        }
    }

    fn check_components(&mut self, ty: TypeId, arguments: &[ExprId], is_matrix: bool, head: Span) -> bool {
        let name = self.type_name(ty);
        let wanted = self.types.flat_len(ty);
        let mut have = 0;
        for (index, &argument) in arguments.iter().enumerate() {
            if is_matrix && matches!(self.types.get(self.ty(argument)), Type::Matrix(..)) {
                let span = self.span(argument);
                self.report(
                    Diagnostic::new(&types::CONSTRUCTOR, span, format!("a matrix among other arguments of `{name}`"))
                        .here("a matrix must be the only argument of a matrix constructor"),
                );
                return false;
            }
            if have >= wanted {
                let span = self.past(arguments, index, head);
                self.report(
                    Diagnostic::new(&types::CONSTRUCTOR, span, format!("too many arguments for `{name}`"))
                        .here("not used")
                        .label(head, format!("the {wanted} components are complete before it")),
                );
                return false;
            }
            have += self.types.flat_len(self.ty(argument));
        }
        if have < wanted {
            let components = if have == 1 { "component" } else { "components" };
            let message = format!("`{name}` needs {wanted} components, not {have}");
            self.report(Diagnostic::new(&types::CONSTRUCTOR, head, message).here(format!("{have} {components} given")));
            return false;
        }
        true
    }

    fn is_numeric(&mut self, argument: ExprId, head: Span) -> bool {
        let ty = self.ty(argument);
        if self.types.scalar_of(ty).is_some() {
            return true;
        }
        let (name, span) = (self.type_name(ty), self.span(argument));
        self.report(
            Diagnostic::new(&types::CONSTRUCTOR, span, format!("a `{name}` has no components to construct from"))
                .here(format!("this is a `{name}`"))
                .label(head, "for this constructor"),
        );
        false
    }

    fn construct_array(
        &mut self,
        (element, size): (TypeId, ArraySize),
        arguments: Vec<ExprId>,
        head: Span,
        span: Span,
    ) -> ExprId {
        self.require(Feature::ArrayObjects, head);
        let given = arguments.len() as u32;
        if let ArraySize::Sized(size) = size
            && size != given
        {
            let [elements, taken] = ["element", "argument"].map(|noun| plural(size, noun));
            let message = format!("an array of {elements} takes {taken}, not {given}");
            let at = self.past(&arguments, size as usize, head);
            self.report(Diagnostic::new(&types::CONSTRUCTOR, at, message).here(format!("{given} given")));
            return self.poison(span);
        }
        if arguments.is_empty() {
            self.report(
                Diagnostic::new(&types::CONSTRUCTOR, head, "an array of no elements").here("give its elements"),
            );
            return self.poison(span);
        }
        if self.types.contains_sampler(element) {
            let ty = self.types.array(element, size);
            self.report(without_constructor(&self.type_name(ty), head));
            return self.poison(span);
        }
        // The first argument tells the sizes that the element's brackets leave out.
        let first = arguments.first().map_or(element, |&first| self.ty(first));
        let element = if self.leaves_sizes_to(element, first) { first } else { element };
        let ty = self.types.array(element, ArraySize::Sized(given));
        let arguments: Vec<_> =
            arguments.into_iter().map(|argument| self.convert_or_report(argument, element, "the element")).collect();
        self.finish_aggregate(ConstructKind::Array, ty, arguments, span)
    }

    fn construct_struct(
        &mut self,
        (ty, id): (TypeId, StructId),
        arguments: Vec<ExprId>,
        head: Span,
        span: Span,
    ) -> ExprId {
        let members: Vec<(String, TypeId)> =
            self.types.structure(id).members.iter().map(|member| (member.name.clone(), member.ty)).collect();
        let (name, declared) = (self.type_name(ty), self.types.structure(id).span);
        if members.len() != arguments.len() {
            let taken = plural(members.len() as u32, "argument");
            let message = format!("`{name}` takes {taken}, not {}", arguments.len());
            let at = self.past(&arguments, members.len(), head);
            self.report(Diagnostic::new(&types::CONSTRUCTOR, at, message).label(declared, "declared here"));
            return self.poison(span);
        }
        if self.types.contains_sampler(ty) {
            let finding = without_constructor(&name, head).label(declared, "declared here");
            self.report(finding);
            return self.poison(span);
        }
        let arguments: Vec<_> = arguments
            .into_iter()
            .zip(members)
            .map(|(argument, (member, ty))| self.convert_or_report(argument, ty, &format!("the member `{member}`")))
            .collect();
        self.finish_aggregate(ConstructKind::Struct, ty, arguments, span)
    }

    /// An array or struct of converted arguments, unless one of them is in error.
    pub(super) fn finish_aggregate(
        &mut self,
        kind: ConstructKind,
        ty: TypeId,
        arguments: Vec<ExprId>,
        span: Span,
    ) -> ExprId {
        if arguments.iter().any(|&argument| self.ty(argument).is_error()) {
            return self.poison(span);
        }
        self.push(ExprKind::Construct(kind, arguments), ty, span)
    }

    /// The first excess argument, or the constructor's head if there are too few.
    fn past(&self, arguments: &[ExprId], index: usize, head: Span) -> Span {
        arguments.get(index).map_or(head, |&argument| self.span(argument))
    }
}

/// The finding for a constructor of something that holds a sampler (§4.1.7).
fn without_constructor(name: &str, head: Span) -> Diagnostic {
    Diagnostic::new(&types::CONSTRUCTOR, head, format!("`{name}` holds a sampler and has no constructor"))
}
