//! A block's law and columns, to look at one element after the other.

use super::{ElementState, lane_place};
use crate::backend::cpu::{BlockLaw, Cpu, ROWS_A_TASK};
use crate::components::*;
use crate::elements::MOST_NODES;
use crate::elements::{averages, node_count, point_count};
use crate::materials::{Elastic, Kinematics};
use crate::math::{Mat3, Sym3};
use bevy_ecs::prelude::*;
use std::borrow::Cow;

/// A block with what is needed to look at its elements.
pub struct BlockView<'a> {
    /// What it is.
    pub block: &'a Block,
    /// Rows of its elements' nodes.
    pub connectivity: &'a [u32],
    /// Rest shapes.
    pub shape: &'a Reals,
    /// Displacements of the body's nodes (m).
    pub displacement: &'a Reals,
    /// The law in f64, for the run's time step.
    pub law: &'a BlockLaw<f64>,
    /// Fibre directions, where they differ.
    pub fibre_direction: Option<&'a Reals>,
    /// Viscous history; `None` looks at an instantaneous deformation.
    pub memory: Option<&'a Reals>,
    /// θ of the body's nodes, for elements that take their pressure from it.
    pub nodal_volume_change: Option<Cow<'a, Reals>>,
}

impl<'a> BlockView<'a> {
    /// A block under displacements of its body's nodes (m), its history left out. Nodal means are made afresh.
    pub fn under(world: &'a World, entity: Entity, displacement: &'a Reals) -> Option<Self> {
        let block = world.get::<Block>(entity)?;
        let mut view = Self {
            block,
            connectivity: world.get::<Connectivity>(entity)?,
            shape: world.get::<RestShape>(entity)?,
            displacement,
            law: world.get::<BlockLaw<f64>>(entity)?,
            fibre_direction: world.get::<FibreDirection>(entity).map(|f| &f.0),
            memory: None,
            nodal_volume_change: None,
        };
        if averages(block.kind) {
            let means = nodal_volume_change(&view, world.resource::<Cpu>(), world.get::<BlockCorners>(entity)?);
            view.nodal_volume_change = Some(Cow::Owned(means));
        }
        Some(view)
    }

    /// A block as it is now, its history included: after an implicit step that of its beginning, with which its forces
    /// were found; else the one with which the next step will find them.
    pub fn now(world: &'a World, entity: Entity) -> Option<Self> {
        let displacement = world.get::<Displacement>(world.get::<Block>(entity)?.body)?;
        let before = world.get::<MemoryBefore>(entity).map(|m| &m.0);
        let memory = before.or_else(|| world.get::<ViscousMemory>(entity).map(|m| &m.0));
        Some(Self { memory, ..Self::under(world, entity, displacement)? })
    }

    /// An element's state.
    pub fn element(&self, row: usize) -> ElementState {
        ElementState::of(self.block, row, self.connectivity, self.shape, self.displacement, self.law.elastic_of(row))
    }

    /// First Piola-Kirchhoff stress (Pa) at a point that `element_forces` finds at these displacements.
    pub fn stress(&self, row: usize, state: &ElementState, point: usize) -> Mat3<f64> {
        let (law, k) = (self.law, &state.points()[point].kinematics);
        let elastic = law.elastic_of(row);
        let (isochoric, instant) = self.instant(row, state, point);
        let mut stress = isochoric;
        let mut pressure = instant;
        if let Some(memory) = self.memory {
            let [prony, volumetric] = law.terms_of(row);
            let (terms, points) = (prony.len(), point_count(state.kind));
            let history = |place: usize| memory.get(lane_place(row, law.memory_numbers(points), place));
            for (number, term) in prony.iter().enumerate() {
                let first = 6 * (point * terms + number);
                let history = Sym3(std::array::from_fn(|i| history(first + i)));
                stress = stress.plus(&term.relaxed(&isochoric, &history).scaled(-1.0));
            }
            for (number, term) in volumetric.iter().enumerate() {
                pressure -= term.relaxed_component(instant, history(6 * terms * points + number));
            }
            if law.reproject {
                stress = elastic.without_pressure(k, stress);
            }
        }
        elastic.first_stress(&state.points()[point].gradient, k, &stress, pressure)
    }

    /// Isochoric second Piola-Kirchhoff stress and pressure (Pa) at a point before anything has relaxed.
    pub fn instant(&self, row: usize, state: &ElementState, point: usize) -> (Sym3<f64>, f64) {
        let (law, k) = (self.law, &state.points()[point].kinematics);
        let mut isochoric = law.elastic_of(row).isochoric(k);
        if let Some((fibres, from)) = law.fibres_of(row) {
            isochoric = isochoric.plus(&fibres.isochoric(k, self.direction(row, from)));
        }
        for (family, from) in law.families_of(row) {
            isochoric = isochoric.plus(&family.isochoric(k, self.direction(row, from)));
        }
        (isochoric, self.pressure(row, state, k))
    }

