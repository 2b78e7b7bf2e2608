//! The port of a device that a hand holds: poses in, forces out, in a thread of its own.

use crate::handle::{SinewSimulation, free, shared, with};
use crate::memory::{Structure, put, put_vector, read, text, write};
use crate::status::{Failure, Outcome, SINEW_BUG, SinewStatus, entry};
use glam::{DQuat, DVec3};
use sinew::port::{DevicePose, ToolPort, Touch, VirtualCoupling};
use std::ffi::c_char;
use std::sync::{Mutex, MutexGuard};

/// The device's end of a port, for the thread of the device. It does not wait for the simulation and outlives it.
pub struct SinewPort {
    ends: Mutex<(ToolPort, VirtualCoupling)>,
}

/// The virtual coupling that makes the force for the hand.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewCoupling {
    /// `sizeof(SinewCoupling)`.
    pub size: usize,
    /// Stiffness (N/m).
    pub stiffness: f64,
    /// Damping (N s/m).
    pub damping: f64,
    /// The device's largest force (N).
    pub most_force: f64,
    /// The share of the force on the tool that is passed on at once: 0 for a proxy.
    pub feed_forward: f64,
}

/// Where a device is.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewPose {
    /// `sizeof(SinewPose)`.
    pub size: usize,
    /// When, by the device's own clock (s); it must not go back.
    pub time: f64,
    /// Where it is, in the scene's axes (m).
    pub place: [f64; 3],
    /// How it is turned, from the tool's axes to the scene's: a quaternion x, y, z, w; 0, 0, 0, 0: it is not.
    pub orientation: [f64; 4],
    /// How fast it goes (m/s).
    pub velocity: [f64; 3],
    /// How fast it turns (rad/s).
    pub spin: [f64; 3],
    /// Buttons that are pressed, a bit each.
    pub buttons: u64,
}

/// What the tool did and felt in the last batch of steps.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewTouch {
    /// `sizeof(SinewTouch)`.
    pub size: usize,
    /// Its number: 1, 2, 3 ...; 0 before the first.
    pub sequence: u64,
    /// Simulated time at the end of the batch (s).
    pub time: f64,
    /// Where the tool is (m).
    pub place: [f64; 3],
    /// How it is turned: x, y, z, w.
    pub orientation: [f64; 4],
    /// How fast it went (m/s).
    pub velocity: [f64; 3],
    /// The force on it, the mean over the batch (N); of what it sucks that of the batch's last step.
    pub force: [f64; 3],
    /// The moment of that force about the tool's origin (N m).
    pub torque: [f64; 3],
    /// The direction of the force; 0 where the tool feels nothing.
    pub normal: [f64; 3],
    /// Stiffness along the normal (N/m).
    pub stiffness: f64,
    /// What the batch took on the wall over its simulated time: below 1 is faster than real time.
    pub real_time_factor: f64,
    /// The number of the pose that the batch went to; 0 where none had come since the port was opened and since the
    /// run last went back.
    pub answers: u64,
    /// 1 if it touched or held anything during the batch, or sucks at something at its end.
    pub in_contact: i32,
    /// 0.
    pub reserved: i32,
}

// SAFETY: they are repr(C), begin with their sizes, and have numbers only
unsafe impl Structure for SinewCoupling {
    const NAME: &'static str = "SinewCoupling";
}
// SAFETY: as above
unsafe impl Structure for SinewPose {
    const NAME: &'static str = "SinewPose";
}
// SAFETY: as above
unsafe impl Structure for SinewTouch {
    const NAME: &'static str = "SinewTouch";
}

impl From<SinewPose> for DevicePose {
    fn from(pose: SinewPose) -> Self {
        let turned = pose.orientation != [0.0; 4];
        Self {
            time: pose.time,
            place: DVec3::from(pose.place),
            orientation: if turned { DQuat::from_array(pose.orientation) } else { DQuat::IDENTITY },
            velocity: DVec3::from(pose.velocity),
            spin: DVec3::from(pose.spin),
            buttons: pose.buttons,
            sequence: 0,
        }
    }
}

