//! What node systems have of nodes for themselves, from outside: nodes that they are for, numbers that they keep.

use super::{NodeSet, Simulation};
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::{Authoring, ChosenBy, Clock, Column, Mass, OwnNumbers};
use crate::error::Error;
use crate::systems::{NodeRows, mark};

impl Simulation {
    /// From the next step on a node system is for these nodes of their body and for no others of it: one that
    /// [chooses](crate::systems::NodeSystem::choose) its nodes. Snapshots hold what is chosen.
    ///
    /// # Errors
    /// No such system in the step, or one that is for all nodes of the body; nodes of another simulation; what the GPU
    /// says.
    pub fn choose_nodes(&mut self, system: &str, nodes: &NodeSet) -> Result<(), Error> {
        self.settle()?;
        self.keep_start();
        self.node_state(nodes)?;
        let (rows, body) = (self.node_system(system)?, nodes.body());
        let bit = rows.share_of(body, &mut self.world).map_or(0, |share| share.bit);
        if bit == 0 {
            let message =
                format!("`{system}` is for all nodes of this body: it does not choose any (NodeSystem::choose)");
            return Err(Error::Options(message));
        }
        let is_chosen = |of, name: &str| of == body && name == ChosenBy::NAME;
        bring_to_host(&mut self.world, is_chosen)?;
        mark(system, bit, nodes.rows().iter().copied(), body, &mut self.world)?;
        send_to_device(&mut self.world, is_chosen)?;
        let step = self.world.resource::<Clock>().step;
        self.lineage.note(step, &format!("{system} {:?}", nodes.rows()));
        Ok(())
    }

    /// The numbers that a node system [keeps](crate::systems::NodeSystem::OWN_NUMBERS) of a body's nodes, in the
    /// author's order.
    ///
    /// # Errors
    /// No such system in the step, or one that keeps none of the body; no such body; what the GPU says.
    pub fn own_numbers(&mut self, system: &str, body: &str) -> Result<Vec<Vec<f64>>, Error> {
        self.settle()?;
        let (rows, entity) = (self.node_system(system)?, self.body(body)?);
        let share = rows.share_of(entity, &mut self.world).filter(|share| share.numbers > 0);
        bring_to_host(&mut self.world, |of, name| of == entity && name == OwnNumbers::NAME)?;
        let of_body = self.world.entity(entity);
        let (Some(share), Some(own), Some(authoring), Some(mass)) =
            (share, of_body.get::<OwnNumbers>(), of_body.get::<Authoring>(), of_body.get::<Mass>())
        else {
            return Err(Error::Options(format!("`{system}` keeps no numbers of {body} (NodeSystem::OWN_NUMBERS)")));
        };
        let all = own.len() / mass.len().max(1);
        let of_row = |&row: &u32| (0..share.numbers).map(|i| own.get(all * row as usize + share.first + i)).collect();
        Ok(authoring.node_rows.iter().map(of_row).collect())
    }

    fn node_system(&self, name: &str) -> Result<NodeRows, Error> {
        let known = &self.facts.node_systems;
        known.iter().find(|(known, _)| known == name).map(|(_, rows)| *rows).ok_or_else(|| {
            let names: Vec<&str> = known.iter().map(|(name, _)| name.as_str()).collect();
            Error::Options(format!("the step has no node system named {name:?}; there is {}", names.join(", ")))
        })
    }
}
