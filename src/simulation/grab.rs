//! Grabbing: a spring and a damper between a point of a body and a target that a program moves.

use super::follow::Follower;
use super::{Pick, Simulation};
use crate::backend::device::{Device, bring_to_host};
use crate::components::*;
use crate::error::Error;
use crate::systems::{grab_bytes, grab_uniform};
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// ω Δt of a spring whose stiffness is not given. With critical damping γΔt is twice that. Where Δt is 0.9 of the
/// stable step, 2.8 % of that are lost: 1 − 2/(γ/2 + √(γ²/4 + 4 + ω²)) with ω = 0.05/0.9 and γ = 2ω in units of it; 5 %
/// is what such a step leaves free before it follows ([`Follower::most`](super::follow::Follower::most)).
const GENTLE: f64 = 0.05;

/// How a hand holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grip {
    /// Stiffness of the spring (N/m); left out: m ω² with ω Δt = 0.05, m the least mass of a held node over its weight
    /// and Δt the first step of the run: it takes 2.8 % of a stable step of which Δt is 0.9, and no step has to follow
    /// that.
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
    held: Vec<Held>,
}

/// A node that is held, when it was grabbed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Held {
    row: u32,
    weight: f64,
    /// Its displacement (m).
    displacement: DVec3,
    /// Its mass (kg).
    mass: f64,
}

/// All that is held, by number.
pub(super) type AllGrabs = BTreeMap<GrabId, Grab>;

impl Grab {
    /// The held nodes, each with its share of the spring.
    fn nodes(&self) -> impl Iterator<Item = HeldNode> {
        self.held.iter().map(|&Held { row, weight, displacement, mass }| {
            let (stiffness, damping) = (weight * self.stiffness, weight * self.damping);
            // what has no mass is not pulled
            let over_mass = |number: f64| if mass > 0.0 { number / mass } else { 0.0 };
            HeldNode {
                row,
                stiffness,
                damping,
                stiffness_over_mass: over_mass(stiffness),
                damping_over_mass: over_mass(damping),
                most: weight * self.most_force,
                goal: displacement + (self.target - self.from),
            }
        })
    }

    fn is_sound(&self, rows: usize) -> bool {
        let numbers = [self.stiffness, self.damping];
        let held = |held: &Held| {
            let sound = held.weight > 0.0 && held.displacement.is_finite() && held.mass.is_finite();
            (held.row as usize) < rows && sound && held.mass >= 0.0
        };
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
    /// [`Options::grabs`](super::Options::grabs) is not set; a static analysis; a grip that is no positive number, too
    /// stiff for a step that the scene insists on, or for any that a run goes on with; too many nodes held; what the
    /// GPU says.
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
        self.keep_start();
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
        let held: Vec<Held> = (set.rows().iter().zip(weights).zip(&states))
            .map(|((&row, weight), state)| Held {
                row: row as u32,
                weight,
                displacement: state.displacement,
                mass: state.mass,
            })
            .collect();
        let from = held.iter().zip(&states).map(|(held, state)| held.weight * (state.rest + state.displacement)).sum();
        let inertia = held.iter().map(|held| held.mass / held.weight);
        let mass = inertia.filter(|mass| *mass > 0.0).fold(f64::INFINITY, f64::min);
        if !mass.is_finite() {
            return Err(wrong("the grabbed nodes have no mass: all their elements are removed"));
        }
        // the same for every grab, whatever the step has become
        let time_step = self.solver.follower().map_or_else(|| self.time_step(), |follower| follower.first);
        let stiffness = grip.stiffness.unwrap_or(mass * (GENTLE / time_step).powi(2));
        let damping = grip.damping.unwrap_or(2.0 * (stiffness * mass).sqrt());
        let body = body.to_string();
        let grab = Grab { body, from, target: from, stiffness, damping, most_force: grip.most_force, held };
        if !grab.is_sound(usize::MAX) || grab.stiffness == 0.0 {
            return Err(wrong("stiffness and largest force of a grip must be above 0, its damping 0 or above"));
        }
        let id = GrabId(self.next_grab);
        self.grabs.insert(id, grab);
        let put = self.put_grabs(entity).and_then(|()| self.is_stable_with_grabs());
        if let Err(error) = put {
            self.grabs.remove(&id);
            let _ = self.put_grabs(entity);
            let _ = self.count_loads();
            return Err(error);
        }
        self.next_grab += 1;
        self.note_grab(id);
        if let Some(follower) = self.solver.follower_mut() {
            follower.check_soon();
        }
        Ok(id)
    }

