//! Analyzes assignments (§5.8), `++` and `--`.

use super::super::context::Analyzer;
use super::Purpose;
use crate::builtin::BuiltinVariable;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::types;
use crate::hir::{ArraySize, ExprId, ExprKind, IncDec, Scalar, ScalarValue, Type, TypeId, VarRef};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

/// As many as a driver has to have (`gl_MaxClipDistances`, §7.4).
const MOST_CLIP_DISTANCES: u32 = 8;
/// How deep an index of `gl_in` may be that is copied for each clip distance.
const DEEPEST_COPY: u32 = 16;

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
        if let Some(assigned) = self.assign_clip_distances(target, value, span) {
            return assigned;
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
            self.require_array_value(value, self.span(target));
        }
        if self.types.is_struct_with_array(ty) {
            self.require(Feature::ArraysInValues, self.span(target));
        }
        let value = self.convert_or_report(value, ty, "the left side");
        if self.ty(value).is_error() {
            return self.poison(span);
        }
        self.push(ExprKind::Assign(None, target, value), ty, span)
    }

    /// `gl_ClipDistance = gl_in[0].gl_ClipDistance` where one of the two has no size, as many geometry shaders write it: copied element by
    /// element. Arrays without a size cannot be assigned (§4.1.9), but drivers take it, so it is a warning.
    fn assign_clip_distances(&mut self, target: ExprId, value: ExprId, span: Span) -> Option<ExprId> {
        if self.strict || !self.is_clip_distance(target) || !self.is_clip_distance(value) {
            return None;
        }
        let size = |id: ExprId| match self.types.get(self.ty(id)) {
            Type::Array(_, ArraySize::Sized(size)) => Some(size),
            _ => None,
        };
        let sizes = [size(target), size(value)];
        if sizes.iter().all(Option::is_some) || !self.can_be_copied(value, DEEPEST_COPY) {
            return None;
        }
        let used = |id: ExprId| {
            self.array_key(id).and_then(|key| self.uses.largest_index(key)).map(|(index, _)| index.saturating_add(1))
        };
        let known = sizes.into_iter().flatten().next();
        let size = known.or_else(|| used(target).max(used(value))).unwrap_or(1).min(MOST_CLIP_DISTANCES);
        let at = self.span(target);
        self.report(
            Diagnostic::new(
                &types::UNSIZED_CLIP_DISTANCES,
                at,
                "clip distances without a size are assigned as a whole",
            )
            .here("as many as the shader has indexed by constants, or one")
            .help("declare both with a size"),
        );
        for (id, size_of) in [(target, sizes[0]), (value, sizes[1])] {
            if size_of.is_none() {
                self.note_array_index(id, size.saturating_sub(1), at);
            }
        }
        let mut all: Option<ExprId> = None;
        for number in 0..size {
            let [to, from] = [target, value].map(|id| {
                let array = self.copied(id);
                let index = self.push(ExprKind::Literal(ScalarValue::Int(number as i32)), TypeId::INT, span);
                self.push(ExprKind::Index(array, index), TypeId::FLOAT, span)
            });
            let one = self.push(ExprKind::Assign(None, to, from), TypeId::FLOAT, span);
            all = Some(all.map_or(one, |all| self.push(ExprKind::Comma(all, one), TypeId::FLOAT, span)));
        }
        all
    }

    /// Whether an expression has no effects, is made of what [`copied`](Self::copied) copies, and is not deeper than this.
    fn can_be_copied(&self, id: ExprId, depth: u32) -> bool {
        let kind = &self.expr_at(id).kind;
        let is_plain = matches!(
            kind,
            ExprKind::Var(_)
                | ExprKind::Literal(_)
                | ExprKind::Member(..)
                | ExprKind::Index(..)
                | ExprKind::Convert(_)
                | ExprKind::Binary(..)
        );
        is_plain && depth > 0 && kind.children().into_iter().all(|child| self.can_be_copied(child, depth - 1))
    }

    /// A copy of an expression.
    fn copied(&mut self, id: ExprId) -> ExprId {
        let (ty, span) = (self.ty(id), self.span(id));
        let kind = match self.expr_at(id).kind.clone() {
            ExprKind::Member(base, member) => ExprKind::Member(self.copied(base), member),
            ExprKind::Index(base, index) => ExprKind::Index(self.copied(base), self.copied(index)),
            ExprKind::Convert(inner) => ExprKind::Convert(self.copied(inner)),
            ExprKind::Binary(operator, a, b) => ExprKind::Binary(operator, self.copied(a), self.copied(b)),
            kind => kind,
        };
        self.push(kind, ty, span)
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
