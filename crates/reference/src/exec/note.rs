//! [`Note`]: a value of the text, for an observer that follows single invocations.
//!
//! *In:* code of a form with notes, as it runs. *Out:* [`Noted`] values in the order in which they are computed.
//! *Holds:* notes change nothing. Lanes that do not execute an expression are not shown its value; while the other ways of
//! an undecided condition are explored, nothing is shown.

use super::Mask;
use super::code::Section;
use super::inst::List;
use super::machine::Machine;
use super::observe::{Fate, Invoked};
use crate::domain::{Domain, Source};
use glisten_front::hir::{Scalar, TypeId};
use glisten_front::source::Span;
use smallvec::SmallVec;
use std::sync::Arc;

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
    /// What it is.
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

impl<D: Domain> Machine<D> {
    /// Shows the scalars of a note.
    pub(super) fn note(&mut self, number: u32, section: &Section, [floats, ints]: [List; 2], mask: u64) {
        let lanes = mask & self.watched;
        if self.ways.exploring || lanes == 0 {
            return;
        }
        let inner = Arc::clone(&self.code.inner);
        let (Some(observer), Some(note)) = (&mut self.observer, inner.notes.get(number as usize)) else { return };
        let registers = &self.registers;
        let mut floats = section.list(floats).iter();
        let mut ints = section.list(ints).iter();
        let scalar = |scalar: &Option<Scalar>| {
            if *scalar == Some(Scalar::Float) {
                floats.next().map(|operand| NotedScalar::Float(registers.float(*operand)))
            } else {
                ints.next().map(|operand| NotedScalar::Int(registers.int(*operand)))
            }
        };
        let scalars = note.scalars.iter().filter_map(scalar).collect();
        observer.note(&Noted { note, number, lanes: Mask(lanes), scalars });
    }

    /// Lets the observer follow an invocation of the next run.
    pub(crate) fn announce(&mut self, lane: usize, invocation: &Invoked) {
        if let Some(observer) = &mut self.observer {
            observer.follows(lane, invocation);
        }
    }

    /// Tells the observer what became of an invocation of the last run.
    pub(crate) fn conclude(&mut self, lane: usize, fate: Fate) {
        if let Some(observer) = &mut self.observer {
            observer.ended(lane, fate);
        }
    }
}
