//! A simulation behind a pointer.

use crate::memory::{put, read};
use crate::options::SinewOptions;
use crate::status::{Failure, Outcome, SINEW_BUG, SinewStatus, entry};
use sinew::{GrabId, Simulation};
use std::collections::BTreeMap;
use std::ffi::{CString, c_char};
use std::sync::Mutex;

/// A simulation. One thread at a time is at work with it: another one waits.
pub struct SinewSimulation {
    state: Mutex<State>,
    /// By kind.
    names: [Vec<CString>; 5],
}

/// What calls work with.
pub(crate) struct State {
    pub simulation: Simulation,
    /// All that was ever grabbed, by the number that C has: what is released can be held again after going back.
    pub grabs: Vec<GrabId>,
    /// Of each body, the elements that were left when somebody asked, and how often that was another number.
    pub generations: BTreeMap<String, (Option<usize>, u64)>,
}

/// The names of bodies.
pub const SINEW_BODIES: i32 = 0;
/// The names of probes.
pub const SINEW_PROBES: i32 = 1;
/// The names of inputs.
pub const SINEW_INPUTS: i32 = 2;
/// The names of tools.
pub const SINEW_TOOLS: i32 = 3;
/// The names of ports.
pub const SINEW_PORTS: i32 = 4;

impl SinewSimulation {
    fn new(simulation: Simulation) -> Self {
        let scene = simulation.scene();
        let inputs = simulation.inputs();
        let c = |name: &String| CString::new(name.replace('\0', "\u{fffd}")).unwrap_or_default();
        let names = [
            scene.bodies.keys().map(c).collect(),
            scene.probes.keys().map(c).collect(),
            inputs.iter().map(|input| c(&input.name)).collect(),
            scene.tools.keys().map(c).collect(),
            simulation.ports().keys().map(c).collect(),
        ];
        Self { state: Mutex::new(State { simulation, grabs: Vec::new(), generations: BTreeMap::new() }), names }
    }

    fn names(&self, kind: i32) -> Outcome<&[CString]> {
        let names = usize::try_from(kind).ok().and_then(|kind| self.names.get(kind));
        let wrong = || Failure::argument(format!("`kind` is {kind}; SINEW_BODIES (0) to SINEW_PORTS (4) are allowed"));
        names.map(Vec::as_slice).ok_or_else(wrong)
    }

    /// The name of a body by its number.
    pub(crate) fn body_name(&self, number: u32) -> Outcome<&str> {
        let name = self.names[0].get(number as usize).and_then(|name| name.to_str().ok());
        name.ok_or_else(|| Failure::argument(format!("there is no body {number}; there are {}", self.names[0].len())))
    }

    /// The number of a body by its name.
    pub(crate) fn body_number(&self, name: &str) -> u32 {
        let place = self.names[0].iter().position(|other| other.as_bytes() == name.as_bytes());
        place.and_then(|place| u32::try_from(place).ok()).unwrap_or(u32::MAX)
    }
}

/// What a pointer leads to.
pub(crate) unsafe fn shared<'a, T>(pointer: *const T, what: &str) -> Outcome<&'a T> {
    // SAFETY: the caller has it from one of our functions and has not freed it
    unsafe { pointer.as_ref() }.ok_or_else(|| Failure::argument(format!("`{what}` is NULL")))
}

/// Works with a simulation; nobody else does meanwhile.
pub(crate) unsafe fn with<T>(
    simulation: *const SinewSimulation,
    work: impl FnOnce(&mut State, &SinewSimulation) -> Outcome<T>,
) -> Outcome<T> {
    // SAFETY: the caller has it from sinew_simulation_new and has not freed it
    let handle = unsafe { shared(simulation, "simulation") }?;
    let broken = |_| Failure::new(SINEW_BUG, "a call before ended in a mistake of sinew's own: free the simulation");
    let mut state = handle.state.lock().map_err(broken)?;
    work(&mut state, handle)
}

/// Frees what was made for C, if it is there.
pub(crate) unsafe fn free<T>(pointer: *mut T) {
    if !pointer.is_null() {
        // SAFETY: the caller has it from one of our functions, and this is the last that is done with it
        let owned = unsafe { Box::from_raw(pointer) };
        entry(|| {
            drop(owned);
            Ok(())
        });
    }
}

/// Makes a simulation of a scene and writes the pointer to it; NULL where the call fails. `sinew_simulation_free` ends
/// it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_simulation_new(
    options: *const SinewOptions,
    simulation: *mut *mut SinewSimulation,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        put(simulation, std::ptr::null_mut(), "simulation")?;
        let options = read(options, "options")?;
        let made = Simulation::new(&options.scene()?, &options.of_the_run()?)?;
        put(simulation, Box::into_raw(Box::new(SinewSimulation::new(made))), "simulation")
    })
}

/// Frees a simulation; NULL is allowed. Its names are gone with it; ports and snapshots stay.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_simulation_free(simulation: *mut SinewSimulation) {
    // SAFETY: as the header asks of callers
    unsafe { free(simulation) }
}

/// How many bodies, probes and so on the scene has: `kind` is one of `SINEW_BODIES` to `SINEW_PORTS`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_name_count(
    simulation: *const SinewSimulation,
    kind: i32,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe { put(count, shared(simulation, "simulation")?.names(kind)?.len(), "count") })
}

/// The name of a body, a probe and so on, by its place among those of its kind, counted from 0. The text stays until
/// the simulation is freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_name(
    simulation: *const SinewSimulation,
    kind: i32,
    place: usize,
    name: *mut *const c_char,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let names = shared(simulation, "simulation")?.names(kind)?;
        let wrong = || Failure::argument(format!("`place` is {place}; there are {} of this kind", names.len()));
        put(name, names.get(place).ok_or_else(wrong)?.as_ptr(), "name")
    })
}
