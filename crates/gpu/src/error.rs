//! [`Error`]: why a scene could not be drawn on the GPU.

use glisten_front::diagnostic::Diagnostic;
use std::fmt;
use std::time::Duration;

/// Why a scene could not be drawn.
#[derive(Clone, Debug)]
pub enum Error {
    /// There is no Vulkan adapter of the wanted kind.
    NoAdapter {
        /// Whether it must be a software adapter.
        software: bool,
        /// The names of the available adapters.
        available: Vec<String>,
    },
    /// No adapter has this name.
    UnknownAdapter {
        /// The requested name.
        name: String,
        /// The names of the available adapters.
        available: Vec<String>,
    },
    /// The adapter cannot do what the scene needs.
    Unsupported(String),
    /// A program of the scene cannot be emitted for the target.
    Emit(Vec<Diagnostic>),
    /// The runner or the driver rejects the scene; the message is wgpu's or the runner's own.
    Refused(String),
    /// A module of another translator cannot be run in place of the emitted one.
    Foreign(String),
    /// This machine lacks a program.
    Lacks(String),
    /// The device stopped working.
    Lost(String),
    /// The draw did not finish in time.
    Timeout(Duration),
}

impl Error {
    /// Whether the cause is this machine (exit code 3) rather than the scene.
    pub fn is_environment(&self) -> bool {
        match self {
            Self::NoAdapter { .. } | Self::UnknownAdapter { .. } | Self::Unsupported(_) | Self::Lacks(_) => true,
            Self::Emit(_) | Self::Refused(_) | Self::Foreign(_) | Self::Lost(_) | Self::Timeout(_) => false,
        }
    }

    /// The diagnostics of emission, if that failed.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Emit(diagnostics) => diagnostics,
            _ => &[],
        }
    }
}

fn list(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAdapter { software, available } => {
                let kind = if *software { "software " } else { "" };
                let found = match &available[..] {
                    [] => "there is none at all".to_owned(),
                    found => format!("there are {}", list(found)),
                };
                write!(
                    f,
                    "no Vulkan {kind}adapter was found: {found}\n\
                     help: install Mesa's driver (Debian, Ubuntu: `apt-get install mesa-vulkan-drivers`; \
                     Fedora: `dnf install mesa-vulkan-drivers`; Arch: `pacman -S vulkan-swrast`)"
                )?;
                f.write_str(if available.is_empty() {
                    ""
                } else {
                    ", or choose another adapter with `--adapter NAME`"
                })?;
                f.write_str("; `glisten render --backend cpu` draws without one")
            }
            Self::UnknownAdapter { name, available } if available.is_empty() => {
                write!(
                    f,
                    "no Vulkan adapter is called `{name}`: there is none at all\n\
                     help: install a Vulkan driver (Debian: `apt-get install mesa-vulkan-drivers`)"
                )
            }
            Self::UnknownAdapter { name, available } => {
                let found = list(available);
                write!(f, "no Vulkan adapter is called `{name}`\nhelp: there are {found}; a part of the name will do")
            }
            Self::Unsupported(what) => write!(f, "the adapter lacks {what}"),
            Self::Emit(diagnostics) => match diagnostics.first() {
                Some(first) => f.write_str(&first.message),
                None => f.write_str("a program of the scene cannot be emitted"),
            },
            Self::Foreign(message) | Self::Lacks(message) => f.write_str(message),
            Self::Refused(message) => write!(f, "the draw was refused: {message}"),
            Self::Lost(message) => write!(f, "the GPU device was lost: {message}"),
            Self::Timeout(limit) => {
                write!(
                    f,
                    "the draw did not end within {} s\nhelp: `--timeout SECONDS` waits longer",
                    limit.as_secs_f64()
                )
            }
        }
    }
}

impl std::error::Error for Error {}

impl From<glisten_plan::Error> for Error {
    fn from(error: glisten_plan::Error) -> Self {
        match error {
            glisten_plan::Error::Unsupported(what) => Self::Unsupported(what),
            glisten_plan::Error::Emit(diagnostics) => Self::Emit(diagnostics),
            glisten_plan::Error::Refused(message) => Self::Refused(message),
        }
    }
}
