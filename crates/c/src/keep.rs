//! Going back: to the start, to snapshots, along the history.

use crate::handle::{SinewSimulation, State, free, shared, with};
use crate::memory::{fill, put, values};
use crate::status::{Outcome, SinewStatus, entry};
use sinew::{Error, Snapshot};

/// The state of a simulation between two steps. It may be used by several threads at once.
pub struct SinewSnapshot {
    snapshot: Snapshot,
}

impl State {
    /// After going back the surface may be any, and what a snapshot held is held.
    fn went_back(&mut self) {
        for (left, _) in self.generations.values_mut() {
            *left = None;
        }
        let held: Vec<_> = self.simulation.grabs().map(|(id, _)| id).filter(|id| !self.grabs.contains(id)).collect();
        self.grabs.extend(held);
    }
}

/// Writes a pointer to a new snapshot.
unsafe fn hand_out(snapshot: Snapshot, to: *mut *mut SinewSnapshot) -> Outcome {
    // SAFETY: the caller has room for a pointer there
    unsafe { put(to, Box::into_raw(Box::new(SinewSnapshot { snapshot })), "snapshot") }
}

/// Goes back to the state before the first step, with all inputs at their initial values and nothing held: the same
/// steps give the same bits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_reset(simulation: *mut SinewSimulation) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        with(simulation, |state, _| {
            state.simulation.reset()?;
            state.went_back();
            Ok(())
        })
    })
}

/// The present state; NULL where the call fails. `sinew_snapshot_free` ends it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_snapshot(
    simulation: *mut SinewSimulation,
    snapshot: *mut *mut SinewSnapshot,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        put(snapshot, std::ptr::null_mut(), "snapshot")?;
        hand_out(with(simulation, |state, _| Ok(state.simulation.snapshot()?))?, snapshot)
    })
}

/// Goes back to a snapshot of this simulation or one of the same scene, text and options: what goes on from it gives
/// the same bits as before. What does not fit is refused, and nothing has changed. What is held in a snapshot of
/// another process has no numbers here yet: it gets the next ones that `sinew_grab` would give, in the order in which
/// it was grabbed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_restore(
    simulation: *mut SinewSimulation,
    snapshot: *const SinewSnapshot,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let snapshot = shared(snapshot, "snapshot")?;
        with(simulation, |state, _| {
            state.simulation.restore(&snapshot.snapshot)?;
            state.went_back();
            Ok(())
        })
    })
}

/// The snapshot as bytes, as `sinew run --resume` takes them from a file: to keep, and to go on from in another
/// process.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_snapshot_bytes(
    snapshot: *const SinewSnapshot,
    buffer: *mut u8,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let bytes = shared(snapshot, "snapshot")?.snapshot.to_bytes().map_err(Error::from)?;
        fill(&bytes, buffer, capacity, count)
    })
}

/// The snapshot that bytes hold; NULL where the call fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_snapshot_of_bytes(
    bytes: *const u8,
    size: usize,
    snapshot: *mut *mut SinewSnapshot,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        put(snapshot, std::ptr::null_mut(), "snapshot")?;
        let read = Snapshot::from_bytes(values(bytes, size, "bytes")?).map_err(Error::from)?;
        hand_out(read, snapshot)
    })
}

/// Frees a snapshot; NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_snapshot_free(snapshot: *mut SinewSnapshot) {
    // SAFETY: as the header asks of callers
    unsafe { free(snapshot) }
}

/// Keeps a state now and whenever so much simulated time has passed (s), as many as fit into the bytes; the oldest go
/// first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_keep_history(simulation: *mut SinewSimulation, every: f64, bytes: usize) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe { with(simulation, |state, _| Ok(state.simulation.keep_history(every, bytes)?)) })
}

/// Goes back to the last state kept that is not later than a time (s), or to that before the first step. `reached` is
/// its time (s) and may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_rewind(simulation: *mut SinewSimulation, to: f64, reached: *mut f64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let time = with(simulation, |state, _| {
            let time = state.simulation.rewind(to)?;
            state.went_back();
            Ok(time)
        })?;
        if reached.is_null() { Ok(()) } else { put(reached, time, "reached") }
    })
}
