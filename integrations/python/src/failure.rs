//! Errors of glisten as exceptions of Python.

use glisten_binding::{Error, Kind, Unreadable};
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};

/// The exception for an error. What a shader's author did wrong is a `ValueError`, too: the Python side tells it apart before.
pub(crate) fn raised(error: Error) -> PyErr {
    match error.kind {
        // The Python side makes a `CompileError` of both.
        Kind::Content if error.diagnostics.is_some() => PyValueError::new_err((error.message, error.diagnostics)),
        Kind::Argument | Kind::Content => PyValueError::new_err(error.message),
        // Python makes the subclass of the number: `FileNotFoundError` and so on.
        Kind::File => match error.file {
            Some(Unreadable { path, errno: Some(errno) }) => PyOSError::new_err((errno, error.message, path)),
            _ => PyOSError::new_err(error.message),
        },
        Kind::Internal => PyRuntimeError::new_err(error.message),
    }
}
