//! What is observed: probes, energies, the summary.

use crate::handle::{SinewSimulation, with};
use crate::memory::{Structure, fill, fill_text, text, write};
use crate::status::{Failure, SINEW_BUG, SinewStatus, entry};
use std::ffi::c_char;

/// Energies of all bodies (J). What is not counted in this scene is not a number (NAN).
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewEnergies {
    /// `sizeof(SinewEnergies)`.
    pub size: usize,
    /// Half of m v² in the middle of the last step.
    pub kinetic: f64,
    /// Elastic energy of the laws.
    pub strain: f64,
    /// In hourglass control.
    pub hourglass: f64,
    /// Of the work of loads, what springs hold and give back.
    pub held: f64,
    /// Of removed elements, when they went.
    pub removed: f64,
    /// Done by loads since the start.
    pub load_work: f64,
    /// Lost to damping since the start.
    pub damping_loss: f64,
    /// Taken by the formula of implicit steps since the start.
    pub scheme_loss: f64,
    /// Done by constraints since the start.
    pub constraint_work: f64,
    /// Done against internal forces since the start.
    pub internal_work: f64,
    /// Of the work of loads, what contact has taken since the start.
    pub contact_loss: f64,
}

// SAFETY: it is repr(C), begins with its size, and has numbers only
unsafe impl Structure for SinewEnergies {
    const NAME: &'static str = "SinewEnergies";
}

/// What a probe of the scene sees now: as many numbers as its table has columns after the time.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_probe(
    simulation: *mut SinewSimulation,
    name: *const c_char,
    buffer: *mut f64,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let name = text(name, "name")?;
        fill(&with(simulation, |state, _| Ok(state.simulation.probe(name)?))?, buffer, capacity, count)
    })
}

/// Energies now.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_energies(simulation: *mut SinewSimulation, energies: *mut SinewEnergies) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let now = with(simulation, |state, _| Ok(state.simulation.energies()?))?;
        let told = SinewEnergies {
            size: 0,
            kinetic: now.kinetic,
            strain: now.strain,
            hourglass: now.hourglass,
            held: now.held.unwrap_or(f64::NAN),
            removed: now.removed,
            load_work: now.load_work.unwrap_or(f64::NAN),
            damping_loss: now.damping_loss.unwrap_or(f64::NAN),
            scheme_loss: now.scheme_loss.unwrap_or(f64::NAN),
            constraint_work: now.constraint_work.unwrap_or(f64::NAN),
            internal_work: now.internal_work.unwrap_or(f64::NAN),
            contact_loss: now.contact_loss.unwrap_or(f64::NAN),
        };
        write(energies, told, "energies")
    })
}

/// What the run amounted to so far, as JSON: what `sinew run` writes as `summary.json`, with its end as `running` or
/// what went wrong. A text that ends with a 0, which `count` counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_summary_json(
    simulation: *mut SinewSimulation,
    buffer: *mut c_char,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let json = with(simulation, |state, _| {
            let ended = state.simulation.failure().map_or_else(|| "running".into(), ToString::to_string);
            let summary = state.simulation.summary(&ended)?;
            serde_json::to_string(&summary).map_err(|error| Failure::new(SINEW_BUG, error.to_string()))
        })?;
        fill_text(&json, buffer, capacity, count)
    })
}

/// What is not wrong with the scene but should be known: a text that ends with a 0, which `count` counts; 1 of nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_warnings(
    simulation: *const SinewSimulation,
    buffer: *mut c_char,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let told = with(simulation, |state, _| Ok(state.simulation.warnings().render(false)))?;
        fill_text(&told, buffer, capacity, count)
    })
}
