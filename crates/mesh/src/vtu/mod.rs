//! VTU files (VTK's XML format of unstructured grids): text, base64 or raw, compressed by zlib or lz4 or not.
//!
//! [`read`] gives all that a file holds; [`Mesh::read`](super::Mesh::read) makes a mesh of it.

mod appended;
mod cells;
mod decode;
pub(super) mod scalar;
mod xml;

use super::MeshError;
use glam::DVec3;
use std::collections::BTreeMap;
use std::path::Path;

pub(super) use xml::parse;

/// A column of a file: so many rows of `components` numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataArray {
    /// Numbers a row.
    pub components: usize,
    /// All numbers, row by row; integers beyond 2⁵³ are rounded.
    pub values: Vec<f64>,
    /// Whether the file stores integers.
    pub integers: bool,
}

/// What a VTU file holds, its pieces joined.
#[derive(Clone, Debug, Default)]
pub struct VtuFile {
    /// Coordinates of points (m).
    pub points: Vec<DVec3>,
    /// VTK's type of each cell (10: tetrahedron, 12: hexahedron).
    pub types: Vec<u8>,
    /// Where each cell ends in `connectivity`.
    pub offsets: Vec<usize>,
    /// Rows of `points` of all cells, one cell after the other; not checked against the points.
    pub connectivity: Vec<u64>,
    /// Columns with one row a point.
    pub point_data: BTreeMap<String, DataArray>,
    /// Columns with one row a cell.
    pub cell_data: BTreeMap<String, DataArray>,
    /// What of the file was left out, one sentence each.
    pub notes: Vec<String>,
}

/// Reads a VTU file.
pub fn read(path: impl AsRef<Path>) -> Result<VtuFile, MeshError> {
    let path = path.as_ref();
    let bytes = std::fs::read(path).map_err(|source| MeshError::Unreadable { file: path.into(), source })?;
    parse(&bytes).map_err(|fault| fault.in_file(path))
}

impl VtuFile {
    /// The points of a cell, as rows of `points`; nothing for a cell that is not there.
    pub fn cell(&self, row: usize) -> &[u64] {
        let start = if row == 0 { 0 } else { self.offsets.get(row - 1).copied().unwrap_or(0) };
        let end = self.offsets.get(row).copied().unwrap_or(start);
        self.connectivity.get(start..end).unwrap_or(&[])
    }
}
