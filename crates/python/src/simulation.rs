//! Simulations: who may call the engine, and when.

use crate::scene::Scene;
use crate::view::Lent;
use crate::{arrays, errors, reading, values};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::{PyDict, PyList};
use sinew::components::Precision;
use sinew::{BackendChoice, Error, Options};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;

/// A simulation.
#[pyclass(frozen, module = "sinew")]
pub struct Simulation {
    run: Mutex<Run>,
    pub scene: Py<Scene>,
}

/// The engine's, and what was lent of it.
pub struct Run {
    pub simulation: sinew::Simulation,
    pub lent: Lent,
    /// Whether steps write columns where they lie.
    in_place: bool,
    /// What the engine said when it panicked: its state may be anything since.
    broken: Option<String>,
}

impl Run {
    /// What arrays show is no longer sure to be the present state.
    pub fn leave(&mut self) -> &mut sinew::Simulation {
        self.lent.hand_over(&mut self.simulation);
        &mut self.simulation
    }

    /// To take steps.
    pub fn stepping(&mut self) -> &mut sinew::Simulation {
        if !self.in_place {
            self.lent.hand_over(&mut self.simulation);
        }
        &mut self.simulation
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.lent.end(&mut self.simulation);
    }
}

impl Simulation {
    /// Calls the engine, with the interpreter released and nobody else in the same simulation.
    pub fn with<T: Send>(&self, py: Python<'_>, task: impl FnOnce(&mut Run) -> Result<T, Error> + Send) -> PyResult<T> {
        let done = {
            let mut run = self.run.lock_py_attached(py).unwrap_or_else(|poisoned| poisoned.into_inner());
            let run = &mut *run;
            py.detach(|| match &run.broken {
                Some(said) => Err(said.clone()),
                None => catch_unwind(AssertUnwindSafe(|| task(run))).map_err(|panic| {
                    let said = errors::said(&*panic);
                    run.broken = Some(said.clone());
                    said
                }),
            })
        };
        match done {
            Ok(result) => result.map_err(|error| errors::of_engine(py, &error)),
            Err(said) => Err(errors::bug(py, &said)),
        }
    }

    /// The same for what cannot fail.
    pub fn look<T: Send>(&self, py: Python<'_>, task: impl FnOnce(&mut Run) -> T + Send) -> PyResult<T> {
        self.with(py, |run| Ok(task(run)))
    }
}

/// The engine's, of those that Python names.
pub fn options(backend: &str, precision: &str, threads: usize, grabs: bool, resets: bool) -> PyResult<Options> {
    let wrong = |what: &str, found: &str, allowed: &str| {
        PyValueError::new_err(format!("{what} {found:?} is not known; allowed: {allowed}"))
    };
    let backend = match backend {
        "auto" => BackendChoice::Auto,
        "cpu" => BackendChoice::Cpu,
        "gpu" => BackendChoice::Gpu,
        other => return Err(wrong("the backend", other, "\"auto\", \"cpu\", \"gpu\"")),
    };
    let precision = match precision {
        "f32" => Precision::F32,
        "f64" => Precision::F64,
        other => return Err(wrong("the precision", other, "\"f32\", \"f64\"")),
    };
    Ok(Options { backend, precision, threads, grabs, forgets_start: !resets, ..Options::default() })
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, *, backend = "auto", precision = "f32", threads = 0, grabs = false, resets = true))]
    fn new(
        py: Python<'_>,
        scene: Py<Scene>,
        backend: &str,
        precision: &str,
        threads: usize,
        grabs: bool,
        resets: bool,
    ) -> PyResult<Self> {
        let options = options(backend, precision, threads, grabs, resets)?;
        let file = scene.get().file();
        let made = py.detach(|| catch_unwind(AssertUnwindSafe(|| sinew::Simulation::new(file, &options))));
        let made = made.map_err(|panic| errors::bug(py, &errors::said(&*panic)))?;
        let simulation = made.map_err(|error| errors::of_engine(py, &error))?;
        let explicit = matches!(simulation.scene().solver, sinew::scene::schema::Solver::Explicit);
        let in_place = explicit && !simulation.is_on_gpu() && !simulation.scene().is_static();
        let run = Run { simulation, lent: Lent::default(), in_place, broken: None };
        Ok(Self { run: Mutex::new(run), scene })
    }

    #[getter]
    fn scene(&self, py: Python<'_>) -> Py<Scene> {
        self.scene.clone_ref(py)
    }

    #[getter]
    fn time(&self, py: Python<'_>) -> PyResult<f64> {
        self.look(py, |run| run.simulation.time())
    }

    #[getter]
    fn time_step(&self, py: Python<'_>) -> PyResult<f64> {
        self.look(py, |run| run.simulation.time_step())
    }

    #[getter]
    fn step_count(&self, py: Python<'_>) -> PyResult<u64> {
        self.look(py, |run| run.simulation.step_count())
    }

    #[getter]
    fn is_finished(&self, py: Python<'_>) -> PyResult<bool> {
        self.look(py, |run| run.simulation.is_finished())
    }

    #[getter]
    fn is_on_gpu(&self, py: Python<'_>) -> PyResult<bool> {
        self.look(py, |run| run.simulation.is_on_gpu())
    }

    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let warnings = self.look(py, |run| run.simulation.warnings().clone())?;
        errors::list(py, &warnings)
    }

    fn change(&self, py: Python<'_>, set: &Bound<'_, PyDict>) -> PyResult<()> {
        let sets = values::sets(Some(set))?;
        self.with(py, |run| run.leave().change(&sets))
    }

    fn probe<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let seen = self.with(py, |run| run.simulation.probe(name))?;
        arrays::numbers(py, &seen)
    }

    fn probes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        for name in self.scene.get().file().scene.probes.keys() {
            all.set_item(name, self.probe(py, name)?)?;
        }
        Ok(all)
    }

    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let energies = self.with(py, |run| run.simulation.energies())?;
        reading::dict(py, &energies)
    }

    #[pyo3(signature = (ended = "unfinished"))]
    fn summary<'py>(&self, py: Python<'py>, ended: &str) -> PyResult<Bound<'py, PyAny>> {
        let summary = self.with(py, |run| run.simulation.summary(ended))?;
        reading::dict(py, &summary)
    }

    fn tool<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let felt = self.with(py, |run| run.simulation.tool(name))?;
        reading::dict(py, &felt)
    }

    fn attachment<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let borne = self.with(py, |run| run.simulation.attachment(name))?;
        reading::dict(py, &borne)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let title = self.scene.get().file().scene.title.clone();
        let (time, steps) = self.look(py, |run| (run.simulation.time(), run.simulation.step_count()))?;
        Ok(format!("<sinew.Simulation {title:?} at t = {time} s after {steps} steps>"))
    }
}
