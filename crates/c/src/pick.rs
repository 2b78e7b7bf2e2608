//! Picking and grabbing.

use crate::handle::{SinewSimulation, State, with};
use crate::memory::{Structure, put, put_vector, read, text, values, vector, write};
use crate::status::{Failure, Outcome, SinewStatus, entry};
use glam::DVec3;
use sinew::{GrabId, Grip, Pick};
use std::ffi::c_char;

/// Where a ray meets a body.
#[derive(Clone, Copy, Default)]
#[repr(C)]
pub struct SinewPick {
    /// `sizeof(SinewPick)`.
    pub size: usize,
    /// 1 if the ray meets a body; 0 if not, and then all else is 0.
    pub hit: i32,
    /// The body's place among `SINEW_BODIES`.
    pub body: u32,
    /// The author's number of the element behind the face.
    pub element: u64,
    /// The triangle that the ray meets: places of its nodes.
    pub nodes: [u32; 3],
    /// 0.
    pub reserved: u32,
    /// Barycentric coordinates of the point in it: the weights of its nodes, which sum up to 1.
    pub weights: [f64; 3],
    /// The point (m).
    pub point: [f64; 3],
    /// The triangle's outward normal, of length 1.
    pub normal: [f64; 3],
    /// From the ray's origin (m).
    pub distance: f64,
}

/// How a hand holds: all that is 0 is chosen so that no step has to follow.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewGrip {
    /// `sizeof(SinewGrip)`.
    pub size: usize,
    /// Stiffness of the spring (N/m); 0: as stiff as the step allows.
    pub stiffness: f64,
    /// Damping of the damper (N s/m); 0: critical.
    pub damping: f64,
    /// The largest force (N); 0: any.
    pub most_force: f64,
}

// SAFETY: they are repr(C), begin with their sizes, and have numbers only
unsafe impl Structure for SinewPick {
    const NAME: &'static str = "SinewPick";
}
// SAFETY: as above
unsafe impl Structure for SinewGrip {
    const NAME: &'static str = "SinewGrip";
}

impl SinewPick {
    fn new(pick: &Pick, body: u32) -> Self {
        Self {
            size: 0,
            hit: 1,
            body,
            element: pick.element,
            nodes: pick.nodes,
            reserved: 0,
            weights: pick.weights,
            point: pick.point.to_array(),
            normal: pick.normal.to_array(),
            distance: pick.distance,
        }
    }
}

unsafe fn grip(from: *const SinewGrip) -> Outcome<Grip> {
    if from.is_null() {
        return Ok(Grip::default());
    }
    // SAFETY: as the header asks of callers
    let SinewGrip { stiffness, damping, most_force, .. } = unsafe { read(from, "grip") }?;
    let given = |value: f64| (value != 0.0).then_some(value);
    let most_force = given(most_force).unwrap_or(f64::INFINITY);
    Ok(Grip { stiffness: given(stiffness), damping: given(damping), most_force })
}

impl State {
    fn grab(&mut self, body: &str, nodes: &[(usize, f64)], grip: &Grip) -> Outcome<u64> {
        let id = self.simulation.grab_nodes(body, nodes, grip)?;
        self.grabs.push(id);
        Ok(self.grabs.len() as u64 - 1)
    }

    fn grab_id(&self, grab: u64) -> Outcome<GrabId> {
        let found = usize::try_from(grab).ok().and_then(|place| self.grabs.get(place)).copied();
        found.ok_or_else(|| Failure::argument(format!("`grab` is {grab}: nothing was grabbed by that number")))
    }
}

/// Where a ray first meets the surface of a body, as it is now. `origin` (m) and `direction` (of any length) are three
/// numbers each. A miss is `SINEW_OK` with `hit` 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_pick(
    simulation: *mut SinewSimulation,
    origin: *const f64,
    direction: *const f64,
    pick: *mut SinewPick,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let (origin, direction) = (vector(origin, "origin")?, vector(direction, "direction")?);
        let found = with(simulation, |state, handle| {
            let found = state.simulation.pick(origin, direction)?;
            Ok(found.map_or_else(SinewPick::default, |pick| SinewPick::new(&pick, handle.body_number(&pick.body))))
        })?;
        write(pick, found, "pick")
    })
}

/// Grabs the point that was picked: from the next step on a spring and a damper pull it to a target, at first where it
/// is. `grip` may be NULL. The options of the simulation must have `grabs` 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_grab(
    simulation: *mut SinewSimulation,
    pick: *const SinewPick,
    grip_or_null: *const SinewGrip,
    grab: *mut u64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let (pick, grip) = (read(pick, "pick")?, grip(grip_or_null)?);
        put(grab, u64::MAX, "grab")?;
        if pick.hit != 1 {
            return Err(Failure::argument("`pick->hit` is not 1: there is nothing to grab"));
        }
        let nodes = [0, 1, 2].map(|i| (pick.nodes[i] as usize, pick.weights[i].max(0.0)));
        put(grab, with(simulation, |state, handle| state.grab(handle.body_name(pick.body)?, &nodes, &grip))?, "grab")
    })
}

/// Grabs the weighted mean of `count` nodes, by their places in the author's order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_grab_nodes(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    nodes: *const u32,
    weights: *const f64,
    count: usize,
    grip_or_null: *const SinewGrip,
    grab: *mut u64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let (body, grip) = (text(body, "body")?, grip(grip_or_null)?);
        put(grab, u64::MAX, "grab")?;
        let (nodes, weights) = (values(nodes, count, "nodes")?, values(weights, count, "weights")?);
        let nodes: Vec<(usize, f64)> = nodes.iter().map(|node| *node as usize).zip(weights.iter().copied()).collect();
        put(grab, with(simulation, |state, _| state.grab(body, &nodes, &grip))?, "grab")
    })
}

/// Moves the target of a grab: three numbers (m).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_grab_move(
    simulation: *mut SinewSimulation,
    grab: u64,
    target: *const f64,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let target = vector(target, "target")?;
        with(simulation, |state, _| Ok(state.simulation.move_grab(state.grab_id(grab)?, target)?))
    })
}

/// The force with which a grab pulls: three numbers (N).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_grab_force(simulation: *mut SinewSimulation, grab: u64, force: *mut f64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let pull: DVec3 = with(simulation, |state, _| Ok(state.simulation.grab_force(state.grab_id(grab)?)?))?;
        put_vector(force, pull, "force")
    })
}

/// Lets go.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_release(simulation: *mut SinewSimulation, grab: u64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe { with(simulation, |state, _| Ok(state.simulation.release(state.grab_id(grab)?)?)) })
}
