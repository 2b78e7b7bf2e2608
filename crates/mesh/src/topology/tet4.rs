//! The four-node tetrahedron.

use super::isoparametric::first;
use super::{CellKind, Diagonal, Face, Listing, Located, MOST_NODES, MassRule, Shape, Solid, Split, Topology};
use glam::{DMat3, DVec3};

/// A tetrahedron; the fourth point lies on the side that the right-hand normal of the first three points to.
pub static TET4: Topology = Topology {
    name: "Tet4",
    plural: "tetrahedra",
    dimension: 3,
    nodes: &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    corners: 4,
    edges: &EDGES,
    faces: &[
        Face { kind: CellKind::Triangle, nodes: &[0, 2, 1] },
        Face { kind: CellKind::Triangle, nodes: &[0, 1, 3] },
        Face { kind: CellKind::Triangle, nodes: &[1, 2, 3] },
        Face { kind: CellKind::Triangle, nodes: &[0, 3, 2] },
    ],
    facets: &[],
    vtk: &[Listing { number: 10, order: &[0, 1, 2, 3] }],
    gmsh: Listing { number: 4, order: &[0, 1, 2, 3] },
    // one in each corner, and four around a diagonal of the octahedron between them
    split: Some(&Split {
        points: &[&[0], &[1], &[2], &[3], &[0, 1], &[0, 2], &[0, 3], &[1, 2], &[1, 3], &[2, 3]],
        parts: &[&[0, 4, 5, 6], &[4, 1, 7, 8], &[5, 7, 2, 9], &[6, 8, 9, 3]],
        inner: &[
            Diagonal { ends: [4, 9], ring: [5, 6, 8, 7] },
            Diagonal { ends: [5, 8], ring: [6, 4, 7, 9] },
            Diagonal { ends: [6, 7], ring: [4, 5, 9, 8] },
        ],
    }),
    solid: Some(&Solid {
        shape,
        quadrature: &[([0.25; 3], 1.0 / 6.0)],
        mass: MassRule::RowSum,
        shares: &[0.25; 4],
        frames: &[],
        samples: &[],
        axes: |p| [p[1] - p[0], p[2] - p[0], p[3] - p[0]],
        unit_volume: 1.0 / 6.0,
        volume: |p| volume(first(p)),
        smallest_altitude: |p| smallest_altitude(first(p)),
        quality: |p| mean_ratio(first(p)),
        locate: |p, x| locate(first(p), x),
        turned: &[0, 1, 3, 2],
        // along the diagonal from corner 0 to corner 7 (Kuhn): one a way along the edges
        in_cube: &[&[0, 1, 3, 7], &[0, 2, 6, 7], &[0, 4, 5, 7], &[0, 1, 7, 5], &[0, 2, 7, 3], &[0, 4, 7, 6]],
    }),
};

const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];

fn shape([r, s, t]: [f64; 3]) -> Shape {
    let mut shape = Shape::default();
    shape.values[..4].copy_from_slice(&[1.0 - r - s - t, r, s, t]);
    shape.gradients[..4].copy_from_slice(&[DVec3::NEG_ONE, DVec3::X, DVec3::Y, DVec3::Z]);
    shape
}

/// Signed volume of a tetrahedron (m³): positive in VTK order.
pub fn volume(p: [DVec3; 4]) -> f64 {
    (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6.0
}

/// Smallest altitude of a tetrahedron (m), 0 where all its points coincide.
pub fn smallest_altitude(p: [DVec3; 4]) -> f64 {
    let double_area = |a: usize, b: usize, c: usize| (p[b] - p[a]).cross(p[c] - p[a]).length();
    let largest = double_area(0, 1, 2).max(double_area(0, 1, 3)).max(double_area(0, 2, 3)).max(double_area(1, 2, 3));
    if largest > 0.0 { 6.0 * volume(p).abs() / largest } else { 0.0 }
}

/// Mean ratio of a tetrahedron, 12 (3 V)^(2/3) / Σ l² over its edges (Liu and Joe 1994): 1 for the regular one.
pub fn mean_ratio(p: [DVec3; 4]) -> f64 {
    let sum: f64 = EDGES.iter().map(|&[a, b]| p[a].distance_squared(p[b])).sum();
    let volume = volume(p);
    if sum > 0.0 { volume.signum() * 12.0 * (3.0 * volume.abs()).powf(2.0 / 3.0) / sum } else { 0.0 }
}

fn locate(p: [DVec3; 4], x: DVec3) -> Located {
    let edges = DMat3::from_cols(p[1] - p[0], p[2] - p[0], p[3] - p[0]);
    let r = edges.inverse() * (x - p[0]);
    let share = [1.0 - r.x - r.y - r.z, r.x, r.y, r.z];
    let outside = share.iter().fold(0.0, |worst: f64, share| worst.max(-share));
    let clipped = share.map(|share| share.max(0.0));
    let sum: f64 = clipped.iter().sum();
    let mut weights = [0.0; MOST_NODES];
    weights.iter_mut().zip(clipped).for_each(|(weight, share)| *weight = share / sum);
    Located { weights, outside: if outside.is_finite() { outside } else { f64::INFINITY } }
}
