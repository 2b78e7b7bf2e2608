//! The author's nodes in the engine's columns: one call that translates, checked.

use super::Simulation;
use crate::components::{Authoring, Displacement, DisplacementIncrement, ExternalForce, Mass, RestPosition};
use crate::error::Error;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Some nodes of one body, for systems of one's own.
///
/// Nodes have three orders: the numbers that the author knows them by (those of the mesh file), their places in the
/// author's order (rows of [`Simulation::displacements`], corners of [`Simulation::surface_triangles`]), and the
/// engine's rows in columns of components, which are sorted for speed. A set is made from numbers or places and holds
/// rows, so that nobody has to translate by hand; and it knows its body, so that no other body's nodes can be meant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeSet {
    body: Entity,
    rows: Vec<usize>,
    /// Nodes of the body: columns of another simulation are refused.
    count: usize,
}

impl NodeSet {
    /// The body that the nodes belong to.
    pub fn body(&self) -> Entity {
        self.body
    }

    /// Rows of the nodes in the columns of their body, in the order in which they were named.
    pub fn rows(&self) -> &[usize] {
        &self.rows
    }

    /// Adds a force (N) to each node, for one step.
    ///
    /// # Errors
    /// Columns of another simulation.
    pub fn add_force(&self, bodies: &mut Query<&mut ExternalForce>, force: DVec3) -> Result<(), Error> {
        self.add_forces(bodies, |_| force)
    }

    /// Adds a force (N) to each node, which may depend on its place in the set, for one step.
    ///
    /// # Errors
    /// Columns of another simulation.
    pub fn add_forces(
        &self,
        bodies: &mut Query<&mut ExternalForce>,
        force: impl Fn(usize) -> DVec3,
    ) -> Result<(), Error> {
        let column = bodies.get_mut(self.body).ok().filter(|column| column.len() == 3 * self.count);
        let Some(mut column) = column else { return Err(foreign()) };
        for (place, &row) in self.rows.iter().enumerate() {
            let sum = column.vector(row) + force(place);
            column.set_vector(row, sum);
        }
        Ok(())
    }
}

fn foreign() -> Error {
    Error::Options("these nodes are of a body that this simulation does not have: make the set anew".into())
}

/// What [`Simulation::node_state`] tells of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeState {
    /// Rest position (m).
    pub rest: DVec3,
    /// Displacement (m).
    pub displacement: DVec3,
    /// Velocity in the middle of the last step (m/s).
    pub velocity: DVec3,
    /// Lumped mass (kg).
    pub mass: f64,
}

impl Simulation {
    /// The author's numbers of a body's nodes, in the author's order: that of [`displacements`](Self::displacements),
    /// [`rest_positions`](Self::rest_positions) and the corners of [`surface_triangles`](Self::surface_triangles).
    ///
    /// # Errors
    /// No such body.
    pub fn node_numbers(&mut self, body: &str) -> Result<Vec<u64>, Error> {
        let entity = self.body(body)?;
        let Some(authoring) = self.world.get::<Authoring>(entity) else { return Ok(Vec::new()) };
        Ok((0..authoring.node_rows.len()).map(|place| authoring.node_ids.of(place)).collect())
    }

    /// Nodes by the author's numbers.
    ///
    /// # Errors
    /// No such body; a number that it does not have.
    pub fn nodes_numbered(&mut self, body: &str, numbers: &[u64]) -> Result<NodeSet, Error> {
        let all = self.node_numbers(body)?;
        let mut places: Vec<(u64, usize)> = all.iter().copied().zip(0..).collect();
        places.sort_unstable();
        let place = |&number: &u64| {
            let found = places.binary_search_by_key(&number, |entry| entry.0);
            let (least, most) = (places.first().map_or(0, |e| e.0), places.last().map_or(0, |e| e.0));
            let message = || format!("{body} has no node {number}; it has {} between {least} and {most}", all.len());
            found.map(|at| places[at].1).map_err(|_| Error::Options(message()))
        };
        let places = numbers.iter().map(place).collect::<Result<Vec<usize>, Error>>()?;
        self.nodes_at(body, &places)
    }

    /// Nodes by their places in the author's order.
    ///
    /// # Errors
    /// No such body; a place that it does not have.
    pub fn nodes_at(&mut self, body: &str, places: &[usize]) -> Result<NodeSet, Error> {
        let entity = self.body(body)?;
        let Some(authoring) = self.world.get::<Authoring>(entity) else { return Err(foreign()) };
        let count = authoring.node_rows.len();
        let row = |&place: &usize| match authoring.node_rows.get(place) {
            Some(&row) => Ok(row as usize),
            None => Err(Error::Options(format!("{body} has {count} nodes, counted from 0: there is no place {place}"))),
        };
        Ok(NodeSet { body: entity, rows: places.iter().map(row).collect::<Result<_, _>>()?, count })
    }

    /// What is known of each node of a set, in its order.
    ///
    /// # Errors
    /// A set of another simulation; what the GPU says.
    pub fn node_state(&mut self, nodes: &NodeSet) -> Result<Vec<NodeState>, Error> {
        self.settle()?;
        use crate::components::{Column, Reals};
        let wanted = [Displacement::NAME, DisplacementIncrement::NAME, Mass::NAME];
        crate::backend::device::bring_to_host(&mut self.world, |entity, name| {
            entity == nodes.body && wanted.contains(&name)
        })?;
        let rate = self.world.resource::<crate::components::Clock>().rate();
        let body = self.world.get_entity(nodes.body).map_err(|_| foreign())?;
        let rest = body.get::<RestPosition>().filter(|rest| rest.0.len() == nodes.count).ok_or_else(foreign)?;
        let vector = |reals: Option<&Reals>, row: usize| reals.map_or(DVec3::ZERO, |reals| reals.vector(row));
        let state = |&row: &usize| NodeState {
            rest: rest.0[row],
            displacement: vector(body.get::<Displacement>().map(|u| &u.0), row),
            velocity: vector(body.get::<DisplacementIncrement>().map(|d| &d.0), row) * rate,
            mass: body.get::<Mass>().map_or(0.0, |mass| mass.get(row)),
        };
        Ok(nodes.rows.iter().map(state).collect())
    }
}
