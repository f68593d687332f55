//! Analyzes statements (§6.2 to §6.4).
//!
//! A `for` becomes a block that contains its initializer and the loop, so that its variables live as long as the
//! block.

mod jump;
mod local;
mod switch;

use super::context::Analyzer;
use super::qualifiers::DeclarationContext;
use super::scope::Entry;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{qualifiers, statements};
use crate::hir::{Condition, ExprId, LoopKind, Stmt, StmtKind};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast;

/// How deep the statements of a shader nest.
pub(super) fn nesting(ast: &ast::Ast) -> u32 {
    let bodies = ast.declarations.iter().filter_map(|declaration| match &declaration.kind {
        ast::DeclarationKind::Function(_, body) => Some(body),
        _ => None,
    });
    bodies.map(nesting_of).max().unwrap_or(0)
}

/// Recurses, with small stack frames, as deep as the parser did.
fn nesting_of<'s>(body: impl IntoIterator<Item = &'s ast::Stmt>) -> u32 {
    body.into_iter().map(nesting_of_one).max().unwrap_or(0)
}

fn nesting_of_one(stmt: &ast::Stmt) -> u32 {
    use ast::StmtKind as S;
    let inner = match &stmt.kind {
        S::Block(body) => nesting_of(body),
        S::If { arms, otherwise } => nesting_of(arms.iter().map(|(_, body)| body).chain(otherwise.as_deref())),
        S::Switch { body, .. } => nesting_of(body.iter().filter_map(|item| match item {
            ast::SwitchItem::Stmt(stmt) => Some(stmt),
            ast::SwitchItem::Case(..) | ast::SwitchItem::Default(_) => None,
        })),
        S::For { body, .. } | S::While { body, .. } | S::DoWhile { body, .. } => nesting_of_one(body),
        _ => return 0,
    };
    inner.saturating_add(1)
}

