//! Steps, and the ways back. Long ones are taken in pieces, so that Ctrl-C is heard.

use crate::simulation::Simulation;
use crate::snapshot::Snapshot;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::Ended;
use std::time::{Duration, Instant};

/// About the time of a piece.
const PIECE: Duration = Duration::from_millis(50);

impl Simulation {
    /// Takes steps by `take`, which is given how many it may take at most and says whether there are more to come,
    /// until there are none or `count` were taken.
    pub fn in_pieces(
        &self,
        py: Python<'_>,
        mut count: u64,
        take: impl Fn(&mut sinew::Simulation, u64) -> Result<bool, sinew::Error> + Send + Sync,
    ) -> PyResult<()> {
        let mut most = 1;
        while count > 0 {
            let piece = most.min(count);
            let started = Instant::now();
            let more = self.with(py, |run| take(run.stepping(), piece))?;
            count -= piece;
            if !more {
                return Ok(());
            }
            most = match started.elapsed() < PIECE / 2 {
                true => most.saturating_mul(2),
                false => (most / 2).max(1),
            };
            py.check_signals()?;
        }
        Ok(())
    }
}

fn seconds(name: &str, value: f64) -> PyResult<Duration> {
    Duration::try_from_secs_f64(value)
        .map_err(|_| PyValueError::new_err(format!("`{name}` must be a number of seconds, 0 or above; it is {value}")))
}

#[pymethods]
impl Simulation {
    #[pyo3(signature = (count = 1))]
    fn step(&self, py: Python<'_>, count: u64) -> PyResult<()> {
        self.in_pieces(py, count, |simulation, piece| simulation.advance(piece).map(|()| true))
    }

    fn advance_to(&self, py: Python<'_>, time: f64) -> PyResult<()> {
        if !time.is_finite() {
            return Err(PyValueError::new_err(format!("steps cannot be taken until t = {time} s")));
        }
        self.in_pieces(py, u64::MAX, |simulation, piece| simulation.advance_towards(time, piece))
    }

    #[pyo3(signature = (budget, until = f64::INFINITY))]
    fn advance_for<'py>(&self, py: Python<'py>, budget: f64, until: f64) -> PyResult<Bound<'py, PyDict>> {
        let (started, budget) = (Instant::now(), seconds("budget", budget)?);
        let (mut steps, mut simulated) = (0, 0.0);
        let why = loop {
            let left = budget.saturating_sub(started.elapsed());
            let advanced = self.with(py, |run| run.stepping().advance_for(left.min(PIECE), until))?;
            (steps, simulated) = (steps + advanced.steps, simulated + advanced.simulated);
            let a_step = advanced.took / u32::try_from(advanced.steps).unwrap_or(u32::MAX).max(1);
            py.check_signals()?;
            match advanced.why {
                Ended::Budget if started.elapsed() + a_step < budget => {}
                Ended::Budget => break "budget",
                Ended::Reached => break "reached",
                Ended::Rest => break "rest",
            }
        };
        let took = started.elapsed().as_secs_f64();
        let told = PyDict::new(py);
        told.set_item("steps", steps)?;
        told.set_item("simulated", simulated)?;
        told.set_item("took", took)?;
        told.set_item("real_time_factor", if took > 0.0 { simulated / took } else { 0.0 })?;
        told.set_item("why", why)?;
        Ok(told)
    }

    fn finish(&self, py: Python<'_>) -> PyResult<()> {
        self.in_pieces(py, u64::MAX, |simulation, piece| {
            simulation.advance_towards_end(piece)?;
            Ok(!simulation.is_finished())
        })
    }

    fn snapshot(&self, py: Python<'_>) -> PyResult<Snapshot> {
        self.with(py, |run| run.simulation.snapshot()).map(Snapshot)
    }

    fn restore(&self, py: Python<'_>, snapshot: Py<Snapshot>) -> PyResult<()> {
        let snapshot = &snapshot.get().0;
        self.with(py, |run| run.leave().restore(snapshot))
    }

    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.with(py, |run| run.leave().reset())
    }

    #[pyo3(signature = (every, *, bytes = 256 << 20))]
    fn keep_history(&self, py: Python<'_>, every: f64, bytes: usize) -> PyResult<()> {
        self.with(py, |run| run.simulation.keep_history(every, bytes))
    }

    fn forget_history(&self, py: Python<'_>) -> PyResult<()> {
        self.look(py, |run| run.simulation.forget_history())
    }

    #[getter]
    fn history(&self, py: Python<'_>) -> PyResult<Vec<f64>> {
        self.look(py, |run| run.simulation.history())
    }

    fn rewind(&self, py: Python<'_>, time: f64) -> PyResult<f64> {
        self.with(py, |run| run.leave().rewind(time))
    }
}
