//! Columns seen from outside, without copies.

use super::Simulation;
use crate::backend::device::bring_to_host;
use crate::components::{Authoring, Column, Reals, Rows};
use crate::error::Error;
use bevy_ecs::prelude::*;
use std::ops::Deref;

/// A column of a body's nodes as it lies in memory: see [`Simulation::column`].
#[derive(Clone, Copy, Debug)]
pub struct ColumnView<'a> {
    values: &'a Reals,
    numbers: usize,
    node_rows: &'a [u32],
    generation: u32,
}

impl<'a> ColumnView<'a> {
    /// The numbers in the run's precision, row after row in the engine's order.
    pub fn values(&self) -> &'a Reals {
        self.values
    }

    /// Rows, one a node.
    pub fn rows(&self) -> usize {
        self.values.len() / self.numbers
    }

    /// Numbers a row, side by side.
    pub fn numbers(&self) -> usize {
        self.numbers
    }

    /// The engine's row of each of the author's nodes, in the author's order: that of
    /// [`displacements`](Simulation::displacements) and the corners of
    /// [`surface_triangles`](Simulation::surface_triangles).
    pub fn node_rows(&self) -> &'a [u32] {
        self.node_rows
    }

    /// Another one whenever the column may have changed since: by steps, by a snapshot taken up, or by who had
    /// [`world_mut`](Simulation::world_mut) and wrote there. It says nothing of which was first.
    pub fn generation(&self) -> u32 {
        self.generation
    }

    /// Copies the rows in the author's order, rounded to f32: what vertex buffers take.
    ///
    /// # Errors
    /// A length that is not that of all the author's nodes times [`numbers`](Self::numbers).
    pub fn copy_in_authors_order(&self, into: &mut [f32]) -> Result<(), Error> {
        let wanted = self.node_rows.len() * self.numbers;
        if into.len() != wanted {
            let (nodes, numbers) = (self.node_rows.len(), self.numbers);
            let message = format!("{} numbers for {nodes} nodes of {numbers}: it must be {wanted}", into.len());
            return Err(Error::Options(message));
        }
        for (to, &row) in into.chunks_exact_mut(self.numbers).zip(self.node_rows) {
            let from = row as usize * self.numbers;
            match self.values {
                Reals::F32(values) => to.copy_from_slice(&values[from..from + self.numbers]),
                Reals::F64(values) => {
                    to.iter_mut().zip(&values[from..]).for_each(|(to, value)| *to = *value as f32);
                }
            }
        }
        Ok(())
    }
}

impl Simulation {
    /// A column of a body's nodes without a copy, on a GPU brought to the host when it is older than the device's:
    /// `simulation.column::<Displacement>("cube")?`. Columns of nodes are listed in [`components`](crate::components).
    ///
    /// # Errors
    /// No such body; a column that it does not have, or whose rows are no nodes; what the GPU says.
    pub fn column<C: Column + Deref<Target = Reals>>(&mut self, body: &str) -> Result<ColumnView<'_>, Error> {
        self.settle()?;
        let entity = self.body(body)?;
        let Rows::Nodes(numbers) = C::ROWS else {
            return Err(Error::Options(format!("`{}` does not have a row a node", C::NAME)));
        };
        bring_to_host(&mut self.world, |of, name| of == entity && name == C::NAME)?;
        let missing = || Error::Options(format!("{body} has no `{}`: the scene does not call for it", C::NAME));
        let found = self.world.get_entity(entity).ok();
        let column = found.and_then(|found| found.get_ref::<C>()).ok_or_else(missing)?;
        let generation = column.last_changed().get();
        let node_rows = found.and_then(|found| found.get::<Authoring>()).map_or(&[][..], |known| &known.node_rows);
        Ok(ColumnView { values: column.into_inner(), numbers, node_rows, generation })
    }
}
