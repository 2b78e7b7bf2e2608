//! Inputs of a scene as a mapping from names to factors.

use crate::simulation::Simulation;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use sinew::InputValue;

/// The inputs of a simulation.
#[pyclass(frozen, mapping, module = "sinew")]
pub struct Inputs(Py<Simulation>);

#[pymethods]
impl Simulation {
    #[getter]
    fn inputs(slf: Py<Self>) -> Inputs {
        Inputs(slf)
    }
}

impl Inputs {
    fn all(&self, py: Python<'_>) -> PyResult<Vec<InputValue>> {
        self.0.get().look(py, |run| run.simulation.inputs())
    }

    fn find(&self, py: Python<'_>, name: &str) -> PyResult<InputValue> {
        let all = self.all(py)?;
        let names: Vec<String> = all.iter().map(|input| input.name.clone()).collect();
        all.into_iter().find(|input| input.name == name).ok_or_else(|| {
            let there = if names.is_empty() { "none in this scene".into() } else { names.join(", ") };
            PyKeyError::new_err(format!("there is no input named {name:?}; there is {there}"))
        })
    }
}

#[pymethods]
impl Inputs {
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.all(py)?.len())
    }

    fn __contains__(&self, py: Python<'_>, name: &str) -> PyResult<bool> {
        Ok(self.all(py)?.iter().any(|input| input.name == name))
    }

    fn __getitem__(&self, py: Python<'_>, name: &str) -> PyResult<f64> {
        Ok(self.find(py, name)?.value)
    }

    #[pyo3(signature = (name, default = None))]
    fn get(&self, py: Python<'_>, name: &str, default: Option<f64>) -> PyResult<Option<f64>> {
        let found = self.all(py)?.into_iter().find(|input| input.name == name);
        Ok(found.map(|input| input.value).or(default))
    }

    fn __setitem__(&self, py: Python<'_>, name: &str, value: f64) -> PyResult<()> {
        self.find(py, name)?;
        self.0.get().with(py, |run| run.simulation.set_input(name, value))
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(PyList::new(py, self.keys(py)?)?.try_iter()?.into_any())
    }

    fn keys(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        Ok(self.all(py)?.into_iter().map(|input| input.name).collect())
    }

    fn values(&self, py: Python<'_>) -> PyResult<Vec<f64>> {
        Ok(self.all(py)?.into_iter().map(|input| input.value).collect())
    }

    fn items(&self, py: Python<'_>) -> PyResult<Vec<(String, f64)>> {
        Ok(self.all(py)?.into_iter().map(|input| (input.name, input.value)).collect())
    }

    fn about<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyDict>> {
        let input = self.find(py, name)?;
        let about = PyDict::new(py);
        about.set_item("value", input.value)?;
        about.set_item("target", input.target)?;
        about.set_item("rate", input.rate)?;
        let uses: Vec<(String, &str, Option<&str>)> =
            input.uses.into_iter().map(|used| (used.path, used.of, used.unit)).collect();
        about.set_item("uses", uses)?;
        Ok(about)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let texts: Vec<String> = self.items(py)?.iter().map(|(name, value)| format!("{name:?}: {value}")).collect();
        Ok(format!("<sinew.Inputs {{{}}}>", texts.join(", ")))
    }
}
