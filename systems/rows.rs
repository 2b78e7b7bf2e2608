//! For which nodes node systems are, as the plan of a step knows it.

use super::node_shares::ShareOf;
use super::node_system::NodeSystem;
use crate::components::{Mass, OfBody, OfSystem};
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;
use std::fmt::{Display, Formatter, Result};

/// For which of a body's nodes something is that calls for a node system ([`NodeSystem::rows`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rows<'a> {
    /// All.
    All,
    /// Those of these rows of the body, in any order, as long as the simulation lasts.
    List(&'a [u32]),
    /// Some, which are others from step to step.
    Changing,
}

/// For which nodes a system of a step is, of all bodies that something calls for it on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub enum RowSet {
    /// All of these bodies.
    All,
    /// So many of them, as long as the simulation lasts.
    List(usize),
    /// Some, which are others from step to step or as a program chooses.
    Changing,
}

impl Display for RowSet {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        match self {
            Self::All => write!(f, "all nodes of its bodies"),
            Self::List(0) => write!(f, "no node"),
            Self::List(1) => write!(f, "a list of 1 node"),
            Self::List(nodes) => write!(f, "a list of {nodes} nodes"),
            Self::Changing => write!(f, "a list of nodes that changes while it runs"),
        }
    }
}

/// Of all that calls for a system.
pub(super) fn row_set<S: NodeSystem>(of_system: Option<OfSystem>, world: &mut World) -> RowSet {
    let mut callers = world.query::<(Entity, &S, Option<&OfBody>, Option<&OfSystem>, Option<&ShareOf<S>>)>();
    let mut bodies: BTreeMap<Entity, Vec<bool>> = BTreeMap::new();
    for (entity, system, of, _, share) in callers.iter(world).filter(|caller| caller.3.copied() == of_system) {
        if share.is_some_and(|share| share.share.bit != 0) {
            return RowSet::Changing;
        }
        let body = of.map_or(entity, |of| of.0);
        let nodes = world.get::<Mass>(body).map_or(0, |mass| mass.len());
        let marked = bodies.entry(body).or_insert_with(|| vec![false; nodes]);
        match system.rows() {
            Rows::All => marked.fill(true),
            Rows::List(rows) => {
                for &row in rows {
                    if let Some(marked) = marked.get_mut(row as usize) {
                        *marked = true;
                    }
                }
            }
            Rows::Changing => return RowSet::Changing,
        }
    }
    let marked = bodies.values().flatten().filter(|marked| **marked).count();
    match bodies.values().map(Vec::len).sum::<usize>() {
        all if marked == all && all > 0 => RowSet::All,
        _ => RowSet::List(marked),
    }
}
