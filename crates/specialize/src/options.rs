//! [`Options`]: how a program is specialized.
//!
//! *In:* the choices of a host. *Out:* what the phases read of them.

use glisten_front::source::{SourceMap, Span};

/// The choices of a specialization.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// The texts that the program was compiled from: comments are kept, and the account names files and lines.
    pub sources: Option<&'a SourceMap>,
    /// The numbers that the residual may take for granted, and the algebra that is allowed.
    pub math: Math,
    /// Lets what is affine in varyings move from the fragment stage to the vertex stage, which changes rounding, too.
    pub move_to_vertex: bool,
    /// How far the program is evaluated.
    pub extent: Extent,
    /// Loops that stay loops if they run more than once, by their places ([`Residual::written_out`](crate::Residual::written_out)).
    pub kept: &'a [Span],
}

/// The contract about numbers. Each allows what the ones before it allow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Math {
    /// The residual draws the same bits, whatever the inputs are.
    #[default]
    Exact,
    /// Every number that the original reads or computes is taken to be finite: where that holds, the residual draws the same bits.
    Finite,
    /// Algebra that changes rounding is allowed, and zeros have no sign.
    Fast,
}

/// How far a program is evaluated. What is written out is faster, and may be longer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Extent {
    /// Loops are written out, functions are cloned for each kind of call.
    #[default]
    All,
    /// Loops that run more than once stay loops.
    LoopsKept,
    /// Functions are not cloned, either.
    FunctionsKept,
    /// Nothing is evaluated: what reaches no output goes, as by [`optimize`](crate::optimize()).
    Nothing,
}

impl Extent {
    /// From the furthest to none.
    pub const ALL: [Self; 4] = [Self::All, Self::LoopsKept, Self::FunctionsKept, Self::Nothing];
}
