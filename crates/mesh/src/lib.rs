//! Meshes as authors give them: points, elements and named sets in the author's order and numbering; surfaces of
//! triangles.
//!
//! A [`Mesh`] is what generators make and files hold; the engine, whose `sinew::mesh` this is, renumbers it for
//! locality when a body is built from it. Files (Gmsh, VTK, VTU; STL, OBJ, PLY and glTF of triangles) are read with the
//! feature `files`.

#[cfg(not(feature = "files"))]
mod absent;
mod cells;
mod error;
#[doc(hidden)]
pub mod generators;
#[cfg(feature = "files")]
mod gmsh;
mod locate;
#[doc(hidden)]
pub mod measure;
mod pieces;
mod placement;
#[doc(hidden)]
pub mod quality;
#[cfg(feature = "files")]
mod read;
mod refine;
mod repeat;
mod report;
#[doc(hidden)]
pub mod soundness;
mod surface;
#[doc(hidden)]
pub mod topology;
mod triangle;
mod triangles;
#[cfg(feature = "files")]
mod vtk;
#[cfg(feature = "files")]
#[doc(hidden)]
pub mod vtu;

pub use cells::Cells;
pub use error::{FilePosition, MeshError};
pub use generators::ElementKind;
#[doc(hidden)]
pub use locate::{Location, Locator};
#[doc(hidden)]
pub use pieces::{NO_PIECE, lowest};
#[doc(hidden)]
pub use placement::{angles_about_axes, rotation_about_axes};
#[doc(hidden)]
pub use quality::Quality;
#[cfg(feature = "files")]
#[doc(hidden)]
pub use read::Fault;
#[cfg(feature = "files")]
#[doc(hidden)]
pub use read::cursor::{Cursor, Form as NumberForm};
#[doc(hidden)]
pub use report::{MeshReport, SetReport, extent};
pub use surface::SurfaceFace;
#[doc(hidden)]
pub use surface::nodes_of_face;
pub use topology::CellKind;
#[doc(hidden)]
#[doc(hidden)]
pub use triangle::OnTriangle;
pub use triangles::{EdgeFault, SurfaceError, Triangles};

use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The numbers an author knows things by: row numbers from 0, or the numbers that a file gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Ids {
    /// Row `i` is called `i`.
    #[default]
    Rows,
    /// Row `i` is called by the `i`-th number.
    Named(Vec<u64>),
}

impl Ids {
    /// The author's number of a row.
    pub fn of(&self, row: usize) -> u64 {
        match self {
            Ids::Rows => row as u64,
            Ids::Named(ids) => ids[row],
        }
    }
}

/// A volume mesh in the author's order.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Rest positions (m), one row a point.
    pub points: Vec<DVec3>,
    /// The author's number of each point.
    pub point_ids: Ids,
    /// Elements by rows of `points`: [`CellKind`] has the order of their nodes.
    pub cells: Cells,
    /// The author's number of each element, in the order of `cells`.
    pub element_ids: Ids,
    /// Named sets of points (rows of `points`, ascending, each once).
    pub node_sets: BTreeMap<String, Vec<u32>>,
    /// Lists of points by their numbers, with their rows (ascending, each once): [`Mesh::refine`] adds the new points
    /// between them, as it does to named sets.
    pub point_lists: BTreeMap<Vec<u64>, Vec<u32>>,
    /// Named sets of surface faces: rows of `points`; a triangle repeats its last point.
    pub face_sets: BTreeMap<String, Vec<[u32; 4]>>,
    /// Named sets of elements (rows of `cells`, ascending, each once).
    pub element_sets: BTreeMap<String, Vec<u32>>,
    /// Named vectors, one row an element: fibre directions, for instance.
    pub element_vectors: BTreeMap<String, Vec<DVec3>>,
    /// What the author should know about how the mesh was read, one sentence each.
    pub notes: Vec<String>,
}

impl Mesh {
    /// The nodes of all sets by their names, each once.
    #[doc(hidden)]
    pub fn nodes_of_sets(&self) -> BTreeMap<String, Vec<u32>> {
        let mut all: BTreeMap<String, BTreeSet<u32>> = BTreeMap::new();
        for (name, nodes) in &self.node_sets {
            all.entry(name.clone()).or_default().extend(nodes);
        }
        for (name, faces) in &self.face_sets {
            all.entry(name.clone()).or_default().extend(faces.as_flattened());
        }
        for (name, elements) in &self.element_sets {
            let nodes = elements.iter().flat_map(|element| self.element(*element as usize));
            all.entry(name.clone()).or_default().extend(nodes);
        }
        all.into_iter().map(|(name, nodes)| (name, nodes.into_iter().collect())).collect()
    }

    /// Keeps a list of points by their numbers, if the mesh has all of them.
    #[doc(hidden)]
    pub fn keep_list(&mut self, numbers: &[u64], rows: &HashMap<u64, usize>) {
        let found: Option<BTreeSet<u32>> = numbers.iter().map(|id| rows.get(id).map(|&row| row as u32)).collect();
        if let Some(found) = found {
            self.point_lists.insert(numbers.to_vec(), found.into_iter().collect());
        }
    }

    /// Rows of the points by their numbers.
    #[doc(hidden)]
    pub fn point_rows(&self) -> HashMap<u64, usize> {
        (0..self.points.len()).map(|row| (self.point_ids.of(row), row)).collect()
    }

    /// How many elements there are, of all kinds.
    pub fn element_count(&self) -> usize {
        self.cells.len()
    }

    /// The points of an element. Panics on a row that is not there.
    pub fn element(&self, row: usize) -> &[u32] {
        self.cells.nodes(row)
    }
}
