//! `nodes.csv`: where every node ended up, in the author's numbering.

use super::{OutputError, write_table};
use glam::DVec3;
use std::path::Path;

/// One row of `nodes.csv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// The author's number.
    pub id: u64,
    /// Rest position (m).
    pub position: DVec3,
    /// Displacement (m).
    pub displacement: DVec3,
    /// Internal force F of M ü = R − F (N): what it takes to hold the node against its deformed elements.
    pub force: DVec3,
    /// Lumped mass (kg).
    pub mass: f64,
}

/// The columns, each with its unit.
pub const COLUMNS: [(&str, &str); 11] = [
    ("id", "1"),
    ("X", "m"),
    ("Y", "m"),
    ("Z", "m"),
    ("ux", "m"),
    ("uy", "m"),
    ("uz", "m"),
    ("fx", "N"),
    ("fy", "N"),
    ("fz", "N"),
    ("mass", "kg"),
];

/// The name of a body's file, where there are so many bodies.
pub fn file_name(body: &str, bodies: usize) -> String {
    if bodies == 1 { "nodes.csv".into() } else { format!("nodes_{body}.csv") }
}

/// Writes the table, one row a node, with as many digits as give each number back exactly.
///
/// # Errors
/// Files that cannot be written.
pub fn write(path: &Path, nodes: impl IntoIterator<Item = Node>) -> Result<(), OutputError> {
    let row = |Node { id, position: x, displacement: u, force: f, mass }| {
        (id, x.x, x.y, x.z, u.x, u.y, u.z, f.x, f.y, f.z, mass)
    };
    write_table(path, &COLUMNS.map(|(name, _)| name), nodes.into_iter().map(row))
}
