//! The ten-node tetrahedron.

use super::isoparametric::{Inside, first, newton};
use super::tet4::{TET4, mean_ratio};
use super::{CellKind, Face, Listing, MassRule, Shape, Solid, Topology, tet4};
use glam::DVec3;

/// A tetrahedron of second order: its edges may be parabolas.
pub static TET10: Topology = Topology {
    name: "Tet10",
    plural: "10-node tetrahedra",
    dimension: 3,
    nodes: &NODES,
    corners: 4,
    edges: &EDGES,
    faces: &[
        Face { kind: CellKind::Triangle6, nodes: &[0, 2, 1, 6, 5, 4] },
        Face { kind: CellKind::Triangle6, nodes: &[0, 1, 3, 4, 8, 7] },
        Face { kind: CellKind::Triangle6, nodes: &[1, 2, 3, 5, 9, 8] },
        Face { kind: CellKind::Triangle6, nodes: &[0, 3, 2, 7, 9, 6] },
    ],
    facets: &[],
    vtk: &[Listing { number: 24, order: &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9] }],
    gmsh: Listing { number: 11, order: &[0, 1, 2, 3, 4, 5, 6, 7, 9, 8] },
    // by its corners: the new middles of edges are halfway between nodes
    split: TET4.split,
    solid: Some(&Solid {
        shape,
        // the determinant is of third order (Keast 1986)
        quadrature: &[
            ([0.25; 3], -2.0 / 15.0),
            ([1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0], 0.075),
            ([0.5, 1.0 / 6.0, 1.0 / 6.0], 0.075),
            ([1.0 / 6.0, 0.5, 1.0 / 6.0], 0.075),
            ([1.0 / 6.0, 1.0 / 6.0, 0.5], 0.075),
        ],
        mass: MassRule::Hrz,
        shares: &[
            1.0 / 36.0,
            1.0 / 36.0,
            1.0 / 36.0,
            1.0 / 36.0,
            4.0 / 27.0,
            4.0 / 27.0,
            4.0 / 27.0,
            4.0 / 27.0,
            4.0 / 27.0,
            4.0 / 27.0,
        ],
        frames: &[],
        // the nodes, where the determinant of a curved cell is least as a rule, and the integration points
        samples: &[
            NODES[0], NODES[1], NODES[2], NODES[3], NODES[4], NODES[5], NODES[6], NODES[7], NODES[8], NODES[9],
            POINTS[0], POINTS[1], POINTS[2], POINTS[3],
        ],
        axes: |p| {
            let middle = shape([0.25; 3]).jacobian(p);
            [middle.x_axis, middle.y_axis, middle.z_axis]
        },
        unit_volume: 1.0 / 6.0,
        volume,
        smallest_altitude: |p| tet4::smallest_altitude(first(p)),
        quality: |p| mean_ratio(first(p)),
        locate: |p, x| newton(&p[..10], x, shape, clip),
        turned: &[0, 1, 3, 2, 4, 8, 7, 6, 5, 9],
        in_cube: match TET4.solid {
            Some(straight) => straight.in_cube,
            None => &[],
        },
    }),
};

const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Reference coordinates of the nodes.
const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.5, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [0.0, 0.5, 0.0],
    [0.0, 0.0, 0.5],
    [0.5, 0.0, 0.5],
    [0.0, 0.5, 0.5],
];

/// (5 + 3√5)/20 and (5 − √5)/20: barycentric coordinates of the four points that integrate second order exactly.
pub const FAR: f64 = 0.585_410_196_624_968_5;
/// See [`FAR`].
pub const NEAR: f64 = 0.138_196_601_125_010_5;

/// Reference coordinates of the points: each is nearest to the corner of the same place.
pub const POINTS: [[f64; 3]; 4] = [[NEAR; 3], [FAR, NEAR, NEAR], [NEAR, FAR, NEAR], [NEAR, NEAR, FAR]];

/// Shape functions: L(2L − 1) of corners, 4 L_a L_b of middles.
pub fn shape([r, s, t]: [f64; 3]) -> Shape {
    let mut shape = Shape::default();
    let share = [1.0 - r - s - t, r, s, t];
    let slope = [DVec3::NEG_ONE, DVec3::X, DVec3::Y, DVec3::Z];
    for corner in 0..4 {
        shape.values[corner] = share[corner] * (2.0 * share[corner] - 1.0);
        shape.gradients[corner] = (4.0 * share[corner] - 1.0) * slope[corner];
    }
    for (node, [a, b]) in (4..).zip(EDGES) {
        shape.values[node] = 4.0 * share[a] * share[b];
        shape.gradients[node] = 4.0 * (share[a] * slope[b] + share[b] * slope[a]);
    }
    shape
}

/// Signed volume (m³), of curved cells too.
fn volume(p: &[DVec3]) -> f64 {
    let quadrature = TET10.solid.map_or(&[][..], |solid| solid.quadrature);
    quadrature.iter().map(|(at, weight)| weight * shape(*at).jacobian(p).determinant()).sum()
}

fn clip(at: DVec3) -> Inside {
    let share = [1.0 - at.x - at.y - at.z, at.x, at.y, at.z];
    let clipped = share.map(|share| share.max(0.0));
    let sum: f64 = clipped.iter().sum();
    let outside = share.iter().fold(0.0, |worst: f64, share| worst.max(-share));
    Inside { at: DVec3::new(clipped[1], clipped[2], clipped[3]) / sum, outside }
}