impl Analyzer<'_> {
    /// Statements, in a scope that the caller has opened.
    pub(super) fn statements(&mut self, body: &[ast::Stmt]) -> Vec<Stmt> {
        let mut out = Vec::with_capacity(body.len());
        for stmt in body {
            self.statement(stmt, &mut out);
        }
        out
    }

    /// A statement as a body with its own scope.
    fn scoped(&mut self, stmt: &ast::Stmt) -> Vec<Stmt> {
        self.in_scope(|this| this.unscoped(stmt))
    }

    /// Runs `body` in a scope of its own, of names and of default precisions: a precision statement in a "compound statement, ..
    /// its effect stops at the end of the innermost statement it was declared in" (GLSL ES 3.00 §4.5.4).
    pub(super) fn in_scope<T>(&mut self, body: impl FnOnce(&mut Self) -> T) -> T {
        self.with_precisions(|this| {
            this.scopes.open();
            let out = body(this);
            this.scopes.close();
            out
        })
    }

    /// Runs `body`, whose precision statements end with it.
    pub(super) fn with_precisions<T>(&mut self, body: impl FnOnce(&mut Self) -> T) -> T {
        let before = self.precisions.defaults();
        let out = body(self);
        self.precisions.restore(before);
        out
    }

    /// A statement as a body in the current scope; its braces open none.
    fn unscoped(&mut self, stmt: &ast::Stmt) -> Vec<Stmt> {
        let mut out = Vec::new();
        match &stmt.kind {
            ast::StmtKind::Block(inner) => out = self.statements(inner),
            _ => self.statement(stmt, &mut out),
        }
        out
    }

    fn statement(&mut self, stmt: &ast::Stmt, out: &mut Vec<Stmt>) {
        use ast::StmtKind as S;
        let span = stmt.span;
        let kind = match &stmt.kind {
            S::Error => {
                if let Some(body) = &mut self.body {
                    body.returns = true;
                }
                return;
            }
            S::Broken(fragment) => return self.local_fragment(fragment, span, out),
            S::Empty => return,
            // A declaration of nothing, `S;`. Only the meaning of the name distinguishes it from an expression (§9).
            S::Expr(expr) if self.is_struct_name(*expr) => return,
            S::Expr(expr) => StmtKind::Expr(self.expr(*expr)),
            S::Variables(declaration) => return self.local_variables(declaration, out),
            S::Precision { qualifier, ty } => return self.precision(qualifier, ty),
            S::Requalify { qualifiers, names } => return self.requalify_local(qualifiers, names, span),
            S::Prototype(header) => return self.misplaced_prototype(header),
            S::Block(body) => StmtKind::Block(self.in_scope(|this| this.statements(body))),
            S::If { arms, otherwise } => self.selection(arms, otherwise.as_deref()),
            S::Switch { selector, body } => self.switch(*selector, body),
            S::For { init, condition, step, body } => self.for_loop(init, condition.as_ref(), *step, body, span),
            S::While { condition, body } => self.while_loop(condition, body),
            S::DoWhile { body, condition } => self.do_loop(body, *condition),
            S::Continue => self.continue_jump(span),
            S::Break => self.break_jump(span),
            S::Return(value) => self.return_jump(*value, span),
            S::Discard => self.discard_jump(span),
        };
        out.push(Stmt { kind, span });
    }

    fn is_struct_name(&self, expr: ast::ExprId) -> bool {
        let ast::ExprKind::Name(name) = self.ast.expr(expr).kind else { return false };
        self.scopes.find(name.symbol).is_some_and(|binding| matches!(binding.entry, Entry::Struct(_)))
    }

    fn selection(&mut self, arms: &[(ast::ExprId, ast::Stmt)], otherwise: Option<&ast::Stmt>) -> StmtKind {
        let arms = arms
            .iter()
            .map(|(condition, body)| (self.condition(*condition, "the condition of `if`"), self.scoped(body)))
            .collect();
        let otherwise = otherwise.map_or_else(Vec::new, |body| self.scoped(body));
        StmtKind::If { arms, otherwise }
    }

    fn condition(&mut self, id: ast::ExprId, what: &str) -> ExprId {
        let first = self.n_diagnostics();
        let expr = self.expr(id);
        if matches!(self.ast.expr(id).kind, ast::ExprKind::Assign(None, ..)) {
            self.help_with_assignment(first);
        }
        self.require_bool(expr, what);
        expr
    }

    fn for_loop(
        &mut self,
        init: &ast::Stmt,
        condition: Option<&ast::Condition>,
        step: Option<ast::ExprId>,
        body: &ast::Stmt,
        span: Span,
    ) -> StmtKind {
        StmtKind::Block(self.in_scope(|this| {
            let mut outer = Vec::new();
            this.statement(init, &mut outer);
            let condition = condition.map(|condition| this.loop_condition(condition));
            let step = step.map(|step| this.expr(step));
            let body = this.loop_body(body, false);
            outer.push(Stmt { kind: StmtKind::Loop { kind: LoopKind::For, condition, step, body }, span });
            outer
        }))
    }

    fn while_loop(&mut self, condition: &ast::Condition, body: &ast::Stmt) -> StmtKind {
        self.in_scope(|this| {
            let condition = Some(this.loop_condition(condition));
            let body = this.loop_body(body, false);
            StmtKind::Loop { kind: LoopKind::While, condition, step: None, body }
        })
    }

    fn do_loop(&mut self, body: &ast::Stmt, condition: ast::ExprId) -> StmtKind {
        let body = self.loop_body(body, true);
        let expr = self.condition(condition, "the condition of a loop");
        StmtKind::Loop { kind: LoopKind::DoWhile, condition: Some(Condition { local: None, expr }), step: None, body }
    }

    fn loop_condition(&mut self, condition: &ast::Condition) -> Condition {
        match condition {
            ast::Condition::Expr(expr) => {
                Condition { local: None, expr: self.condition(*expr, "the condition of a loop") }
            }
            ast::Condition::Declaration(declaration) => self.condition_variable(declaration),
        }
    }

    /// The body of `for` and `while` shares the scope of the loop's header (§4.2, §9).
    fn loop_body(&mut self, body: &ast::Stmt, own_scope: bool) -> Vec<Stmt> {
        // A `break` in the loop leaves the loop, even inside a `switch`.
        let switches = self.body.as_mut().map_or(0, |state| {
            state.loops += 1;
            std::mem::take(&mut state.switches)
        });
        let body = if own_scope { self.scoped(body) } else { self.unscoped(body) };
        if let Some(state) = self.body.as_mut() {
            state.loops -= 1;
            state.switches = switches;
        }
        body
    }

    /// A declaration without a type in a function: only `precise a;` may be there.
    fn requalify_local(&mut self, list: &[ast::Qualifier], names: &[ast::Ident], span: Span) {
        let is_precise = |one: &ast::Qualifier| one.kind == ast::QualifierKind::Precise;
        if !names.is_empty() && list.iter().all(is_precise) {
            self.qualifiers(list, DeclarationContext::Alone);
            return self.make_precise(names);
        }
        let what = if list.iter().any(|qualifier| qualifier.kind == ast::QualifierKind::Invariant) {
            "`invariant`"
        } else {
            "a declaration without a type"
        };
        self.report(
            Diagnostic::new(&qualifiers::MISPLACED, span, format!("{what} may only be at global scope"))
                .here("inside of a function"),
        );
    }

    /// A prototype inside a function, which GLSL 1.10 allows.
    fn misplaced_prototype(&mut self, header: &ast::FunctionHeader) {
        if !self.ast.version.has(Feature::GlobalPrototypes) {
            return self.prototype(header);
        }
        self.report(
            Diagnostic::new(
                &statements::NESTED_FUNCTION,
                header.span,
                "a function may only be declared at global scope",
            )
            .here("inside of a function"),
        );
    }
}
