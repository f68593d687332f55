//! Typed statements (§6).

use super::{ExprId, LocalId};
use crate::source::Span;

/// A statement.
#[derive(Clone, Debug, Hash)]
pub struct Stmt {
    /// The kind.
    pub kind: StmtKind,
    /// The span.
    pub span: Span,
}

/// The kinds of statements.
#[derive(Clone, Debug, Hash)]
#[expect(missing_docs, reason = "fields of variants say what they are")]
pub enum StmtKind {
    /// An expression, evaluated for its effects.
    Expr(ExprId),
    /// The start of a local's lifetime, with its initializer or with an undefined value.
    Local(LocalId, Option<ExprId>),
    /// `{ .. }`
    Block(Vec<Stmt>),
    /// `if`: runs the first arm whose condition holds, or `otherwise`. A chain of `else if` of any length is one
    /// statement.
    If { arms: Vec<(ExprId, Vec<Stmt>)>, otherwise: Vec<Stmt> },
    /// `switch`: each case falls through to the next unless it ends in `break`.
    Switch { selector: ExprId, cases: Vec<Case> },
    /// `for`, `while`, `do`. The initializer of a `for` precedes the loop in a [`StmtKind::Block`] that contains
    /// both.
    Loop { kind: LoopKind, condition: Option<Condition>, step: Option<ExprId>, body: Vec<Stmt> },
    /// Leaves the innermost loop or switch.
    Break,
    /// Continues with the step and the condition of the innermost loop.
    Continue,
    /// Returns from the function.
    Return(Option<ExprId>),
    /// Discards the fragment.
    Discard,
}

/// The labels of a switch that share a body, and the body.
#[derive(Clone, Debug, Hash)]
pub struct Case {
    /// One or more labels.
    pub labels: Vec<CaseLabel>,
    /// The body.
    pub body: Vec<Stmt>,
}

/// A label.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CaseLabel {
    /// The bits of an `int` or `uint` constant.
    Value(u32),
    /// `default`
    Default,
}

/// The form of a loop, which says whether the condition comes before or after the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LoopKind {
    /// `for`
    For,
    /// `while`
    While,
    /// `do`: the condition is evaluated after the body.
    DoWhile,
}

/// The condition of a loop.
#[derive(Clone, Debug, Hash)]
pub struct Condition {
    /// `while (bool b = ..)`: the local that takes the value in each iteration.
    pub local: Option<LocalId>,
    /// The `bool`.
    pub expr: ExprId,
}
