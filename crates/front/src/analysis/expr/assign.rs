//! Analyzes assignments (§5.8), `++` and `--`.

use super::super::context::Analyzer;
use super::Purpose;
use crate::builtin::BuiltinVariable;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::types;
use crate::hir::{ArraySize, ExprId, ExprKind, IncDec, Scalar, Type, TypeId, VarRef};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

impl Analyzer<'_> {
    /// `a = b`, `a op= b`
    pub(super) fn assign(
        &mut self,
        operator: Option<ast::BinaryOp>,
        at: Span,
        target: ExprId,
        value: ExprId,
        span: Span,
    ) -> ExprId {
        let writable = self.require_lvalue(target, Purpose::Assign);
        let (ty, from) = (self.ty(target), self.ty(value));
        if !writable || ty.is_error() || from.is_error() {
            return self.poison(span);
        }
        match operator {
            None => self.assign_plainly(target, value, span),
            Some(operator) => self.assign_by(operator, at, target, value, span),
        }
    }

    fn assign_plainly(&mut self, target: ExprId, value: ExprId, span: Span) -> ExprId {
        let ty = self.ty(target);
        if self.assigns_clip_distances(target, value) {
            return self.push(ExprKind::Assign(None, target, value), ty, span);
        }
        if let Type::Array(_, ArraySize::Unsized) = self.types.get(ty) {
            let at = self.span(target);
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, at, "an array without a size cannot be assigned as a whole")
                    .here("its size is not known")
                    .help("declare it with a size"),
            );
            return self.poison(span);
        }
        if matches!(self.types.get(ty), Type::Array(..)) {
            self.require(Feature::ArrayObjects, self.span(target));
        }
        if self.types.is_struct_with_array(ty) {
            self.require_here(Feature::ArraysInValues, self.span(target));
        }
        let value = self.convert_or_report(value, ty, "the left side");
        if self.ty(value).is_error() {
            return self.poison(span);
        }
        self.push(ExprKind::Assign(None, target, value), ty, span)
    }

    /// Whether this is `gl_ClipDistance = gl_in[0].gl_ClipDistance` where one of both has no size yet, as passed on by many
    /// geometry shaders. Arrays without a size cannot be assigned (§4.1.9), but drivers take it, so it is a warning.
    fn assigns_clip_distances(&mut self, target: ExprId, value: ExprId) -> bool {
        if self.strict || !self.is_clip_distance(target) || !self.is_clip_distance(value) {
            return false;
        }
        let size = |analyzer: &Self, of| match analyzer.types.get(analyzer.ty(of)) {
            Type::Array(_, size) => Some(size),
            _ => None,
        };
        let (at, from) = (self.span(target), self.span(value));
        let known = match (size(self, target), size(self, value)) {
            (Some(ArraySize::Unsized), Some(ArraySize::Sized(known))) => Some((target, known, from)),
            (Some(ArraySize::Sized(known)), Some(ArraySize::Unsized)) => Some((value, known, at)),
            (Some(ArraySize::Unsized), Some(ArraySize::Unsized)) => None,
            _ => return false,
        };
        if let Some((open, known, at)) = known {
            self.note_array_index(open, known.saturating_sub(1), at);
        } else if let (Some(target), Some(value)) = (self.array_key(target), self.array_key(value)) {
            self.uses.note_assigned_array(target, value);
        }
        self.report(
            Diagnostic::new(
                &types::UNSIZED_CLIP_DISTANCES,
                at,
                "clip distances without a size are assigned as a whole",
            )
            .here("as many as the shader indexes by constants, or one")
            .help("declare it with a size: `out float gl_ClipDistance[2];`"),
        );
        true
    }

    /// Whether an expression is `gl_ClipDistance`, of this vertex or of one of `gl_in`.
    fn is_clip_distance(&self, id: ExprId) -> bool {
        match self.expr_at(id).kind {
            ExprKind::Var(VarRef::Global(global)) => {
                self.shader.global(global).builtin == Some(BuiltinVariable::ClipDistance)
            }
            ExprKind::Member(base, member) => match self.types.get(self.ty(base)) {
                Type::Struct(structure) => {
                    let member = self.types.structure(structure).members.get(member as usize);
                    member.is_some_and(|member| member.name == BuiltinVariable::ClipDistance.name())
                }
                _ => false,
            },
            _ => false,
        }
    }

    /// `a op= b` is `a = a op b`: both the operation and the assignment must be valid.
    fn assign_by(&mut self, operator: ast::BinaryOp, at: Span, target: ExprId, value: ExprId, span: Span) -> ExprId {
        let ty = self.ty(target);
        match self.typed_binary(operator, target, value) {
            Some(typed) if typed.ty == ty && typed.left == target => {
                self.push(ExprKind::Assign(Some(typed.operator), target, typed.right), ty, span)
            }
            Some(typed) => {
                let (result, wanted) = (self.type_name(typed.ty), self.type_name(ty));
                let (left, right) = (self.span(target), self.span(value));
                let right_name = self.type_name(self.ty(value));
                let spelling = operator.spelling();
                self.report(
                    Diagnostic::new(
                        &types::MISMATCH,
                        at,
                        format!("`{spelling}` makes a `{result}`, which does not go back into a `{wanted}`"),
                    )
                    .label(left, format!("this is a `{wanted}`"))
                    .label(right, format!("this is a `{right_name}`")),
                );
                self.poison(span)
            }
            None => {
                self.report_operands(&format!("{}=", operator.spelling()), at, target, value);
                self.poison(span)
            }
        }
    }

    /// `++a`, `a--`
    pub(super) fn inc_dec(&mut self, operator: IncDec, target: ExprId, span: Span) -> ExprId {
        let ty = self.ty(target);
        if !self.require_lvalue(target, Purpose::Change) || ty.is_error() {
            return self.poison(span);
        }
        if self.types.scalar_of(ty).is_none_or(|scalar| scalar == Scalar::Bool) {
            let (name, at) = (self.type_name(ty), self.span(target));
            self.report(
                Diagnostic::new(&types::OPERANDS, at, format!("`++` and `--` need numbers, not a `{name}`"))
                    .here(format!("this is a `{name}`")),
            );
            return self.poison(span);
        }
        self.push(ExprKind::IncDec(operator, target), ty, span)
    }

    /// Checks that an initializer or argument is a complete value: neither `void` nor an array of unknown size.
    pub(in crate::analysis) fn is_whole_value(&mut self, id: ExprId) -> bool {
        let (ty, span) = (self.ty(id), self.span(id));
        if ty == TypeId::VOID {
            self.report(
                Diagnostic::new(&types::VOID_VALUE, span, "a `void` has no value")
                    .here("this function returns nothing"),
            );
            return false;
        }
        if let Type::Array(_, ArraySize::Unsized) = self.types.get(ty) {
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, span, "an array without a size cannot be used as a whole")
                    .here("its size is not known here")
                    .help("declare it with a size"),
            );
            return false;
        }
        true
    }
}
