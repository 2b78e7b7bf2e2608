//! The nodes that ties act on, and what a step finds of them.

use super::{TiedColumns, TiedColumnsItem};
use crate::backend::cpu::IntegrationCoefficients;
use crate::components::*;
use crate::contact::{Tie, TieSet};
use crate::math::Scalar;
use crate::systems::grasp::Grip;
use crate::systems::node_slices::{NodeSlices, note_farther};
use bevy_ecs::prelude::*;
use glam::DVec3;

/// How stiff ties are in implicit steps, as shares of contact count it: under a pull p, ends of elements of edge a and
/// modulus M come apart by 2 a p/(100 M), a fiftieth of what the elements are drawn out by.
pub(super) const STIFF: f64 = 100.0;

/// The nodes that ties act on, each once, by bodies and rows: places in [`Glue::bodies`], and rows there.
pub(super) fn nodes_of(glue: &Glue) -> Vec<(usize, u32)> {
    let of_tie = |tie: &TiedPoint| {
        let [of, onto] = tie.bodies;
        let points: Vec<(usize, u32)> = tie.nodes.iter().map(|&(row, _)| (of, row)).collect();
        let corners = tie.corners.into_iter().chain(tie.behind.map(|(row, _)| row));
        points.into_iter().chain(corners.map(move |row| (onto, row)))
    };
    let mut nodes: Vec<(usize, u32)> = glue.ties.iter().flat_map(of_tie).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// The nodes of a tie, by their places among those of all.
pub(super) struct TieNodes {
    /// With signed weights: first those of the point, then those of the face.
    pub parts: Vec<(u32, f64)>,
    /// The corners of the face.
    pub corners: [u32; 3],
}

/// The places among `nodes` of those of a tie.
pub(super) fn parts_of(tie: &TiedPoint, nodes: &[(usize, u32)]) -> TieNodes {
    let place = |body: usize, row: u32| nodes.partition_point(|&node| node < (body, row)) as u32;
    let [of, onto] = tie.bodies;
    let corners = tie.corners.map(|row| place(onto, row));
    let points = tie.nodes.iter().map(|&(row, weight)| (place(of, row), weight));
    let of_face = tie.bearers().map(|(row, weight)| (place(onto, row), -weight));
    TieNodes { parts: points.chain(of_face).collect(), corners }
}

/// What a step finds, kept so that the next one need not ask for memory: nothing in it is carried on from step to step
/// but what follows from [`Glue`].
#[derive(Default)]
pub(super) struct Work {
    nodes: Vec<(usize, u32)>,
    /// The corners of the face of each tie.
    corners: Vec<[u32; 3]>,
    /// One tie for each, and the nodes' next steps.
    pub set: TieSet,
    /// Unit normals of the ties' faces.
    pub outs: Vec<DVec3>,
    /// Where nodes are (m, from the reference), and what they weigh (kg).
    places: Vec<DVec3>,
    masses: Vec<f64>,
    /// Their last steps (m).
    pub before: Vec<DVec3>,
    /// What ties do to them (N).
    pub forces: Vec<DVec3>,
}

impl Work {
    pub fn of(glue: &Glue) -> Self {
        let nodes = nodes_of(glue);
        let of_tie = |tie: &TiedPoint| {
            let TieNodes { parts, corners } = parts_of(tie, &nodes);
            (Tie::new(parts, tie.nodes.len(), DVec3::ZERO), corners)
        };
        let (ties, corners): (Vec<Tie>, Vec<[u32; 3]>) = glue.ties.iter().map(of_tie).unzip();
        let vectors = || vec![DVec3::ZERO; nodes.len()];
        Self {
            set: TieSet::new(ties, vectors(), vectors()),
            outs: vec![DVec3::ZERO; corners.len()],
            places: vectors(),
            masses: vec![0.0; nodes.len()],
            before: vectors(),
            forces: vectors(),
            corners,
            nodes,
        }
    }

    /// Sees where nodes are and where they would go; `false` where a body lacks something.
    pub fn place<T: Scalar>(
        &mut self,
        glue: &Glue,
        (coefficients, signals): (&IntegrationCoefficients<f64>, &Signals),
        bodies: &mut Query<TiedColumns>,
    ) -> bool {
        let mut at = 0;
        for of_body in self.nodes.chunk_by(|one, other| one.0 == other.0) {
            let Ok(TiedColumnsItem { nodes, grip, .. }) = bodies.get_mut(glue.bodies[of_body[0].0]) else {
                return false;
            };
            let masses = nodes.mass.slice::<T>();
            let columns = NodeSlices::<T>::of(nodes);
            let first = at;
            for row in of_body.iter().map(|&(_, row)| row as usize) {
                self.places[at] = columns.rest[row] - glue.reference + columns.displacement(row);
                self.masses[at] = masses[row].to_f64();
                let foreseen = columns.foresee(row, coefficients);
                self.before[at] = columns.last_step(row);
                self.set.steps[at] = foreseen.step;
                self.set.responses[at] = foreseen.free / foreseen.to_force;
                at += 1;
            }
            let Some(grip) = grip.map(Grip::of) else { continue };
            let place_of = |row| of_body.binary_search_by_key(&row, |node| node.1).ok().map(|place| first + place);
            let set = &mut self.set;
            grip.each_held(&columns, (coefficients, signals), place_of, |at, step| {
                (set.steps[at], set.responses[at]) = (step, DVec3::ZERO);
            });
        }
        true
    }

    /// Whether there is tissue at the point of a tie.
    pub fn has_mass(&self, number: usize, tie: &TiedPoint) -> bool {
        let of_point = &self.set.ties[number].parts[..tie.nodes.len()];
        of_point.iter().all(|&(node, _)| self.masses[node as usize] > 0.0)
    }

    /// Sees how far a tie that holds is off.
    pub fn begin(&mut self, number: usize, tie: &TiedPoint) {
        let solved = &mut self.set.ties[number];
        let corners = self.corners[number].map(|node| self.places[node as usize]);
        let of_point = &solved.parts[..tie.nodes.len()];
        let point: DVec3 = of_point.iter().map(|&(node, weight)| self.places[node as usize] * weight).sum();
        let of_face = &solved.parts[tie.nodes.len()..];
        let mut belongs: DVec3 = of_face.iter().map(|&(node, weight)| self.places[node as usize] * -weight).sum();
        self.outs[number] = DVec3::ZERO;
        if let Some([along, across, out]) = frame_of(corners) {
            belongs += along * tie.gap.x + across * tie.gap.y + out * tie.gap.z;
            self.outs[number] = out;
        }
        (solved.holds, solved.off, solved.force) = (true, point - belongs, DVec3::ZERO);
    }

    /// Finds the forces of springs in place of ties, whose nodes are where they are tried.
    pub fn press(&mut self, springs: &SolvedSprings) {
        self.set.press(&self.masses, STIFF / (springs.step * springs.step));
        self.set.steps.clone_from(&self.before);
    }

    /// Adds the forces to the loads of nodes that are tied; where work is counted, by its factor, so that contact
    /// knows.
    pub fn push(&self, glue: &Glue, work_factor: Option<f64>, bodies: &mut Query<TiedColumns>) {
        let mut at = 0;
        for of_body in self.nodes.chunk_by(|one, other| one.0 == other.0) {
            let Ok(mut columns) = bodies.get_mut(glue.bodies[of_body[0].0]) else { continue };
            for &(_, row) in of_body {
                if self.set.is_tied(at) {
                    let load = columns.nodes.external.vector(row as usize) + self.forces[at];
                    columns.nodes.external.set_vector(row as usize, load);
                    if let Some(work_factor) = work_factor {
                        note_farther(
                            &mut columns.met,
                            row as usize,
                            self.set.responses[at] * self.forces[at],
                            work_factor,
                        );
                    }
                }
                at += 1;
            }
        }
    }
}
