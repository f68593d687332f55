//! [`Observer`]: sees the results of a machine as [`Event`]s.

use super::Mask;
use super::inst::{Composite, Float2, Inst};
use crate::domain::{Domain, Source};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use std::fmt::Debug;

/// A scalar in all lanes: one number per lane, or one for all.
pub type Values<'a, T> = Source<'a, T>;

/// The position of a piece of a run among all pieces of a drawing, regardless of the thread.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Order {
    /// The draw of the scene.
    pub draw: usize,
    /// The first instance of the group.
    pub instance: u32,
    /// The kind of piece.
    pub piece: Piece,
    /// The batch of vertices, or the bin of the framebuffer.
    pub part: usize,
}

/// A unit of work of a machine, in the order of a drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Piece {
    /// The computations that are the same for all vertices.
    #[default]
    SameForVertices,
    /// The computations that are the same for all fragments.
    SameForFragments,
    /// A batch of vertices.
    Vertices,
    /// The fragments of a bin.
    Fragments,
}

impl Piece {
    /// The stage to which it belongs.
    pub fn stage(self) -> Stage {
        match self {
            Self::SameForVertices | Self::Vertices => Stage::Vertex,
            Self::SameForFragments | Self::Fragments => Stage::Fragment,
        }
    }
}

/// The kind of an operation that yields floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `a + b`, `a - b`
    Sum,
    /// `dot(a, b)`; the operands are those of `a`, then those of `b`.
    Dot,
    /// A discontinuous function: `floor`, `sign`, `step`, `fract`, `mod` and similar ones.
    Jump,
    /// A difference between neighboring lanes.
    Derivative,
    /// Texels of a texture, from coordinates.
    Texture,
    /// Anything else.
    Other,
}

/// The content of an event.
#[derive(Debug)]
pub enum What<'a, D: Domain> {
    /// Floats were computed.
    Floats {
        /// The kind of operation.
        kind: Kind,
        /// The operands. Those of conversions from integers are not shown.
        operands: &'a [Values<'a, D::Float>],
        /// One result, or the components of a vector or matrix.
        results: &'a [Values<'a, D::Float>],
    },
    /// A comparison of floats, a classification or a conversion to an integer was made.
    Answer(Values<'a, D::Int>),
    /// Lanes diverge, or one of two values is selected, by this condition or selector.
    Choice(Values<'a, D::Int>),
    /// The stage has ended with this value in an output.
    Output(Values<'a, D::Float>),
}

/// An event in some lanes.
#[derive(Debug)]
pub struct Event<'a, D: Domain> {
    /// The expression or statement.
    pub span: Span,
    /// The lanes.
    pub lanes: Mask,
    /// The content.
    pub what: What<'a, D>,
}

/// Receives the events of a machine.
pub trait Observer<D: Domain>: Send + Debug {
    /// Receives an event.
    fn see(&mut self, event: &Event<'_, D>);
    /// Called at the end of a piece of the drawing.
    fn finish(self: Box<Self>, order: Order);
}

impl Kind {
    /// Returns `None` for instructions that do not compute floats.
    pub(super) fn of(inst: &Inst) -> Option<Self> {
        Some(match inst {
            Inst::Float2 { op: Float2::Add | Float2::Sub, .. } => Self::Sum,
            Inst::Composite { op: Composite::Dot, .. } => Self::Dot,
            Inst::Float1 { op, .. } if op.jumps() => Self::Jump,
            Inst::Float2 { op, .. } if op.jumps() => Self::Jump,
            Inst::Derivative { .. } => Self::Derivative,
            Inst::Float1 { .. }
            | Inst::Float2 { .. }
            | Inst::Float3 { .. }
            | Inst::MulAdd { .. }
            | Inst::SumOfProducts { .. }
            | Inst::IntToFloat { .. }
            | Inst::Composite { .. } => Self::Other,
            _ => return None,
        })
    }
}
