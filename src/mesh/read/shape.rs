//! Shapes of cells that files may hold and sinew makes use of.

/// A shape; corners in VTK order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Shape {
    /// One point.
    Point,
    /// Two points.
    Line,
    /// Three points.
    Triangle,
    /// Four points, in order around it.
    Quad,
    /// Four points, row by row.
    Pixel,
    /// Four points.
    Tet,
    /// Eight points, in order around the bottom, then the top.
    Hex,
    /// Eight points, row by row.
    Voxel,
}

/// What VTK calls cells that sinew cannot use: type, name, dimension.
const FOREIGN_VTK: [(u8, &str, u8); 30] = [
    (0, "empty cells", 0),
    (2, "poly-vertices", 0),
    (4, "polylines", 1),
    (6, "triangle strips", 2),
    (7, "polygons", 2),
    (13, "wedges", 3),
    (14, "pyramids", 3),
    (15, "pentagonal prisms", 3),
    (16, "hexagonal prisms", 3),
    (21, "3-node lines", 1),
    (22, "6-node triangles", 2),
    (23, "8-node quadrilaterals", 2),
    (24, "10-node tetrahedra", 3),
    (25, "20-node hexahedra", 3),
    (26, "15-node wedges", 3),
    (27, "13-node pyramids", 3),
    (28, "9-node quadrilaterals", 2),
    (29, "27-node hexahedra", 3),
    (30, "6-node quadrilaterals", 2),
    (31, "12-node wedges", 3),
    (32, "18-node wedges", 3),
    (33, "24-node hexahedra", 3),
    (34, "7-node triangles", 2),
    (35, "4-node lines", 1),
    (37, "19-node pyramids", 3),
    (42, "polyhedra", 3),
    (71, "Lagrange tetrahedra", 3),
    (72, "Lagrange hexahedra", 3),
    (78, "Bézier tetrahedra", 3),
    (79, "Bézier hexahedra", 3),
];

impl Shape {
    /// How many points it has.
    pub fn corner_count(self) -> usize {
        match self {
            Shape::Point => 1,
            Shape::Line => 2,
            Shape::Triangle => 3,
            Shape::Quad | Shape::Pixel | Shape::Tet => 4,
            Shape::Hex | Shape::Voxel => 8,
        }
    }

    /// 0 for points to 3 for volumes.
    pub fn dimension(self) -> u8 {
        match self {
            Shape::Point => 0,
            Shape::Line => 1,
            Shape::Triangle | Shape::Quad | Shape::Pixel => 2,
            Shape::Tet | Shape::Hex | Shape::Voxel => 3,
        }
    }

    /// What many of them are called.
    pub fn plural(self) -> &'static str {
        match self {
            Shape::Point => "points",
            Shape::Line => "lines",
            Shape::Triangle => "triangles",
            Shape::Quad => "quadrilaterals",
            Shape::Pixel => "pixels",
            Shape::Tet => "tetrahedra",
            Shape::Hex => "hexahedra",
            Shape::Voxel => "voxels",
        }
    }

    /// The shape of a VTK cell type; else its name and dimension (3 where it is not known).
    pub fn of_vtk(kind: u8) -> Result<Shape, (String, u8)> {
        Ok(match kind {
            1 => Shape::Point,
            3 => Shape::Line,
            5 => Shape::Triangle,
            8 => Shape::Pixel,
            9 => Shape::Quad,
            10 => Shape::Tet,
            11 => Shape::Voxel,
            12 => Shape::Hex,
            _ => {
                let known = FOREIGN_VTK.iter().find(|foreign| foreign.0 == kind);
                return Err(known.map_or((format!("cells of VTK type {kind}"), 3), |&(_, name, dimension)| {
                    (name.into(), dimension)
                }));
            }
        })
    }
}
