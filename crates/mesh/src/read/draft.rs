//! What a file says, before it is a mesh: cells of all shapes that name points by the file's numbers.

mod assemble;
mod numbering;

use crate::CellKind;
use glam::DVec3;
use std::collections::BTreeMap;

/// What a reader has gathered.
#[derive(Default)]
pub struct Draft {
    /// Coordinates (m).
    pub points: Vec<DVec3>,
    /// The file's number of each point; rows from 0 when left out.
    pub point_numbers: Option<Vec<u64>>,
    /// Cells one after the other.
    cells: Vec<Cell>,
    /// Points of all cells by the file's numbers.
    corners: Vec<u64>,
    /// Cells of each named group, ascending.
    groups: BTreeMap<String, Vec<u32>>,
    /// Named vectors: number of a cell, vector.
    pub vectors: BTreeMap<String, Vec<(u64, DVec3)>>,
    /// Volume cells that sinew cannot use: how many of which kind.
    refused: BTreeMap<String, usize>,
    /// Other cells that are not read: how many of which kind.
    left_out: BTreeMap<String, usize>,
    /// What the author should know.
    pub notes: Vec<String>,
    /// Whether the format repeats an element for each of its groups.
    pub repeats_elements: bool,
}

#[derive(Clone, Copy)]
struct Cell {
    kind: CellKind,
    number: u64,
    /// First of its `corners`.
    start: usize,
}

impl Draft {
    /// A draft whose points have numbers of their own.
    pub fn numbered() -> Self {
        Draft { point_numbers: Some(Vec::new()), ..Draft::default() }
    }

    /// A draft whose points are numbered by row.
    pub fn with_notes(notes: Vec<String>) -> Self {
        Draft { notes, ..Draft::default() }
    }

    /// Adds a cell by its nodes; gives its row for [`Draft::group`].
    pub fn add(&mut self, kind: CellKind, number: u64, corners: impl IntoIterator<Item = u64>) -> u32 {
        self.cells.push(Cell { kind, number, start: self.corners.len() });
        self.corners.extend(corners);
        debug_assert_eq!(self.corners.len() - self.cells[self.cells.len() - 1].start, kind.node_count());
        (self.cells.len() - 1) as u32
    }

    /// Counts a cell that sinew cannot use: refused when it has volume, else left out.
    pub fn cannot_use(&mut self, name: &str, dimension: u8) {
        let counts = if dimension == 3 { &mut self.refused } else { &mut self.left_out };
        match counts.get_mut(name) {
            Some(count) => *count += 1,
            None => drop(counts.insert(name.into(), 1)),
        }
    }

    /// Puts a cell into a named group.
    pub fn group(&mut self, name: &str, cell: u32) {
        match self.groups.get_mut(name) {
            Some(cells) => cells.push(cell),
            None => drop(self.groups.insert(name.into(), vec![cell])),
        }
    }

    /// The file's numbers of a cell's points.
    fn corners(&self, cell: usize) -> &[u64] {
        let Cell { kind, start, .. } = self.cells[cell];
        &self.corners[start..start + kind.node_count()]
    }
}
