//! Gmsh's element types.

use crate::mesh::read::shape::Shape;

/// What an element type is.
#[derive(Clone, Copy)]
pub struct Kind {
    /// The shape sinew makes use of, if any.
    pub shape: Option<Shape>,
    /// What many of them are called.
    pub name: &'static str,
    /// Points of each.
    pub nodes: usize,
    /// 0 for points to 3 for volumes.
    pub dimension: u8,
}

/// Number, name, points, dimension of types that sinew cannot use.
const FOREIGN: [(u64, &str, usize, u8); 26] = [
    (6, "wedges", 6, 3),
    (7, "pyramids", 5, 3),
    (8, "3-node lines", 3, 1),
    (9, "6-node triangles", 6, 2),
    (10, "9-node quadrilaterals", 9, 2),
    (11, "10-node tetrahedra", 10, 3),
    (12, "27-node hexahedra", 27, 3),
    (13, "18-node wedges", 18, 3),
    (14, "14-node pyramids", 14, 3),
    (16, "8-node quadrilaterals", 8, 2),
    (17, "20-node hexahedra", 20, 3),
    (18, "15-node wedges", 15, 3),
    (19, "13-node pyramids", 13, 3),
    (20, "9-node triangles", 9, 2),
    (21, "10-node triangles", 10, 2),
    (22, "12-node triangles", 12, 2),
    (23, "15-node triangles", 15, 2),
    (24, "15-node triangles", 15, 2),
    (25, "21-node triangles", 21, 2),
    (26, "4-node lines", 4, 1),
    (27, "5-node lines", 5, 1),
    (28, "6-node lines", 6, 1),
    (29, "20-node tetrahedra", 20, 3),
    (30, "35-node tetrahedra", 35, 3),
    (31, "56-node tetrahedra", 56, 3),
    (92, "64-node hexahedra", 64, 3),
];

/// The kind of a type's number, if it is known.
pub fn kind(number: u64) -> Option<Kind> {
    let shape = match number {
        1 => Shape::Line,
        2 => Shape::Triangle,
        3 => Shape::Quad,
        4 => Shape::Tet,
        5 => Shape::Hex,
        15 => Shape::Point,
        _ => {
            let &(_, name, nodes, dimension) = FOREIGN.iter().find(|foreign| foreign.0 == number)?;
            return Some(Kind { shape: None, name, nodes, dimension });
        }
    };
    let (name, nodes, dimension) = (shape.plural(), shape.corner_count(), shape.dimension());
    Some(Kind { shape: Some(shape), name, nodes, dimension })
}
