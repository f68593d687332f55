//! [`Console`]: the only place that prints.
//!
//! *Holds:* results go to standard output, everything else to standard error. If the reader of standard output goes
//! away, nothing more is written there, and the exit code is the same; any other failure to write is reported. Where diagnostics are a document for programs, nothing
//! else is written to standard error but the failure that ends the command.

use crate::arguments::args::DiagnosticFormat;
use crate::batch::Batch;
use crate::exit::{Exit, Failure};
use crate::told::Document;
use clap::ValueEnum;
use glisten_front::diagnostic::shortened;
use glisten_front::diagnostic::write::{Scope, clean};
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// When to use colors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorChoice {
    /// If the output is a terminal and `NO_COLOR` is not set.
    #[default]
    Auto,
    /// Always.
    Always,
    /// Never.
    Never,
}

impl From<ColorChoice> for clap::ColorChoice {
    fn from(choice: ColorChoice) -> Self {
        match choice {
            ColorChoice::Auto => Self::Auto,
            ColorChoice::Always => Self::Always,
            ColorChoice::Never => Self::Never,
        }
    }
}

impl ColorChoice {
    /// The `--color` of arguments that are not parsed: help and messages about arguments obey it, too.
    pub(crate) fn asked_for(arguments: &[OsString]) -> Self {
        let words = arguments.iter().skip(1).map(|word| word.to_string_lossy());
        let mut words = words.take_while(|word| word != "--");
        let mut choice = Self::Auto;
        while let Some(word) = words.next() {
            let value = match word.strip_prefix("--color") {
                Some("") => words.next().map(|value| value.into_owned()),
                Some(rest) => rest.strip_prefix('=').map(str::to_owned),
                None => None,
            };
            choice = value.and_then(|value| Self::from_str(&value, false).ok()).unwrap_or(choice);
        }
        choice
    }
}

/// Standard output and standard error, with the user's settings for them.
#[derive(Clone, Debug)]
pub(crate) struct Console {
    quiet: bool,
    color: ColorChoice,
    document: Arc<Mutex<Option<Document>>>,
}

impl Console {
    /// A console with `--quiet` and `--color` as given.
    pub(crate) fn new(quiet: bool, color: ColorChoice) -> Self {
        Self { quiet, color, document: Arc::default() }
    }

    fn document(&self) -> MutexGuard<'_, Option<Document>> {
        self.document.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Keeps standard error for a document, if the format is one for programs.
    pub(crate) fn set_format(&self, format: DiagnosticFormat) {
        if format != DiagnosticFormat::Human {
            self.document().get_or_insert_with(|| Document::new(format));
        }
    }

    /// Adds batches to the document. Whether there is one.
    pub(crate) fn document_has(&self, batches: &[&Batch], scope: Option<&Scope>) -> bool {
        let mut document = self.document();
        document.as_mut().map(|document| document.add(batches, scope)).is_some()
    }

    /// Writes the document, if there is one and something was reported to it.
    pub(crate) fn write_document(&self) {
        let text = self.document().as_mut().and_then(Document::take);
        text.iter().for_each(|text| self.message(text));
    }

    /// Whether to omit progress and summaries.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Whether standard error is a terminal.
    pub(crate) fn is_watched(&self) -> bool {
        !self.quiet && io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
    }

    /// Whether to color standard output.
    pub(crate) fn colors_output(&self) -> bool {
        self.colors(&io::stdout())
    }

    /// Whether to color standard error.
    pub(crate) fn colors_messages(&self) -> bool {
        self.colors(&io::stderr())
    }

    fn colors(&self, stream: &impl IsTerminal) -> bool {
        match self.color {
            ColorChoice::Always => true,
            ColorChoice::Never => false,
            ColorChoice::Auto => {
                let refused = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
                    || std::env::var_os("TERM").is_some_and(|term| term == "dumb");
                stream.is_terminal() && !refused
            }
        }
    }

    /// Writes a result to standard output.
    pub(crate) fn output(&self, text: &str) -> Result<(), Failure> {
        self.output_bytes(text.as_bytes())
    }

    /// Writes a result that need not be text to standard output.
    pub(crate) fn output_bytes(&self, bytes: &[u8]) -> Result<(), Failure> {
        let mut stdout = io::stdout().lock();
        written(stdout.write_all(bytes).and_then(|()| stdout.flush()))
    }

    /// Writes to standard error. A failure is ignored, since there is no other place to report it.
    pub(crate) fn message(&self, text: &str) {
        let mut stderr = io::stderr().lock();
        let _ = stderr.write_all(text.as_bytes()).and_then(|()| stderr.flush());
    }

    /// Writes a line to standard error, which `--quiet` and a document omit.
    pub(crate) fn remark(&self, text: &str) {
        if !self.quiet {
            self.aside(text);
        }
    }

    /// Writes a line to standard error, which a document omits.
    pub(crate) fn aside(&self, text: &str) {
        if self.document().is_none() {
            self.message(&format!("{text}\n"));
        }
    }

    /// Clears what a process that is gone may have left of its progress on this line.
    pub(crate) fn clear_line(&self) {
        if self.is_watched() {
            self.message("\r\x1b[2K");
        }
    }

    /// Reports why a command, or a part of its work, cannot continue. Returns the exit code.
    pub(crate) fn tell(&self, failure: Failure) -> Exit {
        self.failure(&failure.message, failure.help.as_deref());
        failure.exit
    }

    /// Reports a failure.
    pub(crate) fn failure(&self, message: &str, help: Option<&str>) {
        let mut text = painted("error", "", message, self.colors_messages());
        if let Some(help) = help {
            text.push_str(&format!("  help: {}\n", clean(&shortened(help))));
        }
        self.message(&text);
    }
}

/// The outcome of writing to standard output: a reader that goes away is no failure, a full disk is one.
pub(crate) fn written(result: io::Result<()>) -> Result<(), Failure> {
    match result {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Failure::usage(format!("cannot write to standard output: {error}"))),
    }
}

/// The first line of a message: its severity, a code, and what it says.
pub(crate) fn painted(severity: &str, code: &str, message: &str, color: bool) -> String {
    let message = clean(&shortened(message));
    if !color {
        return format!("{severity}{code}: {message}\n");
    }
    let paint = if severity == "error" { "\x1b[1;31m" } else { "\x1b[1;32m" };
    format!("{paint}{severity}{code}\x1b[0m\x1b[1m: {message}\x1b[0m\n")
}
