//! Whether a mesh can be simulated, and what its author should know: all findings at once, by the author's numbers.

mod elements;
mod points;

use super::{Mesh, MeshError};
use std::fmt;

/// Kinds of findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// There are no elements.
    Empty,
    /// A column or a set does not fit the points and elements.
    Misfit,
    /// A point has a coordinate that is not a finite number.
    NotFinite,
    /// An element names a row that the points do not have.
    OutOfRange,
    /// An element names a point twice.
    RepeatedNode,
    /// Two elements have the same points.
    RepeatedElement,
    /// An element without volume.
    Flat,
    /// An element with negative volume, or one folded at a corner or where its edges curve.
    Inverted,
    /// A very thin element (warning).
    Sliver,
    /// Points in the same place (warning).
    Coincident,
    /// Points of no element (warning).
    Unused,
}

/// One thing found: its text names the first ten ids, `ids` holds all.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What kind it is.
    pub defect: Defect,
    /// The author's numbers of the elements or points concerned.
    pub ids: Vec<u64>,
    text: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

/// What was found about a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soundness {
    /// The mesh cannot be simulated until these are put right.
    pub errors: Vec<Finding>,
    /// The mesh can be simulated, but its author should know.
    pub warnings: Vec<Finding>,
}

/// The most ids that a text names.
const LISTED: usize = 10;

/// A size below this share of the same power of the longest edge counts as none.
const FLAT: f64 = 1e-12;

impl Mesh {
    /// Looks for everything that is wrong with the mesh.
    pub fn soundness(&self) -> Soundness {
        let mut found = Soundness::default();
        if self.element_count() == 0 {
            found.error(Defect::Empty, vec![], "there are no elements: add tetrahedra, hexahedra or wedges".into());
        }
        self.check_columns(&mut found);
        self.check_points(&mut found);
        self.check_elements(&mut found);
        found
    }

    /// Refuses a mesh with errors; `name` says which mesh it is.
    pub fn require_sound(&self, name: &str) -> Result<(), MeshError> {
        let findings = self.soundness().errors;
        if findings.is_empty() {
            return Ok(());
        }
        Err(MeshError::Unsound { name: name.into(), findings, notes: self.notes.clone() })
    }

    /// Checks that sets, vectors and numbers fit the points and elements.
    fn check_columns(&self, found: &mut Soundness) {
        let mut misfit = |text: String| found.error(Defect::Misfit, vec![], text);
        let (points, elements) = (self.points.len(), self.element_count());
        for (what, ids, rows) in [("points", &self.point_ids, points), ("elements", &self.element_ids, elements)] {
            if let super::Ids::Named(ids) = ids
                && ids.len() != rows
            {
                misfit(format!("{} numbers are given to {rows} {what}: give each one", ids.len()));
            }
        }
        for (name, rows) in &self.node_sets {
            if let Some(row) = rows.iter().find(|&&row| row as usize >= points) {
                misfit(format!("the node set `{name}` names point row {row}: rows are below {points}"));
            }
        }
        for (name, faces) in &self.face_sets {
            if let Some(row) = faces.iter().flatten().find(|&&row| row as usize >= points) {
                misfit(format!("the face set `{name}` names point row {row}: rows are below {points}"));
            }
        }
        for (name, rows) in &self.element_sets {
            if let Some(row) = rows.iter().find(|&&row| row as usize >= elements) {
                misfit(format!("the element set `{name}` names element row {row}: rows are below {elements}"));
            }
        }
        for (name, vectors) in &self.element_vectors {
            if vectors.len() != elements {
                misfit(format!("`{name}` has {} vectors for {elements} elements: give each one", vectors.len()));
            } else if let Some(row) = vectors.iter().position(|vector| !vector.is_finite()) {
                misfit(format!("`{name}` is not finite in element {}", self.element_name(row)));
            }
        }
    }

    /// The author's number of an element; its row where numbers are missing.
    fn element_name(&self, row: usize) -> u64 {
        match &self.element_ids {
            super::Ids::Named(ids) => ids.get(row).copied().unwrap_or(row as u64),
            super::Ids::Rows => row as u64,
        }
    }

    /// The author's number of a point; its row where numbers are missing.
    fn point_name(&self, row: usize) -> u64 {
        match &self.point_ids {
            super::Ids::Named(ids) => ids.get(row).copied().unwrap_or(row as u64),
            super::Ids::Rows => row as u64,
        }
    }
}

impl Soundness {
    /// Whether there are no errors.
    pub fn is_sound(&self) -> bool {
        self.errors.is_empty()
    }

    fn error(&mut self, defect: Defect, ids: Vec<u64>, text: String) {
        self.errors.push(Finding { defect, ids, text });
    }

    fn warn(&mut self, defect: Defect, ids: Vec<u64>, text: String) {
        self.warnings.push(Finding { defect, ids, text });
    }
}

/// "3 flat elements" and the first names, and how many more there are.
fn counted(count: usize, one: &str, many: &str, names: impl Iterator<Item = String>) -> String {
    let listed: Vec<String> = names.take(LISTED).collect();
    let more = if count > listed.len() { format!(" and {} more", count - listed.len()) } else { String::new() };
    format!("{count} {}: {}{more}", if count == 1 { one } else { many }, listed.join(", "))
}
