//! What the state of a body is, computed on the host in f64 from its columns: for outputs, probes and removal. Reads
//! only; viscous memory is looked at, not carried on.

mod block;
mod element;
mod measures;

pub use block::{BlockView, nodal_volume_change};
pub use element::{ElementState, PointKinematics};
pub use measures::principal_values;

use crate::components::*;
use crate::elements::{Element, MOST_NODES, MOST_POINTS, MOST_ROWS, PressureFrom};
use crate::math::LANES;
use crate::mesh::ElementKind;

macro_rules! make_with_element {
    ($dollar:tt $($(#[$about:meta])* $kind:ident: $cell:ident, $shader:literal;)*) => {
        /// Runs an expression with `$element` standing for the type of an [`ElementKind`].
        macro_rules! with_element {
            ($dollar of:expr, $dollar element:ident => $dollar body:expr) => {
                match $dollar of {
                    $(crate::mesh::ElementKind::$kind => {
                        type $dollar element = crate::elements::$kind;
                        $dollar body
                    })*
                }
            };
        }
    };
}
crate::mesh::each_element_kind! { $ make_with_element }
pub(crate) use with_element;

/// The same for a block, or whatever has a `kind` and is `simple` as one: where it is, with the type for
/// [simple](Element::Simple) shapes.
macro_rules! with_element_of {
    ($block:expr, $element:ident => $body:expr) => {
        if $block.simple {
            $crate::evaluation::with_element!($block.kind, General => {
                type $element = <General as $crate::elements::Element>::Simple;
                $body
            })
        } else {
            $crate::evaluation::with_element!($block.kind, $element => $body)
        }
    };
}
pub(crate) use with_element_of;

/// Place of number `k` of `numbers` of an element in a column of groups.
pub fn lane_place(row: usize, numbers: usize, k: usize) -> usize {
    (row / LANES * numbers + k) * LANES + row % LANES
}

/// How many nodes an element of a kind has.
pub const fn node_count(kind: ElementKind) -> usize {
    with_element!(kind, E => E::NODES)
}

/// What share of an element's mass each of its nodes has, 1 together: the one rule by which masses go to nodes.
pub const fn mass_shares(kind: ElementKind) -> &'static [f64] {
    with_element!(kind, E => E::CELL.shares())
}

// what the list of kinds says of their cells is what the elements say, and kernels have room for them
const _: () = {
    let (mut place, mut nodes, mut rows, mut points) = (0, 0, 0, 0);
    const fn larger(a: usize, b: usize) -> usize {
        if a > b { a } else { b }
    }
    while place < ElementKind::ALL.len() {
        let kind = ElementKind::ALL[place];
        with_element!(kind, E => {
            assert!(E::CELL as usize == kind.cell() as usize && E::CELL.shares().len() == E::NODES);
            // energies, viscous memory and nodal means know one pressure an element
            assert!(E::POINTS == 1 || matches!(E::PRESSURE, PressureFrom::MeanOverPoints));
            nodes = larger(nodes, E::NODES);
            rows = larger(rows, E::ROWS);
            points = larger(points, E::POINTS);
        });
        place += 1;
    }
    assert!(nodes == MOST_NODES && rows == MOST_ROWS && points == MOST_POINTS);
};

/// How many numbers describe the rest shape of an element of a block.
pub const fn row_count(block: &Block) -> usize {
    with_element_of!(block, E => E::ROWS)
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
pub fn rest_volume(block: &Block, row: usize, shape: &Reals) -> f64 {
    shape.get(with_element_of!(block, E => lane_place(row, E::ROWS, E::VOLUME_ROW)))
}

/// Makes an element exert nothing and weigh nothing.
pub fn extinguish(block: &Block, row: usize, shape: &mut Reals) {
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
    density: f64,
    rate: f64,
    mass: &mut [f64],
    damping: &mut [f64],
) {
    let nodes = node_count(block.kind);
    let shares = mass_shares(block.kind);
    for row in 0..block.count {
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
