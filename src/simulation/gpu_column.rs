//! Columns on the GPU, lent to who draws by the same device.

use super::Simulation;
use crate::backend::device::Device;
use crate::backend::gpu::Buffer;
use crate::components::{Authoring, Column, Reals, Rows};
use crate::error::Error;
use std::ops::{Deref, Range};

/// A column of a body's nodes as it lies on the GPU: see [`Simulation::gpu_column`].
#[derive(Clone, Debug)]
pub struct GpuColumn {
    /// The buffer: a storage buffer of f32, for reading only. It stays the same for as long as the simulation is there.
    pub buffer: Buffer,
    /// The column's bytes in it; others may lie before and after them.
    pub bytes: Range<u64>,
    /// Numbers a row, side by side.
    pub numbers: usize,
    /// The engine's row of each of the author's nodes, in the author's order.
    pub node_rows: Vec<u32>,
}

impl Simulation {
    /// A column of a body's nodes on the GPU, to draw from it without a copy on the device that the simulation adopted
    /// ([`Options::host`](super::Options::host)); none where the simulation runs on the CPU or no kernel has it. What
    /// is submitted to the device after a step reads the numbers of that step: nobody need wait for it.
    ///
    /// # Errors
    /// No such body; a column whose rows are no nodes; a start in equilibrium that is not found; what the GPU says.
    pub fn gpu_column<C: Column + Deref<Target = Reals>>(&mut self, body: &str) -> Result<Option<GpuColumn>, Error> {
        self.settle()?;
        let entity = self.body(body)?;
        let Rows::Nodes(numbers) = C::ROWS else {
            return Err(Error::Options(format!("`{}` does not have a row a node", C::NAME)));
        };
        let lent = self.world.get_resource::<Device>().and_then(|device| device.lend(entity, C::NAME));
        let node_rows = self.world.get::<Authoring>(entity).map(|known| known.node_rows.clone());
        Ok(lent.zip(node_rows).map(|((buffer, bytes), node_rows)| GpuColumn { buffer, bytes, numbers, node_rows }))
    }
}
