//! A hand: picking, grabbing, moving, letting go.

use crate::arrays::{self, vector};
use crate::simulation::Simulation;
use pyo3::prelude::*;
use sinew::{GrabId, Grip};

/// Where a ray meets a body.
#[pyclass(frozen, module = "sinew")]
pub struct Pick(sinew::Pick);

#[pymethods]
impl Pick {
    #[getter]
    fn body(&self) -> &str {
        &self.0.body
    }

    #[getter]
    fn element(&self) -> u64 {
        self.0.element
    }

    #[getter]
    fn nodes(&self) -> [u32; 3] {
        self.0.nodes
    }

    #[getter]
    fn weights(&self) -> [f64; 3] {
        self.0.weights
    }

    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::numbers(py, &self.0.point.to_array())
    }

    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        arrays::numbers(py, &self.0.normal.to_array())
    }

    #[getter]
    fn distance(&self) -> f64 {
        self.0.distance
    }

    fn __repr__(&self) -> String {
        format!("<sinew.Pick of {:?}, element {}, at {} m>", self.0.body, self.0.element, self.0.point)
    }
}

/// What a hand holds.
#[pyclass(frozen, module = "sinew")]
pub struct Grab {
    simulation: Py<Simulation>,
    id: GrabId,
}

fn grip(stiffness: Option<f64>, damping: Option<f64>, most_force: f64) -> Grip {
    Grip { stiffness, damping, most_force }
}

#[pymethods]
impl Simulation {
    fn pick(&self, py: Python<'_>, origin: [f64; 3], direction: [f64; 3]) -> PyResult<Option<Pick>> {
        let found = self.with(py, |run| run.simulation.pick(vector(origin), vector(direction)))?;
        Ok(found.map(Pick))
    }

    #[pyo3(signature = (pick, *, stiffness = None, damping = None, most_force = f64::INFINITY))]
    fn grab(
        slf: Py<Self>,
        py: Python<'_>,
        pick: Py<Pick>,
        stiffness: Option<f64>,
        damping: Option<f64>,
        most_force: f64,
    ) -> PyResult<Grab> {
        let grip = grip(stiffness, damping, most_force);
        let id = slf.get().with(py, |run| run.simulation.grab(&pick.get().0, &grip))?;
        Ok(Grab { simulation: slf, id })
    }

    #[pyo3(signature = (body, nodes, weights = None, *, stiffness = None, damping = None, most_force = f64::INFINITY))]
    fn grab_nodes(
        slf: Py<Self>,
        py: Python<'_>,
        body: &str,
        nodes: Vec<usize>,
        weights: Option<Vec<f64>>,
        stiffness: Option<f64>,
        damping: Option<f64>,
        most_force: f64,
    ) -> PyResult<Grab> {
        let weights = weights.unwrap_or_else(|| vec![1.0; nodes.len()]);
        if weights.len() != nodes.len() {
            let text = format!("{} nodes and {} weights: there must be as many", nodes.len(), weights.len());
            return Err(pyo3::exceptions::PyValueError::new_err(text));
        }
        let held: Vec<(usize, f64)> = nodes.into_iter().zip(weights).collect();
        let grip = grip(stiffness, damping, most_force);
        let id = slf.get().with(py, |run| run.simulation.grab_nodes(body, &held, &grip))?;
        Ok(Grab { simulation: slf, id })
    }
}

#[pymethods]
impl Grab {
    #[pyo3(name = "move")]
    fn move_to(&self, py: Python<'_>, target: [f64; 3]) -> PyResult<()> {
        self.simulation.get().with(py, |run| run.simulation.move_grab(self.id, vector(target)))
    }

    #[getter]
    fn force<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let force = self.simulation.get().with(py, |run| run.simulation.grab_force(self.id))?;
        arrays::numbers(py, &force.to_array())
    }

    fn release(&self, py: Python<'_>) -> PyResult<()> {
        self.simulation.get().with(py, |run| run.simulation.release(self.id))
    }
}
