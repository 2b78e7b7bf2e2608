//! Hands that hold bodies, by numbers that the host gives.

use super::state::HeldState;
use crate::error::Error;
use crate::{GrabId, Grip, Pick, Simulation};
use glam::DVec3;
use std::collections::BTreeMap;

/// What each hand holds.
#[derive(Debug, Default)]
pub struct Hands(BTreeMap<u32, (GrabId, Pick)>);

impl Hands {
    /// Whether any holds something.
    pub fn hold(&self) -> bool {
        !self.0.is_empty()
    }

    /// Takes hold of what a ray meets; lets go where it meets nothing.
    pub fn grab(&mut self, hand: u32, ray: (DVec3, DVec3), simulation: &mut Simulation) -> Result<(), Error> {
        match simulation.pick(ray.0, ray.1)? {
            Some(pick) => self.take(hand, pick, simulation),
            None => self.release(hand, simulation),
        }
    }

    /// Takes hold of a point that was picked, and lets go of what the hand held.
    pub fn take(&mut self, hand: u32, pick: Pick, simulation: &mut Simulation) -> Result<(), Error> {
        self.release(hand, simulation)?;
        let id = simulation.grab(&pick, &Grip::default())?;
        self.0.insert(hand, (id, pick));
        Ok(())
    }

    /// Moves what a hand pulls towards; one that holds nothing moves nothing.
    pub fn move_to(&mut self, hand: u32, target: DVec3, simulation: &mut Simulation) -> Result<(), Error> {
        match self.0.get(&hand) {
            Some((id, _)) => simulation.move_grab(*id, target),
            None => Ok(()),
        }
    }

    /// Lets go.
    pub fn release(&mut self, hand: u32, simulation: &mut Simulation) -> Result<(), Error> {
        match self.0.remove(&hand) {
            Some((id, _)) => simulation.release(id),
            None => Ok(()),
        }
    }

    /// Forgets what a run does not hold that goes on from elsewhere, and lets go of what it held there.
    pub fn all_open(&mut self, simulation: &mut Simulation) -> Result<(), Error> {
        self.0.clear();
        let held: Vec<GrabId> = simulation.grabs().map(|(id, _)| id).collect();
        held.into_iter().try_for_each(|id| simulation.release(id))
    }

    /// Where they are and how they pull. `position`: of a body's node.
    pub fn states(
        &self,
        simulation: &mut Simulation,
        position: impl Fn(&str, u32) -> DVec3,
    ) -> Result<Vec<HeldState>, Error> {
        let state = |(hand, (id, pick)): (&u32, &(GrabId, Pick))| {
            let force = simulation.grab_force(*id)?;
            let target = simulation.grabs().find(|(other, _)| other == id).map(|(_, grab)| grab.target);
            let point = (0..3).map(|i| pick.weights[i] * position(&pick.body, pick.nodes[i])).sum();
            Ok(HeldState { hand: *hand, point, target: target.unwrap_or(point), force })
        };
        self.0.iter().map(state).collect()
    }
}
