//! [`LeftOut`]: what went, where it stood, and what decided it.

use crate::forward::Walked;
use crate::known::Known;
use crate::residual::Options;
use glisten_front::hir::{Shader, Stage};
use glisten_front::Program;

/// What something was.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Kind {
    Branch,
    Loop,
    Function,
    Statement,
    Varying,
    Attribute,
    Uniform,
    Block,
    Texture,
    Output,
}

impl Kind {
    /// `branch`, `loop` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Self::Branch => "branch",
            Self::Loop => "loop",
            Self::Function => "function",
            Self::Statement => "statement",
            Self::Varying => "varying",
            Self::Attribute => "attribute",
            Self::Uniform => "uniform",
            Self::Block => "block",
            Self::Texture => "texture",
            Self::Output => "output",
        }
    }
}

/// Something that was left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// What it was.
    pub what: Kind,
    /// Its name; of a branch its condition, of a statement its first line.
    pub name: String,
    /// The file that it stood in.
    pub file: String,
    /// The line, from 1.
    pub line: u32,
    /// What decided it.
    pub because: String,
}

/// What was left out of a program.
pub(crate) fn left_out(
    program: &Program,
    known: &Known,
    options: &Options<'_>,
    walked: &[(Stage, Walked)],
    shaders: &[Shader],
) -> Vec<LeftOut> {
    let _ = (program, known, options, walked, shaders);
    Vec::new()
}
