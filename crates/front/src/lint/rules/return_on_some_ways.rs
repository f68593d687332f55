//! `missing-return`: a path through a function that ends without returning a value.
//!
//! The values of constant conditions are known; other conditions may be either. A function without any `return` is an
//! error, which this rule leaves alone.

use super::super::{Findings, Subject, running};
use crate::fold;
use crate::hir::{CaseLabel, ExprId, LoopKind, ScalarValue, Shader, Stmt, StmtKind, TypeId, Types};

pub(super) fn check(subject: &Subject<'_>, findings: &mut Findings<'_>) {
    let program = subject.program;
    for shader in &program.stages {
        let ways = Ways { shader, types: &program.types };
        for (function, body) in running(shader) {
            if function.ret == TypeId::VOID || !ways.through(body).next {
                continue;
            }
            let type_name = program.types.name(function.ret);
            let message = format!("`{}` may end without returning a `{type_name}`", function.name);
            let finding = findings.at(function.span, message).here("one path through it has no `return`");
            findings.push(finding.help("its value is undefined then: end it with a `return`"));
        }
    }
}

/// Where control may go after a statement, other than out of the function.
#[derive(Clone, Copy, Debug, Default)]
struct Flow {
    /// To the next statement.
    next: bool,
    /// Out of the loop or switch around the statement.
    breaks: bool,
    /// To the next iteration of the loop around the statement.
    continues: bool,
}

impl Flow {
    const NEXT: Self = Self { next: true, breaks: false, continues: false };

    fn or(self, other: Self) -> Self {
        Self {
            next: self.next || other.next,
            breaks: self.breaks || other.breaks,
            continues: self.continues || other.continues,
        }
    }

    /// The flow of two statements in sequence.
    fn then(self, other: Self) -> Self {
        Self { next: other.next, ..self.or(other) }
    }
}

struct Ways<'a> {
    shader: &'a Shader,
    types: &'a Types,
}

impl Ways<'_> {
    fn through(&self, body: &[Stmt]) -> Flow {
        let mut flow = Flow::NEXT;
        for statement in body {
            if !flow.next {
                break;
            }
            flow = flow.then(self.of(statement));
        }
        flow
    }

    /// The parser limits the nesting of statements.
    fn of(&self, statement: &Stmt) -> Flow {
        match &statement.kind {
            StmtKind::Expr(_) | StmtKind::Local(..) => Flow::NEXT,
            StmtKind::Block(body) => self.through(body),
            StmtKind::If { arms, otherwise } => {
                let mut flow = Flow::default();
                for (condition, arm) in arms {
                    match self.known(*condition) {
                        Some(false) => {}
                        Some(true) => return flow.or(self.through(arm)),
                        None => flow = flow.or(self.through(arm)),
                    }
                }
                flow.or(self.through(otherwise))
            }
            StmtKind::Switch { cases, .. } => {
                let is_whole = cases.iter().any(|case| case.labels.contains(&CaseLabel::Default));
                let mut flow = Flow { next: !is_whole, ..Flow::default() };
                let mut last = true;
                for case in cases {
                    let through = self.through(&case.body);
                    last = through.next;
                    flow = flow.or(Flow { next: false, ..through });
                }
                Flow { next: flow.next || flow.breaks || last, breaks: false, continues: flow.continues }
            }
            StmtKind::Loop { kind, condition, body, .. } => {
                let always = condition.as_ref().is_none_or(|condition| self.known(condition.expr) == Some(true));
                let inside = self.through(body);
                let asked = *kind != LoopKind::DoWhile || inside.next || inside.continues;
                Flow { next: inside.breaks || !always && asked, ..Flow::default() }
            }
            StmtKind::Break => Flow { breaks: true, ..Flow::default() },
            StmtKind::Continue => Flow { continues: true, ..Flow::default() },
            StmtKind::Return(_) | StmtKind::Discard => Flow::default(),
        }
    }

    fn known(&self, condition: ExprId) -> Option<bool> {
        let value = fold::evaluate(self.shader, self.types, condition, &|_| None)?;
        match value.scalars.first() {
            Some(ScalarValue::Bool(value)) => Some(*value),
            _ => None,
        }
    }
}
