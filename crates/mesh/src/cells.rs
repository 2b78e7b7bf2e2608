//! Cells that fill space, of any kind: blocks of one kind each, with the nodes of their cells one after the other.

use super::MeshError;
use super::topology::CellKind;
use std::collections::TryReserveError;
use std::ops::Range;

/// Cells that fill space, in the order of their kinds (tetrahedra first), cells of one kind in the order in which they
/// were added. A cell's row counts all cells before it.
#[derive(Clone, Debug, Default)]
pub struct Cells {
    /// Ascending by kind, each kind once.
    blocks: Vec<CellBlock>,
}

#[derive(Clone, Debug)]
struct CellBlock {
    kind: CellKind,
    /// Nodes of each.
    each: usize,
    /// How many cells.
    count: usize,
    nodes: Vec<u32>,
}

impl CellBlock {
    fn nodes(&self, row: usize) -> &[u32] {
        &self.nodes[row * self.each..][..self.each]
    }

    fn push(&mut self, nodes: impl Iterator<Item = u32>) {
        self.nodes.extend(nodes);
        self.count += 1;
        debug_assert_eq!(self.nodes.len(), self.count * self.each, "{:?}", self.kind);
    }

    fn extend(&mut self, nodes: impl IntoIterator<Item = u32>) {
        self.nodes.extend(nodes);
        debug_assert!(self.nodes.len().is_multiple_of(self.each), "{:?}", self.kind);
        self.count = self.nodes.len() / self.each;
    }
}

impl Cells {
    /// Cells of one kind by their nodes.
    ///
    /// # Errors
    /// The kind does not fill space, or has another number of nodes.
    pub fn of<const N: usize>(kind: CellKind, cells: &[[u32; N]]) -> Result<Self, MeshError> {
        fits(kind, N)?;
        let mut all = Self::default();
        all.block(kind).extend(cells.as_flattened().iter().copied());
        Ok(all)
    }

    /// Triangles alone: a surface to be written, no mesh of elements.
    #[doc(hidden)]
    pub fn triangles(corners: &[[u32; 3]]) -> Self {
        let mut all = Self::default();
        all.block(CellKind::Triangle).extend(corners.as_flattened().iter().copied());
        all
    }

    /// Adds a cell by its nodes; behind the others of its kind, so before those of later kinds.
    ///
    /// # Errors
    /// The kind does not fill space, or has another number of nodes.
    pub fn push<const N: usize>(&mut self, kind: CellKind, nodes: [u32; N]) -> Result<(), MeshError> {
        fits(kind, N)?;
        self.block(kind).push(nodes.into_iter());
        Ok(())
    }

    /// Adds cells by their nodes, one cell after the other: as many as the kind has, of a kind that fills space.
    #[doc(hidden)]
    pub fn extend_kind(&mut self, kind: CellKind, nodes: impl IntoIterator<Item = u32>) {
        debug_assert!(kind.topology().solid.is_some(), "{kind:?}");
        self.block(kind).extend(nodes);
    }

    /// The same of one cell.
    pub(crate) fn push_nodes(&mut self, kind: CellKind, nodes: &[u32]) {
        debug_assert!(kind.topology().solid.is_some(), "{kind:?}");
        self.block(kind).push(nodes.iter().copied());
    }

    /// Makes room for so many more of a kind, or some more.
    #[doc(hidden)]
    pub fn reserve(&mut self, kind: CellKind, cells: usize) {
        let block = self.block(kind);
        block.nodes.reserve(cells * block.each);
    }

    /// Adds all of some others, with `first` added to each of their nodes.
    #[doc(hidden)]
    pub fn extend_moved(&mut self, others: &Cells, first: u32) {
        for block in &others.blocks {
            self.block(block.kind).extend(block.nodes.iter().map(|node| node + first));
        }
    }

    /// Makes room for so many more of a kind.
    ///
    /// # Errors
    /// They do not fit into memory.
    #[doc(hidden)]
    pub fn try_reserve_exact(&mut self, kind: CellKind, cells: usize) -> Result<(), TryReserveError> {
        let block = self.block(kind);
        block.nodes.try_reserve_exact(cells.saturating_mul(block.each))
    }

