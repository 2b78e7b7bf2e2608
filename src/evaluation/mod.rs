//! What the state of a body is, computed on the host in f64 from its columns: for outputs, probes and removal. Reads
//! only; viscous memory is looked at, not carried on.

mod block;
mod element;
mod measures;

pub use block::{BlockView, nodal_volume_change};
pub use element::{ElementState, PointKinematics};
pub use measures::principal_values;

use crate::components::*;
use crate::elements::{Element, mass_shares, node_count, with_element_of};
use crate::math::lane_place;

/// How many numbers describe the rest shape of an element of a block.
pub const fn row_count(block: &Block) -> usize {
    with_element_of!(block, E => E::ROWS)
}

/// An element's volume at rest (m³); 0 once it is removed.
pub fn rest_volume(block: &Block, row: usize, shape: &Reals) -> f64 {
    shape.get(with_element_of!(block, E => lane_place(row, E::ROWS, E::VOLUME_ROW)))
}

/// Makes an element exert nothing and weigh nothing.
pub fn deactivate(block: &Block, row: usize, shape: &mut Reals) {
    with_element_of!(block, E => {
        shape.set(lane_place(row, E::ROWS, E::VOLUME_ROW), 0.0);
        if let Some(further) = E::FORCE_ROW {
            shape.set(lane_place(row, E::ROWS, further), 0.0);
        }
    });
}

/// Adds a block's lumped masses (kg) and damping coefficients (kg/s) to its nodes', from the elements that still have
/// volume: its nodes' shares of the ρV of each, and the damping rate (1/s) times that.
pub fn add_nodal_masses(
    block: &Block,
    connectivity: &[u32],
    shape: &Reals,
    inertia: ElementInertia<'_>,
    mass: &mut [f64],
    damping: &mut [f64],
) {
    let nodes = node_count(block.kind);
    let shares = mass_shares(block.kind);
    for row in 0..block.count {
        let [density, rate] = inertia.of_row(row);
        let whole = density * rest_volume(block, row, shape);
        for (corner, share) in shares.iter().enumerate() {
            let (node, share) = (connectivity[lane_place(row, nodes, corner)] as usize, whole * share);
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
