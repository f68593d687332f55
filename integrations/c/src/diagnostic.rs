//! [`Diagnostic`]: a diagnostic as a struct of C.

use crate::pointers::{c_text, exclusive};
use glisten_binding::{Error, Finding, FoundSeverity};
use std::ffi::{CString, c_char};
use std::ptr;

/// How bad something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub enum Severity {
    /// Good to know.
    Note = 0,
    /// It is legal, but will hurt.
    Warning = 1,
    /// It is wrong, and there is no code.
    Error = 2,
}

/// A diagnostic. Its texts belong to the program or the scene.
#[repr(C)]
pub struct Diagnostic {
    /// How bad it is.
    pub severity: Severity,
    /// The code, such as `E0201`.
    pub code: *const c_char,
    /// The name of the code, such as `undeclared-identifier`.
    pub name: *const c_char,
    /// The message.
    pub message: *const c_char,
    /// The help text, or NULL.
    pub help: *const c_char,
    /// The name of the file.
    pub file: *const c_char,
    /// The first line, from 1.
    pub line: u32,
    /// The first column, from 1, in Unicode scalar values.
    pub column: u32,
    /// The last line.
    pub end_line: u32,
    /// The column after the last.
    pub end_column: u32,
}

/// A diagnostic with its texts.
pub(crate) struct Kept {
    severity: Severity,
    code: CString,
    name: CString,
    message: CString,
    help: Option<CString>,
    file: CString,
    place: [u32; 4],
}

impl Kept {
    pub(crate) fn all(findings: Vec<Finding>) -> Vec<Self> {
        findings.into_iter().map(|finding| Self::new(&finding)).collect()
    }

    fn new(finding: &Finding) -> Self {
        let region = &finding.region;
        Self {
            severity: match finding.severity {
                FoundSeverity::Error => Severity::Error,
                FoundSeverity::Warning => Severity::Warning,
                FoundSeverity::Note => Severity::Note,
            },
            code: c_text(finding.code.id),
            name: c_text(finding.code.name),
            message: c_text(&finding.message),
            help: finding.help.as_deref().map(c_text),
            file: c_text(&region.file),
            place: [region.line, region.column, region.end_line, region.end_column],
        }
    }

    fn shown(&self) -> Diagnostic {
        let [line, column, end_line, end_column] = self.place;
        Diagnostic {
            severity: self.severity,
            code: self.code.as_ptr(),
            name: self.name.as_ptr(),
            message: self.message.as_ptr(),
            help: self.help.as_ref().map_or(ptr::null(), |help| help.as_ptr()),
            file: self.file.as_ptr(),
            line,
            column,
            end_line,
            end_column,
        }
    }
}

/// Writes one of the diagnostics to memory of the host.
///
/// # Safety
/// `place` is null or can be written to.
pub(crate) unsafe fn show(kept: &[Kept], index: usize, place: *mut Diagnostic) -> Result<(), Error> {
    let one = kept.get(index).ok_or_else(|| Error::argument("there is no diagnostic with this number"))?;
    // SAFETY: the caller's.
    *unsafe { exclusive(place, "place for the diagnostic")? } = one.shown();
    Ok(())
}
