//! [`Upgraded`] and [`upgrade`].

use crate::failure::raised;
use crate::input::{Settings, format, reraised};
use crate::program::sources_of;
use glisten_binding::guarded;
use pyo3::prelude::*;

/// The sources of a program in another version.
#[pyclass(frozen, name = "Upgraded", module = "glisten._glisten")]
pub(crate) struct Upgraded {
    upgraded: glisten_binding::Upgraded,
}

/// Rewrites sources: names, texts, and stages where the names do not tell them.
#[pyfunction]
pub(crate) fn upgrade(
    py: Python<'_>,
    settings: &Settings,
    sources: Vec<(String, String, Option<String>)>,
    version: &str,
) -> PyResult<Upgraded> {
    let (settings, trouble) = settings.for_call(py);
    let sources = sources_of(sources)?;
    let upgraded = py.detach(|| guarded(|| glisten_binding::upgrade(&settings, &sources, version)));
    reraised(&trouble)?;
    Ok(Upgraded { upgraded: upgraded.map_err(raised)? })
}

#[pymethods]
impl Upgraded {
    #[getter]
    fn is_sound(&self) -> bool {
        self.upgraded.is_sound()
    }

    #[getter]
    fn texts(&self) -> Vec<String> {
        self.upgraded.texts().to_vec()
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.upgraded.notes().to_vec()
    }

    fn diagnostics(&self, name: &str) -> PyResult<String> {
        Ok(self.upgraded.diagnostics(format(name)?))
    }
}
