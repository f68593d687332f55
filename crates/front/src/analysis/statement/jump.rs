//! Analyzes jumps (§6.4): `return`, `break`, `continue`, `discard`.

use super::super::context::Analyzer;
use crate::diagnostic::codes::statements;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place, Severity};
use crate::hir::{ExprId, Stage, StmtKind, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

impl Analyzer<'_> {
    pub(super) fn continue_jump(&mut self, span: Span) -> StmtKind {
        if self.body.as_ref().is_none_or(|body| body.loops == 0) {
            self.report(
                Diagnostic::new(&statements::STRAY_JUMP, span, "`continue` outside of a loop")
                    .here("no loop around it"),
            );
            return StmtKind::Block(Vec::new());
        }
        StmtKind::Continue
    }

    pub(super) fn break_jump(&mut self, span: Span) -> StmtKind {
        if self.body.as_ref().is_none_or(|body| body.loops == 0 && body.switches == 0) {
            self.report(
                Diagnostic::new(&statements::STRAY_JUMP, span, "`break` outside of a loop or switch")
                    .here("nothing to leave")
                    .help("`return` leaves a function"),
            );
            return StmtKind::Block(Vec::new());
        }
        StmtKind::Break
    }

    pub(super) fn discard_jump(&mut self, span: Span) -> StmtKind {
        if self.stage != Stage::Fragment {
            let stage = self.stage.name();
            self.report(
                Diagnostic::new(&statements::DISCARD, span, format!("`discard` in a {stage} shader"))
                    .here("only a fragment can be discarded"),
            );
        }
        StmtKind::Discard
    }

    pub(super) fn return_jump(&mut self, value: Option<ast::ExprId>, span: Span) -> StmtKind {
        let value = value.map(|value| self.expr(value));
        if let Some(body) = &mut self.body {
            body.returns = true;
        }
        let Some((ret, name, declared)) =
            self.current_function().map(|function| (function.ret, function.name.clone(), function.span))
        else {
            return StmtKind::Return(value);
        };
        match value {
            None if ret == TypeId::VOID || ret.is_error() => StmtKind::Return(None),
            None => {
                let type_name = self.type_name(ret);
                self.report(
                    Diagnostic::new(&statements::RETURN, span, format!("`{name}` must return a `{type_name}`"))
                        .here("no value")
                        .label(declared, format!("declared to return a `{type_name}`")),
                );
                StmtKind::Return(None)
            }
            Some(value) => StmtKind::Return(Some(self.returned(value, ret, &name, declared))),
        }
    }

    /// Warns about a converted `return` value: §6.4 does not mention conversions; 420pack adds them, and every driver
    /// has always converted.
    fn report_conversion(&mut self, span: Span, from: TypeId, to: TypeId) {
        let (from, to) = (self.type_name(from), self.type_name(to));
        let mut finding = Diagnostic::new(
            &statements::RETURN_CONVERSION,
            span,
            format!("the returned `{from}` becomes a `{to}` by itself only since GLSL 4.20"),
        )
        .here(format!("this is a `{from}`"))
        .help(Advice::new(
            Applicability::Safe,
            format!("write `{to}(...)` around it"),
            Place::Around,
            format!("{to}(...)"),
        ));
        if self.strict {
            finding.severity = Severity::Error;
        }
        self.report(finding);
    }

    fn returned(&mut self, value: ExprId, ret: TypeId, name: &str, declared: Span) -> ExprId {
        let (ty, span) = (self.ty(value), self.span(value));
        if ret.is_error() || ty.is_error() {
            return value;
        }
        if ret == TypeId::VOID {
            self.report(
                Diagnostic::new(&statements::RETURN, span, format!("`{name}` returns nothing"))
                    .here("a value is returned here")
                    .label(declared, "declared `void`"),
            );
            return value;
        }
        if !self.is_whole_value(value) {
            return self.poison(span);
        }
        match self.convert(value, ret) {
            Some(converted) => {
                if converted != value && !self.allows(Feature::ReturnConversions, span) {
                    self.report_conversion(span, ty, ret);
                }
                converted
            }
            None => {
                let (from, to) = (self.type_name(ty), self.type_name(ret));
                let help = self.conversion_help(ty, ret, span);
                self.report(
                    Diagnostic::new(&statements::RETURN, span, format!("`{name}` returns a `{to}`, not a `{from}`"))
                        .here(format!("this is a `{from}`"))
                        .label(declared, format!("declared to return a `{to}`"))
                        .maybe_help(help),
                );
                self.poison(span)
            }
        }
    }
}
