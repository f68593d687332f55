//! Analyzes `switch` (§6.2).

use super::super::context::Analyzer;
use crate::diagnostic::codes::statements;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::hir::{Case, CaseLabel, ExprId, ScalarValue, StmtKind, TypeId};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{self, SwitchItem};
use rustc_hash::FxHashMap;

impl Analyzer<'_> {
    pub(super) fn switch(&mut self, selector: ast::ExprId, body: &[SwitchItem]) -> StmtKind {
        let selector = self.expr(selector);
        self.check_selector(selector);
        if let Some(state) = self.body.as_mut() {
            state.switches += 1;
        }
        let cases = self.in_scope(|this| this.cases(this.ty(selector), body));
        if let Some(state) = self.body.as_mut() {
            state.switches -= 1;
        }
        StmtKind::Switch { selector, cases }
    }

    fn check_selector(&mut self, selector: ExprId) {
        let ty = self.ty(selector);
        if ty == TypeId::INT || ty == TypeId::UINT || ty.is_error() {
            return;
        }
        let (name, span) = (self.type_name(ty), self.span(selector));
        let help = self.conversion_help(ty, TypeId::INT, span);
        self.report(
            Diagnostic::new(&statements::SWITCH_TYPE, span, format!("`switch` needs an integer, not a `{name}`"))
                .here(format!("this is a `{name}`"))
                .maybe_help(help),
        );
    }

    /// Groups labels and statements into cases. A label after a statement begins a new case.
    fn cases(&mut self, selector: TypeId, body: &[SwitchItem]) -> Vec<Case> {
        let mut cases: Vec<Case> = Vec::new();
        let mut seen: FxHashMap<CaseLabel, Span> = FxHashMap::default();
        let mut last_label = None;
        let mut reported_first = false;
        for item in body {
            let label = match item {
                SwitchItem::Case(value, span) => {
                    last_label = Some(*span);
                    self.case_label(selector, *value).map(|label| (label, *span))
                }
                SwitchItem::Default(span) => {
                    last_label = Some(*span);
                    Some((CaseLabel::Default, *span))
                }
                SwitchItem::Stmt(stmt) => {
                    last_label = None;
                    if let Some(case) = cases.last_mut() {
                        let mut body = std::mem::take(&mut case.body);
                        self.statement(stmt, &mut body);
                        if let Some(case) = cases.last_mut() {
                            case.body = body;
                        }
                    } else if !reported_first {
                        reported_first = true;
                        self.report(
                            Diagnostic::new(&statements::BEFORE_CASE, stmt.span, "a statement before the first `case`")
                                .here("no label leads here"),
                        );
                    }
                    continue;
                }
            };
            if cases.last().is_none_or(|case| !case.body.is_empty()) {
                cases.push(Case { labels: Vec::new(), body: Vec::new() });
            }
            if let (Some((label, span)), Some(case)) = (label, cases.last_mut()) {
                case.labels.push(label);
                self.check_repeated(&mut seen, label, span);
            }
        }
        if let Some(span) = last_label {
            self.report(
                Diagnostic::new(&statements::EMPTY_CASE, span, "a label at the end of a `switch` without a statement")
                    .here("nothing follows")
                    .help(Advice::new(Applicability::Safe, "write `break;` after it", Place::After, " break;")),
            );
        }
        cases
    }

    fn case_label(&mut self, selector: TypeId, value: ast::ExprId) -> Option<CaseLabel> {
        let id = self.expr(value);
        let (ty, span) = (self.ty(id), self.span(id));
        if ty.is_error() {
            return None;
        }
        if ty != TypeId::INT && ty != TypeId::UINT {
            let name = self.type_name(ty);
            self.report(
                Diagnostic::new(&statements::SWITCH_TYPE, span, format!("a case is an integer, not a `{name}`"))
                    .here(format!("this is a `{name}`")),
            );
            return None;
        }
        let Some(value) = self.evaluate(id) else {
            self.report(self.not_constant(id, "a case"));
            return None;
        };
        // Since 4.00 (§6.2) the integers are compared as unsigned ones.
        let is_other = ty != selector && (selector == TypeId::INT || selector == TypeId::UINT);
        if is_other && !self.allows(Feature::ImplicitToUint, span) {
            let (name, wanted) = (self.type_name(ty), self.type_name(selector));
            self.report(
                Diagnostic::new(
                    &statements::SWITCH_TYPE,
                    span,
                    format!("a case of type `{name}` in a `switch` over a `{wanted}`"),
                )
                .here(format!("this is a `{name}`"))
                .help(Advice::new(
                    Applicability::Safe,
                    format!("write `{wanted}(...)` around it"),
                    Place::Around,
                    format!("{wanted}(...)"),
                )),
            );
            return None;
        }
        match value.scalars.first() {
            Some(&ScalarValue::Int(value)) => Some(CaseLabel::Value(value as u32)),
            Some(&ScalarValue::Uint(value)) => Some(CaseLabel::Value(value)),
            _ => None,
        }
    }

    fn check_repeated(&mut self, seen: &mut FxHashMap<CaseLabel, Span>, label: CaseLabel, span: Span) {
        if let Some(first) = seen.get(&label) {
            let what = if label == CaseLabel::Default { "`default` is" } else { "this case is" };
            self.report(
                Diagnostic::new(&statements::REPEATED_CASE, span, format!("{what} twice in one `switch`"))
                    .here("again here")
                    .label(*first, "first here"),
            );
            return;
        }
        seen.insert(label, span);
    }
}
