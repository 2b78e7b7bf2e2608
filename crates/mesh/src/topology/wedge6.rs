//! The six-node wedge.

use super::isoparametric::{Inside, first, newton};
use super::{CellKind, Face, Listing, MassRule, Shape, Solid, Split, Topology};
use glam::DVec3;

/// A wedge (a triangular prism): the bottom counter-clockwise seen from the top, then the top, as Gmsh, Abaqus and
/// Exodus have it. VTK's own order is another: there the normal of the first triangle points outwards (`vtkWedge`).
pub static WEDGE6: Topology = Topology {
    name: "Wedge6",
    plural: "wedges",
    dimension: 3,
    nodes: &NODES,
    corners: 6,
    edges: &[[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]],
    faces: &[
        Face { kind: CellKind::Triangle, nodes: &[0, 2, 1] },
        Face { kind: CellKind::Triangle, nodes: &[3, 4, 5] },
        Face { kind: CellKind::Quad, nodes: &[0, 1, 4, 3] },
        Face { kind: CellKind::Quad, nodes: &[1, 2, 5, 4] },
        Face { kind: CellKind::Quad, nodes: &[2, 0, 3, 5] },
    ],
    facets: &[],
    vtk: &[Listing { number: 13, order: &[0, 2, 1, 3, 5, 4] }],
    gmsh: Listing { number: 6, order: &[0, 1, 2, 3, 4, 5] },
    // the triangle's four parts in two layers; points layer by layer
    split: Some(&Split {
        points: &[
            &[0],
            &[1],
            &[2],
            &[0, 1],
            &[1, 2],
            &[2, 0],
            &[0, 3],
            &[1, 4],
            &[2, 5],
            &[0, 1, 3, 4],
            &[1, 2, 4, 5],
            &[2, 0, 5, 3],
            &[3],
            &[4],
            &[5],
            &[3, 4],
            &[4, 5],
            &[5, 3],
        ],
        parts: &[
            &[0, 3, 5, 6, 9, 11],
            &[3, 1, 4, 9, 7, 10],
            &[5, 4, 2, 11, 10, 8],
            &[3, 4, 5, 9, 10, 11],
            &[6, 9, 11, 12, 15, 17],
            &[9, 7, 10, 15, 13, 16],
            &[11, 10, 8, 17, 16, 14],
            &[9, 10, 11, 15, 16, 17],
        ],
        inner: &[],
    }),
    solid: Some(&Solid {
        shape,
        // the determinant is linear in the triangle and quadratic along the axis
        quadrature: &[
            ([1.0 / 6.0, 1.0 / 6.0, -GAUSS], 1.0 / 6.0),
            ([2.0 / 3.0, 1.0 / 6.0, -GAUSS], 1.0 / 6.0),
            ([1.0 / 6.0, 2.0 / 3.0, -GAUSS], 1.0 / 6.0),
            ([1.0 / 6.0, 1.0 / 6.0, GAUSS], 1.0 / 6.0),
            ([2.0 / 3.0, 1.0 / 6.0, GAUSS], 1.0 / 6.0),
            ([1.0 / 6.0, 2.0 / 3.0, GAUSS], 1.0 / 6.0),
        ],
        mass: MassRule::RowSum,
        shares: &[1.0 / 6.0; 6],
        frames: &[[0, 1, 2, 3], [1, 2, 0, 4], [2, 0, 1, 5], [3, 5, 4, 0], [4, 3, 5, 1], [5, 4, 3, 2]],
        samples: &[],
        axes: |p| axes(first(p)),
        unit_volume: 0.5,
        volume: |p| volume(first(p)),
        smallest_altitude: |p| smallest_altitude(first(p)),
        quality: |p| scaled_jacobian(first(p)),
        locate: |p, x| newton(&p[..6], x, shape, clip),
        turned: &[3, 4, 5, 0, 1, 2],
        in_cube: &[&[0, 1, 3, 4, 5, 7], &[0, 3, 2, 4, 7, 6]],
    }),
};

