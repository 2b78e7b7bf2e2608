//! Cells of any kind: blocks of one kind each, with the nodes of their cells one after the other.

use super::topology::{CellKind, MOST_NODES};
use std::collections::TryReserveError;

/// Cells in the order of their kinds (tetrahedra first), cells of one kind in the order in which they were added. A
/// cell's row counts all cells before it.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Ascending by kind, each kind once.
    blocks: Vec<Block>,
}

#[derive(Clone, Debug)]
struct Block {
    kind: CellKind,
    nodes: Vec<u32>,
}

impl Block {
    fn len(&self) -> usize {
        self.nodes.len() / self.kind.node_count()
    }
}

impl Cells {
    /// Adds a cell by its nodes; behind the others of its kind, so before those of later kinds.
    pub fn push(&mut self, kind: CellKind, nodes: &[u32]) {
        debug_assert_eq!(nodes.len(), kind.node_count(), "{kind:?}");
        self.block(kind).extend_from_slice(nodes);
    }

    /// Adds all of some others, with `first` added to each of their nodes.
    pub fn extend_moved(&mut self, others: &Cells, first: u32) {
        for block in &others.blocks {
            self.block(block.kind).extend(block.nodes.iter().map(|node| node + first));
        }
    }

    /// Makes room for so many more of a kind.
    ///
    /// # Errors
    /// They do not fit into memory.
    pub fn try_reserve_exact(&mut self, kind: CellKind, cells: usize) -> Result<(), TryReserveError> {
        self.block(kind).try_reserve_exact(cells.saturating_mul(kind.node_count()))
    }

    fn block(&mut self, kind: CellKind) -> &mut Vec<u32> {
        let place = match self.blocks.binary_search_by_key(&kind, |block| block.kind) {
            Ok(place) => place,
            Err(place) => {
                self.blocks.insert(place, Block { kind, nodes: Vec::new() });
                place
            }
        };
        &mut self.blocks[place].nodes
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(Block::len).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The kinds there are, ascending, with how many of each.
    pub fn kinds(&self) -> impl Iterator<Item = (CellKind, usize)> + Clone {
        self.blocks.iter().map(|block| (block.kind, block.len())).filter(|(_, count)| *count > 0)
    }

    /// How many of a kind there are.
    pub fn count(&self, kind: CellKind) -> usize {
        self.kinds().find(|of| of.0 == kind).map_or(0, |of| of.1)
    }

    /// The row of the first cell of a kind, or where it would be.
    pub fn first(&self, kind: CellKind) -> usize {
        self.kinds().take_while(|of| of.0 < kind).map(|of| of.1).sum()
    }

    /// The block of a row, and the row in it. A row that is not there is beyond the last block.
    fn place(&self, mut row: usize) -> (usize, usize) {
        for (place, block) in self.blocks.iter().enumerate() {
            let count = block.len();
            if row < count {
                return (place, row);
            }
            row -= count;
        }
        (self.blocks.len(), row)
    }

    /// The kind of a cell. Panics on a row that is not there.
    pub fn kind(&self, row: usize) -> CellKind {
        self.blocks[self.place(row).0].kind
    }

    /// The nodes of a cell. Panics on a row that is not there.
    pub fn nodes(&self, row: usize) -> &[u32] {
        let (place, row) = self.place(row);
        let Block { kind, nodes } = &self.blocks[place];
        &nodes[row * kind.node_count()..][..kind.node_count()]
    }

    /// The same, to be changed. Panics on a row that is not there.
    pub fn nodes_mut(&mut self, row: usize) -> &mut [u32] {
        let (place, row) = self.place(row);
        let Block { kind, nodes } = &mut self.blocks[place];
        &mut nodes[row * kind.node_count()..][..kind.node_count()]
    }

    /// All cells in their order.
    pub fn iter(&self) -> impl Iterator<Item = (CellKind, &[u32])> + Clone {
        let of = |block| -> (CellKind, &[u32]) {
            let Block { kind, nodes }: &Block = block;
            (*kind, nodes)
        };
        let blocks = self.blocks.iter().map(of);
        blocks.flat_map(|(kind, nodes)| nodes.chunks_exact(kind.node_count()).map(move |nodes| (kind, nodes)))
    }

    /// The nodes of all cells, one cell after the other.
    pub fn all_nodes(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.blocks.iter().flat_map(|block| block.nodes.iter().copied())
    }

    /// The cells of a kind whose cells have `N` nodes; none of a kind that has another number.
    pub fn of_kind<const N: usize>(&self, kind: CellKind) -> &[[u32; N]] {
        debug_assert_eq!(N, kind.node_count(), "{kind:?}");
        let of = self.blocks.iter().find(|block| block.kind == kind && N == kind.node_count());
        of.map_or(&[], |block| block.nodes.as_chunks().0)
    }

    /// The cells of some rows, ascending, with other names for their nodes.
    pub fn select(&self, rows: impl IntoIterator<Item = usize>, mut rename: impl FnMut(u32) -> u32) -> Cells {
        let mut selected = Cells::default();
        let mut nodes = [0; MOST_NODES];
        for row in rows {
            let (kind, own) = (self.kind(row), self.nodes(row));
            nodes.iter_mut().zip(own).for_each(|(node, own)| *node = rename(*own));
            selected.push(kind, &nodes[..own.len()]);
        }
        selected
    }
}

impl PartialEq for Cells {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

impl<'a> FromIterator<(CellKind, &'a [u32])> for Cells {
    fn from_iter<T: IntoIterator<Item = (CellKind, &'a [u32])>>(cells: T) -> Self {
        let mut all = Cells::default();
        cells.into_iter().for_each(|(kind, nodes)| all.push(kind, nodes));
        all
    }
}
