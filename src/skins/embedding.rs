//! Points in the elements of a mesh.

use super::carrier::{Carrier, Carriers};
use crate::mesh::Mesh;
use glam::DVec3;

/// Points that the elements of a mesh carry.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Embedding {
    /// What carries each point; none where no element lives.
    carriers: Vec<Option<Carrier>>,
}

/// Forces on nodes that do the work of forces on points.
#[derive(Clone, Debug, PartialEq)]
pub struct NodalForces {
    /// On each node of the mesh (N).
    pub forces: Vec<DVec3>,
    /// The moment (N m) that they leave out: of forces on points that lie farther off than an element's size.
    pub left_out: DVec3,
}

impl Embedding {
    /// Embeds points (m) in the elements of a mesh that live.
    pub fn new(mesh: &Mesh, points: &[DVec3], lives: &dyn Fn(usize) -> bool) -> Self {
        let carriers = Carriers::new(mesh, lives);
        Self { carriers: points.iter().map(|&point| carriers.carrier(point)).collect() }
    }

    /// The same with other carriers for points (m) whose element lives no more: a function of the mesh and of what
    /// lives alone if it is made of what all elements carried, whatever went before what.
    #[must_use]
    pub fn rebound(&self, mesh: &Mesh, points: &[DVec3], lives: &dyn Fn(usize) -> bool) -> Self {
        let gone = |carrier: &Option<Carrier>| carrier.as_ref().is_none_or(|carrier| !lives(carrier.element));
        if !self.carriers.iter().any(gone) {
            return self.clone();
        }
        let carriers = Carriers::new(mesh, lives);
        let now = |(carrier, &point): (&Option<Carrier>, &DVec3)| {
            if gone(carrier) { carriers.carrier(point) } else { carrier.clone() }
        };
        Self { carriers: self.carriers.iter().zip(points).map(now).collect() }
    }

    /// What carries each point.
    pub fn carriers(&self) -> &[Option<Carrier>] {
        &self.carriers
    }

    /// Where the points are (m) when the nodes of the mesh are there; at the origin what nothing carries.
    pub fn places(&self, mesh: &Mesh, nodes: &[DVec3]) -> Vec<DVec3> {
        self.carriers
            .iter()
            .map(|carrier| carrier.as_ref().map_or(DVec3::ZERO, |c| c.place(&of(mesh, c, nodes))))
            .collect()
    }

    /// What the points have of a field of the nodes that has no direction: its weighted mean.
    pub fn values(&self, mesh: &Mesh, field: impl Fn(usize) -> DVec3) -> Vec<DVec3> {
        let value = |carrier: &Carrier| {
            let nodes = mesh.element(carrier.element).iter().zip(&carrier.weights);
            nodes.map(|(&node, weight)| *weight * field(node as usize)).sum()
        };
        self.carriers.iter().map(|carrier| carrier.as_ref().map_or(DVec3::ZERO, value)).collect()
    }

    /// Forces on nodes that do the same work as forces on the points (N), for every motion of the nodes: f_a = Σ w_a f.
    pub fn forces(&self, mesh: &Mesh, nodes: &[DVec3], forces: &[DVec3]) -> NodalForces {
        let mut found = NodalForces { forces: vec![DVec3::ZERO; nodes.len()], left_out: DVec3::ZERO };
        for (carrier, force) in self.carriers.iter().zip(forces) {
            let Some(carrier) = carrier else { continue };
            for (&node, weight) in mesh.element(carrier.element).iter().zip(&carrier.weights) {
                found.forces[node as usize] += *weight * *force;
            }
            found.left_out += carrier.arm(&of(mesh, carrier, nodes)).cross(*force);
        }
        found
    }
}

/// What the nodes of a carrier's element have.
fn of(mesh: &Mesh, carrier: &Carrier, nodes: &[DVec3]) -> Vec<DVec3> {
    mesh.element(carrier.element).iter().map(|&node| nodes[node as usize]).collect()
}
