//! Volumes, Jacobian determinants and shapes of elements.

use super::Mesh;
use glam::DVec3;

/// Corners of a hexahedron (VTK order) with their three neighbours, in the order that makes a right-handed frame.
const HEX_FRAMES: [[usize; 4]; 8] =
    [[0, 1, 3, 4], [1, 2, 0, 5], [2, 3, 1, 6], [3, 0, 2, 7], [4, 7, 5, 0], [5, 4, 6, 1], [6, 5, 7, 2], [7, 6, 4, 3]];

const HEX_EDGES: [[usize; 2]; 12] =
    [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];

const TET_EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

/// Signed volume of a tetrahedron (m³): positive in VTK order.
pub fn tet_volume(p: [DVec3; 4]) -> f64 {
    (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6.0
}

/// Determinants of the Jacobian of a trilinear hexahedron over the unit cube (m³): at its eight corners, then in the
/// centre.
pub fn hex_determinants(p: [DVec3; 8]) -> [f64; 9] {
    let mut determinants = [0.0; 9];
    for (determinant, [o, a, b, c]) in determinants.iter_mut().zip(HEX_FRAMES) {
        *determinant = (p[a] - p[o]).cross(p[b] - p[o]).dot(p[c] - p[o]);
    }
    let [a, b, c] = hex_axes(p);
    determinants[8] = a.cross(b).dot(c);
    determinants
}

/// Mean edges of a hexahedron along its three directions (m).
fn hex_axes(p: [DVec3; 8]) -> [DVec3; 3] {
    [
        (p[1] + p[2] + p[5] + p[6] - p[0] - p[3] - p[4] - p[7]) / 4.0,
        (p[2] + p[3] + p[6] + p[7] - p[0] - p[1] - p[4] - p[5]) / 4.0,
        (p[4] + p[5] + p[6] + p[7] - p[0] - p[1] - p[2] - p[3]) / 4.0,
    ]
}

/// Signed volume of a trilinear hexahedron (m³), exact: two Gauss points a direction integrate its determinant.
pub fn hex_volume(p: [DVec3; 8]) -> f64 {
    let gauss = 0.5 / 3f64.sqrt();
    let mut volume = 0.0;
    for corner in 0..8 {
        let at = |bit: usize| 0.5 + if corner >> bit & 1 == 0 { -gauss } else { gauss };
        let (r, s, t) = (at(0), at(1), at(2));
        let along = |edges: [[usize; 2]; 4], u: f64, v: f64| {
            (p[edges[0][1]] - p[edges[0][0]]) * ((1.0 - u) * (1.0 - v))
                + (p[edges[1][1]] - p[edges[1][0]]) * (u * (1.0 - v))
                + (p[edges[2][1]] - p[edges[2][0]]) * ((1.0 - u) * v)
                + (p[edges[3][1]] - p[edges[3][0]]) * (u * v)
        };
        let a = along([[0, 1], [3, 2], [4, 5], [7, 6]], s, t);
        let b = along([[0, 3], [1, 2], [4, 7], [5, 6]], r, t);
        let c = along([[0, 4], [1, 5], [3, 7], [2, 6]], r, s);
        volume += a.cross(b).dot(c) / 8.0;
    }
    volume
}

/// Longest edge of a tetrahedron (m).
pub fn tet_longest_edge(p: [DVec3; 4]) -> f64 {
    TET_EDGES.iter().map(|&[a, b]| p[a].distance(p[b])).fold(0.0, f64::max)
}

/// Longest edge of a hexahedron (m).
pub fn hex_longest_edge(p: [DVec3; 8]) -> f64 {
    HEX_EDGES.iter().map(|&[a, b]| p[a].distance(p[b])).fold(0.0, f64::max)
}

/// Smallest altitude of a tetrahedron (m), 0 where all its points coincide.
pub fn tet_smallest_altitude(p: [DVec3; 4]) -> f64 {
    let double_area = |a: usize, b: usize, c: usize| (p[b] - p[a]).cross(p[c] - p[a]).length();
    let largest = double_area(0, 1, 2).max(double_area(0, 1, 3)).max(double_area(0, 2, 3)).max(double_area(1, 2, 3));
    if largest > 0.0 { 6.0 * tet_volume(p).abs() / largest } else { 0.0 }
}

/// Smallest altitude of a hexahedron (m): of the parallelepiped spanned by its mean edges.
pub fn hex_smallest_altitude(p: [DVec3; 8]) -> f64 {
    let [a, b, c] = hex_axes(p);
    let largest = a.cross(b).length().max(b.cross(c).length()).max(c.cross(a).length());
    if largest > 0.0 { a.cross(b).dot(c).abs() / largest } else { 0.0 }
}

impl Mesh {
    /// The corners of a tetrahedron (m). Panics on a row of `points` that does not exist; [`Mesh::soundness`] finds
    /// those.
    pub fn tet_corners(&self, row: usize) -> [DVec3; 4] {
        self.tets[row].map(|point| self.points[point as usize])
    }

    /// The corners of a hexahedron (m), by its row in `hexes`. Panics as [`Mesh::tet_corners`] does.
    pub fn hex_corners(&self, row: usize) -> [DVec3; 8] {
        self.hexes[row].map(|point| self.points[point as usize])
    }

    /// Sum of the signed volumes of all elements (m³).
    pub fn volume(&self) -> f64 {
        let tets: f64 = (0..self.tets.len()).map(|row| tet_volume(self.tet_corners(row))).sum();
        let hexes: f64 = (0..self.hexes.len()).map(|row| hex_volume(self.hex_corners(row))).sum();
        tets + hexes
    }
}
