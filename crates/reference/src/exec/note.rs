//! [`Note`]: a value of the text, for an observer that follows single invocations.
//!
//! *In:* code of a form with notes, as it runs. *Out:* [`Noted`] values in the order in which they are computed.
//! *Holds:* notes change nothing. Lanes that do not execute an expression are not shown its value; while the other ways of
//! an undecided condition are explored, nothing is shown.

use super::Mask;
use crate::domain::{Domain, Source};
use glisten_front::hir::{Scalar, TypeId};
use glisten_front::source::Span;
use smallvec::SmallVec;

/// The kind of a [`Note`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum NoteKind {
    /// An input of the stage, before it runs.
    Input,
    /// An output of the stage, after it ran.
    Output,
    /// A variable, a member or an element was read.
    Read,
    /// An expression was computed.
    Value,
    /// A variable was declared with this value, is a parameter that has it, or was incremented or decremented to it.
    Local,
    /// A function was called; the values of its parameters follow as locals.
    Call,
    /// A function has returned this.
    Return,
    /// The condition of an `if`.
    If,
    /// The condition of a loop.
    Loop,
    /// The selector of a `switch`.
    Switch,
    /// `discard`
    Discard,
}

/// A place of the text.
#[derive(Clone, Debug)]
pub struct Note {
    /// Its kind.
    pub kind: NoteKind,
    /// The expression, the statement or the declaration.
    pub span: Span,
    /// The name of the variable or function; empty for an expression.
    pub name: String,
    /// The type of the value; `void` if there is none.
    pub ty: TypeId,
    /// The type of each scalar, in flat order; none of a sampler, whose scalar is the number of its slot.
    pub scalars: Vec<Option<Scalar>>,
}

/// A place of the text with its value in some lanes.
#[derive(Debug)]
pub struct Noted<'a, D: Domain> {
    /// The place.
    pub note: &'a Note,
    /// Its number among those of the stage.
    pub number: u32,
    /// The lanes.
    pub lanes: Mask,
    /// The scalars in flat order.
    pub scalars: SmallVec<[NotedScalar<'a, D>; 4]>,
}

/// A scalar of a value.
#[derive(Clone, Copy, Debug)]
pub enum NotedScalar<'a, D: Domain> {
    /// A `float`.
    Float(Source<'a, D::Float>),
    /// An `int`, the bits of a `uint`, or a `bool`.
    Int(Source<'a, D::Int>),
}
