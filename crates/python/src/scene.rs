//! Scenes.

use crate::{errors, values};
use pyo3::prelude::*;
use pyo3::types::{PyAny, PyBytes, PyDict, PyList, PyString, PyTuple, PyType};
use sinew::SceneFile;
use sinew::scene::{Allowed, Diagnostics};
use sinew::systems::Registry;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A scene, read and checked: simulations are made of it, as many as are wanted.
#[pyclass(frozen, module = "sinew")]
pub struct Scene {
    from: From,
    sets: Vec<String>,
    allow_outside: bool,
    file: SceneFile,
    warnings: Diagnostics,
}

/// What it was read from.
#[derive(Clone)]
enum From {
    File(PathBuf),
    Text { name: String, text: String, folder: PathBuf },
    Memory { name: String, text: String, files: BTreeMap<String, Vec<u8>> },
}

impl From {
    fn read(&self, sets: &[String], allow_outside: bool) -> Result<SceneFile, Diagnostics> {
        let allowed = Allowed { outside: allow_outside, ..Allowed::default() };
        match self {
            From::File(path) => SceneFile::load_allowing(path, sets, allowed),
            From::Text { name, text, folder } => SceneFile::from_text_allowing(name, text, folder, sets, allowed),
            From::Memory { name, text, files } => SceneFile::from_memory(name, text, files.clone(), sets),
        }
    }
}

impl Scene {
    fn make(py: Python<'_>, from: From, sets: Vec<String>, allow_outside: bool) -> PyResult<Self> {
        let read = py.detach(|| {
            let file = from.read(&sets, allow_outside)?;
            let found = sinew::Simulation::check(&file, &Registry::default());
            if found.has_errors() { Err(found) } else { Ok((file, found)) }
        });
        let (file, warnings) = read.map_err(|diagnostics| errors::of_scene(py, &diagnostics))?;
        Ok(Self { from, sets, allow_outside, file, warnings })
    }

    /// The engine's.
    pub fn file(&self) -> &SceneFile {
        &self.file
    }

    /// The same with other values; whether it could run is not asked.
    pub fn with(&self, sets: Vec<String>) -> Result<SceneFile, Diagnostics> {
        self.from.read(&[self.sets.clone(), sets].concat(), self.allow_outside)
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (path, set = None, *, allow_outside = false))]
    fn new(py: Python<'_>, path: PathBuf, set: Option<&Bound<'_, PyDict>>, allow_outside: bool) -> PyResult<Self> {
        Self::make(py, From::File(path), values::sets(set)?, allow_outside)
    }

    #[classmethod]
    #[pyo3(signature = (text, set = None, *, name = "scene.ron", folder = None, files = None, allow_outside = false))]
    fn from_text(
        _class: &Bound<'_, PyType>,
        py: Python<'_>,
        text: String,
        set: Option<&Bound<'_, PyDict>>,
        name: &str,
        folder: Option<PathBuf>,
        files: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        let name = name.to_owned();
        let from = match files {
            Some(files) => From::Memory { name, text, files: contents(files)? },
            None => From::Text { name, text, folder: folder.unwrap_or_default() },
        };
        Self::make(py, from, values::sets(set)?, allow_outside)
    }

    /// One of what `__reduce__` tells: values in the order in which they were put in, a place as often as it was.
    #[classmethod]
    #[pyo3(signature = (name, text, path, files, sets, allow_outside))]
    fn _made_of(
        _class: &Bound<'_, PyType>,
        py: Python<'_>,
        name: Option<String>,
        text: Option<String>,
        path: Option<PathBuf>,
        files: Option<BTreeMap<String, Bound<'_, PyAny>>>,
        sets: Vec<String>,
        allow_outside: bool,
    ) -> PyResult<Self> {
        let path = path.unwrap_or_default();
        let from = match (name, text, files) {
            (Some(name), Some(text), Some(files)) => From::Memory { name, text, files: contents(files)? },
            (Some(name), Some(text), None) => From::Text { name, text, folder: path },
            _ => From::File(path),
        };
        Self::make(py, from, sets, allow_outside)
    }

    fn with_values(&self, py: Python<'_>, set: &Bound<'_, PyDict>) -> PyResult<Self> {
        let sets = [self.sets.clone(), values::sets(Some(set))?].concat();
        Self::make(py, self.from.clone(), sets, self.allow_outside)
    }

    #[getter]
    fn text(&self) -> &str {
        self.file.text()
    }

    #[getter]
    fn title(&self) -> &str {
        &self.file.scene.title
    }

    #[getter]
    fn duration(&self) -> f64 {
        self.file.scene.duration
    }

    #[getter]
    fn bodies(&self) -> Vec<String> {
        self.file.scene.bodies.keys().cloned().collect()
    }

    #[getter]
    fn probes(&self) -> Vec<String> {
        self.file.scene.probes.keys().cloned().collect()
    }

    #[getter]
    fn tools(&self) -> Vec<String> {
        self.file.scene.tools.keys().cloned().collect()
    }

    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        errors::list(py, &self.warnings)
    }

    fn __repr__(&self) -> String {
        format!("<sinew.Scene {:?} of {}>", self.file.scene.title, self.file.path.display())
    }

    /// How it is made again in another process: of the same file, or of the text and what came with it.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let package = py.import("sinew._again")?;
        let sets = PyList::new(py, &this.sets)?;
        let (name, text, folder, files) = match &this.from {
            From::File(path) => {
                // the other process may be in another folder
                let path = std::path::absolute(path)?;
                (None, None, Some(path), None)
            }
            From::Text { name, text, folder } => {
                (Some(name), Some(text), Some(std::path::absolute(folder.join("."))?), None)
            }
            From::Memory { name, text, files } => {
                let bytes = PyDict::new(py);
                for (name, content) in files {
                    bytes.set_item(name, PyBytes::new(py, content))?;
                }
                (Some(name), Some(text), None, Some(bytes))
            }
        };
        let made = PyTuple::new(
            py,
            [
                name.into_pyobject(py)?.into_any(),
                text.into_pyobject(py)?.into_any(),
                folder.into_pyobject(py)?.into_any(),
                files.into_pyobject(py)?.into_any(),
                sets.into_any(),
                this.allow_outside.into_pyobject(py)?.to_owned().into_any(),
            ],
        )?;
        PyTuple::new(py, [package.getattr("scene")?, made.into_any()])
    }
}

/// Files in memory: texts are in UTF-8.
fn contents(files: BTreeMap<String, Bound<'_, PyAny>>) -> PyResult<BTreeMap<String, Vec<u8>>> {
    let bytes = |(name, content): (String, Bound<'_, PyAny>)| {
        let content = match content.cast::<PyString>() {
            Ok(text) => text.to_str()?.as_bytes().to_vec(),
            Err(_) => content.extract()?,
        };
        Ok((name, content))
    };
    files.into_iter().map(bytes).collect()
}
