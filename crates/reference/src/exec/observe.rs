//! [`Observer`]: sees the results of a machine as [`Event`]s.

use super::Mask;
use super::inst::{Composite, Float1, Float2, Float3, Inst};
use super::note::Noted;
use super::step::Step;
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
    /// The computations that are the same for all primitives of a geometry stage.
    SameForPrimitives,
    /// A batch of vertices.
    Vertices,
    /// A batch of primitives of a geometry stage.
    Primitives,
    /// The fragments of a bin.
    Fragments,
}

impl Piece {
    /// The stage to which it belongs.
    pub fn stage(self) -> Stage {
        match self {
            Self::SameForVertices | Self::Vertices => Stage::Vertex,
            Self::SameForPrimitives | Self::Primitives => Stage::Geometry,
            Self::SameForFragments | Self::Fragments => Stage::Fragment,
        }
    }
}

/// The kind of an operation that yields floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// `a + b`, `a - b`
    Sum,
    /// `a * b`
    Product,
    /// `a / b`
    Quotient,
    /// `dot(a, b)`; the operands are those of `a`, then those of `b`.
    Dot,
    /// `a0 b0 + a1 b1 + ...`; the operands are pairs.
    Pairs,
    /// `normalize(a)`
    Normalize,
    /// Another function of whole vectors or matrices.
    Vector,
    /// `pow`
    Power,
    /// `exp`, `exp2` and the hyperbolic functions that grow like them.
    Exponential,
    /// `sin`, `cos`, `tan`
    Angle,
    /// A function that is not defined everywhere: `sqrt`, inverse functions.
    Partial,
    /// `inversesqrt`
    InverseRoot,
    /// `log`, `log2`
    Logarithm,
    /// A discontinuous function whose result follows a comparison: `sign`, `step`.
    Step,
    /// A discontinuous function that rounds: `floor`, `fract`, `mod` and similar ones.
    Whole,
    /// `mix`, `smoothstep`: a formula.
    Blend,
    /// A difference between neighboring lanes.
    Derivative,
    /// Texels of a texture, from coordinates.
    Texture,
    /// `float(i)`
    Conversion,
    /// An operation that adds no more than a rounding: `abs`, `min`, a negation.
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
    Answer {
        /// Whether it is a conversion to an integer.
        converts: bool,
        /// Whether it compares for equality.
        equality: bool,
        /// The floats.
        operands: &'a [Values<'a, D::Float>],
        /// The answer.
        answer: Values<'a, D::Int>,
    },
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

/// An invocation that an observer may follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Invoked {
    /// Of the vertex stage: `gl_VertexID` and `gl_InstanceID`.
    Vertex {
        /// The index of the vertex.
        vertex: u32,
        /// The instance.
        instance: u32,
    },
    /// Of the fragment stage.
    Fragment {
        /// `gl_PrimitiveID`
        primitive: u32,
        /// `gl_FrontFacing`
        front: bool,
    },
}

/// The end of an invocation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fate {
    /// It ran to its end; a fragment was drawn.
    #[default]
    Done,
    /// The fragment was discarded.
    Discarded,
    /// The fragment failed the depth or the stencil test.
    Failed,
}

/// Receives the events of a machine.
pub trait Observer<D: Domain>: Send + Debug {
    /// Receives an event.
    fn see(&mut self, event: &Event<'_, D>);
    /// Counts a step in so many lanes; complete only in code of the counted form.
    fn count(&mut self, _step: Step, _lanes: u32) {}
    /// Receives a value of the text; only in code of a form with notes.
    fn note(&mut self, _noted: &Noted<'_, D>) {}
    /// Whether it follows this invocation, which is about to run in a lane.
    fn follows(&mut self, _lane: usize, _invocation: &Invoked) {}
    /// Receives the fate of the invocation in a lane.
    fn ended(&mut self, _lane: usize, _fate: Fate) {}
    /// Called at the end of a piece of the drawing.
    fn finish(self: Box<Self>, order: Order);
}

impl Kind {
    /// Whether the operation is discontinuous.
    pub fn jumps(self) -> bool {
        matches!(self, Self::Step | Self::Whole)
    }

    /// Returns `None` for instructions that do not compute floats.
    pub(super) fn of(inst: &Inst) -> Option<Self> {
        Some(match inst {
            Inst::Float1 { op, .. } => Self::of_unary(*op),
            Inst::Float2 { op, .. } => Self::of_binary(*op),
            Inst::Float3 { op, .. } => Self::of_ternary(*op),
            Inst::Composite { op: Composite::Dot, .. } => Self::Dot,
            Inst::Composite { op: Composite::Normalize, .. } => Self::Normalize,
            Inst::Composite { .. } => Self::Vector,
            Inst::MulAdd { .. } | Inst::SumOfProducts { .. } => Self::Pairs,
            Inst::Derivative { .. } => Self::Derivative,
            Inst::IntToFloat { .. } => Self::Conversion,
            _ => return None,
        })
    }

    fn of_unary(op: Float1) -> Self {
        match op {
            Float1::Sin | Float1::Cos | Float1::Tan => Self::Angle,
            Float1::Exp | Float1::Exp2 | Float1::Sinh | Float1::Cosh => Self::Exponential,
            Float1::Sqrt | Float1::Asin | Float1::Acos | Float1::Acosh | Float1::Atanh => Self::Partial,
            Float1::Inversesqrt => Self::InverseRoot,
            Float1::Log | Float1::Log2 => Self::Logarithm,
            Float1::Sign => Self::Step,
            op if op.jumps() => Self::Whole,
            _ => Self::Other,
        }
    }

    fn of_binary(op: Float2) -> Self {
        match op {
            Float2::Add | Float2::Sub => Self::Sum,
            Float2::Mul => Self::Product,
            Float2::Div => Self::Quotient,
            Float2::Pow => Self::Power,
            Float2::Step => Self::Step,
            op if op.jumps() => Self::Whole,
            _ => Self::Other,
        }
    }

    fn of_ternary(op: Float3) -> Self {
        match op {
            Float3::Mix | Float3::Smoothstep | Float3::Fma => Self::Blend,
            _ => Self::Other,
        }
    }
}
