//! How a command ends: exit codes, and failures that are not diagnostics of a source.

use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::{general, preprocess, scenes};
use std::process::ExitCode;

/// The exit codes, from the best to the worst. The worst one that applies is returned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Exit {
    /// 0: success, nothing wrong found.
    #[default]
    Ok,
    /// 1: an input has errors, or a check did not hold.
    Content,
    /// 2: wrong usage; or a file is missing, unreadable, a folder, or cannot be written.
    Usage,
    /// 3: the machine lacks something.
    Machine,
    /// 130: Ctrl-C ended it, as shells have it.
    Interrupted = 130,
}

/// The codes of errors about files rather than about their content.
static FILE_CODES: &[&str] = &[
    general::FILE_NOT_FOUND.id,
    general::FILE_UNREADABLE.id,
    general::FILE_IS_FOLDER.id,
    scenes::SCENE_FILE_UNREADABLE.id,
    preprocess::INCLUDE_NOT_FOUND.id,
];

impl Exit {
    /// The exit code of a list of diagnostics.
    pub(crate) fn of<'a>(diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> Self {
        diagnostics.into_iter().filter(|diagnostic| diagnostic.is_error()).map(Self::of_error).max().unwrap_or_default()
    }

    /// The exit with this code.
    pub(crate) fn of_code(code: u8) -> Self {
        let known = [Self::Ok, Self::Usage, Self::Machine, Self::Interrupted];
        known.into_iter().find(|exit| *exit as u8 == code).unwrap_or(Self::Content)
    }

    fn of_error(error: &Diagnostic) -> Self {
        if FILE_CODES.contains(&error.code.id) { Self::Usage } else { Self::Content }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why a command cannot continue, for the user.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// The exit code.
    pub(crate) exit: Exit,
    /// The message, without a full stop.
    pub(crate) message: String,
    /// The help text.
    pub(crate) help: Option<String>,
}

impl Failure {
    /// Wrong usage, or a file that cannot be read or written.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self::new(Exit::Usage, message)
    }

    /// A failure with any exit code.
    pub(crate) fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit, message: message.into(), help: None }
    }

    /// Adds a help text.
    pub(crate) fn help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }
}

/// The result of a command.
pub(crate) type Outcome = Result<Exit, Failure>;
