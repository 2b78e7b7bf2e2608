//! What forces on nodes make of the stable step, as far as the systems that bring them say so
//! ([`NodeSystem::slopes`](crate::systems::NodeSystem::slopes), and [`System::with_slopes`] of those on the host).
//!
//! A force f(u, v) on a node is that of a spring and a damper to the first order, K = −∂f/∂u and C = −∂f/∂v. Central
//! differences take v from the middle of the step before, so the recursion M (u⁺ − 2u + u⁻)/Δt² + C (u − u⁻)/Δt + K u =
//! 0 is stable while Δt² xᵀKx/4 + Δt xᵀCx/2 ≤ xᵀMx. With κ and γ the largest Σ |K|/m and Σ |C|/m of all nodes, sums
//! over the forces on a node with norms of Frobenius, and ω² the largest of the bodies, that is so up to
//!
//! Δt = 2/(γ/2 + √(γ²/4 + ω² + κ)),
//!
//! for xᵀKx ≤ Σ over nodes of (Σ |K|/m) m |x|² ≤ κ xᵀMx, and C likewise. Forces at different nodes do not add up.
//!
//! Of loads that a scene has in WGSL they are differences at nodes at rest, at some times, with the curve at 1. What
//! pushes only later, or harder elsewhere, is not seen: where it may be stiff, the scene's own `step` or `safety` is
//! smaller.

use super::Simulation;
use super::follow::step_of;
use crate::backend::device::bring_to_host;
use crate::components::{Column, Mass};
use crate::error::Error;
use crate::scene::schema::WhenUnstable;
use crate::systems::{ForceSlopes, NodeSlopes, SlopesOf, System};
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};

/// The slopes of the forces of all systems: the largest that come together at a node, each of the two by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LoadRates(ForceSlopes);

impl LoadRates {
    /// Of the systems of a world, whose scene lasts so long (s).
    ///
    /// # Errors
    /// That a system cannot say how fast its forces grow, or says what is no number.
    pub fn of<'a>(systems: impl Iterator<Item = &'a System>, duration: f64, world: &mut World) -> Result<Self, Error> {
        Self::sum(systems.filter_map(System::slopes), duration, world)
    }

    /// The same of what tells them.
    fn sum(all: impl Iterator<Item = SlopesOf>, duration: f64, world: &mut World) -> Result<Self, Error> {
        let mut nodes = NodeSlopes::default();
        for slopes in all {
            slopes(duration, world, &mut nodes)?;
        }
        Ok(Self(nodes.largest()))
    }

    /// Whether they are numbers that steps can be found from.
    pub fn are_sound(&self) -> bool {
        [self.0.stiffness, self.0.damping].iter().all(|number| number.is_finite() && *number >= 0.0)
    }

    /// By how much they grow with displacements (N/(m kg)), the most of all nodes.
    pub fn stiffness(&self) -> f64 {
        self.0.stiffness
    }

    /// The stable step (s) under the loads, from that of the bodies alone.
    pub fn with(&self, step: f64) -> f64 {
        if *self == Self::default() {
            return step;
        }
        let half = 0.5 * self.0.damping;
        2.0 / (half + (half * half + 4.0 / (step * step) + self.0.stiffness).sqrt())
    }

    /// What they do to the stable step of the bodies (s), where it can be noticed.
    pub fn told(&self, step: f64) -> Option<String> {
        let with = self.with(step);
        (with < 0.999 * step).then(|| {
            format!(
                "forces on nodes make {with:.3e} s of {step:.3e} s: at rest they grow by up to {:.3e} N/(m kg) with \
                 displacements and {:.3e} N s/(m kg) with velocities",
                self.0.stiffness, self.0.damping
            )
        })
    }
}

impl Simulation {
    /// The slopes of all forces on nodes as they are now.
    pub(super) fn loads_now(&mut self) -> Result<LoadRates, Error> {
        bring_to_host(&mut self.world, |_, name| name == Mass::NAME)?;
        LoadRates::sum(self.facts.slopes.iter().cloned(), self.scene.duration, &mut self.world)
    }

    /// Counts forces on nodes for the stable step from here on. Snapshots hold what was counted: elements that went
    /// since must not make another step of it.
    pub(super) fn count_loads(&mut self) -> Result<(), Error> {
        let loads = self.loads_now()?;
        if let Some(follower) = self.solver.follower_mut() {
            follower.found.loads = Some(loads);
        }
        Ok(())
    }

    /// Whether a step that stays is stable with such loads by the margin at which something would be done about it.
    ///
    /// # Errors
    /// The largest that is (s).
    pub(super) fn fits_the_step(&self, loads: &LoadRates) -> Result<(), f64> {
        let Some(follower) = self.solver.follower() else { return Ok(()) };
        let bodies = step_of(follower.found.known.max(follower.found.latest));
        let limit = follower.most() * loads.with(bodies);
        let follows = follower.policy == WhenUnstable::Adapt || self.scene.integration.beyond_stable_step;
        if follows || self.time_step() <= limit { Ok(()) } else { Err(limit) }
    }
}

#[cfg(test)]
mod tests;
