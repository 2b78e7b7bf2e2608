//! A body of a simulation: its nodes and elements as arrays.

use crate::arrays;
use crate::reading;
use crate::simulation::{Run, Simulation};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use sinew::Error;
use sinew::components::Displacement;

/// A body.
#[pyclass(frozen, module = "sinew")]
pub struct Body {
    simulation: Py<Simulation>,
    name: String,
}

#[pymethods]
impl Simulation {
    fn body(slf: Py<Self>, py: Python<'_>, name: &str) -> PyResult<Body> {
        slf.get().with(py, |run| run.simulation.body(name))?;
        Ok(Body { simulation: slf, name: name.to_owned() })
    }

    #[getter]
    fn bodies(slf: Py<Self>, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        let all = PyDict::new(py);
        for name in slf.get().scene.get().file().scene.bodies.keys() {
            all.set_item(name, Body { simulation: slf.clone_ref(py), name: name.clone() })?;
        }
        Ok(all)
    }
}

impl Body {
    fn with<T: Send>(
        &self,
        py: Python<'_>,
        task: impl FnOnce(&mut Run, &str) -> Result<T, Error> + Send,
    ) -> PyResult<T> {
        self.simulation.get().with(py, |run| task(run, &self.name))
    }
}

#[pymethods]
impl Body {
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    #[getter]
    fn displacement<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.with(py, |run, name| run.lent.displacement(&mut run.simulation, name))?.array(py)
    }

    #[getter]
    fn generation(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |run, _| Ok(run.lent.generation()))
    }

    #[getter]
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let rows = self.with(py, |run, name| {
            // the address of no array changes by this, on a GPU either
            Ok(run.simulation.column::<Displacement>(name)?.node_rows().to_vec())
        })?;
        arrays::array(py, &rows, "uint32", &[rows.len()])
    }

    #[pyo3(signature = (out = None))]
    fn positions<'py>(&self, py: Python<'py>, out: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let places = self.with(py, |run, name| run.simulation.positions(name))?;
        arrays::into(arrays::vectors(py, &places)?, out)
    }

    #[pyo3(signature = (out = None))]
    fn displacements<'py>(&self, py: Python<'py>, out: Option<Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let moved = self.with(py, |run, name| run.simulation.displacements(name))?;
        arrays::into(arrays::vectors(py, &moved)?, out)
    }

    #[getter]
    fn rest_positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::vectors(py, &self.with(py, |run, name| run.simulation.rest_positions(name))?)
    }

    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let triangles = self.with(py, |run, name| run.simulation.surface_triangles(name))?;
        arrays::array(py, &triangles, "uint32", &[triangles.len(), 3])
    }

    #[getter]
    fn node_numbers<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let numbers = self.with(py, |run, name| run.simulation.node_numbers(name))?;
        arrays::array(py, &numbers, "uint64", &[numbers.len()])
    }

    fn fields<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let fields = self.with(py, |run, name| run.simulation.fields(name))?;
        let elements = fields.stress.len();
        let all = PyDict::new(py);
        all.set_item("displacement", arrays::vectors(py, &fields.displacement)?)?;
        all.set_item("velocity", arrays::vectors(py, &fields.velocity)?)?;
        all.set_item("volume_ratio", arrays::numbers(py, &fields.volume_ratio)?)?;
        all.set_item("stress", arrays::array(py, &fields.stress, "float64", &[elements, 6])?)?;
        all.set_item("alive", arrays::array(py, &fields.alive, "bool", &[elements])?)?;
        Ok(all)
    }

    fn internal_forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::vectors(py, &self.with(py, |run, name| run.simulation.internal_forces(name))?)
    }

    fn masses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::numbers(py, &self.with(py, |run, name| run.simulation.masses(name))?)
    }

    fn contact<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        reading::dict(py, &self.with(py, |run, name| run.simulation.contact(name))?)
    }

    #[getter]
    fn copies(&self) -> u32 {
        let scene = &self.simulation.get().scene.get().file().scene;
        scene.bodies.get(&self.name).map_or(1, |body| body.copies)
    }

    fn by_copy<'py>(&self, array: Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (copies, shape) = (self.copies() as usize, array.getattr("shape")?.extract::<Vec<usize>>()?);
        let Some((rows, others)) = shape.split_first().filter(|(rows, _)| *rows % copies == 0) else {
            let text = format!("an array of shape {shape:?} cannot be parted into {copies} copies");
            return Err(PyValueError::new_err(text));
        };
        let parted: Vec<usize> = [copies, rows / copies].into_iter().chain(others.iter().copied()).collect();
        array.call_method1("reshape", (PyTuple::new(array.py(), parted)?,))
    }

    fn __repr__(&self) -> String {
        format!("<sinew.Body {:?}>", self.name)
    }
}
