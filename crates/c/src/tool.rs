//! What tools of the scene feel.

use crate::handle::{SinewSimulation, with};
use crate::memory::{Structure, text, write};
use crate::status::{SinewStatus, entry};
use std::ffi::c_char;

/// What a tool feels: forces are those of the beginning of the last step.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SinewTool {
    /// `sizeof(SinewTool)`.
    pub size: usize,
    /// How many nodes it touches or holds.
    pub nodes: u64,
    /// The force on it (N).
    pub force: [f64; 3],
    /// The moment of this force about its origin (N m).
    pub torque: [f64; 3],
    /// Where its origin is (m).
    pub place: [f64; 3],
    /// The part of the force that is of what it sucks (N).
    pub suction: [f64; 3],
    /// How deep the deepest node is inside it (m).
    pub penetration: f64,
    /// The work that it has done since the start (J); NaN in a static analysis, which counts none.
    pub work: f64,
    /// What of it impact, friction and catching nodes have taken (J); NaN likewise.
    pub loss: f64,
    /// How many nodes slipped out of its grasps when these were closed last.
    pub slipped: u64,
}

// SAFETY: it is repr(C), begins with its size, and has numbers only
unsafe impl Structure for SinewTool {
    const NAME: &'static str = "SinewTool";
}

/// What a tool of the scene feels.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_tool(
    simulation: *mut SinewSimulation,
    name: *const c_char,
    tool: *mut SinewTool,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let name = text(name, "name")?;
        let felt = with(simulation, |state, _| Ok(state.simulation.tool(name)?))?;
        let told = SinewTool {
            size: 0,
            nodes: felt.nodes as u64,
            force: felt.force.to_array(),
            torque: felt.torque.to_array(),
            place: felt.place.to_array(),
            suction: felt.suction.to_array(),
            penetration: felt.penetration,
            work: felt.work.unwrap_or(f64::NAN),
            loss: felt.loss.unwrap_or(f64::NAN),
            slipped: felt.slipped as u64,
        };
        write(tool, told, "tool")
    })
}
