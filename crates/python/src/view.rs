//! Columns of the engine as numpy arrays without a copy. ! ! Such an array shows memory that the simulation owns. It
//stays allocated as long as the array lives: ! ! * Explicit steps on the CPU write a column where it lies, so that the
//array shows the present state. ! * Whatever else may put another column in its place (going back, a change of the
//scene, implicit steps, static !   analyses, a GPU's copy to the host) is preceded by [`Lent::hand_over`]: the
//simulation goes on with a copy, and the !   array keeps the old memory, with the state that it showed. ! * A
//simulation that is dropped leaves its arrays their memory in the same way. ! ! Numpy is told the address by its array
//interface, as read-only. Who reads an array in one thread while another thread ! steps may see old and new numbers
//mixed, as with any array that two threads share.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sinew::components::{Displacement, Precision, Reals};
use std::sync::{Arc, OnceLock, Weak};

/// Where the memory is once the simulation has left it to the arrays that show it.
type Kept = OnceLock<Reals>;

/// All columns that arrays show.
#[derive(Default)]
pub struct Lent {
    columns: Vec<(String, Weak<Kept>)>,
    /// How often arrays were left behind.
    generation: u64,
}

/// A column as it lies in memory.
pub struct Column {
    address: usize,
    length: usize,
    precision: Precision,
    /// What the memory is left to, as long as an array shows it.
    _kept: Arc<Kept>,
}

impl Lent {
    /// How often arrays may have been left behind: one that was made at another number shows a state of the past.
    pub fn generation(&self) -> u64 {
        self.generation
    }

    /// The displacements of a body.
    pub fn displacement(&mut self, simulation: &mut sinew::Simulation, body: &str) -> Result<Column, sinew::Error> {
        if simulation.is_on_gpu() {
            // newer numbers may come from there, and older arrays keep theirs
            self.hand_over(simulation);
        }
        let values = simulation.column::<Displacement>(body)?.values();
        let address = match values {
            Reals::F32(values) => values.as_ptr().addr(),
            Reals::F64(values) => values.as_ptr().addr(),
        };
        let (length, precision) = (values.len(), values.precision());
        self.columns.retain(|(_, kept)| kept.strong_count() > 0);
        let known = self.columns.iter().find(|(name, _)| name == body).and_then(|(_, kept)| kept.upgrade());
        let kept = known.unwrap_or_else(|| {
            let kept = Arc::new(Kept::new());
            self.columns.push((body.to_owned(), Arc::downgrade(&kept)));
            kept
        });
        Ok(Column { address, length, precision, _kept: kept })
    }

    /// Leaves the arrays their memory; the simulation goes on with a copy of it.
    pub fn hand_over(&mut self, simulation: &mut sinew::Simulation) {
        self.generation += 1;
        self.leave(simulation, Reals::clone);
    }

    /// The same for a simulation that ends: nothing is put in its place.
    pub fn end(&mut self, simulation: &mut sinew::Simulation) {
        self.leave(simulation, |column| Reals::zeros(column.precision(), 0));
    }

    fn leave(&mut self, simulation: &mut sinew::Simulation, instead: impl Fn(&Reals) -> Reals) {
        for (body, kept) in self.columns.drain(..) {
            let Some(kept) = kept.upgrade() else { continue };
            let Ok(entity) = simulation.body(&body) else { continue };
            let Some(mut column) = simulation.world_mut().get_mut::<Displacement>(entity) else { continue };
            // what moves is the owner of the memory, not the memory
            let new = instead(&column.0);
            let _ = kept.set(std::mem::replace(&mut column.0, new));
        }
    }
}

/// What a numpy array without a copy holds on to.
#[pyclass(frozen, module = "sinew")]
struct Shown(Column);

#[pymethods]
impl Shown {
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Column { address, length, precision, .. } = self.0;
        let size = if precision == Precision::F32 { 4 } else { 8 };
        let order = if cfg!(target_endian = "little") { '<' } else { '>' };
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("shape", (length / 3, 3))?;
        interface.set_item("typestr", format!("{order}f{size}"))?;
        let read_only = true;
        interface.set_item("data", (address, read_only))?;
        Ok(interface)
    }
}

impl Column {
    /// The array: vectors, one a row, in the run's precision.
    pub fn array(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        py.import("numpy")?.call_method1("asarray", (Bound::new(py, Shown(self))?,))
    }
}