/// Reference coordinates of the nodes.
pub const NODES: [[f64; 3]; 6] =
    [[0.0, 0.0, -1.0], [1.0, 0.0, -1.0], [0.0, 1.0, -1.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];

/// 1/√3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

fn shape([r, s, t]: [f64; 3]) -> Shape {
    let mut shape = Shape::default();
    let triangle = [(1.0 - r - s, -1.0, -1.0), (r, 1.0, 0.0), (s, 0.0, 1.0)];
    for (node, [.., end]) in NODES.into_iter().enumerate() {
        let (value, by_r, by_s) = triangle[node % 3];
        let along = (1.0 + end * t) / 2.0;
        shape.values[node] = value * along;
        shape.gradients[node] = DVec3::new(by_r * along, by_s * along, value * end / 2.0);
    }
    shape
}

fn clip(at: DVec3) -> Inside {
    let share = [1.0 - at.x - at.y, at.x, at.y];
    let clipped = share.map(|share| share.max(0.0));
    let sum: f64 = clipped.iter().sum();
    let inside = DVec3::new(clipped[1] / sum, clipped[2] / sum, at.z.clamp(-1.0, 1.0));
    let beside = share.iter().fold(0.0, |worst: f64, share| worst.max(-share));
    Inside { at: inside, outside: beside.max((at.z - inside.z).abs() / 2.0) }
}

/// Mean edges of a wedge along its three directions (m).
fn axes(p: [DVec3; 6]) -> [DVec3; 3] {
    [
        (p[1] - p[0] + p[4] - p[3]) / 2.0,
        (p[2] - p[0] + p[5] - p[3]) / 2.0,
        (p[3] + p[4] + p[5] - p[0] - p[1] - p[2]) / 3.0,
    ]
}

/// Signed volume of a wedge with bilinear sides (m³), exact: the determinant, linear in the triangle, in its middle at
/// two Gauss points along the axis.
pub fn volume(p: [DVec3; 6]) -> f64 {
    let up = (p[3] + p[4] + p[5] - p[0] - p[1] - p[2]) / 3.0;
    let gauss = 0.5 * GAUSS;
    let at = |high: f64| {
        let along = |a: usize, b: usize| (p[b] - p[a]) * (1.0 - high) + (p[b + 3] - p[a + 3]) * high;
        along(0, 1).cross(along(0, 2)).dot(up) / 4.0
    };
    at(0.5 - gauss) + at(0.5 + gauss)
}

/// Smallest altitude of a wedge (m): of the prism spanned by its mean edges, 0 where that is flat.
pub fn smallest_altitude(p: [DVec3; 6]) -> f64 {
    let [a, b, c] = axes(p);
    let sides = [a.cross(b), a.cross(c), b.cross(c), (b - a).cross(c)];
    let largest = sides.iter().fold(0.0, |largest: f64, side| largest.max(side.length()));
    if largest > 0.0 { a.cross(b).dot(c).abs() / largest } else { 0.0 }
}

/// Scaled Jacobian of a wedge: the least of its corners' determinants over the lengths of their edges, as a share of
/// that of the prism on an equilateral triangle, which has 1.
pub fn scaled_jacobian(p: [DVec3; 6]) -> f64 {
    let frames = WEDGE6.solid.map_or(&[][..], |solid| solid.frames);
    let scaled = |&[o, a, b, c]: &[usize; 4]| {
        let determinant = (p[a] - p[o]).cross(p[b] - p[o]).dot(p[c] - p[o]);
        let lengths: f64 = [a, b, c].iter().map(|&other| p[o].distance(p[other])).product();
        if lengths > 0.0 { determinant / lengths * (2.0 / 3f64.sqrt()) } else { 0.0 }
    };
    frames.iter().map(scaled).fold(1.0, f64::min)
}
