//! What the state of a body is, computed on the host in f64 from its columns: for outputs, probes and removal. Reads only;
//! viscous memory is looked at, not carried on.

use crate::backend::cpu::BlockLaw;
use crate::components::*;
use crate::elements::{Element, Hex8, MOST_NODES, Tet4};
use crate::materials::Kinematics;
use crate::math::{LANES, Mat3, Sym3};
use crate::scene::schema::ElementKind;

/// An element's kinematics.
pub struct ElementState {
    /// Its kind.
    pub kind: ElementKind,
    /// Rows of its nodes.
    pub nodes: [u32; MOST_NODES],
    /// Its nodes' displacements (m).
    pub displacements: [[f64; 3]; MOST_NODES],
    /// ∇u.
    pub gradient: Mat3<f64>,
    /// Strain measures.
    pub kinematics: Kinematics<f64>,
    /// Rest volume (m³); 0 once removed.
    pub volume: f64,
}

/// Runs an expression with `$element` standing for the type of an [`ElementKind`].
macro_rules! with_element {
    ($kind:expr, $element:ident => $body:expr) => {
        match $kind {
            $crate::scene::schema::ElementKind::Tet4 => {
                type $element = $crate::elements::Tet4;
                $body
            }
            $crate::scene::schema::ElementKind::Hex8 => {
                type $element = $crate::elements::Hex8;
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
    match kind {
        ElementKind::Tet4 => Tet4::NODES,
        ElementKind::Hex8 => Hex8::NODES,
    }
}

/// How many numbers describe the rest shape of an element of a kind.
pub const fn row_count(kind: ElementKind) -> usize {
    match kind {
        ElementKind::Tet4 => Tet4::ROWS,
        ElementKind::Hex8 => Hex8::ROWS,
    }
}

impl ElementState {
    /// Looks at element `row` of a block.
    pub fn of(kind: ElementKind, row: usize, connectivity: &[u32], shape: &Reals, displacement: &Reals) -> Self {
        let mut nodes = [0; MOST_NODES];
        let mut displacements = [[0.0; 3]; MOST_NODES];
        for corner in 0..node_count(kind) {
            nodes[corner] = connectivity[lane_place(row, node_count(kind), corner)];
            displacements[corner] = displacement.vector(nodes[corner] as usize).to_array();
        }
        let number = |k: usize| shape.get(lane_place(row, row_count(kind), k));
        with_element!(kind, E => {
            let gradient = E::gradient(&displacements, number);
            let kinematics = Kinematics::new(&gradient);
            Self { kind, nodes, displacements, gradient, kinematics, volume: number(E::VOLUME_ROW) }
        })
    }

    /// Nodal forces (N) for a second Piola-Kirchhoff stress (Pa).
    pub fn forces(&self, row: usize, shape: &Reals, stress: &Sym3<f64>) -> [[f64; 3]; MOST_NODES] {
        let number = |k: usize| shape.get(lane_place(row, row_count(self.kind), k));
        let stress = self.gradient.plus_identity_times(stress);
        let mut forces = [[0.0; 3]; MOST_NODES];
        with_element!(self.kind, E => {
            E::forces(&self.displacements, &self.gradient, &stress, number, |corner, i, force| forces[corner][i] = force);
        });
        forces
    }

    /// Energy in hourglass control (J).
    pub fn hourglass_energy(&self, row: usize, shape: &Reals) -> f64 {
        let number = |k: usize| shape.get(lane_place(row, row_count(self.kind), k));
        with_element!(self.kind, E => E::hourglass_energy(&self.displacements, &self.gradient, number))
    }

    /// Cauchy stress (Pa) from the second Piola-Kirchhoff stress: xx, yy, zz, xy, yz, xz.
    pub fn cauchy(&self, stress: &Sym3<f64>) -> [f64; 6] {
        let first = self.gradient.plus_identity_times(stress).0;
        let f = |i: usize, j: usize| self.gradient.0[i][j] + if i == j { 1.0 } else { 0.0 };
        let entry = |i: usize, j: usize| (0..3).map(|k| first[i][k] * f(j, k)).sum::<f64>() / self.kinematics.j;
        [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)]
    }

    /// Largest principal stretch.
    pub fn largest_stretch(&self) -> f64 {
        let [xx, yy, zz, xy, yz, xz] = self.kinematics.green_strain.0;
        let strain = glam::DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
        (1.0 + 2.0 * crate::elements::largest_eigenvalue(&strain)).max(0.0).sqrt()
    }
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

/// A block's law and the columns it needs, to look at one element after the other.
pub struct Material<'a> {
    /// The law in f64, for the run's time step.
    pub law: &'a BlockLaw<f64>,
    /// Fibre directions, where they differ.
    pub fibre_direction: Option<&'a Reals>,
    /// Viscous history.
    pub memory: Option<&'a Reals>,
}

impl Material<'_> {
    fn direction(&self, row: usize, uniform: Option<[f64; 3]>) -> [f64; 3] {
        match (uniform, self.fibre_direction) {
            (Some(a), _) => a,
            (None, Some(all)) => [0, 1, 2].map(|i| all.get(lane_place(row, 3, i))),
            (None, None) => [0.0; 3],
        }
    }

    /// Second Piola-Kirchhoff stress (Pa) that the next `element_forces` will find.
    pub fn stress(&self, row: usize, k: &Kinematics<f64>) -> Sym3<f64> {
        let mut isochoric = self.law.neo_hookean.isochoric(k);
        if let Some((fibres, uniform)) = &self.law.fibres {
            isochoric = isochoric.plus(&fibres.isochoric(k, self.direction(row, *uniform)));
        }
        let mut stress = isochoric.plus(&self.law.neo_hookean.volumetric(k));
        let terms = self.law.prony.len();
        if let Some(memory) = self.memory {
            for (number, term) in self.law.prony.iter().enumerate() {
                let history = Sym3(std::array::from_fn(|i| memory.get(lane_place(row, 6 * terms, 6 * number + i))));
                stress = stress.plus(&term.relaxed(&isochoric, &history).scaled(-1.0));
            }
        }
        stress
    }

    /// Elastic energy per rest volume (J/m³), as of an instantaneous deformation.
    pub fn energy(&self, row: usize, k: &Kinematics<f64>) -> f64 {
        let fibres =
            self.law.fibres.as_ref().map_or(0.0, |(fibres, uniform)| fibres.energy(k, self.direction(row, *uniform)));
        self.law.neo_hookean.energy(k) + fibres
    }
}
