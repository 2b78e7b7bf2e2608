//! What a body knows of its nodes: one row a node, in the engine's order (see [`Authoring`] for the author's).

use super::Reals;
use super::column::columns;
use crate::mesh::{Cells, Ids, Mesh, SurfaceFace};
use bevy_ecs::prelude::*;
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Positions at rest (m), always in f64.
#[derive(Component, Clone, Debug)]
pub struct RestPosition(pub Vec<DVec3>);

columns! {
    /// Displacement u (m), a vector a node.
    Displacement(Reals) = "displacement", State of Motion, Nodes(3);
    /// Displacement of the last step, u_n − u_{n−1} (m), a vector a node: velocity in the middle of the step times Δt.
    /// On constrained axes `boundary` writes the step to come here.
    DisplacementIncrement(Reals) = "displacement_increment", State of Motion, Nodes(3), increments: All;
    /// What rounding has made of the displacements too much (m), a vector a node, and then what of their steps,
    /// likewise. Exists in f32 where sums are compensated.
    DisplacementCompensation(Reals) = "displacement_compensation", State of Motion, Other, increments: SecondHalf;
    /// Lumped mass (kg), a number a node; 0: the node is inactive.
    Mass(Reals) = "mass", State of Mass, Nodes(1);
    /// Mass (kg) that resists acceleration in place of the real one, which only weighs then: in static analyses the
    /// mass that makes every element's bound of the stable step the same, else the real one and what was added to it
    /// where a scene has mass scaled. A number a node.
    InertialMass(Reals) = "inertial_mass", State of Mass, Nodes(1);
    /// Σ c m over a node's elements (kg/s): damping rate times mass. Exists when a material is damped.
    DampingCoefficient(Reals) = "damping_coefficient", State of Mass, Nodes(1);
    /// Force of the deformed elements on the node, sign such that M ü = R − F (N), a vector a node.
    InternalForce(Reals) = "internal_force", State of Force, Nodes(3);
    /// Sum R of all loads (N), a vector a node. Exists when there are loads.
    ExternalForce(Reals) = "external_force", State of Force, Nodes(3);
    /// Bits 0, 1, 2: the node does not move freely along x, y, z.
    ConstrainedAxes(Vec<u32>) = "constrained_axes", Given of Constraint, Nodes(1);
    /// Work done on or by a node since the start (J): by loads, against damping, by constraints, by internal forces;
    /// then the last step along constrained axes (m), which `boundary` writes over: [`WORK_NUMBERS`] a node. Exists
    /// when energies are asked for.
    Work(Reals) = "work", State of Account, Nodes(WORK_NUMBERS), increments: LastThreeOf(WORK_NUMBERS);
    /// Acceleration at the end of the last step (m/s²), a vector a node. Exists where implicit steps are of second
    /// order.
    Acceleration(Reals) = "acceleration", State of Scheme, Nodes(3);
    /// Energy that the formula of implicit steps has taken from a node since the start (J), a number a node. Exists in
    /// implicit runs when energies are asked for.
    SchemeLoss(Reals) = "scheme_loss", State of Scheme, Nodes(1);
    /// Two numbers: the lowest row of a node whose displacement was found not finite, and the step in which it was: the
    /// first in which there was one; `u32::MAX`: none.
    FirstNonFinite(Vec<u32>) = "first_non_finite", State of Guard, Other, in "node_diagnostics";
    /// Work against internal forces since the start (J), in f32 whatever the run's precision: two numbers for each
    /// [`GROUP_ROWS`] nodes and two more, a sum over nodes that move together and what rounding has left out of it.
    /// Exists in a motion without [`Work`] whose energy is guarded.
    InternalWork(Vec<f32>) = "internal_work", State of Account, Other, in "node_diagnostics";
    /// Displacement of the last step along prescribed axes (m), which `boundary` has written over in
    /// [`DisplacementIncrement`], in f32 whatever the run's precision: a vector a node. Exists with [`Work`] or
    /// [`InternalWork`] where nodes are prescribed and steps are explicit.
    PreviousPrescribedIncrement(Vec<f32>) = "previous_prescribed_increment", State of Account, Nodes(3), increments: All, in "node_diagnostics";
    /// Bits: which of those node systems that choose their nodes have chosen a node. Exists when there are some.
    ChosenBy(Vec<u32>) = "chosen_by", State of Own, Nodes(1);
    /// Numbers that node systems keep for themselves from step to step: those of a node side by side, of one system
    /// after the other. Exists when a system has some.
    OwnNumbers(Reals) = "own_numbers", State of Own, Other;
    /// Displacement in the middle of the last step (m), a vector a node: for the guards on a GPU.
    MiddleDisplacement(Reals) = "middle_displacement", Scratch of Guard, Nodes(3);
    /// What each 64 nodes come to, four words each: bits of ½ m d² (kg m²) and of the longest step's square (m²), its
    /// row, bits of the square of the largest displacement (m²).
    NodeSums(Vec<u32>) = "node_sums", Scratch of Guard, Other;
    /// Forces of all elements (N), all blocks of the body one after the other: a vector for each node of each patch
    /// ([`Patches`](super::Patches)), which those that move with their patch do not use; in the scheme of two passes
    /// those on corners, in each group of [`LANES`](crate::math::LANES) elements by corner, component, element.
    ElementForce(Reals) = "element_force", Scratch of Force, Other;
}

