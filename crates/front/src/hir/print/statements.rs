//! Prints statements. Every body has braces.

use super::Printer;
use crate::hir::{Case, CaseLabel, Condition, ExprId, LocalId, LocalKind, LoopKind, ScalarValue, Stmt, StmtKind, Type};

impl Printer<'_> {
    /// Prints the statements of a body, one level deeper.
    pub(super) fn body(&mut self, body: &[Stmt]) {
        self.indent += 1;
        for statement in body {
            self.statement(statement);
        }
        self.indent -= 1;
    }

    fn statement(&mut self, statement: &Stmt) {
        if !matches!(statement.kind, StmtKind::Block(_)) {
            self.above(statement.span);
        }
        self.bare_statement(statement);
        let simple =
            matches!(statement.kind, StmtKind::Expr(_) | StmtKind::Local(..) | StmtKind::Return(_) | StmtKind::Discard);
        if simple {
            self.behind(statement.span);
        }
    }

    fn bare_statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Expr(expr) => {
                let expr = self.expr(*expr);
                self.line(&format!("{expr};"));
            }
            StmtKind::Local(id, initializer) => {
                let declaration = self.declaration(*id, *initializer);
                self.line(&format!("{declaration};"));
            }
            StmtKind::Block(body) => self.block_statement(body),
            StmtKind::If { arms, otherwise } => self.chain(arms, otherwise),
            StmtKind::Switch { selector, cases } => self.switch(*selector, cases),
            StmtKind::Loop { kind, condition, step, body } => {
                self.loop_statement("", *kind, condition.as_ref(), *step, body)
            }
            StmtKind::Break => self.line("break;"),
            StmtKind::Continue => self.line("continue;"),
            StmtKind::Return(None) => self.line("return;"),
            StmtKind::Return(Some(value)) => {
                let value = self.expr(*value);
                self.line(&format!("return {value};"));
            }
            StmtKind::Discard => self.line("discard;"),
        }
    }

    /// `const float x = 1.0`
    fn declaration(&self, id: LocalId, initializer: Option<ExprId>) -> String {
        let Some(function) = self.function else { return String::new() };
        let local = self.shader.function(function).local(id);
        let constant = if local.kind == LocalKind::Const { "const " } else { "" };
        let precise = self.precise(local.span);
        let head = format!("{precise}{constant}{} {}", self.type_name(local.ty), self.names.local(function, id));
        match (initializer, &local.value) {
            (Some(expr), _) => format!("{head} = {}", self.argument(expr)),
            (None, Some(value)) if local.kind == LocalKind::Const => format!("{head} = {}", self.value(value)),
            (None, _) => head,
        }
    }

    /// Prints a block, or the `for` that it represents: declarations before a loop, with nothing after it.
    fn block_statement(&mut self, body: &[Stmt]) {
        if let Some((last, before)) = body.split_last()
            && let StmtKind::Loop { kind: LoopKind::For, condition, step, body } = &last.kind
            && let Some(initializer) = self.for_initializer(before)
        {
            self.loop_statement(&initializer, LoopKind::For, condition.as_ref(), *step, body);
            return;
        }
        self.line("{");
        self.body(body);
        self.line("}");
    }

    /// The part of a `for` before its first semicolon, if it can be written there.
    fn for_initializer(&self, before: &[Stmt]) -> Option<String> {
        match before {
            [] => Some(String::new()),
            [Stmt { kind: StmtKind::Expr(expr), .. }] => Some(self.expr(*expr)),
            _ => {
                let mut text = String::new();
                let mut first = None;
                for statement in before {
                    let StmtKind::Local(id, initializer) = statement.kind else { return None };
                    let local = self.shader.function(self.function?).local(id);
                    let precise = self.precise(local.span);
                    match first {
                        None => text.push_str(&self.declaration(id, initializer)),
                        Some(one) if one == (local.ty, local.kind, precise) => {
                            text.push_str(&format!(", {}", self.names.local(self.function?, id)));
                            if let Some(initializer) = initializer {
                                text.push_str(&format!(" = {}", self.argument(initializer)));
                            }
                        }
                        Some(_) => return None,
                    }
                    first = Some((local.ty, local.kind, precise));
                }
                Some(text)
            }
        }
    }

    fn chain(&mut self, arms: &[(ExprId, Vec<Stmt>)], otherwise: &[Stmt]) {
        for (index, (condition, body)) in arms.iter().enumerate() {
            let condition = self.expr(*condition);
            let word = if index == 0 { "if" } else { "} else if" };
            self.line(&format!("{word} ({condition}) {{"));
            self.body(body);
        }
        if !otherwise.is_empty() {
            self.line("} else {");
            self.body(otherwise);
        }
        self.line("}");
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) {
        let unsigned = self.types.get(self.shader.expr(selector).ty) == Type::Scalar(crate::hir::Scalar::Uint);
        let selector = self.expr(selector);
        self.line(&format!("switch ({selector}) {{"));
        let mut body_from = self.text.len();
        for case in cases {
            for label in &case.labels {
                let label = match *label {
                    CaseLabel::Default => "default:".to_owned(),
                    CaseLabel::Value(bits) => {
                        let value = if unsigned { ScalarValue::Uint(bits) } else { ScalarValue::Int(bits as i32) };
                        format!("case {}:", super::expressions::literal(value))
                    }
                };
                self.line(&label);
            }
            body_from = self.text.len();
            self.body(&case.body);
        }
        // A label at the end of a `switch` has a statement (§6.2).
        let is_comment = |line: &str| line.trim_start().starts_with("//") || line.trim().is_empty();
        if !cases.is_empty() && self.text.get(body_from..).is_some_and(|body| body.lines().all(is_comment)) {
            self.line("    break;");
        }
        self.line("}");
    }

    fn loop_statement(
        &mut self,
        initializer: &str,
        kind: LoopKind,
        condition: Option<&Condition>,
        step: Option<ExprId>,
        body: &[Stmt],
    ) {
        let condition = condition.map_or(String::new(), |condition| match condition.local {
            Some(local) => self.declaration(local, Some(condition.expr)),
            None => self.expr(condition.expr),
        });
        let step = step.map_or(String::new(), |step| format!(" {}", self.expr(step)));
        let gap = if condition.is_empty() { "" } else { " " };
        match kind {
            LoopKind::For => self.line(&format!("for ({initializer};{gap}{condition};{step}) {{")),
            LoopKind::While => self.line(&format!("while ({condition}) {{")),
            LoopKind::DoWhile => self.line("do {"),
        }
        self.body(body);
        match kind {
            LoopKind::For | LoopKind::While => self.line("}"),
            LoopKind::DoWhile => self.line(&format!("}} while ({condition});")),
        }
    }
}
