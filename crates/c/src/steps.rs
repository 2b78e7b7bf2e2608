//! Steps and time.

use crate::handle::{SinewSimulation, with};
use crate::memory::{Structure, size_of_callers, write};
use crate::status::{Failure, SinewStatus, entry};
use sinew::Ended;
use std::time::Duration;

/// The time that was wanted is reached.
pub const SINEW_ENDED_REACHED: i32 = 0;
/// The budget is spent: what falls short is not caught up later.
pub const SINEW_ENDED_BUDGET: i32 = 1;
/// A static analysis is at rest.
pub const SINEW_ENDED_REST: i32 = 2;

/// Where a simulation is.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewClock {
    /// `sizeof(SinewClock)`.
    pub size: usize,
    /// Simulated time (s).
    pub time: f64,
    /// The present step (s).
    pub time_step: f64,
    /// What the scene lasts (s).
    pub duration: f64,
    /// Steps taken.
    pub steps: u64,
}

/// What `sinew_advance_for` did.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewAdvanced {
    /// `sizeof(SinewAdvanced)`.
    pub size: usize,
    /// Steps taken.
    pub steps: u64,
    /// Simulated time that they took (s).
    pub simulated: f64,
    /// What that took on the clock on the wall (s).
    pub took: f64,
    /// The longest of the batches in which steps were taken (s): by no more than that the budget is overdrawn.
    pub longest_batch: f64,
    /// `SINEW_ENDED_REACHED`, `_BUDGET` or `_REST`.
    pub why: i32,
    /// 0.
    pub reserved: i32,
}

// SAFETY: they are repr(C), begin with their sizes, and have numbers only
unsafe impl Structure for SinewClock {
    const NAME: &'static str = "SinewClock";
}
// SAFETY: as above
unsafe impl Structure for SinewAdvanced {
    const NAME: &'static str = "SinewAdvanced";
}

/// Takes so many steps.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_step(simulation: *mut SinewSimulation, count: u64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe { with(simulation, |state, _| Ok(state.simulation.advance(count)?)) })
}

/// Takes steps until the clock shows at least `time` (s).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_advance_to(simulation: *mut SinewSimulation, time: f64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        with(simulation, |state, _| {
            if !time.is_finite() {
                return Err(Failure::argument(format!("`time` is {time}: it must be a finite number")));
            }
            Ok(state.simulation.advance_to(time)?)
        })
    })
}

/// Takes as many steps as fit into a budget of time on the wall (s), one at least, until the clock shows at least
/// `until` (s). `advanced` may be NULL. The caller keeps the pace: `real_time` of a scene waits for nothing here.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_advance_for(
    simulation: *mut SinewSimulation,
    budget: f64,
    until: f64,
    advanced: *mut SinewAdvanced,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let time = Duration::try_from_secs_f64(budget)
            .map_err(|_| Failure::argument(format!("`budget` is {budget}: it must be a time in s, 0 or above")))?;
        if !advanced.is_null() {
            size_of_callers(advanced, "advanced")?;
        }
        let done = with(simulation, |state, _| Ok(state.simulation.advance_for(time, until)?))?;
        if advanced.is_null() {
            return Ok(());
        }
        let why = match done.why {
            Ended::Reached => SINEW_ENDED_REACHED,
            Ended::Budget => SINEW_ENDED_BUDGET,
            Ended::Rest => SINEW_ENDED_REST,
        };
        let told = SinewAdvanced {
            size: 0,
            steps: done.steps,
            simulated: done.simulated,
            took: done.took.as_secs_f64(),
            longest_batch: done.longest_batch.as_secs_f64(),
            why,
            reserved: 0,
        };
        write(advanced, told, "advanced")
    })
}

/// Where the simulation is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_clock(simulation: *const SinewSimulation, clock: *mut SinewClock) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let told = with(simulation, |state, _| {
            let simulation = &state.simulation;
            Ok(SinewClock {
                size: 0,
                time: simulation.time(),
                time_step: simulation.time_step(),
                duration: simulation.scene().duration,
                steps: simulation.step_count(),
            })
        })?;
        write(clock, told, "clock")
    })
}