/// Nodes to a sum in [`InternalWork`]: no less are moved together, so that who moves some has a sum of its own.
pub const GROUP_ROWS: usize = 16;

impl InternalWork {
    /// Of a body with so many nodes, none of which has moved yet.
    pub fn zero(nodes: usize) -> Self {
        Self(vec![0.0; 2 * (nodes.div_ceil(GROUP_ROWS) + 1)])
    }

    /// The work (J).
    pub fn total(&self) -> f64 {
        self.iter().map(|&part| f64::from(part)).sum()
    }

    /// Adds work of the whole body (J) to the first sum.
    pub fn add(&mut self, work: f64) {
        if let [sum, left_out, ..] = &mut *self.0 {
            let all = f64::from(*sum) + f64::from(*left_out) + work;
            *sum = all as f32;
            *left_out = (all - f64::from(*sum)) as f32;
        }
    }
}

/// Numbers a node in [`Work`].
pub const WORK_NUMBERS: usize = 7;

/// Which corners of elements meet in a node: the gather's map, in compressed rows. `corners[starts[i]..starts[i + 1]]`
/// are places in [`ElementForce`] of the x component; y and z follow `stride` and twice that later.
#[derive(Component, Clone, Debug)]
pub struct Corners {
    /// One more than nodes.
    pub starts: Vec<u32>,
    /// One for each patch that has the node; in the scheme of two passes four a tetrahedron, eight a hexahedron.
    pub corners: Vec<u32>,
    /// From component to component.
    pub stride: usize,
    /// The first row that is not [inside](super::Patches::interior) a patch.
    pub first_interface: usize,
    /// Rows before that which may have to [wait](super::Patches::deferred), patch by patch.
    pub deferred: Vec<Range<usize>>,
    /// The first of the others that may have to wait, or rows that are done in one go with it.
    pub first_waiting: usize,
}

/// How the author numbers and orders what the engine has renumbered.
#[derive(Component, Clone, Debug)]
pub struct Authoring {
    /// For each of the author's nodes, in the author's order, its row here.
    pub node_rows: Vec<u32>,
    /// The author's number of each of the author's nodes.
    pub node_ids: Ids,
    /// For each of the author's elements, its block's place in the body's list and its row there.
    pub element_rows: Vec<(u32, u32)>,
    /// The author's number of each of the author's elements.
    pub element_ids: Ids,
    /// Nodes of each element, in the author's order and the author's rows.
    pub cells: Cells,
    /// The body's element blocks.
    pub blocks: Vec<Entity>,
    /// Sets of the mesh file by name: their nodes, or those of their faces or elements, by places in the author's order
    /// (ascending, each once). None of a body that is there several times.
    pub sets: BTreeMap<String, Vec<u32>>,
}

impl Authoring {
    /// The author's number of the node in an engine row.
    pub fn node_id(&self, row: usize) -> u64 {
        let place = self.node_rows.iter().position(|&r| r as usize == row).unwrap_or(row);
        self.node_ids.of(place)
    }

    /// Faces of the surface, by places in the author's order. `alive` tells which elements are there, by their block's
    /// place and their row there.
    #[doc(hidden)]
    pub fn surface(&self, alive: impl Fn(u32, u32) -> bool) -> Vec<SurfaceFace> {
        let points = vec![DVec3::ZERO; self.node_rows.len()];
        let whole = Mesh { points, cells: self.cells.clone(), ..Mesh::default() };
        whole.exposed(|element| {
            let (block, row) = self.element_rows[element];
            alive(block, row)
        })
    }

    /// The author's number of an element, from its block's place and its row there.
    pub fn element_id(&self, block: usize, row: usize) -> u64 {
        let wanted = (block as u32, row as u32);
        let place = self.element_rows.iter().position(|&r| r == wanted).unwrap_or(row);
        self.element_ids.of(place)
    }
}
