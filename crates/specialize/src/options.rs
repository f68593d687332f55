//! [`Options`]: how a program is specialized.
//!
//! *In:* the choices of a host. *Out:* what the phases read of them.

use glisten_front::source::{SourceMap, Span};

/// The choices of a specialization.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options<'a> {
    /// The texts that the program was compiled from: comments are kept, and the account names files and lines.
    pub sources: Option<&'a SourceMap>,
    /// Allows algebra that changes rounding: the residual no longer draws the same bits, and what the original makes of
    /// infinities and NaN may differ.
    pub fast_math: bool,
    /// Lets what is affine in varyings move from the fragment stage to the vertex stage, which changes rounding, too.
    pub move_to_vertex: bool,
    /// How far the program is evaluated.
    pub extent: Extent,
    /// Loops that stay loops if they run more than once, by their places ([`Residual::written_out`](crate::Residual::written_out)).
    pub kept: &'a [Span],
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
