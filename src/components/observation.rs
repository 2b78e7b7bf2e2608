//! What is observed.

use crate::scene::schema::Quantity;
use bevy_ecs::prelude::*;

/// One thing to observe, on rows of a body.
#[derive(Component, Clone, Debug)]
pub struct Probe {
    /// What.
    pub what: Quantity,
    /// Rows of the body's node columns.
    pub nodes: Vec<u32>,
    /// Elements: place of the block in the body's list, and row there.
    pub elements: Vec<(u32, u32)>,
    /// Steps between observations.
    pub every: u64,
}

/// Energies of all bodies (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Energies {
    /// ½ m v² in the middle of the last step.
    pub kinetic: f64,
    /// Elastic energy of the laws, in the middle of the last step too, so that energies add up (with viscosity: what an
    /// instantaneous deformation would store).
    pub strain: f64,
    /// In hourglass control, likewise.
    pub hourglass: f64,
    /// Kinetic and elastic energy of removed elements, at the time of their removal.
    pub removed: f64,
    /// Done by loads since the start, when booked.
    pub load_work: Option<f64>,
    /// Lost to damping since the start, when booked.
    pub damping_loss: Option<f64>,
    /// Done by constraints since the start, when booked.
    pub constraint_work: Option<f64>,
    /// Done against internal forces since the start, when booked: strain, hourglass and what viscosity took.
    pub internal_work: Option<f64>,
}
