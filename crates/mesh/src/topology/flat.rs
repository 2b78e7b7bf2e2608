//! Points, lines and faces.

use super::{CellKind, Listing, Split, Topology};

/// One point.
pub static POINT: Topology = Topology {
    name: "Point",
    plural: "points",
    dimension: 0,
    nodes: &[[0.0; 3]],
    corners: 1,
    edges: &[],
    faces: &[],
    facets: &[],
    vtk: &[Listing { number: 1, order: &[0] }],
    gmsh: Listing { number: 15, order: &[0] },
    split: None,
    solid: None,
};

/// Two points.
pub static LINE: Topology = Topology {
    name: "Line",
    plural: "lines",
    dimension: 1,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
    corners: 2,
    edges: &[[0, 1]],
    faces: &[],
    facets: &[],
    vtk: &[Listing { number: 3, order: &[0, 1] }],
    gmsh: Listing { number: 1, order: &[0, 1] },
    split: None,
    solid: None,
};

/// Three points.
pub static TRIANGLE: Topology = Topology {
    name: "Triangle",
    plural: "triangles",
    dimension: 2,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    corners: 3,
    edges: &[[0, 1], [1, 2], [2, 0]],
    faces: &[],
    facets: &[[0, 1, 2, 2]],
    vtk: &[Listing { number: 5, order: &[0, 1, 2] }],
    gmsh: Listing { number: 2, order: &[0, 1, 2] },
    split: Some(&Split {
        points: &[&[0], &[1], &[2], &[0, 1], &[1, 2], &[2, 0]],
        parts: &[&[0, 3, 5], &[3, 1, 4], &[5, 4, 2], &[3, 4, 5]],
        inner: &[],
    }),
    solid: None,
};

/// The ends of a line, and its middle.
pub static LINE3: Topology = Topology {
    name: "Line3",
    plural: "3-node lines",
    dimension: 1,
    nodes: &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]],
    corners: 2,
    edges: &[[0, 1]],
    faces: &[],
    facets: &[],
    vtk: &[Listing { number: 21, order: &[0, 1, 2] }],
    gmsh: Listing { number: 8, order: &[0, 1, 2] },
    split: None,
    solid: None,
};

/// The corners of a triangle, and the middles of its edges.
pub static TRIANGLE6: Topology = Topology {
    name: "Triangle6",
    plural: "6-node triangles",
    dimension: 2,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.0]],
    corners: 3,
    edges: &[[0, 1], [1, 2], [2, 0]],
    faces: &[],
    facets: &[[0, 3, 5, 5], [3, 1, 4, 4], [5, 4, 2, 2], [3, 4, 5, 5]],
    vtk: &[Listing { number: 22, order: &[0, 1, 2, 3, 4, 5] }],
    gmsh: Listing { number: 9, order: &[0, 1, 2, 3, 4, 5] },
    // by its corners
    split: TRIANGLE.split,
    solid: None,
};

/// Four points, in order around it; files may list them row by row (pixels).
pub static QUAD: Topology = Topology {
    name: "Quad",
    plural: "quadrilaterals",
    dimension: 2,
    nodes: &[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
    corners: 4,
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0]],
    faces: &[],
    facets: &[[0, 1, 2, 3]],
    vtk: &[Listing { number: 9, order: &[0, 1, 2, 3] }, Listing { number: 8, order: &[0, 1, 3, 2] }],
    gmsh: Listing { number: 3, order: &[0, 1, 2, 3] },
    split: Some(&Split {
        points: &[&[0], &[1], &[2], &[3], &[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]],
        parts: &[&[0, 4, 8, 7], &[4, 1, 5, 8], &[8, 5, 2, 6], &[7, 8, 6, 3]],
        inner: &[],
    }),
    solid: None,
};

impl CellKind {
    /// The face of so many different nodes.
    pub fn of_face(nodes: &[u32; 4]) -> CellKind {
        if nodes[2] == nodes[3] { CellKind::Triangle } else { CellKind::Quad }
    }
}