    /// A grab is what it is from the present step on: snapshots from before are not of another run.
    fn note_grab(&mut self, id: GrabId) {
        let grab = self.grabs.get(&id);
        let what = format!("{id:?} {:?}", grab.map(|grab| (grab.from, grab.target, grab.stiffness, grab.damping)));
        self.lineage.note(self.world.resource::<Clock>().step, &what);
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
        self.note_grab(id);
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
        let wanted = [Displacement::NAME, DisplacementIncrement::NAME, Mass::NAME];
        bring_to_host(&mut self.world, |entity, name| entity == body && wanted.contains(&name))?;
        let rate = self.world.resource::<Clock>().rate();
        let entity = self.world.entity(body);
        let (Some(u), Some(d), Some(mass)) =
            (entity.get::<Displacement>(), entity.get::<DisplacementIncrement>(), entity.get::<Mass>())
        else {
            return Ok(DVec3::ZERO);
        };
        let of_node = |held: HeldNode| {
            let row = held.row as usize;
            held.force(u.vector(row), d.vector(row) * rate, mass.get(row))
        };
        Ok(grab.nodes().filter(|held| mass.get(held.row as usize) > 0.0).map(of_node).sum())
    }

    /// Lets go.
    ///
    /// # Errors
    /// No such grab; what the GPU says.
    pub fn release(&mut self, id: GrabId) -> Result<(), Error> {
        let grab = self.grabs.remove(&id).ok_or_else(released)?;
        let body = self.body(&grab.body)?;
        self.put_grabs(body)?;
        self.note_grab(id);
        self.count_loads()?;
        if let Some(follower) = self.solver.follower_mut() {
            follower.ease();
        }
        Ok(())
    }

    /// All that is held.
    pub fn grabs(&self) -> impl Iterator<Item = (GrabId, &Grab)> {
        self.grabs.iter().map(|(id, grab)| (*id, grab))
    }

    /// Whether what a snapshot holds can be held here.
    ///
    /// # Errors
    /// That nothing can be grabbed; what cannot be held.
    pub(super) fn check_grabs(&mut self, grabs: &AllGrabs) -> Result<(), Error> {
        if grabs.is_empty() {
            return Ok(());
        }
        if self.world.query::<&Grabs>().iter(&self.world).next().is_none() {
            let count = grabs.len();
            return Err(Error::Options(format!(
                "something is held in the snapshot ({count} by Simulation::grab), and nothing can be held here: make the \
                 simulation with `Options {{ grabs: true, .. }}`"
            )));
        }
        let names: BTreeSet<&String> = grabs.values().map(|grab| &grab.body).collect();
        for name in names {
            let body = self.body(name)?;
            let rows = self.world.get::<Mass>(body).map_or(0, |mass| mass.len());
            let of_body = || grabs.values().filter(|grab| grab.body == *name);
            let count = of_body().map(|grab| grab.held.len()).sum::<usize>();
            if !of_body().all(|grab| grab.is_sound(rows)) || count > Grabs::MOST_HELD {
                return Err(wrong("the snapshot holds what cannot be held"));
            }
        }
        Ok(())
    }

    /// Goes on from what is held in a snapshot, which has been checked.
    pub(super) fn take_up_grabs(&mut self, grabs: AllGrabs) -> Result<(), Error> {
        let before = std::mem::replace(&mut self.grabs, grabs);
        self.next_grab = self.next_grab.max(self.grabs.last_key_value().map_or(0, |(id, _)| id.0 + 1));
        let names: BTreeSet<String> =
            before.values().chain(self.grabs.values()).map(|grab| grab.body.clone()).collect();
        for name in names {
            let body = self.body(&name)?;
            self.put_grabs(body)?;
        }
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
            device.rewrite(&grab_uniform(&label), &bytes)?;
        }
        Ok(())
    }

    /// Whether a step that does not follow what is stable is stable with what is held.
    fn is_stable_with_grabs(&mut self) -> Result<(), Error> {
        self.count_loads()?;
        let loads = self.solver.follower().map(Follower::loads).unwrap_or_default();
        if let Some(limit) = self.solver.follower().and_then(|follower| follower.gives_up_with(&loads)) {
            return Err(Error::Options(format!(
                "with so stiff a grip the stable step is {limit:.3e} s, so short that a run ends for it: hold more softly \
                 (`stiffness` left out suits any step)"
            )));
        }
        self.fits_the_step(&loads).map_err(|limit| {
            let step = self.time_step();
            Error::Options(format!(
                "with so stiff a grip the stable step is {limit:.3e} s, and the step is {step:.3e} s: hold more softly, or \
                 let the step follow (when_unstable: Adapt)"
            ))
        })
    }
}

fn released() -> Error {
    wrong("this is not held, or has been released")
}

fn wrong(text: &str) -> Error {
    Error::Options(text.into())
}
