//! [`Scene`] and [`load`].

use crate::failure::raised;
use crate::input::{Settings, format, reraised};
use glisten_binding::{Error, Files, Precision, Scenery, guarded, joined};
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A loaded scene.
#[pyclass(frozen, name = "Scene", module = "glisten._glisten")]
pub(crate) struct Scene {
    scenery: Scenery,
}

/// What was drawn: width, height, the attachments as native doubles, whether pixels are covered.
type Drawing<'py> = (u32, u32, Vec<Bound<'py, PyByteArray>>, Bound<'py, PyByteArray>);

/// Loads the scene at a path, from these files or from the disk.
#[pyfunction]
pub(crate) fn load(
    py: Python<'_>,
    settings: &Settings,
    path: &str,
    files: Option<BTreeMap<String, Vec<u8>>>,
) -> PyResult<Scene> {
    let (mut settings, trouble) = settings.for_call(py);
    let files = match files {
        None => Files::Disk,
        Some(files) => {
            let files = files.into_iter().map(|(path, bytes)| (joined("", &path), bytes));
            let files: Arc<BTreeMap<String, Vec<u8>>> = Arc::new(files.collect());
            settings.includes.look_in(Arc::clone(&files));
            Files::of(files)
        }
    };
    let scenery = py.detach(|| guarded(|| Scenery::load(&settings, path, &files)));
    reraised(&trouble)?;
    Ok(Scene { scenery: scenery.map_err(raised)? })
}

#[pymethods]
impl Scene {
    #[getter]
    fn is_sound(&self) -> bool {
        self.scenery.is_sound()
    }

    fn diagnostics(&self, name: &str) -> PyResult<String> {
        Ok(self.scenery.diagnostics(format(name)?))
    }

    fn render<'py>(&self, py: Python<'py>, precision: &str) -> PyResult<Drawing<'py>> {
        let precision = match precision {
            "f64" => Precision::F64,
            "f32" => Precision::F32,
            _ => return Err(raised(Error::argument(format!("`{precision}` is no precision: f64, f32")))),
        };
        let drawn = py.detach(|| guarded(|| self.scenery.draw(precision))).map_err(raised)?;
        let bytes = |pixels: &Vec<[f64; 4]>| {
            let channels: Vec<u8> = pixels.as_flattened().iter().flat_map(|channel| channel.to_ne_bytes()).collect();
            PyByteArray::new(py, &channels)
        };
        let covered: Vec<u8> = drawn.covered.iter().map(|covered| u8::from(*covered)).collect();
        let attachments = drawn.attachments.iter().map(bytes).collect();
        Ok((drawn.width, drawn.height, attachments, PyByteArray::new(py, &covered)))
    }

    fn stability(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| guarded(|| self.scenery.stability())).map_err(raised)
    }
}
