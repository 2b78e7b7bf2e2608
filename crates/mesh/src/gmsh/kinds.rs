//! Gmsh's element types.

use crate::topology::{CellKind, foreign};

/// What an element type is.
#[derive(Clone, Copy)]
pub struct Kind {
    /// The kind of cell, if sinew makes use of it.
    pub cell: Option<CellKind>,
    /// What many of them are called.
    pub name: &'static str,
    /// Points of each.
    pub nodes: usize,
    /// 0 for points to 3 for volumes.
    pub dimension: u8,
}

/// The kind of a type's number, if it is known.
pub fn kind(number: u64) -> Option<Kind> {
    let Some(cell) = CellKind::of_gmsh(number) else {
        let foreign = foreign::CELLS.iter().find(|foreign| foreign.gmsh == Some(number))?;
        return Some(Kind { cell: None, name: foreign.plural, nodes: foreign.nodes, dimension: foreign.dimension });
    };
    let topology = cell.topology();
    Some(Kind { cell: Some(cell), name: topology.plural, nodes: topology.nodes.len(), dimension: topology.dimension })
}
