//! Statements (§6).

use super::{ExprId, LocalId};
use crate::source::Span;

/// A statement.
#[derive(Clone, Debug)]
pub struct Stmt {
    /// Which.
    pub kind: StmtKind,
    /// Where.
    pub span: Span,
}

/// What a statement is.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "fields of variants say what they are")]
pub enum StmtKind {
    /// An expression for its effects.
    Expr(ExprId),
    /// A local comes to life, with its initializer or undefined.
    Local(LocalId, Option<ExprId>),
    /// `{ .. }`
    Block(Vec<Stmt>),
    /// The first arm whose condition holds, or `otherwise`. A chain of `else if` of any length is one statement.
    If { arms: Vec<(ExprId, Vec<Stmt>)>, otherwise: Vec<Stmt> },
    /// `switch`: each case runs into the next unless it ends in `break`.
    Switch { selector: ExprId, cases: Vec<Case> },
    /// `for`, `while`, `do`. A `for`'s initializer stands before it in a [`StmtKind::Block`] that holds both.
    Loop { kind: LoopKind, condition: Option<Condition>, step: Option<ExprId>, body: Vec<Stmt> },
    /// Leaves the innermost loop or switch.
    Break,
    /// On to the step and condition of the innermost loop.
    Continue,
    /// Leaves the function.
    Return(Option<ExprId>),
    /// Ends the fragment.
    Discard,
}

/// Cases of a switch that share a body.
#[derive(Clone, Debug)]
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

/// Whether the condition stands before or behind the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoopKind {
    /// `for`
    For,
    /// `while`
    While,
    /// `do`: the condition is evaluated after the body.
    DoWhile,
}

/// The condition of a loop.
#[derive(Clone, Debug)]
pub struct Condition {
    /// `while (bool b = ..)`: the local that takes the value in each round.
    pub local: Option<LocalId>,
    /// The `bool`.
    pub expr: ExprId,
}
