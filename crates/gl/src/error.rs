//! [`Error`]: why there is no picture.

use glisten_front::hir::Stage;
use std::fmt;

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// No EGL library, no display without a window, or no context of OpenGL on it; why.
    NoDriver(String),
    /// The driver is too old, or lacks what the scene needs.
    Unsupported(String),
    /// The driver's compiler refuses a stage.
    Compile {
        /// The program.
        program: String,
        /// The stage.
        stage: Stage,
        /// What the compiler says.
        log: String,
    },
    /// The driver's linker refuses a program.
    Link {
        /// The program.
        program: String,
        /// What the linker says.
        log: String,
    },
    /// The scene asks for what the driver refuses.
    Refused(String),
}

impl Error {
    /// Whether this machine lacks something (exit code 3), rather than the scene being at fault.
    pub fn is_environment(&self) -> bool {
        match self {
            Self::NoDriver(_) | Self::Unsupported(_) => true,
            Self::Compile { .. } | Self::Link { .. } | Self::Refused(_) => false,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoDriver(why) => write!(
                f,
                "OpenGL cannot be reached without a window: {why}\n\
                 help: install Mesa's drivers (Debian, Ubuntu: `apt-get install libegl1 libgl1-mesa-dri`; \
                 Fedora: `dnf install mesa-libEGL mesa-dri-drivers`; Arch: `pacman -S mesa`), \
                 or draw with `--backend cpu`"
            ),
            Self::Unsupported(what) => write!(f, "the OpenGL driver lacks {what}"),
            Self::Compile { program, stage, log } => {
                write!(f, "the OpenGL driver refuses the {} stage of `{program}`:\n{}", stage.name(), log.trim())
            }
            Self::Link { program, log } => write!(f, "the OpenGL driver does not link `{program}`:\n{}", log.trim()),
            Self::Refused(what) => write!(f, "OpenGL refuses the draw: {what}"),
        }
    }
}

impl std::error::Error for Error {}
