//! The soft-tissue engine sinew in Python: the module `sinew._sinew`, of which `python/sinew` makes a package.
//!
//! No Python code runs while a simulation is locked, and the engine works with the interpreter released: [`simulation`]
//! has the one function that all calls go through. There is no `unsafe`; [`view`] says why arrays without copies
//! are sound.

mod arrays;
mod body;
mod errors;
mod grab;
mod inputs;
mod picture;
mod reading;
mod scene;
mod simulation;
mod snapshot;
mod stepping;
mod sweep;
mod values;
mod view;

use pyo3::prelude::*;

/// The engine.
#[pymodule]
fn _sinew(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<simulation::Simulation>()?;
    module.add_class::<inputs::Inputs>()?;
    module.add_class::<body::Body>()?;
    module.add_class::<grab::Pick>()?;
    module.add_class::<grab::Grab>()?;
    module.add_class::<snapshot::Snapshot>()?;
    module.add_class::<picture::Picture>()?;
    module.add_class::<sweep::SweepResults>()?;
    module.add_function(wrap_pyfunction!(sweep::check_kept, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::probes_at, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::warnings_of, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::latin_hypercube_rows, module)?)?;
    module.add_function(wrap_pyfunction!(sweep::read_sweep_file, module)?)
}
