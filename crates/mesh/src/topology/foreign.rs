//! Cells that files may hold and sinew cannot use.

/// A cell of no kind of sinew's.
pub struct Foreign {
    /// What many of them are called.
    pub plural: &'static str,
    /// Nodes of each; 0 where that varies.
    pub nodes: usize,
    /// 0 for points to 3 for cells that fill space.
    pub dimension: u8,
    /// VTK's type.
    pub vtk: Option<u8>,
    /// Gmsh's type.
    pub gmsh: Option<u64>,
}

const fn cell(plural: &'static str, nodes: usize, dimension: u8, vtk: Option<u8>, gmsh: Option<u64>) -> Foreign {
    Foreign { plural, nodes, dimension, vtk, gmsh }
}

/// All that are known.
pub static CELLS: [Foreign; 39] = [
    cell("empty cells", 0, 0, Some(0), None),
    cell("poly-vertices", 0, 0, Some(2), None),
    cell("polylines", 0, 1, Some(4), None),
    cell("4-node lines", 4, 1, Some(35), Some(26)),
    cell("5-node lines", 5, 1, None, Some(27)),
    cell("6-node lines", 6, 1, None, Some(28)),
    cell("polygons", 0, 2, Some(7), None),
    cell("triangle strips", 0, 2, Some(6), None),
    cell("6-node quadrilaterals", 6, 2, Some(30), None),
    cell("7-node triangles", 7, 2, Some(34), None),
    cell("8-node quadrilaterals", 8, 2, Some(23), Some(16)),
    cell("9-node quadrilaterals", 9, 2, Some(28), Some(10)),
    cell("9-node triangles", 9, 2, None, Some(20)),
    cell("10-node triangles", 10, 2, None, Some(21)),
    cell("12-node triangles", 12, 2, None, Some(22)),
    cell("15-node triangles", 15, 2, None, Some(23)),
    cell("15-node triangles", 15, 2, None, Some(24)),
    cell("21-node triangles", 21, 2, None, Some(25)),
    cell("Bézier hexahedra", 0, 3, Some(79), None),
    cell("Bézier tetrahedra", 0, 3, Some(78), None),
    cell("Lagrange hexahedra", 0, 3, Some(72), None),
    cell("Lagrange tetrahedra", 0, 3, Some(71), None),
    cell("polyhedra", 0, 3, Some(42), None),
    cell("pyramids", 5, 3, Some(14), Some(7)),
    cell("pentagonal prisms", 10, 3, Some(15), None),
    cell("12-node wedges", 12, 3, Some(31), None),
    cell("hexagonal prisms", 12, 3, Some(16), None),
    cell("13-node pyramids", 13, 3, Some(27), Some(19)),
    cell("14-node pyramids", 14, 3, None, Some(14)),
    cell("15-node wedges", 15, 3, Some(26), Some(18)),
    cell("18-node wedges", 18, 3, Some(32), Some(13)),
    cell("19-node pyramids", 19, 3, Some(37), None),
    cell("20-node hexahedra", 20, 3, Some(25), Some(17)),
    cell("20-node tetrahedra", 20, 3, None, Some(29)),
    cell("24-node hexahedra", 24, 3, Some(33), None),
    cell("27-node hexahedra", 27, 3, Some(29), Some(12)),
    cell("35-node tetrahedra", 35, 3, None, Some(30)),
    cell("56-node tetrahedra", 56, 3, None, Some(31)),
    cell("64-node hexahedra", 64, 3, None, Some(92)),
];
