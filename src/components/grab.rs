//! What a hand holds of a body.

use bevy_ecs::prelude::*;
use glam::DVec3;

/// Nodes of a body that springs and dampers pull; with [`OfBody`](super::OfBody). Without any it does nothing.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Grabs {
    /// At most [`MOST_HELD`](Self::MOST_HELD), by ascending rows; a node that two hands hold is there twice.
    pub held: Vec<HeldNode>,
}

/// A node that is pulled to where it should be: F = k (goal − u) − c u̇, no longer than `most`. Elements may go that
/// the node had its mass from: k and c over the mass stay what they were when it was grabbed, so that the stable step
/// does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldNode {
    /// Row of the body's node columns.
    pub row: u32,
    /// k (N/m).
    pub stiffness: f64,
    /// c (N s/m).
    pub damping: f64,
    /// k over the mass of the node when it was grabbed (1/s²): k is no more than this times its mass.
    pub stiffness_over_mass: f64,
    /// c over that mass (1/s), in the same way.
    pub damping_over_mass: f64,
    /// The largest force (N).
    pub most: f64,
    /// The displacement to which it is pulled (m).
    pub goal: DVec3,
}

impl Grabs {
    /// Nodes of a body that can be held at once.
    pub const MOST_HELD: usize = 64;
}

impl HeldNode {
    /// The energy (J) of its spring at a displacement (m) of a node with so much mass (kg): ½ k x², and from where it
    /// pulls with the largest force on as much more as that does.
    pub fn energy(&self, displacement: DVec3, mass: f64) -> f64 {
        let stiffness = self.stiffness.min(self.stiffness_over_mass * mass);
        let far = (self.goal - displacement).length();
        let bent = if stiffness > 0.0 { far.min(self.most / stiffness) } else { far };
        let beyond = far - bent;
        0.5 * stiffness * bent * bent + if beyond > 0.0 { self.most * beyond } else { 0.0 }
    }

    /// The force (N) at a displacement (m) and a velocity (m/s) of a node with so much mass (kg).
    pub fn force(&self, displacement: DVec3, velocity: DVec3, mass: f64) -> DVec3 {
        let stiffness = self.stiffness.min(self.stiffness_over_mass * mass);
        let damping = self.damping.min(self.damping_over_mass * mass);
        let force = stiffness * (self.goal - displacement) - damping * velocity;
        let size = force.length();
        if size > self.most { force * (self.most / size) } else { force }
    }
}
