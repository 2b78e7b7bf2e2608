//! Volumes, Jacobian determinants and shapes of elements.

use super::topology::{CellKind, MOST_NODES};
use super::{Cells, Mesh};
use glam::DVec3;

pub use super::topology::tet4::volume as tet_volume;

/// Longest edge of a cell whose nodes are there (m).
pub fn longest_edge(kind: CellKind, p: &[DVec3]) -> f64 {
    kind.topology().edges.iter().map(|&[a, b]| p[a].distance(p[b])).fold(0.0, f64::max)
}

/// Places of the nodes of a cell (m).
pub struct Places {
    all: [DVec3; MOST_NODES],
    count: usize,
}

impl Places {
    /// Of a cell. Panics on a row that is not there.
    pub fn new(cells: &Cells, row: usize, points: &[DVec3]) -> Self {
        let nodes = cells.nodes(row);
        let mut all = [DVec3::ZERO; MOST_NODES];
        for (place, &node) in nodes.iter().enumerate() {
            all[place] = points[node as usize];
        }
        Self { all, count: nodes.len() }
    }
}

impl std::ops::Deref for Places {
    type Target = [DVec3];

    fn deref(&self) -> &[DVec3] {
        &self.all[..self.count]
    }
}

impl Mesh {
    /// Places of the nodes of an element (m); `None` of one that has not `N` nodes. Panics on a row that does not
    /// exist; [`Mesh::soundness`] finds those of `points`.
    pub fn corners<const N: usize>(&self, row: usize) -> Option<[DVec3; N]> {
        let nodes: &[u32; N] = self.element(row).try_into().ok()?;
        Some(nodes.map(|node| self.points[node as usize]))
    }

    /// Places of the nodes of an element (m).
    #[doc(hidden)]
    pub fn places(&self, row: usize) -> Places {
        Places::new(&self.cells, row, &self.points)
    }

    /// Sum of the signed volumes of all elements (m³), kind by kind.
    pub fn volume(&self) -> f64 {
        let mut sum = 0.0;
        for (kind, rows, _) in self.cells.blocks() {
            if let Some(solid) = kind.topology().solid {
                sum += rows.map(|row| (solid.volume)(&self.places(row))).sum::<f64>();
            }
        }
        sum
    }
}