    /// Nodal forces (N).
    pub fn forces(&self, row: usize, state: &ElementState) -> [[f64; 3]; MOST_NODES] {
        state.forces(row, self.shape, |point| self.stress(row, state, point))
    }

    /// Cauchy stress (Pa), mean over the points: xx, yy, zz, xy, yz, xz.
    pub fn cauchy(&self, row: usize, state: &ElementState) -> [f64; 6] {
        let mut mean = [0.0; 6];
        for (number, point) in state.points().iter().enumerate() {
            let first = self.stress(row, state, number);
            let stress = self.law.elastic_of(row).cauchy(&point.gradient, point.kinematics.divisor(), &first);
            (0..6).for_each(|i| mean[i] += point.share * stress.0[i]);
        }
        mean
    }

    /// Elastic energy per rest volume (J/m³), as of an instantaneous deformation.
    pub fn energy(&self, row: usize, state: &ElementState) -> f64 {
        let elastic = self.law.elastic_of(row);
        let isochoric = |k: &Kinematics<f64>| {
            let fibres = self.law.fibres_of(row);
            let fibres = fibres.map_or(0.0, |(fibres, from)| fibres.energy(k, self.direction(row, from)));
            let families = self.law.families_of(row);
            let exponential: f64 = families.map(|(family, from)| family.energy(k, self.direction(row, from))).sum();
            elastic.isochoric_energy(k) + fibres + exponential
        };
        let mean: f64 = state.points().iter().map(|point| point.share * isochoric(&point.kinematics)).sum();
        mean + self.mean_over_volume_changes(state, |theta| elastic.volumetric_energy(theta))
    }

    /// Pressure (Pa), positive when the volume has grown.
    fn pressure(&self, row: usize, state: &ElementState, k: &Kinematics<f64>) -> f64 {
        let elastic = self.law.elastic_of(row);
        match state.points().len() {
            1 if self.nodal_volume_change.is_none() => elastic.pressure(elastic.volume_measure(k)),
            _ => self.mean_over_volume_changes(state, |theta| elastic.pressure(theta)),
        }
    }

    /// Mean of a function of θ over the nodes' θ; else its value at the mean θ of the points.
    fn mean_over_volume_changes(&self, state: &ElementState, of: impl Fn(f64) -> f64) -> f64 {
        match &self.nodal_volume_change {
            Some(means) => {
                let nodes = &state.nodes[..node_count(state.kind)];
                nodes.iter().map(|&node| of(means.get(node as usize))).sum::<f64>() / nodes.len() as f64
            }
            None => of(self.mean_volume_change(state)),
        }
    }

    fn mean_volume_change(&self, state: &ElementState) -> f64 {
        let measure = |k| self.law.elastic.volume_measure(k);
        state.points().iter().map(|point| point.share * measure(&point.kinematics)).sum()
    }

    pub(super) fn direction(&self, row: usize, from: &FamilyDirection<f64>) -> [f64; 3] {
        match (from, self.fibre_direction) {
            (FamilyDirection::Uniform(a), _) => *a,
            (FamilyDirection::Varying(place), Some(all)) => {
                let numbers = 3 * self.law.varying_families();
                [0, 1, 2].map(|i| all.get(lane_place(row, numbers, 3 * place + i)))
            }
            (FamilyDirection::Varying(_), None) => [0.0; 3],
        }
    }
}

/// Mean θ of the block's elements around each node of its body, by rest volume; 0 where there are none. Twin in f64 of
/// the system `nodal_volume`.
pub fn nodal_volume_change(view: &BlockView<'_>, cpu: &Cpu, corners: &BlockCorners) -> Reals {
    let count = view.block.count;
    let of_element = |row: usize| {
        let state = view.element(row);
        (state.volume, state.volume * view.mean_volume_change(&state))
    };
    let task = |task: usize| {
        (task * ROWS_A_TASK..count.min((task + 1) * ROWS_A_TASK)).map(of_element).collect::<Vec<(f64, f64)>>()
    };
    let elements = cpu.map(count.div_ceil(ROWS_A_TASK), task).concat();
    let mean = |node: usize| {
        let rows = &corners.elements[corners.starts[node] as usize..corners.starts[node + 1] as usize];
        let (volume, change) =
            rows.iter().map(|&row| elements[row as usize]).fold((0.0, 0.0), |sum, e| (sum.0 + e.0, sum.1 + e.1));
        if volume > 0.0 { change / volume } else { 0.0 }
    };
    Reals::F64((0..corners.starts.len() - 1).map(mean).collect())
}
