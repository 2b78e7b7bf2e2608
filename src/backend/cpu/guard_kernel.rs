//! What a block's elements come to: energies, and the one that is squeezed most; a register full at a time. Looked at
//! every so many steps by the guards; `shaders/guard_elements.wgsl` is its twin.

use super::element_kernel::{corner_registers, group_vectors};
use super::in_one_place::{ElasticOfCopies, in_one_place};
use super::{BlockLaw, Cpu};
use crate::components::FamilyDirection;
use crate::elements::{Element, PressureFrom};
use crate::materials::{Elastic, ElasticLaw, Kinematics};
use crate::math::{LANES, Mat3, Real, SimdScalar};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;

/// What the elements of a block come to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockSums {
    /// Elastic energy, as of an instantaneous deformation (J).
    pub strain: f64,
    /// Energy in hourglass control (J).
    pub hourglass: f64,
    /// The smallest J at a point of an element that is there; infinite without any.
    pub least_volume_ratio: f64,
    /// The lowest row of an element that has it.
    pub row: u32,
}

impl Default for BlockSums {
    fn default() -> Self {
        Self { strain: 0.0, hourglass: 0.0, least_volume_ratio: f64::INFINITY, row: u32::MAX }
    }
}

impl BlockSums {
    /// These and those of later rows.
    pub fn and(self, later: Self) -> Self {
        // what is no number stays
        let less = later.least_volume_ratio < self.least_volume_ratio || later.least_volume_ratio.is_nan();
        let least = if less && !self.least_volume_ratio.is_nan() { later } else { self };
        Self { strain: self.strain + later.strain, hourglass: self.hourglass + later.hourglass, ..least }
    }
}

/// The columns that the sums are taken from; layouts as in [`components`](crate::components).
pub struct GuardColumns<'a, T> {
    /// The body's displacements (m).
    pub displacement: &'a [T],
    /// Nodes of each element.
    pub connectivity: &'a [u32],
    /// Rest shapes.
    pub rest_shape: &'a [T],
    /// Fibre directions, where they differ.
    pub fibre_direction: Option<&'a [T]>,
    /// θ of each node of the body under these displacements; empty for elements that do not need it.
    pub nodal_volume_change: &'a [T],
}

/// Sums over a block; the same bits for any number of threads.
pub fn run_guard<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    columns: &GuardColumns<'_, T>,
    law: &BlockLaw<T>,
    groups_a_patch: usize,
) -> BlockSums {
    let groups = columns.rest_shape.len() / (E::ROWS * LANES);
    let task = |index: usize| {
        let first = index * groups_a_patch;
        let groups = first..groups.min(first + groups_a_patch);
        cpu.dispatch(PatchSums::<E, T> { columns, law, groups, element: PhantomData })
    };
    let sums = cpu.map(groups.div_ceil(groups_a_patch), task);
    sums.into_iter().fold(BlockSums::default(), BlockSums::and)
}

struct PatchSums<'a, E, T: SimdScalar> {
    columns: &'a GuardColumns<'a, T>,
    law: &'a BlockLaw<T>,
    groups: std::ops::Range<usize>,
    element: PhantomData<E>,
}

/// Energy, hourglass energy, smallest J and volume of a register full of elements.
type Register<V> = [V; 4];

impl<E: Element, T: SimdScalar> WithSimd for PatchSums<'_, E, T> {
    type Output = BlockSums;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> BlockSums {
        let mut sums = BlockSums::default();
        for group in self.groups.clone() {
            let nodes = &self.columns.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
            let displacements = group_vectors::<E, T>(nodes, self.columns.displacement);
            let mut lanes = [[T::default(); LANES]; 4];
            let mut at = 0;
            while at < LANES {
                let u = corner_registers::<E, T, S>(simd, &displacements, at);
                for (numbers, lanes) in self.part_of_group(simd, group, at, &u).into_iter().zip(&mut lanes) {
                    T::store(numbers, &mut lanes[at..]);
                }
                at += T::width::<S>();
            }
            for lane in 0..LANES {
                let [energy, hourglass, least, volume] = [0, 1, 2, 3].map(|i: usize| lanes[i][lane].to_f64());
                if volume > 0.0 {
                    let row = (group * LANES + lane) as u32;
                    let element = BlockSums { strain: energy * volume, hourglass, least_volume_ratio: least, row };
                    sums = sums.and(element);
                }
            }
        }
        sums
    }
}

