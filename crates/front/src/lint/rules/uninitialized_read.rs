//! `uninitialized-read`: reads a local or an `out` parameter before anything can have been assigned to it.
//!
//! The traversal follows the text. An earlier assignment on any path counts, and the assignments in a loop count from
//! its first line on. So the rule errs on the side of silence.

use super::super::{Findings, Subject, running};
use crate::hir::written_by;
use crate::hir::{ExprId, ExprKind, Function, LocalId, LocalKind, ParamMode, Shader, Stmt, StmtKind, VarRef};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        for (function, body) in running(shader) {
            let assigned = function.locals.iter().enumerate().map(|(index, local)| {
                index < function.param_count && local.kind != LocalKind::Param(ParamMode::Out)
                    || local.kind == LocalKind::Const
            });
            let mut walk = Walk { shader, function, assigned: assigned.collect(), reads: Vec::new() };
            walk.body(body);
            for (id, read) in walk.reads {
                let local = function.local(id);
                let message = format!("`{}` is read before anything is assigned to it", local.name);
                let finding = findings.at(shader.expr(read).span, message).here("an undefined value");
                findings.push(finding.label(local.span, "declared here without a value"));
            }
        }
    }
}

struct Walk<'a> {
    shader: &'a Shader,
    function: &'a Function,
    assigned: Vec<bool>,
    reads: Vec<(LocalId, ExprId)>,
}

impl Walk<'_> {
    fn assign(&mut self, id: LocalId) {
        if let Some(assigned) = self.assigned.get_mut(id.index()) {
            *assigned = true;
        }
    }

    /// Reports the first read of a local.
    fn read(&mut self, id: LocalId, expr: ExprId) {
        if self.assigned.get(id.index()) == Some(&false) && !self.function.local(id).name.is_empty() {
            self.reads.push((id, expr));
            self.assign(id);
        }
    }

    /// Recurses into blocks, which nest at most as deep as the parser allows.
    fn body(&mut self, body: &[Stmt]) {
        for statement in body {
            self.statement(statement);
        }
    }

    fn statement(&mut self, statement: &Stmt) {
        match &statement.kind {
            StmtKind::Local(id, Some(initializer)) => {
                self.expr(*initializer);
                self.assign(*id);
            }
            StmtKind::Loop { condition, step, body, .. } => {
                self.assign_all(body);
                for expr in condition.iter().map(|condition| condition.expr).chain(*step) {
                    self.assign_in(expr);
                }
                if let Some(condition) = condition {
                    self.expr(condition.expr);
                    condition.local.into_iter().for_each(|id| self.assign(id));
                }
                self.body(body);
                step.iter().for_each(|step| self.expr(*step));
            }
            StmtKind::If { arms, otherwise } => {
                for (condition, body) in arms {
                    self.expr(*condition);
                    self.body(body);
                }
                self.body(otherwise);
            }
            kind => {
                for expr in kind.exprs() {
                    self.expr(expr);
                }
                for body in kind.bodies() {
                    self.body(body);
                }
            }
        }
    }

    /// Marks everything that a loop's body assigns as assigned.
    fn assign_all(&mut self, body: &[Stmt]) {
        let shader = self.shader;
        shader.visit_statements(body, &mut |statement| {
            if let StmtKind::Local(id, Some(_)) = statement.kind {
                self.assign(id);
            }
            for expr in statement.kind.exprs() {
                self.assign_in(expr);
            }
        });
    }

    fn assign_in(&mut self, root: ExprId) {
        let shader = self.shader;
        shader.visit_expr(root, &mut |expr| {
            written_by(shader, expr, &mut |target| {
                if let Some(VarRef::Local(id)) = shader.root_variable(target) {
                    self.assign(id);
                }
            });
        });
    }

    /// Handles the reads in evaluation order, then the writes.
    fn expr(&mut self, id: ExprId) {
        let shader = self.shader;
        match &shader.expr(id).kind {
            ExprKind::Var(VarRef::Local(local)) => self.read(*local, id),
            ExprKind::Assign(None, target, value) => {
                self.indices(*target);
                self.expr(*value);
                self.assign_in(id);
            }
            ExprKind::Call(function, arguments) => {
                let function = shader.function(*function);
                for (index, &argument) in arguments.iter().enumerate() {
                    if function.param_mode(index) == ParamMode::Out {
                        self.indices(argument)
                    } else {
                        self.expr(argument)
                    }
                }
                self.assign_in(id);
            }
            ExprKind::BuiltinCall(function, arguments) if function.written_argument().is_some() => {
                for (index, &argument) in arguments.iter().enumerate() {
                    if function.written_argument() == Some(index) {
                        self.indices(argument)
                    } else {
                        self.expr(argument)
                    }
                }
                self.assign_in(id);
            }
            kind => {
                for child in kind.children() {
                    self.expr(child);
                }
            }
        }
    }

    /// The reads of an l-value that is written: its indices.
    fn indices(&mut self, mut target: ExprId) {
        loop {
            match self.shader.expr(target).kind {
                ExprKind::Index(base, index) => {
                    self.expr(index);
                    target = base;
                }
                ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => target = base,
                _ => return,
            }
        }
    }
}
