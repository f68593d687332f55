//! Errors of glisten as exceptions of Python.

use glisten_binding::{Error, Kind};
use pyo3::PyErr;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};

/// The exception for an error. What a shader's author did wrong is a `ValueError`, too: the Python side tells it apart before.
pub(crate) fn raised(error: Error) -> PyErr {
    match error.kind {
        Kind::Argument | Kind::Content => PyValueError::new_err(error.message),
        Kind::File => PyOSError::new_err(error.message),
        Kind::Internal => PyRuntimeError::new_err(error.message),
    }
}
