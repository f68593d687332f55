//! [`StageArg`]: a stage on the command line.

use clap::ValueEnum;
use glisten_front::hir::Stage;

/// A stage on the command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StageArg {
    /// Vertex shader.
    #[value(alias = "vert")]
    Vertex,
    /// Fragment shader.
    #[value(alias = "frag")]
    Fragment,
    /// Geometry shader.
    #[value(alias = "geom")]
    Geometry,
}

impl From<StageArg> for Stage {
    fn from(stage: StageArg) -> Self {
        match stage {
            StageArg::Vertex => Self::Vertex,
            StageArg::Fragment => Self::Fragment,
            StageArg::Geometry => Self::Geometry,
        }
    }
}
