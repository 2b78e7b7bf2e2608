//! Grabbing: a spring and a damper between a point of a body and a target that a program moves.

use super::{Pick, Simulation};
use crate::backend::device::{Device, bring_to_host};
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::WhenUnstable;
use crate::systems::{ForceSlopes, NodeRows, grab_bytes, grab_uniform};
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// ω Δt of a spring whose stiffness is not given: what it takes of the stable step cannot be noticed.
const GENTLE: f64 = 0.1;

/// How a hand holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Stiffness of the spring (N/m); left out: m ω² with ω Δt = 0.1, m the least mass of a held node over its weight.
    pub stiffness: Option<f64>,
    /// Damping of the damper (N s/m); left out: that of a critically damped mass m.
    pub damping: Option<f64>,
    /// The largest force (N).
    pub most_force: f64,
}

impl Default for Grip {
    fn default() -> Self {
        Self { stiffness: None, damping: None, most_force: f64::INFINITY }
    }
}

/// What a hand holds: see [`Simulation::grab`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct GrabId(u64);

/// A grab, as snapshots have it and programs see it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Grab {
    /// The body.
    pub body: String,
    /// Where the point was that was grabbed, when it was (m).
    pub from: DVec3,
    /// Where it is pulled to (m).
    pub target: DVec3,
    /// Stiffness of the spring (N/m).
    pub stiffness: f64,
    /// Damping of the damper (N s/m).
    pub damping: f64,
    /// The largest force (N).
    pub most_force: f64,
    /// Rows of the held nodes, their weights, and their displacements when they were grabbed (m).
    held: Vec<(u32, f64, DVec3)>,
}

/// All that is held, by number.
pub(super) type AllGrabs = BTreeMap<GrabId, Grab>;

impl Grab {
    /// The held nodes, each with its share of the spring.
    fn nodes(&self) -> impl Iterator<Item = HeldNode> {
        self.held.iter().map(|&(row, weight, displacement)| HeldNode {
            row,
            stiffness: weight * self.stiffness,
            damping: weight * self.damping,
            most: weight * self.most_force,
            goal: displacement + (self.target - self.from),
        })
    }

    fn is_sound(&self, rows: usize) -> bool {
        let numbers = [self.stiffness, self.damping];
        let held = |&(row, weight, u): &(u32, f64, DVec3)| (row as usize) < rows && weight > 0.0 && u.is_finite();
        numbers.iter().all(|number| number.is_finite() && *number >= 0.0)
            && (self.from - self.target).is_finite()
            && self.most_force > 0.0
            && self.held.iter().all(held)
    }
}

impl Simulation {
    /// Grabs the point of a body that was picked; its target is where it is now. From the next step on a spring and a
    /// damper pull it there, until it is [released](Self::release). Each of the triangle's nodes is pulled with its
    /// weight's share to where it stood beside the point: their forces sum up to that of one spring at the point, and
    /// the triangle is held as it was turned.
    ///
    /// Their work is that of loads in the balance of energy, and their stiffness counts for the stable step.
    ///
    /// # Errors
    /// [`Options::grabs`](super::Options::grabs) is not set; a static analysis; a grip that is no positive number, or
    /// too stiff for a step that the scene insists on; too many nodes held; what the GPU says.
    pub fn grab(&mut self, pick: &Pick, grip: &Grip) -> Result<GrabId, Error> {
        let nodes = [0, 1, 2].map(|i| (pick.nodes[i] as usize, pick.weights[i].max(0.0)));
        self.grab_nodes(&pick.body, &nodes, grip)
    }

