//! What systems say of the forces that they bring, for who chooses steps and who tells energies: those of nodes by
//! their trait, those of the host by functions of their own.

use super::node_slopes::NodeSlopes;
use super::node_views::ForceSlopes;
use super::system::System;
use crate::components::HeldEnergy;
use crate::error::Error;
use bevy_ecs::prelude::*;
use bevy_ecs::system::{IntoSystem, RunSystemOnce};
use std::sync::Arc;

/// Adds how fast the forces of a system grow, in a scene that lasts so long (s).
pub(crate) type SlopesOf = Arc<dyn Fn(f64, &mut World, &mut NodeSlopes) -> Result<(), Error> + Send + Sync>;

/// Tells how fast those of a system on the host grow, wherever they are.
pub(super) type HostSlopes = Arc<dyn Fn(&mut World) -> Result<ForceSlopes, Error> + Send + Sync>;

impl System {
    /// How fast the forces of a custom system on the host grow with displacements and velocities, for the stable step:
    /// norms of −∂f/∂u and −∂f/∂v over the mass of a node, the largest of all nodes and of all that the scene lasts
    /// ([`NodeSystem::slopes`](super::NodeSystem::slopes) is the same of node systems). `slopes` is a bevy system that
    /// finds them; it runs when the simulation is made, with the parameters of the scene, and again where forces are
    /// counted anew. Without it the stable step takes them for [`ForceSlopes::NONE`]. At which nodes these forces are
    /// nobody says: the step is chosen as if they were at the node where the others are stiffest.
    ///
    /// What it asks for and is not there when the simulation is made, and numbers that are not finite or below 0, are
    /// errors of making it.
    pub fn with_slopes<M>(
        mut self,
        slopes: impl IntoSystem<(), ForceSlopes, M> + Clone + Send + Sync + 'static,
    ) -> Self {
        let name = self.name.clone();
        self.slopes =
            Some(Arc::new(move |world| world.run_system_once(slopes.clone()).map_err(|e| failed(&name, "slopes", &e))));
        self
    }

    /// The energy (J) that a custom system on the host holds and gives back, as a spring does
    /// ([`NodeSystem::energy`](super::NodeSystem::energy) is the same of node systems). `energy` is a bevy system that
    /// finds it, from displacements and their last increments, which are on the host then. Energies are those of the
    /// middle of the last step, where the displacement is u − [`Clock::back_to_middle`](crate::components::Clock) Δu.
    pub fn with_energy<M>(mut self, energy: impl IntoSystem<(), f64, M> + Clone + Send + Sync + 'static) -> Self {
        let name = self.name.clone();
        let find = move |world: &mut World| {
            world.run_system_once(energy.clone()).map(Some).map_err(|e| failed(&name, "energy", &e))
        };
        self.energy = Some(Arc::new(find));
        self
    }

    /// What tells how fast its forces grow, if it says so.
    pub(crate) fn slopes(&self) -> Option<SlopesOf> {
        let name = self.name.clone();
        if let Some(rows) = self.host.nodes() {
            return Some(Arc::new(move |duration, world, all| {
                sound(rows.slopes(duration, world, all), &name)?;
                Ok(())
            }));
        }
        let find = self.slopes.clone()?;
        Some(Arc::new(move |_, world, all| {
            all.add_everywhere(sound(find(world)?, &name)?);
            Ok(())
        }))
    }

    /// What tells which energy it holds, if it says so.
    pub(crate) fn held_energy(&self) -> Option<HeldEnergy> {
        match self.host.nodes() {
            Some(rows) => Some(Arc::new(move |world| Ok(rows.energy(world)))),
            None => self.energy.clone(),
        }
    }
}

fn failed(system: &str, what: &str, why: &dyn std::fmt::Display) -> Error {
    Error::Options(format!("the {what} of the system `{system}` cannot be found: {why}"))
}

/// Steps can be found from numbers only that are.
fn sound(slopes: ForceSlopes, system: &str) -> Result<ForceSlopes, Error> {
    let ForceSlopes { stiffness, damping } = slopes;
    match [stiffness, damping].iter().all(|number| number.is_finite() && *number >= 0.0) {
        true => Ok(slopes),
        false => Err(Error::Options(format!(
            "forces of the system `{system}` grow by {stiffness:e} N/(m kg) with displacements and by {damping:e} \
             N s/(m kg) with velocities: both must be finite, 0 or above"
        ))),
    }
}
