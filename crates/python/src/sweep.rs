//! What sweeps of Python have in common with those of the command: which variants there are, what makes two rows the
//! same, and the files of the results.

use crate::scene::Scene;
use crate::simulation::{Simulation, options};
use crate::{errors, values};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt};
use sinew_studies::sweep::{
    Done, Kept, Keys, Part, Results, SweepError, SweepFile, Value, Variants, check_times, warned,
};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// What is done of a part of a sweep.
#[pyclass(frozen, module = "sinew._sinew")]
pub struct SweepResults {
    results: Mutex<Results>,
    places: Vec<String>,
    values: Vec<BTreeMap<String, Value>>,
    kept: Kept,
}

#[pymethods]
impl SweepResults {
    /// Opens the files of a part in a folder. `keep` are probes; of a function its name, and there are no columns.
    #[new]
    fn new(
        scene: PyRef<'_, Scene>,
        table: Vec<Bound<'_, PyDict>>,
        keep: Keep,
        at: Vec<f64>,
        part: (usize, usize),
        folder: PathBuf,
        how: (String, String, bool),
    ) -> PyResult<Self> {
        let (backend, precision, grabs) = how;
        let options = options(&backend, &precision, 1, grabs, true)?;
        let (mut places, mut of_rows) = (Vec::new(), Vec::new());
        let names = match &keep {
            Keep::Probes(names) => names.clone(),
            Keep::Function(name) => vec![format!("{name}()")],
        };
        let (mut of_all, mut keys) = (Keys::new(scene.file(), &names, &at, &options), Vec::new());
        for row in &table {
            let (mut own, mut sets) = (BTreeMap::new(), Vec::new());
            for (place, value) in row.iter() {
                let (place, value) = (place.extract::<String>()?, value_of(&value)?);
                sets.push(format!("{place}={value}"));
                if !places.contains(&place) {
                    places.push(place.clone());
                }
                own.insert(place, value);
            }
            keys.push(of_all.of(&sets, || scene.with(sets.clone())));
            of_rows.push(own);
        }
        let kept = match &keep {
            Keep::Probes(names) => Kept::of(scene.file(), names, &at),
            Keep::Function(_) => check_times(&at).map(|()| Kept::default()),
        };
        let kept = kept.map_err(PyValueError::new_err)?;
        let (which, of) = part;
        let results = Results::open(&folder, Part { which, of }, keys).map_err(|error| failed(&error))?;
        Ok(Self { results: Mutex::new(results), places, values: of_rows, kept })
    }

    /// Numbers of the variants that are not done.
    fn missing(&self) -> Vec<usize> {
        self.look(|results| results.missing())
    }

    /// Lines of what is done, in the order of numbers.
    fn lines(&self) -> PyResult<Vec<String>> {
        let line = |done: &Done| serde_json::to_string(done).map_err(|error| PyValueError::new_err(error.to_string()));
        self.look(|results| results.done().map(line).collect())
    }

    /// Takes the line of a variant that is done: all of it but its values.
    fn add(&self, number: usize, line: &str) -> PyResult<()> {
        let wrong = |error: serde_json::Error| PyValueError::new_err(error.to_string());
        let mut line: serde_json::Value = serde_json::from_str(line).map_err(wrong)?;
        line["values"] = serde_json::to_value(self.values.get(number)).map_err(wrong)?;
        let done: Done = serde_json::from_value(line).map_err(wrong)?;
        self.look(|results| results.add(done)).map_err(|error| failed(&error))
    }

    /// Writes the table.
    fn write_table(&self) -> PyResult<()> {
        let places: Vec<&str> = self.places.iter().map(String::as_str).collect();
        self.look(|results| results.write_table(&places, &self.kept)).map_err(|error| failed(&error))
    }
}

impl SweepResults {
    fn look<R>(&self, task: impl FnOnce(&mut Results) -> R) -> R {
        task(&mut self.results.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// What is kept.
#[derive(FromPyObject)]
enum Keep {
    Function(String),
    Probes(Vec<String>),
}

fn failed(error: &SweepError) -> PyErr {
    match error {
        SweepError::Files(..) => PyOSError::new_err(error.to_string()),
        _ => PyValueError::new_err(error.to_string()),
    }
}

/// A value as sweeps have it: what is no number is RON.
fn value_of(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    // numpy's numbers, too
    let plain = if value.hasattr("tolist")? { value.call_method0("tolist")? } else { value.clone() };
    if plain.is_instance_of::<PyBool>() {
        return Ok(Value::Word(plain.extract()?));
    }
    if plain.is_instance_of::<PyInt>() || plain.is_instance_of::<PyFloat>() {
        return Ok(Value::Number(plain.extract()?));
    }
    Ok(Value::Text(values::ron(value)?))
}

/// Whether a variant has the probes that are kept, and lasts as long as they are asked.
#[pyfunction]
pub fn check_kept(py: Python<'_>, scene: PyRef<'_, Scene>, names: Vec<String>, at: Vec<f64>) -> PyResult<()> {
    let kept = Kept::of(scene.file(), &names, &at);
    kept.map(drop).map_err(|what| errors::exception(py, "SceneError", what, PyDict::new(py)))
}

/// What probes see at the first of some ascending times (s), and at those of the others that need no further step.
#[pyfunction]
pub fn probes_at(
    py: Python<'_>,
    simulation: PyRef<'_, Simulation>,
    names: Vec<String>,
    times: Vec<f64>,
) -> PyResult<Vec<Vec<Vec<f64>>>> {
    let first = times.first().copied().unwrap_or_default();
    simulation.in_pieces(py, u64::MAX, |simulation, piece| {
        let before = simulation.step_count();
        simulation.advance_short_of(first, piece)?;
        Ok(simulation.step_count() - before == piece)
    })?;
    simulation.with(py, |run| run.stepping().probes_at(&names, &times))
}

/// What the guards have warned of.
#[pyfunction]
pub fn warnings_of(py: Python<'_>, simulation: PyRef<'_, Simulation>) -> PyResult<Vec<String>> {
    simulation.look(py, |run| warned(&run.simulation))
}

/// Rows of a Latin hypercube: so many, with a number from low to high for each place.
#[pyfunction]
pub fn latin_hypercube_rows(ranges: Vec<(String, (f64, f64))>, count: usize, seed: u64) -> PyResult<Vec<Vec<f64>>> {
    let variants = Variants::LatinHypercube { count, seed, places: ranges };
    variants.check().map_err(PyValueError::new_err)?;
    let number = |value: Value| if let Value::Number(number) = value { number } else { f64::NAN };
    Ok(variants.rows().into_iter().map(|row| row.into_iter().map(number).collect()).collect())
}

/// The file of a sweep: path of the scene, rows by place, probes, times.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn read_sweep_file<'py>(
    py: Python<'py>,
    path: PathBuf,
) -> PyResult<(PathBuf, Vec<Bound<'py, PyDict>>, Vec<String>, Vec<f64>)> {
    let file = SweepFile::load(&path).map_err(|error| failed(&error))?;
    let places = file.variants.places();
    let mut table = Vec::new();
    for row in file.variants.rows() {
        let values = PyDict::new(py);
        for (place, value) in places.iter().zip(row) {
            match value {
                Value::Word(word) => values.set_item(place, word)?,
                Value::Number(number) => values.set_item(place, number)?,
                Value::Text(text) => values.set_item(place, text)?,
            }
        }
        table.push(values);
    }
    let scene = path.parent().unwrap_or(std::path::Path::new("")).join(&file.scene);
    Ok((scene, table, file.keep, file.at))
}
