//! Still pictures, by the software renderer.

use crate::simulation::Simulation;
use crate::{errors, values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use sinew::observation::{write_fields, write_skins};
use sinew::output::Series;
use sinew::scene::validate_picture;
use sinew_pictures::render::{RenderOptions, draw};
use std::path::PathBuf;

/// A picture as a PNG file.
#[pyclass(frozen, module = "sinew")]
pub struct Picture(Vec<u8>);

#[pymethods]
impl Picture {
    #[getter]
    fn png<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.0)
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        self.png(py)
    }

    fn save(&self, path: PathBuf) -> PyResult<()> {
        Ok(std::fs::write(path, &self.0)?)
    }
}

/// A scene's words of its picture: `from_` stands for `from`, which Python keeps for itself.
fn sets(words: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<String>> {
    let mut sets = Vec::new();
    for (word, value) in words.into_iter().flatten() {
        let word: String = word.extract()?;
        let word = word.strip_suffix('_').unwrap_or(&word);
        sets.push(format!("picture.{word}={}", values::ron(&value)?));
    }
    Ok(sets)
}

#[pymethods]
impl Simulation {
    #[pyo3(signature = (array = None, **words))]
    fn picture(&self, py: Python<'_>, array: Option<String>, words: Option<&Bound<'_, PyDict>>) -> PyResult<Picture> {
        let sets = sets(words)?;
        let scene = self.scene.get();
        let how = py.detach(|| {
            let scene = scene.with(sets)?;
            let mut found = scene.diagnostics();
            validate_picture(&scene, &mut found);
            if found.has_errors() { Err(found) } else { Ok(scene.scene.picture.clone()) }
        });
        let how = how.map_err(|found| errors::of_scene(py, &found))?;
        let folder = tempfile::tempdir()?;
        self.with(py, |run| {
            run.simulation.settle()?;
            let mut series = Series::named(folder.path(), "fields")?;
            write_fields(run.simulation.world_mut(), &mut series)?;
            write_skins(run.simulation.world_mut(), folder.path())
        })?;
        let png = folder.path().join("picture.png");
        let options = RenderOptions { field: array, ..RenderOptions::new(how, png.clone()) };
        py.detach(|| draw(folder.path(), &options)).map_err(|error| PyValueError::new_err(error.to_string()))?;
        Ok(Picture(std::fs::read(png)?))
    }

    fn _repr_png_<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        Ok(self.picture(py, None, None)?.png(py))
    }
}
