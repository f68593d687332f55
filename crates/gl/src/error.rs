//! [`Error`]: why a scene could not be drawn by OpenGL.

use glisten_front::hir::Stage;
use std::fmt;

/// Why a scene could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// There is no EGL library, no display without a window, or no OpenGL context on it. The text says which.
    NoDriver(String),
    /// The driver is too old, or lacks what the scene needs.
    Unsupported(String),
    /// The driver's compiler rejects a stage.
    Compile {
        /// The program.
        program: String,
        /// The stage.
        stage: Stage,
        /// The compiler's log.
        log: String,
    },
    /// The driver's linker rejects a program.
    Link {
        /// The program.
        program: String,
        /// The linker's log.
        log: String,
    },
    /// The driver rejects the scene.
    Refused(String),
}

impl Error {
    /// Whether the cause is this machine (exit code 3) rather than the scene.
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
