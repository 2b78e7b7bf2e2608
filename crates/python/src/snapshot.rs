//! States to go back to.

use crate::errors;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple, PyType};
use std::path::PathBuf;

/// A state of a simulation.
#[pyclass(frozen, module = "sinew")]
pub struct Snapshot(pub sinew::Snapshot);

#[pymethods]
impl Snapshot {
    #[getter]
    fn time(&self) -> f64 {
        self.0.time()
    }

    #[getter]
    fn step_count(&self) -> u64 {
        self.0.step()
    }

    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = self.0.to_bytes().map_err(|error| errors::of_engine(py, &error.into()))?;
        Ok(PyBytes::new(py, &bytes))
    }

    #[classmethod]
    fn from_bytes(_class: &Bound<'_, PyType>, py: Python<'_>, data: &[u8]) -> PyResult<Self> {
        sinew::Snapshot::from_bytes(data).map(Self).map_err(|error| errors::of_engine(py, &error.into()))
    }

    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.0.write(&path).map_err(|error| errors::of_engine(py, &error))
    }

    #[classmethod]
    fn read(_class: &Bound<'_, PyType>, py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        sinew::Snapshot::read(&path).map(Self).map_err(|error| errors::of_engine(py, &error))
    }

    fn differences(&self, other: &Self) -> Vec<String> {
        self.0.differences(&other.0)
    }

    fn __repr__(&self) -> String {
        format!("<sinew.Snapshot of t = {} s, step {}>", self.0.time(), self.0.step())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let again = py.import("sinew._again")?.getattr("snapshot")?;
        let made = PyTuple::new(py, [self.to_bytes(py)?])?;
        PyTuple::new(py, [again, made.into_any()])
    }
}
