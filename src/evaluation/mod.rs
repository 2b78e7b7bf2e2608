//! What the state of a body is, computed on the host in f64 from its columns: for outputs, probes and removal. Reads only;
//! viscous memory is looked at, not carried on.

mod block;
mod element;

pub use block::{BlockView, nodal_volume_change};
pub use element::{ElementState, PointKinematics};

use crate::components::*;
use crate::elements::{Element, PressureFrom};
use crate::math::LANES;
use crate::mesh::ElementKind;

/// Runs an expression with `$element` standing for the type of an [`ElementKind`].
macro_rules! with_element {
    ($kind:expr, $element:ident => $body:expr) => {
        match $kind {
            $crate::mesh::ElementKind::Tet4 => {
                type $element = $crate::elements::Tet4;
                $body
            }
            $crate::mesh::ElementKind::Tet4NodalPressure => {
                type $element = $crate::elements::Tet4NodalPressure;
                $body
            }
            $crate::mesh::ElementKind::Hex8 => {
                type $element = $crate::elements::Hex8;
                $body
            }
            $crate::mesh::ElementKind::Hex8MeanDilatation => {
                type $element = $crate::elements::Hex8MeanDilatation;
                $body
            }
        }
    };
}
pub(crate) use with_element;

/// Place of number `k` of `numbers` of an element in a column of groups.
pub fn lane_place(row: usize, numbers: usize, k: usize) -> usize {
    (row / LANES * numbers + k) * LANES + row % LANES
}

/// How many nodes an element of a kind has.
pub const fn node_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::NODES)
}

/// How many numbers describe the rest shape of an element of a kind.
pub const fn row_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::ROWS)
}

/// How many integration points an element of a kind has.
pub const fn point_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::POINTS)
}

/// Whether elements of a kind take their pressure from nodal means.
pub fn averages(kind: ElementKind) -> bool {
    with_element!(kind, E => E::PRESSURE == PressureFrom::Nodes)
}

/// An element's volume at rest (m³); 0 once it is removed.
pub fn rest_volume(kind: ElementKind, row: usize, shape: &Reals) -> f64 {
    shape.get(lane_place(row, row_count(kind), with_element!(kind, E => E::VOLUME_ROW)))
}

/// Makes an element exert nothing and weigh nothing.
pub fn extinguish(kind: ElementKind, row: usize, shape: &mut Reals) {
    let numbers = row_count(kind);
    with_element!(kind, E => {
        shape.set(lane_place(row, numbers, E::VOLUME_ROW), 0.0);
        if let Some(further) = E::FORCE_ROW {
            shape.set(lane_place(row, numbers, further), 0.0);
        }
    });
}

/// Adds a block's lumped masses (kg) and damping coefficients (kg/s) to its nodes', from the elements that still have
/// volume: ρV over the nodes of each, and the damping rate (1/s) times that.
pub fn add_nodal_masses(
    block: &Block,
    connectivity: &[u32],
    shape: &Reals,
    density: f64,
    rate: f64,
    mass: &mut [f64],
    damping: &mut [f64],
) {
    let nodes = node_count(block.kind);
    let volume_row = with_element!(block.kind, E => E::VOLUME_ROW);
    for row in 0..block.count {
        let share = density * shape.get(lane_place(row, row_count(block.kind), volume_row)) / nodes as f64;
        for corner in 0..nodes {
            let node = connectivity[lane_place(row, nodes, corner)] as usize;
            mass[node] += share;
            damping[node] += share * rate;
        }
    }
}

/// von Mises stress and pressure (Pa) of a Cauchy stress.
pub fn von_mises_and_pressure(s: &[f64; 6]) -> (f64, f64) {
    let mean = (s[0] + s[1] + s[2]) / 3.0;
    let diagonal: f64 = (0..3).map(|i| (s[i] - mean).powi(2)).sum();
    let shear: f64 = (3..6).map(|i| s[i].powi(2)).sum();
    ((1.5 * (diagonal + 2.0 * shear)).sqrt(), -mean)
}
