//! How fast the forces of all systems grow together, node by node: for the stable step, which only forces at the same
//! node make smaller together.

use super::node_views::ForceSlopes;
use bevy_ecs::prelude::*;
use std::collections::BTreeMap;

/// The slopes of the forces on nodes.
#[derive(Debug, Default)]
pub(crate) struct NodeSlopes {
    /// Of forces of which nobody says at which nodes they are.
    everywhere: ForceSlopes,
    /// By row, of each body; none behind the last row that there are some of.
    bodies: BTreeMap<Entity, Vec<ForceSlopes>>,
}

impl NodeSlopes {
    /// Adds those of forces that may be at any node.
    pub(super) fn add_everywhere(&mut self, slopes: ForceSlopes) {
        self.everywhere = self.everywhere.and(slopes);
    }

    /// Those of a body so far, to add to.
    pub(super) fn of_body(&mut self, body: Entity) -> OfBody<'_> {
        OfBody(self.bodies.entry(body).or_default())
    }

    /// The largest of all nodes, each of the two by itself.
    pub(crate) fn largest(&self) -> ForceSlopes {
        let nodes = self.bodies.values().flatten();
        self.everywhere.and(nodes.fold(ForceSlopes::NONE, |largest, &slopes| largest.larger(slopes)))
    }
}

/// What is known of a body's nodes.
pub(super) struct OfBody<'a>(&'a mut Vec<ForceSlopes>);

impl OfBody<'_> {
    /// Adds those of a force on the node of a row.
    pub(super) fn add(&mut self, row: usize, slopes: ForceSlopes) {
        if slopes == ForceSlopes::NONE {
            return;
        }
        if self.0.len() <= row {
            self.0.resize(row + 1, ForceSlopes::NONE);
        }
        self.0[row] = self.0[row].and(slopes);
    }
}

#[cfg(test)]
mod tests;
