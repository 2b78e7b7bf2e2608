//! Fields of a body.

use crate::geometry::numbers;
use crate::handle::{SinewSimulation, State, with};
use crate::memory::{fill, text};
use crate::status::{Failure, Outcome, SinewStatus, entry};
use std::ffi::c_char;

/// Displacement of each node: x, y, z (m).
pub const SINEW_FIELD_DISPLACEMENT: i32 = 0;
/// Velocity of each node in the middle of the last step: x, y, z (m/s).
pub const SINEW_FIELD_VELOCITY: i32 = 1;
/// Where each node is at rest: x, y, z (m).
pub const SINEW_FIELD_REST_POSITION: i32 = 2;
/// Internal force on each node: x, y, z (N).
pub const SINEW_FIELD_INTERNAL_FORCE: i32 = 3;
/// Lumped mass of each node (kg).
pub const SINEW_FIELD_MASS: i32 = 4;
/// Volume ratio J of each element.
pub const SINEW_FIELD_VOLUME_RATIO: i32 = 5;
/// Cauchy stress of each element: xx, yy, zz, xy, yz, xz (Pa); 0 once removed.
pub const SINEW_FIELD_STRESS: i32 = 6;
/// 1 for each element that is there, 0 for each that is removed.
pub const SINEW_FIELD_ALIVE: i32 = 7;

impl State {
    fn field(&mut self, body: &str, field: i32) -> Outcome<Vec<f32>> {
        let simulation = &mut self.simulation;
        let plain = |values: &[f64]| values.iter().map(|value| *value as f32).collect();
        Ok(match field {
            SINEW_FIELD_DISPLACEMENT => numbers(&simulation.displacements(body)?),
            SINEW_FIELD_VELOCITY => numbers(&simulation.fields(body)?.velocity),
            SINEW_FIELD_REST_POSITION => numbers(&simulation.rest_positions(body)?),
            SINEW_FIELD_INTERNAL_FORCE => numbers(&simulation.internal_forces(body)?),
            SINEW_FIELD_MASS => plain(&simulation.masses(body)?),
            SINEW_FIELD_VOLUME_RATIO => plain(&simulation.fields(body)?.volume_ratio),
            SINEW_FIELD_STRESS => plain(simulation.fields(body)?.stress.as_flattened()),
            SINEW_FIELD_ALIVE => simulation.fields(body)?.alive.into_iter().map(f32::from).collect(),
            other => {
                let allowed = "SINEW_FIELD_DISPLACEMENT (0) to SINEW_FIELD_ALIVE (7)";
                return Err(Failure::argument(format!("`field` is {other}; {allowed} are allowed")));
            }
        })
    }
}

/// A field of a body, one of `SINEW_FIELD_DISPLACEMENT` and so on, in the author's order of nodes or elements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sinew_field(
    simulation: *mut SinewSimulation,
    body: *const c_char,
    field: i32,
    buffer: *mut f32,
    capacity: usize,
    count: *mut usize,
) -> SinewStatus {
    // SAFETY: as the header asks of callers
    entry(|| unsafe {
        let body = text(body, "body")?;
        fill(&with(simulation, |state, _| state.field(body, field))?, buffer, capacity, count)
    })
}
