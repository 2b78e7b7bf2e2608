//! One element's state.

use super::lane_place;
use crate::components::*;
use crate::elements::{Element, MOST_NODES, MOST_POINTS, PointState, largest_eigenvalue};
use crate::elements::{node_count, point_count, with_element_of};
use crate::materials::{Elastic, ElasticLaw, Kinematics};
use crate::math::{Mat3, Sym3};
use crate::mesh::ElementKind;

/// The state at an integration point.
#[derive(Clone, Copy, Debug)]
pub struct PointKinematics {
    /// ∇u.
    pub gradient: Mat3<f64>,
    /// Strain measures, as the law takes them.
    pub kinematics: Kinematics<f64>,
    /// The point's share of the element's volume.
    pub share: f64,
}

/// An element's kinematics.
pub struct ElementState {
    /// Its kind.
    pub kind: ElementKind,
    /// Rows of its nodes.
    pub nodes: [u32; MOST_NODES],
    /// Its nodes' displacements (m).
    pub displacements: [[f64; 3]; MOST_NODES],
    /// Rest volume (m³); 0 once removed.
    pub volume: f64,
    /// The least J of the points that are [checked](Element::CHECKED_POINTS).
    pub least_volume_ratio: f64,
    simple: bool,
    points: [PointKinematics; MOST_POINTS],
}

impl ElementState {
    /// Looks at element `row` of a block.
    pub fn of(
        block: &Block,
        row: usize,
        connectivity: &[u32],
        shape: &Reals,
        displacement: &Reals,
        elastic: &ElasticLaw<f64>,
    ) -> Self {
        let Block { kind, simple, .. } = *block;
        let mut nodes = [0; MOST_NODES];
        let mut displacements = [[0.0; 3]; MOST_NODES];
        for corner in 0..node_count(kind) {
            nodes[corner] = connectivity[lane_place(row, node_count(kind), corner)];
            displacements[corner] = displacement.vector(nodes[corner] as usize).to_array();
        }
        with_element_of!(block, E => {
            let number = |k: usize| shape.get(lane_place(row, E::ROWS, k));
            let u = E::prepare(&displacements);
            let states: [_; E::POINTS] = std::array::from_fn(|point| E::at_point(&u, point, number));
            let whole: f64 = states.iter().map(|state| state.volume).sum();
            let at = |state: &PointState<f64>| PointKinematics {
                gradient: state.gradient,
                kinematics: elastic.kinematics(&state.gradient),
                share: if E::POINTS == 1 { 1.0 } else { state.volume / whole },
            };
            let mut points = [at(&states[0]); MOST_POINTS];
            points.iter_mut().zip(&states).skip(1).for_each(|(point, state)| *point = at(state));
            let beside = (E::POINTS..E::CHECKED_POINTS).map(|point| E::at_point(&u, point, number).gradient);
            let ratios = points[..E::POINTS].iter().map(|point| point.kinematics.true_j);
            let ratios = ratios.chain(beside.map(|gradient| 1.0 + gradient.volume_change()));
            let least_volume_ratio = ratios.fold(f64::INFINITY, f64::min);
            Self { kind, nodes, displacements, volume: number(E::VOLUME_ROW), least_volume_ratio, simple, points }
        })
    }

    /// The state at its integration points.
    pub fn points(&self) -> &[PointKinematics] {
        &self.points[..point_count(self.kind)]
    }

    /// Volume ratio J: mean over the points.
    pub fn volume_ratio(&self) -> f64 {
        self.points().iter().map(|point| point.share * point.kinematics.true_j).sum()
    }

    /// Whether it is turned inside out at one of the points that are checked.
    pub fn is_inverted(&self) -> bool {
        self.is_flatter_than(0.0)
    }

    /// Whether J is below a value at one of these.
    pub fn is_flatter_than(&self, least: f64) -> bool {
        self.volume > 0.0 && self.least_volume_ratio < least
    }

    /// Nodal forces (N) for a first Piola-Kirchhoff stress (Pa) at each point.
    pub fn forces(&self, row: usize, shape: &Reals, stress: impl Fn(usize) -> Mat3<f64>) -> [[f64; 3]; MOST_NODES] {
        let mut forces = [[0.0; 3]; MOST_NODES];
        with_element_of!(self, E => {
            let number = |k: usize| shape.get(lane_place(row, E::ROWS, k));
            let u = E::prepare(&self.displacements);
            let mut sums = E::no_forces(0.0);
            for point in 0..E::POINTS {
                E::add_stress(&mut sums, point, &E::at_point(&u, point, number), &stress(point));
            }
            E::store_forces(&u, &sums, number, |corner, i, force| forces[corner][i] = force);
        });
        forces
    }

    /// Energy in hourglass control (J).
    pub fn hourglass_energy(&self, row: usize, shape: &Reals) -> f64 {
        let gradient = &self.points[0].gradient;
        with_element_of!(self, E => {
            let number = |k: usize| shape.get(lane_place(row, E::ROWS, k));
            E::hourglass_energy(&E::prepare(&self.displacements), gradient, number)
        })
    }

    /// Largest principal stretch of all points.
    pub fn largest_stretch(&self) -> f64 {
        self.points().iter().map(|point| largest_stretch(&point.kinematics.green_strain)).fold(0.0, f64::max)
    }
}

fn largest_stretch(green_strain: &Sym3<f64>) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = green_strain.0;
    let strain = glam::DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
    (1.0 + 2.0 * largest_eigenvalue(&strain)).max(0.0).sqrt()
}