    /// Grabs the weighted mean of nodes, by their places in the author's order. Weights are divided by their sum.
    ///
    /// # Errors
    /// As [`Simulation::grab`]; no such body or place; weights that are negative, or all 0.
    pub fn grab_nodes(&mut self, body: &str, nodes: &[(usize, f64)], grip: &Grip) -> Result<GrabId, Error> {
        self.settle()?;
        let sum: f64 = nodes.iter().map(|node| node.1).sum();
        if !(sum.is_finite() && sum > 0.0 && nodes.iter().all(|node| node.1 >= 0.0)) {
            return Err(wrong("the weights of grabbed nodes must be 0 or above, and one of them above"));
        }
        let nodes: Vec<(usize, f64)> = nodes.iter().copied().filter(|node| node.1 > 0.0).collect();
        let places: Vec<usize> = nodes.iter().map(|node| node.0).collect();
        let set = self.nodes_at(body, &places)?;
        let entity = set.body();
        let states = self.node_state(&set)?;
        let weights = nodes.iter().map(|node| node.1 / sum);
        let held: Vec<(u32, f64, DVec3)> = (set.rows().iter().zip(weights).zip(&states))
            .map(|((&row, weight), state)| (row as u32, weight, state.displacement))
            .collect();
        let from = held.iter().zip(&states).map(|(held, state)| held.1 * (state.rest + state.displacement)).sum();
        let inertia = held.iter().zip(&states).map(|(held, state)| state.mass / held.1);
        let mass = inertia.filter(|mass| *mass > 0.0).fold(f64::INFINITY, f64::min);
        if !mass.is_finite() {
            return Err(wrong("the grabbed nodes have no mass: all their elements are removed"));
        }
        let stiffness = grip.stiffness.unwrap_or(mass * (GENTLE / self.time_step()).powi(2));
        let damping = grip.damping.unwrap_or(2.0 * (stiffness * mass).sqrt());
        let body = body.to_string();
        let grab = Grab { body, from, target: from, stiffness, damping, most_force: grip.most_force, held };
        if !grab.is_sound(usize::MAX) || grab.stiffness == 0.0 {
            return Err(wrong("stiffness and largest force of a grip must be above 0, its damping 0 or above"));
        }
        let id = GrabId(self.grabs.last_key_value().map_or(0, |(id, _)| id.0 + 1));
        self.grabs.insert(id, grab);
        let put = self.put_grabs(entity).and_then(|()| self.is_stable_with_grabs());
        if let Err(error) = put {
            self.grabs.remove(&id);
            let _ = self.put_grabs(entity);
            self.count_grabs_for_the_step();
            return Err(error);
        }
        if let Some(follower) = self.solver.follower_mut() {
            follower.look_soon();
        }
        Ok(id)
    }

    /// Moves the target of a grab (m): from the next step on.
    ///
    /// # Errors
    /// No such grab; a place that is no number; what the GPU says.
    pub fn move_grab(&mut self, id: GrabId, target: DVec3) -> Result<(), Error> {
        if !target.is_finite() {
            return Err(Error::Options(format!("a grab cannot be moved to {target}")));
        }
        let grab = self.grabs.get_mut(&id).ok_or_else(released)?;
        grab.target = target;
        let body = grab.body.clone();
        let body = self.body(&body)?;
        self.put_grabs(body)?;
        let step = self.step_count();
        if let Some(follower) = self.solver.follower_mut() {
            follower.note_change(step, false);
        }
        Ok(())
    }

    /// The force with which a grab pulls at the present displacements and velocities (N): that of the next step, if its
    /// target stays where it is.
    ///
    /// # Errors
    /// No such grab; what the GPU says.
    pub fn grab_force(&mut self, id: GrabId) -> Result<DVec3, Error> {
        let grab = self.grabs.get(&id).ok_or_else(released)?.clone();
        let body = self.body(&grab.body)?;
        let wanted = [Displacement::NAME, DisplacementStep::NAME, Mass::NAME];
        bring_to_host(&mut self.world, |entity, name| entity == body && wanted.contains(&name))?;
        let rate = self.world.resource::<Clock>().rate();
        let entity = self.world.entity(body);
        let (Some(u), Some(d), Some(mass)) =
            (entity.get::<Displacement>(), entity.get::<DisplacementStep>(), entity.get::<Mass>())
        else {
            return Ok(DVec3::ZERO);
        };
        let with_mass = grab.nodes().filter(|held| mass.get(held.row as usize) > 0.0);
        Ok(with_mass.map(|held| held.force(u.vector(held.row as usize), d.vector(held.row as usize) * rate)).sum())
    }

