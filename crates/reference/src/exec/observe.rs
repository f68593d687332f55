//! [`Observer`]: who sees what a machine computes, and the [`Event`]s that it sees.

use super::Mask;
use super::inst::{Composite, Float2, Inst};
use crate::domain::{Domain, Source};
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use std::fmt::Debug;

/// A scalar in all lanes: one number each, or one for all.
pub type Values<'a, T> = Source<'a, T>;

/// Where a piece of a run stands among all pieces of a drawing, whichever thread ran it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Order {
    /// The draw of the scene.
    pub draw: usize,
    /// The first instance of the group.
    pub instance: u32,
    /// What was run.
    pub piece: Piece,
    /// The batch of vertices, or the bin of the framebuffer.
    pub part: usize,
}

/// What a machine runs at once, in the order of a drawing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Piece {
    /// What is the same for all vertices.
    #[default]
    SameForVertices,
    /// What is the same for all fragments.
    SameForFragments,
    /// A batch of vertices.
    Vertices,
    /// The fragments of a bin.
    Fragments,
}

impl Piece {
    /// The stage that it counts with.
    pub fn stage(self) -> Stage {
        match self {
            Self::SameForVertices | Self::Vertices => Stage::Vertex,
            Self::SameForFragments | Self::Fragments => Stage::Fragment,
        }
    }
}

/// What kind of operation gave floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `a + b`, `a - b`
    Sum,
    /// `dot(a, b)`; the operands are those of `a`, then those of `b`.
    Dot,
    /// A function that jumps: `floor`, `sign`, `step`, `fract`, `mod` and their like.
    Jump,
    /// A difference of neighboring lanes.
    Derivative,
    /// A texture's texels, from coordinates.
    Texture,
    /// Anything else.
    Other,
}

/// What happened.
#[derive(Debug)]
pub enum What<'a, D: Domain> {
    /// Floats were computed.
    Floats {
        /// By what.
        kind: Kind,
        /// From these; of conversions from integers nothing is shown.
        operands: &'a [Values<'a, D::Float>],
        /// One, or the components of a vector or matrix.
        results: &'a [Values<'a, D::Float>],
    },
    /// A comparison of floats, a classification or a conversion to an integer was made.
    Answer(Values<'a, D::Int>),
    /// Lanes part, or one of two values is taken, by this condition or selector.
    Choice(Values<'a, D::Int>),
    /// The stage has ended with this in an output.
    Output(Values<'a, D::Float>),
}

/// Something that happened in some lanes.
#[derive(Debug)]
pub struct Event<'a, D: Domain> {
    /// The expression or statement.
    pub span: Span,
    /// The lanes.
    pub lanes: Mask,
    /// What.
    pub what: What<'a, D>,
}

/// Sees what a machine computes.
pub trait Observer<D: Domain>: Send + Debug {
    /// Something happened.
    fn see(&mut self, event: &Event<'_, D>);
    /// A piece of the drawing has ended.
    fn finish(self: Box<Self>, order: Order);
}

impl Kind {
    /// `None` for what computes no floats.
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
