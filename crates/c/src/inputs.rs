//! What a program changes while it runs.

use crate::handle::{SinewSimulation, with};
use crate::memory::{put, text};
use crate::options::texts;
use crate::status::{Failure, SinewStatus, entry};
use std::ffi::c_char;

/// Sets an input of the scene (`curve: Input(name: ...)`): from the next step on it goes there, no faster than its
/// rate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_input_set(
    simulation: *mut SinewSimulation,
    name: *const c_char,
    value: f64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let name = text(name, "name")?;
        with(simulation, |state, _| Ok(state.simulation.set_input(name, value)?))
    })
}

/// What an input is at the present time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_input_get(
    simulation: *const SinewSimulation,
    name: *const c_char,
    value: *mut f64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let name = text(name, "name")?;
        let found = with(simulation, |state, _| {
            let inputs = state.simulation.inputs();
            let names = || inputs.iter().map(|input| input.name.as_str()).collect::<Vec<_>>().join(", ");
            let wrong = || Failure::argument(format!("there is no input named {name:?}; there is {}", names()));
            inputs.iter().find(|input| input.name == name).map(|input| input.value).ok_or_else(wrong)
        })?;
        put(value, found, "value")
    })
}

/// Changes parameters of materials and amplitudes of loads while it runs, in the words of `--set`:
/// `"materials.liver.neo_hookean=Young(young: 5e3, poisson: 0.45)"`. All of them or, where one is refused, none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_change(
    simulation: *mut SinewSimulation,
    sets: *const *const c_char,
    set_count: usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let sets = texts(sets, set_count, "sets")?;
        with(simulation, |state, _| Ok(state.simulation.change(&sets)?))
    })
}
