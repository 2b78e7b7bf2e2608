//! The eight-node hexahedron.

use super::isoparametric::{Inside, first, newton};
use super::{CellKind, Face, Listing, MassRule, Shape, Solid, Split, Topology};
use glam::DVec3;

/// A hexahedron: bottom counter-clockwise seen from above, then the top; files may list it row by row (voxels).
pub static HEX8: Topology = Topology {
    name: "Hex8",
    plural: "hexahedra",
    dimension: 3,
    nodes: &NODES,
    corners: 8,
    edges: &[[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]],
    faces: &[
        Face { kind: CellKind::Quad, nodes: &[0, 3, 2, 1] },
        Face { kind: CellKind::Quad, nodes: &[4, 5, 6, 7] },
        Face { kind: CellKind::Quad, nodes: &[0, 1, 5, 4] },
        Face { kind: CellKind::Quad, nodes: &[1, 2, 6, 5] },
        Face { kind: CellKind::Quad, nodes: &[2, 3, 7, 6] },
        Face { kind: CellKind::Quad, nodes: &[3, 0, 4, 7] },
    ],
    facets: &[],
    vtk: &[Listing { number: 12, order: &[0, 1, 2, 3, 4, 5, 6, 7] }, Listing { number: 11, order: &ROW_BY_ROW }],
    gmsh: Listing { number: 5, order: &[0, 1, 2, 3, 4, 5, 6, 7] },
    // points of a 3×3×3 grid, row by row: each the middle of the corners that agree with it; a part at each corner
    split: Some(&Split {
        points: &[
            &[0],
            &[0, 1],
            &[1],
            &[0, 3],
            &[0, 1, 3, 2],
            &[1, 2],
            &[3],
            &[3, 2],
            &[2],
            &[0, 4],
            &[0, 1, 4, 5],
            &[1, 5],
            &[0, 3, 4, 7],
            &[0, 1, 3, 2, 4, 5, 7, 6],
            &[1, 2, 5, 6],
            &[3, 7],
            &[3, 2, 7, 6],
            &[2, 6],
            &[4],
            &[4, 5],
            &[5],
            &[4, 7],
            &[4, 5, 7, 6],
            &[5, 6],
            &[7],
            &[7, 6],
            &[6],
        ],
        parts: &[
            &[0, 1, 4, 3, 9, 10, 13, 12],
            &[1, 2, 5, 4, 10, 11, 14, 13],
            &[4, 5, 8, 7, 13, 14, 17, 16],
            &[3, 4, 7, 6, 12, 13, 16, 15],
            &[9, 10, 13, 12, 18, 19, 22, 21],
            &[10, 11, 14, 13, 19, 20, 23, 22],
            &[13, 14, 17, 16, 22, 23, 26, 25],
            &[12, 13, 16, 15, 21, 22, 25, 24],
        ],
        inner: &[],
    }),
    solid: Some(&Solid {
        shape,
        quadrature: &[
            ([-GAUSS, -GAUSS, -GAUSS], 1.0),
            ([GAUSS, -GAUSS, -GAUSS], 1.0),
            ([GAUSS, GAUSS, -GAUSS], 1.0),
            ([-GAUSS, GAUSS, -GAUSS], 1.0),
            ([-GAUSS, -GAUSS, GAUSS], 1.0),
            ([GAUSS, -GAUSS, GAUSS], 1.0),
            ([GAUSS, GAUSS, GAUSS], 1.0),
            ([-GAUSS, GAUSS, GAUSS], 1.0),
        ],
        mass: MassRule::RowSum,
        shares: &[0.125; 8],
        frames: &[
            [0, 1, 3, 4],
            [1, 2, 0, 5],
            [2, 3, 1, 6],
            [3, 0, 2, 7],
            [4, 7, 5, 0],
            [5, 4, 6, 1],
            [6, 5, 7, 2],
            [7, 6, 4, 3],
        ],
        samples: &[],
        axes: |p| axes(first(p)),
        unit_volume: 1.0,
        volume: |p| volume(first(p)),
        smallest_altitude: |p| smallest_altitude(first(p)),
        quality: |p| scaled_jacobian(first(p)),
        locate: |p, x| newton(&p[..8], x, shape, clip),
        turned: &[4, 5, 6, 7, 0, 1, 2, 3],
        in_cube: &[&ROW_BY_ROW],
    }),
};

/// Reference coordinates of the nodes.
pub const NODES: [[f64; 3]; 8] = [
    [-1.0, -1.0, -1.0],
    [1.0, -1.0, -1.0],
    [1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
    [1.0, -1.0, 1.0],
    [1.0, 1.0, 1.0],
    [-1.0, 1.0, 1.0],
];

/// Corners by bits: 1 upper in the first direction, 2 in the second, 4 in the third; and the other way round.
pub const ROW_BY_ROW: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

fn shape([r, s, t]: [f64; 3]) -> Shape {
    let mut shape = Shape::default();
    for (corner, [a, b, c]) in NODES.into_iter().enumerate() {
        let (u, v, w) = (1.0 + a * r, 1.0 + b * s, 1.0 + c * t);
        shape.values[corner] = u * v * w / 8.0;
        shape.gradients[corner] = DVec3::new(a * v * w, b * u * w, c * u * v) / 8.0;
    }
    shape
}

fn clip(r: DVec3) -> Inside {
    let clipped = r.clamp(DVec3::NEG_ONE, DVec3::ONE);
    Inside { at: clipped, outside: (r - clipped).abs().max_element() / 2.0 }
}

/// Mean edges of a hexahedron along its three directions (m).
fn axes(p: [DVec3; 8]) -> [DVec3; 3] {
    [
        (p[1] + p[2] + p[5] + p[6] - p[0] - p[3] - p[4] - p[7]) / 4.0,
        (p[2] + p[3] + p[6] + p[7] - p[0] - p[1] - p[4] - p[5]) / 4.0,
        (p[4] + p[5] + p[6] + p[7] - p[0] - p[1] - p[2] - p[3]) / 4.0,
    ]
}

/// Signed volume of a trilinear hexahedron (m³), exact: two Gauss points a direction integrate its determinant.
pub fn volume(p: [DVec3; 8]) -> f64 {
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

/// Smallest altitude of a hexahedron (m): of the parallelepiped spanned by its mean edges.
pub fn smallest_altitude(p: [DVec3; 8]) -> f64 {
    let [a, b, c] = axes(p);
    let largest = a.cross(b).length().max(b.cross(c).length()).max(c.cross(a).length());
    if largest > 0.0 { a.cross(b).dot(c).abs() / largest } else { 0.0 }
}

/// Scaled Jacobian of a hexahedron (Knupp 2000): the least of its corners' determinants over the lengths of their
/// edges: 1 for a cuboid.
pub fn scaled_jacobian(p: [DVec3; 8]) -> f64 {
    let frames = HEX8.solid.map_or(&[][..], |solid| solid.frames);
    let scaled = |&[o, a, b, c]: &[usize; 4]| {
        let determinant = (p[a] - p[o]).cross(p[b] - p[o]).dot(p[c] - p[o]);
        let lengths: f64 = [a, b, c].iter().map(|&other| p[o].distance(p[other])).product();
        if lengths > 0.0 { determinant / lengths } else { 0.0 }
    };
    frames.iter().map(scaled).fold(1.0, f64::min)
}
