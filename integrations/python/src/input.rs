//! [`Settings`]: the options of a compilation, and a function of Python that is asked for includes.

use crate::failure::raised;
use glisten_binding::{Answer, Error};
use pyo3::prelude::*;
use std::sync::{Arc, Mutex, PoisonError};

/// The first exception of a function that was asked for an include.
pub(crate) type Trouble = Arc<Mutex<Option<PyErr>>>;

/// The options of a compilation.
#[pyclass(frozen, name = "Settings", module = "glisten._glisten")]
pub(crate) struct Settings {
    settings: glisten_binding::Settings,
    include: Option<Py<PyAny>>,
}

#[pymethods]
impl Settings {
    #[new]
    fn new(
        options: Vec<(String, String)>,
        defines: Vec<(String, String)>,
        folders: Vec<String>,
        include: Option<Py<PyAny>>,
        attributes: Vec<(String, u32)>,
        outputs: Vec<(String, u32)>,
    ) -> PyResult<Self> {
        let fill = || -> Result<glisten_binding::Settings, Error> {
            let mut settings = glisten_binding::Settings::default();
            options.iter().try_for_each(|(name, value)| settings.set(name, value))?;
            defines.iter().try_for_each(|(name, value)| settings.define(name, value))?;
            attributes.iter().try_for_each(|(name, location)| settings.bind_attribute(name, *location))?;
            outputs.iter().try_for_each(|(name, number)| settings.bind_output(name, *number))?;
            settings.includes.folders = folders.into_iter().map(Into::into).collect();
            Ok(settings)
        };
        Ok(Self { settings: fill().map_err(raised)?, include })
    }
}

impl Settings {
    /// The settings for one call, with the place where an exception of the include function is kept.
    pub(crate) fn for_call(&self, py: Python<'_>) -> (glisten_binding::Settings, Trouble) {
        let (mut settings, trouble) = (self.settings.clone(), Trouble::default());
        if let Some(function) = &self.include {
            let (function, trouble) = (function.clone_ref(py), Arc::clone(&trouble));
            settings.includes.ask =
                Some(Arc::new(move |path, angled, from| ask(&function, &trouble, path, angled, from)));
        }
        (settings, trouble)
    }
}

/// Asks a function of Python: a text is the file, `None` passes.
fn ask(function: &Py<PyAny>, trouble: &Trouble, path: &str, angled: bool, from: &str) -> Answer {
    let asked = Python::attach(|py| function.call1(py, (path, angled, from))?.extract::<Option<String>>(py));
    match asked {
        Ok(Some(text)) => Answer::Found { name: path.to_owned(), text },
        Ok(None) => Answer::Pass,
        Err(error) => {
            trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            Answer::Missing("the include function raised an exception".to_owned())
        }
    }
}

/// Raises what an include function raised.
pub(crate) fn reraised(trouble: &Trouble) -> PyResult<()> {
    trouble.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
}

/// The format of diagnostics with this name.
pub(crate) fn format(name: &str) -> PyResult<glisten_binding::Format> {
    use glisten_binding::Format;
    static FORMATS: [(&str, Format); 4] =
        [("human", Format::Human), ("json", Format::Json), ("sarif", Format::Sarif), ("github", Format::Github)];
    let found = FORMATS.iter().find(|(other, _)| *other == name).map(|(_, format)| *format);
    found.ok_or_else(|| raised(Error::argument(format!("`{name}` is no format: human, json, sarif, github"))))
}
