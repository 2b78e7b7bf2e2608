//! The coarse level of a preconditioner as a device has it.

use super::super::preconditioner::{Coarse, RIGID};
use super::kernels::Room;

/// What changes only where bodies or the operator do.
#[derive(Default)]
pub(super) struct Layout {
    /// Of each node of all bodies its arm at rest over the aggregate's extent, and the aggregate; below 0 none.
    pub arms: Vec<[f32; 4]>,
    /// Where each aggregate's nodes begin, and the end; behind these, the nodes.
    pub aggregate_nodes: Vec<u32>,
    /// Of each unknown the first of its piece, how many those are, where its row begins.
    pub rows: Vec<[u32; 3]>,
    /// The inverse of each piece's matrix (m/N), row by row.
    pub inverse: Vec<f32>,
}

impl Layout {
    /// Of the pieces of all bodies.
    pub fn of(pieces: &[&Coarse], nodes: usize) -> Self {
        let mut new = Self { arms: vec![[0.0, 0.0, 0.0, -1.0]; nodes], ..Self::default() };
        let mut members: Vec<Vec<u32>> = Vec::new();
        for piece in pieces {
            let (before, size) = (members.len(), piece.size());
            members.resize(before + size / RIGID, Vec::new());
            for (node, aggregate, arm) in piece.members() {
                let arm = arm.as_vec3();
                new.arms[node] = [arm.x, arm.y, arm.z, (before + aggregate) as f32];
                members[before + aggregate].push(node as u32);
            }
            let first = new.inverse.len();
            let row = |row: usize| [RIGID * before, size, first + row * size].map(|number| number as u32);
            new.rows.extend((0..size).map(row));
            new.inverse.extend(piece.inverse().iter().map(|&entry| entry as f32));
        }
        let mut end = members.len() + 1;
        for nodes in &members {
            new.aggregate_nodes.push(end as u32);
            end += nodes.len();
        }
        new.aggregate_nodes.push(end as u32);
        new.aggregate_nodes.extend(members.into_iter().flatten());
        new
    }

    /// How much room it takes.
    pub fn room(&self) -> Room {
        Room { aggregates: self.rows.len() / RIGID, entries: self.inverse.len() }
    }
}

/// How the aggregates of all pieces have turned, column by column.
pub(super) fn turns(pieces: &[&Coarse]) -> Vec<[f32; 9]> {
    pieces.iter().flat_map(|piece| piece.rotations()).map(|turn| turn.as_mat3().to_cols_array()).collect()
}