    fn block(&mut self, kind: CellKind) -> &mut CellBlock {
        let place = match self.blocks.binary_search_by_key(&kind, |block| block.kind) {
            Ok(place) => place,
            Err(place) => {
                self.blocks.insert(place, CellBlock { kind, each: kind.node_count(), count: 0, nodes: Vec::new() });
                place
            }
        };
        &mut self.blocks[place]
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.blocks.iter().map(|block| block.count).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The kinds there are, ascending, with how many of each.
    pub fn kinds(&self) -> impl Iterator<Item = (CellKind, usize)> + Clone {
        self.blocks.iter().map(|block| (block.kind, block.count)).filter(|(_, count)| *count > 0)
    }

    /// The kinds there are, ascending, with the rows of their cells and the nodes of these, one cell after the other.
    pub fn blocks(&self) -> impl Iterator<Item = (CellKind, Range<usize>, &[u32])> + Clone {
        let mut end = 0;
        self.blocks.iter().filter(|block| block.count > 0).map(move |block| {
            let first = end;
            end += block.count;
            (block.kind, first..end, &block.nodes[..])
        })
    }

    /// How many of a kind there are.
    #[doc(hidden)]
    pub fn count(&self, kind: CellKind) -> usize {
        self.kinds().find(|of| of.0 == kind).map_or(0, |of| of.1)
    }

    /// The row of the first cell of a kind, or where it would be.
    #[doc(hidden)]
    pub fn first(&self, kind: CellKind) -> usize {
        self.kinds().take_while(|of| of.0 < kind).map(|of| of.1).sum()
    }

    /// The place of a row's block, and the block's first row. A row that is not there is beyond the last block.
    fn place(&self, row: usize) -> (usize, usize) {
        let mut first = 0;
        for (place, block) in self.blocks.iter().enumerate() {
            if row - first < block.count {
                return (place, first);
            }
            first += block.count;
        }
        (self.blocks.len(), first)
    }

    /// The kind of a cell. Panics on a row that is not there.
    pub fn kind(&self, row: usize) -> CellKind {
        self.blocks[self.place(row).0].kind
    }

    /// The nodes of a cell. Panics on a row that is not there.
    pub fn nodes(&self, row: usize) -> &[u32] {
        let (place, first) = self.place(row);
        self.blocks[place].nodes(row - first)
    }

    /// The same, to be changed. Panics on a row that is not there.
    #[doc(hidden)]
    pub fn nodes_mut(&mut self, row: usize) -> &mut [u32] {
        let (place, first) = self.place(row);
        let CellBlock { each, nodes, .. } = &mut self.blocks[place];
        &mut nodes[(row - first) * *each..][..*each]
    }

    /// All cells in their order.
    pub fn iter(&self) -> Iter<'_> {
        Iter { blocks: self.blocks.iter(), kind: CellKind::Tet4, nodes: [].chunks_exact(1), left: self.len() }
    }

    /// The nodes of all cells, one cell after the other.
    #[doc(hidden)]
    pub fn all_nodes(&self) -> impl Iterator<Item = u32> + Clone + '_ {
        self.blocks.iter().flat_map(|block| block.nodes.iter().copied())
    }

    /// The cells of a kind whose cells have `N` nodes; `None` for a kind that has another number.
    pub fn of_kind<const N: usize>(&self, kind: CellKind) -> Option<&[[u32; N]]> {
        let of = self.blocks.iter().find(|block| block.kind == kind);
        (N == kind.node_count()).then(|| of.map_or(&[][..], |block| block.nodes.as_chunks().0))
    }

    /// The cells of some rows, ascending, with other names for their nodes. Panics on a row that is not there.
    #[doc(hidden)]
    pub fn select(&self, rows: impl IntoIterator<Item = usize>, mut rename: impl FnMut(u32) -> u32) -> Cells {
        let mut selected = Cells::default();
        let mut rows = rows.into_iter().peekable();
        while let Some(&row) = rows.peek() {
            let (place, first) = self.place(row);
            let (from, to) = (&self.blocks[place], selected.block(self.blocks[place].kind));
            // rows of this block follow each other
            while let Some(row) = rows.next_if(|row| (first..first + from.count).contains(row)) {
                to.push(from.nodes(row - first).iter().map(|&node| rename(node)));
            }
        }
        selected
    }
}

/// Refuses cells of a kind by so many nodes.
fn fits(kind: CellKind, nodes: usize) -> Result<(), MeshError> {
    let topology = kind.topology();
    let (plural, count) = (topology.plural, kind.node_count());
    let refuse = |value: String, allowed: String| {
        Err(MeshError::Parameter { name: "cells of a mesh", parameter: topology.name, value, allowed })
    };
    match topology.solid {
        None => {
            let solids: Vec<&str> = CellKind::solids().map(|(kind, _)| kind.topology().plural).collect();
            refuse(format!("a kind of {plural}"), format!("cells of a mesh fill space: {}", solids.join(", ")))
        }
        Some(_) if nodes != count => refuse(format!("given by {nodes} nodes"), format!("{plural} have {count}")),
        Some(_) => Ok(()),
    }
}

/// Cells in their order: kinds and nodes.
#[derive(Clone, Debug)]
pub struct Iter<'a> {
    blocks: std::slice::Iter<'a, CellBlock>,
    kind: CellKind,
    nodes: std::slice::ChunksExact<'a, u32>,
    left: usize,
}

impl<'a> Iterator for Iter<'a> {
    type Item = (CellKind, &'a [u32]);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(nodes) = self.nodes.next() {
                self.left -= 1;
                return Some((self.kind, nodes));
            }
            let block = self.blocks.next()?;
            (self.kind, self.nodes) = (block.kind, block.nodes.chunks_exact(block.each));
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl ExactSizeIterator for Iter<'_> {}

impl<'a> IntoIterator for &'a Cells {
    type Item = (CellKind, &'a [u32]);
    type IntoIter = Iter<'a>;

    fn into_iter(self) -> Iter<'a> {
        self.iter()
    }
}

impl<'a> Extend<&'a Cells> for Cells {
    fn extend<T: IntoIterator<Item = &'a Cells>>(&mut self, all: T) {
        all.into_iter().for_each(|cells| self.extend_moved(cells, 0));
    }
}

impl PartialEq for Cells {
    fn eq(&self, other: &Self) -> bool {
        self.blocks().eq(other.blocks())
    }
}
