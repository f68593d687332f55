//! [`Program`] and [`compile`].

use crate::failure::raised;
use crate::input::{Settings, format, reraised};
use glisten_binding::{Compiled, Error, Source, guarded, stage_of_word, target_of_word};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// A compiled program.
#[pyclass(frozen, name = "Program", module = "glisten._glisten")]
pub(crate) struct Program {
    compiled: Compiled,
}

/// Compiles sources: names, texts, and stages where the names do not tell them.
#[pyfunction]
pub(crate) fn compile(
    py: Python<'_>,
    settings: &Settings,
    sources: Vec<(String, String, Option<String>)>,
    lints: bool,
) -> PyResult<Program> {
    let (settings, trouble) = settings.for_call(py);
    let sources = sources_of(sources)?;
    let compiled = py.detach(|| guarded(|| glisten_binding::compile(&settings, &sources, lints)));
    reraised(&trouble)?;
    Ok(Program { compiled: compiled.map_err(raised)? })
}

/// The sources of a call.
pub(crate) fn sources_of(sources: Vec<(String, String, Option<String>)>) -> PyResult<Vec<Source>> {
    let sources = sources.into_iter().map(|(name, text, stage)| {
        let stage = stage.map(|word| stage_of_word(&word)).transpose()?;
        glisten_binding::sources_of(&name, &text, stage)
    });
    sources.collect::<Result<Vec<_>, Error>>().map(|sources| sources.concat()).map_err(raised)
}

#[pymethods]
impl Program {
    #[getter]
    fn is_sound(&self) -> bool {
        self.compiled.is_sound()
    }

    #[getter]
    fn stages(&self) -> Vec<&'static str> {
        self.compiled.stages().into_iter().map(|stage| stage.name()).collect()
    }

    fn emit<'py>(&self, py: Python<'py>, stage: &str, target: &str) -> PyResult<Bound<'py, PyBytes>> {
        let (stage, target) = (stage_of_word(stage).map_err(raised)?, target_of_word(target).map_err(raised)?);
        let code = py.detach(|| guarded(|| self.compiled.emit(stage, target))).map_err(raised)?;
        Ok(PyBytes::new(py, &code))
    }

    fn reflect(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| guarded(|| self.compiled.reflect())).map_err(raised)
    }

    fn diagnostics(&self, name: &str) -> PyResult<String> {
        Ok(self.compiled.diagnostics(format(name)?))
    }
}