impl<E: Element, T: SimdScalar> PatchSums<'_, E, T> {
    #[inline(always)]
    fn part_of_group<S: Simd>(
        &self,
        simd: S,
        group: usize,
        at: usize,
        corners: &[[T::Vector<S>; 3]; crate::elements::MOST_NODES],
    ) -> Register<T::Vector<S>> {
        let elastic = match &self.law.copies {
            Some(copies) => {
                let kind = &self.law.elastic;
                in_one_place(simd, ElasticOfCopies { simd, copies, kind, group, at })
            }
            None => self.law.elastic.map(
                #[inline(always)]
                |number: T| T::splat(simd, number),
            ),
        };
        let rest_shape = &self.columns.rest_shape[group * E::ROWS * LANES..(group + 1) * E::ROWS * LANES];
        let number = |row: usize| T::load(simd, &rest_shape[row * LANES + at..]);
        let u = E::prepare(corners);
        let zero = T::splat(simd, T::default());
        let (mut isochoric, mut change, mut volume) = (zero, zero, zero);
        let mut least = zero.constant(f32::MAX.into());
        let mut hourglass = zero;
        for point in 0..E::POINTS {
            let state = E::at_point(&u, point, number);
            let (columns, law) = (self.columns, self.law);
            let point_state =
                PointState { simd, columns, law, elastic: &elastic, group, at, gradient: &state.gradient };
            let [energy, measure, j] = in_one_place(simd, point_state);
            isochoric = state.volume.mul_add(energy, isochoric);
            change = state.volume.mul_add(measure, change);
            volume += state.volume;
            least = least.min(j);
            if point == 0 {
                hourglass = E::hourglass_energy(&u, &state.gradient, number);
            }
        }
        for point in E::POINTS..E::CHECKED_POINTS {
            let change = E::at_point(&u, point, number).gradient.volume_change();
            least = least.min(change + change.constant(1.0));
        }
        // an element that fills up its group may have no volume at all
        let volume = volume.if_positive(volume, zero.constant(1.0));
        let volumetric = match E::PRESSURE {
            PressureFrom::Nodes => self.energy_of_nodes(simd, &elastic, group, at),
            _ => elastic.volumetric_energy(change / volume),
        };
        [isochoric / volume + volumetric, hourglass, least, number(E::VOLUME_ROW)]
    }

    /// Mean of U(θ) (J/m³) over the nodes.
    #[inline(always)]
    fn energy_of_nodes<S: Simd>(
        &self,
        simd: S,
        elastic: &ElasticLaw<T::Vector<S>>,
        group: usize,
        at: usize,
    ) -> T::Vector<S> {
        let nodes = &self.columns.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
        let mut sum = T::splat(simd, T::default());
        for corner in 0..E::NODES {
            let mut lanes = [T::default(); LANES];
            for lane in 0..T::width::<S>() {
                lanes[lane] = self.columns.nodal_volume_change[nodes[corner * LANES + at + lane] as usize];
            }
            sum += elastic.volumetric_energy(T::load(simd, &lanes));
        }
        sum * sum.constant(1.0 / E::NODES as f64)
    }
}

/// What elements come to at one of their points.
struct PointState<'a, T: SimdScalar, S: Simd> {
    simd: S,
    columns: &'a GuardColumns<'a, T>,
    law: &'a BlockLaw<T>,
    elastic: &'a ElasticLaw<T::Vector<S>>,
    group: usize,
    at: usize,
    gradient: &'a Mat3<T::Vector<S>>,
}

impl<T: SimdScalar, S: Simd> WithSimd for PointState<'_, T, S> {
    /// Ψ_iso with the fibres' (J/m³), what the volume is measured by, and J.
    type Output = [T::Vector<S>; 3];

    #[inline(always)]
    fn with_simd<Q: Simd>(self, _: Q) -> Self::Output {
        let k = self.elastic.kinematics(self.gradient);
        let energy = self.elastic.isochoric_energy(&k) + self.fibre_energy(&k);
        [energy, self.elastic.volume_measure(&k), k.true_j]
    }
}

impl<T: SimdScalar, S: Simd> PointState<'_, T, S> {
    /// Of all families of fibres (J/m³).
    #[inline(always)]
    fn fibre_energy(&self, k: &Kinematics<T::Vector<S>>) -> T::Vector<S> {
        let Self { simd, group, at, .. } = *self;
        let splat = |number: T| T::splat(simd, number);
        let mut energy = splat(T::default());
        let (copies, families) = (&self.law.copies, self.law.exponential.len());
        if let Some((fibres, from)) = &self.law.fibres {
            let mut fibres = fibres.map(splat);
            if let Some(copies) = copies {
                fibres.eta = copies.eta(simd, group, at, families);
            }
            energy += fibres.energy(k, self.direction(from));
        }
        for (number, (family, from)) in self.law.exponential.iter().enumerate() {
            let mut family = family.map(splat);
            if let Some(copies) = copies {
                copies.stiffen(simd, (group, at), (number, families), &mut family);
            }
            energy += family.energy(k, self.direction(from));
        }
        energy
    }

    #[inline(always)]
    fn direction(&self, from: &FamilyDirection<T>) -> [T::Vector<S>; 3] {
        let Self { simd, group, at, .. } = *self;
        let numbers = 3 * self.law.varying_families();
        [0, 1, 2].map(|i| match (from, self.columns.fibre_direction) {
            (FamilyDirection::Uniform(a), _) => T::splat(simd, a[i]),
            (FamilyDirection::Varying(place), Some(all)) => {
                T::load(simd, &all[(group * numbers + 3 * place + i) * LANES + at..])
            }
            (FamilyDirection::Varying(_), None) => T::splat(simd, T::default()),
        })
    }
}