    /// Lets go.
    ///
    /// # Errors
    /// No such grab; what the GPU says.
    pub fn release(&mut self, id: GrabId) -> Result<(), Error> {
        let grab = self.grabs.remove(&id).ok_or_else(released)?;
        let body = self.body(&grab.body)?;
        self.put_grabs(body)?;
        self.count_grabs_for_the_step();
        Ok(())
    }

    /// All that is held.
    pub fn grabs(&self) -> impl Iterator<Item = (GrabId, &Grab)> {
        self.grabs.iter().map(|(id, grab)| (*id, grab))
    }

    /// Goes on from what is held in a snapshot.
    pub(super) fn take_up_grabs(&mut self, grabs: AllGrabs) -> Result<(), Error> {
        let before = std::mem::replace(&mut self.grabs, grabs);
        if before.is_empty() && self.grabs.is_empty() {
            return Ok(());
        }
        let names: std::collections::BTreeSet<String> =
            before.values().chain(self.grabs.values()).map(|grab| grab.body.clone()).collect();
        for name in names {
            let body = self.body(&name)?;
            let rows = self.world.get::<Mass>(body).map_or(0, |mass| mass.len());
            if !self.grabs.values().filter(|grab| grab.body == name).all(|grab| grab.is_sound(rows)) {
                return Err(wrong("the snapshot holds what cannot be held"));
            }
            self.put_grabs(body)?;
        }
        self.count_grabs_for_the_step();
        Ok(())
    }

    /// Puts what is held of a body where its steps find it.
    fn put_grabs(&mut self, body: Entity) -> Result<(), Error> {
        let label = self.world.get::<Label>(body).map(|label| label.0.clone()).unwrap_or_default();
        let of_body = self.grabs.values().filter(|grab| grab.body == label);
        let mut held: Vec<HeldNode> = of_body.flat_map(Grab::nodes).collect();
        held.sort_by_key(|held| held.row);
        if held.len() > Grabs::MOST_HELD {
            return Err(Error::Options(format!("at most {} nodes of a body can be held at once", Grabs::MOST_HELD)));
        }
        let mut all = self.world.query::<(&mut Grabs, &OfBody)>();
        let Some((mut grabs, _)) = all.iter_mut(&mut self.world).find(|(_, of)| of.0 == body) else {
            return Err(wrong(
                "nothing can be grabbed: make the simulation with `Options { grabs: true, .. }`, of a motion",
            ));
        };
        grabs.held = held;
        let bytes = grab_bytes(&grabs);
        if let Some(mut device) = self.world.get_resource_mut::<Device>() {
            device.rewrite_uniform(&grab_uniform(&label), &bytes)?;
        }
        Ok(())
    }

    /// What is held counts for the stable step.
    fn count_grabs_for_the_step(&mut self) {
        let slopes: ForceSlopes = NodeRows::of::<Grabs>().slopes(self.scene.duration, &mut self.world);
        if let Some(follower) = self.solver.follower_mut() {
            follower.loads = self.facts.stability.loads.and(slopes);
        }
        self.world.insert_resource(self.facts.stability.loads.and(slopes));
    }

    /// Whether a step that does not follow what is stable is stable with what is held.
    fn is_stable_with_grabs(&mut self) -> Result<(), Error> {
        self.count_grabs_for_the_step();
        let step = self.time_step();
        let Some(follower) = self.solver.follower() else { return Ok(()) };
        let limit = follower.step_of(follower.found.known);
        if follower.policy == WhenUnstable::Adapt || step <= limit || self.scene.integration.beyond_stable_step {
            return Ok(());
        }
        Err(Error::Options(format!(
            "with so stiff a grip the stable step is {limit:.3e} s, and the step is {step:.3e} s: hold more softly, or let the step \
             follow (when_unstable: Adapt)"
        )))
    }
}

fn released() -> Error {
    wrong("this is not held, or has been released")
}

fn wrong(text: &str) -> Error {
    Error::Options(text.into())
}