impl From<Touch> for SinewTouch {
    fn from(touch: Touch) -> Self {
        Self {
            size: 0,
            sequence: touch.sequence,
            time: touch.time,
            place: touch.place.to_array(),
            orientation: touch.orientation.to_array(),
            velocity: touch.velocity.to_array(),
            force: touch.force.to_array(),
            torque: touch.torque.to_array(),
            normal: touch.normal.to_array(),
            stiffness: touch.stiffness,
            real_time_factor: touch.real_time_factor,
            answers: touch.answers,
            in_contact: i32::from(touch.in_contact),
            reserved: 0,
        }
    }
}

unsafe fn ends<'a>(port: *const SinewPort) -> Outcome<MutexGuard<'a, (ToolPort, VirtualCoupling)>> {
    // SAFETY: the caller has it from sinew_port_open and has not freed it
    let port = unsafe { shared(port, "port") }?;
    port.ends
        .lock()
        .map_err(|_| Failure::new(SINEW_BUG, "a call before ended in a mistake of sinew's own: free the port"))
}

/// Opens a port of the scene (`port: (name: ...)` of a tool) for the device that moves the tool; NULL where the call
/// fails. One that was opened before is not heard any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_port_open(
    simulation: *mut SinewSimulation,
    name: *const c_char,
    coupling: *const SinewCoupling,
    port: *mut *mut SinewPort,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        put(port, std::ptr::null_mut(), "port")?;
        let (name, coupling) = (text(name, "name")?, read(coupling, "coupling")?);
        let SinewCoupling { stiffness, damping, most_force, feed_forward, .. } = coupling;
        if ![stiffness, damping, most_force, feed_forward].iter().all(|number| number.is_finite() && *number >= 0.0) {
            return Err(Failure::argument("the numbers of `coupling` must be finite, and 0 or above"));
        }
        let (end, batch) = with(simulation, |state, _| {
            let end = state.simulation.open_port(name)?;
            let mut ports = state.simulation.scene().tools.values().filter_map(|tool| tool.port.as_ref());
            let every = ports.find(|port| port.name == name).map(|port| port.every);
            // a batch is a step at least
            Ok((end, every.map(|every| every.max(state.simulation.time_step()))))
        })?;
        let mut coupling = VirtualCoupling::new(stiffness, damping, most_force);
        coupling.feed_forward = feed_forward;
        coupling.batch = batch.unwrap_or(coupling.batch);
        put(port, Box::into_raw(Box::new(SinewPort { ends: Mutex::new((end, coupling)) })), "port")
    })
}

/// A tick of the device: says where it is and gives the force for the hand (three numbers, N). It does not wait.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_port_tick(port: *mut SinewPort, pose: *const SinewPose, force: *mut f64) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        put_vector(force, DVec3::ZERO, "force")?;
        let pose = DevicePose::from(read(pose, "pose")?);
        let (end, coupling) = &mut *ends(port)?;
        end.send(&pose);
        let touch = end.touch();
        put_vector(force, coupling.force(&touch, pose.place, pose.velocity, pose.time), "force")
    })
}

/// Says where the device is, where it makes its forces itself.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_port_send(port: *mut SinewPort, pose: *const SinewPose) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let pose = DevicePose::from(read(pose, "pose")?);
        ends(port)?.0.send(&pose);
        Ok(())
    })
}

/// The last touch that came; before the first one all of it is 0 but the orientation, which is 0, 0, 0, 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_port_touch(port: *mut SinewPort, touch: *mut SinewTouch) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe { write(touch, SinewTouch::from(ends(port)?.0.touch()), "touch") })
}

/// Frees a port; NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_port_free(port: *mut SinewPort) {
    // SAFETY: as the header asks of callers
    unsafe { free(port) }
}
