//! Volumes of all elements of a block, a register full at a time: what nodal means are made of.

use super::element_kernel::{corner_registers, group_vectors};
use super::{BlockLaw, Cpu};
use crate::elements::{Element, MOST_NODES};
use crate::materials::{Elastic, WithElastic};
use crate::math::{LANES, SimdScalar};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;

/// Fills in, for every element of a block with one integration point, its volume (m³) and that times θ.
pub fn run_volumes<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    law: &BlockLaw<T>,
    displacement: &[T],
    connectivity: &[u32],
    rest_shape: &[T],
    groups_a_patch: usize,
    volumes: &mut [T],
) {
    let element = PhantomData::<E>;
    law.elastic.with(Volumes { cpu, displacement, connectivity, rest_shape, groups_a_patch, volumes, element });
}

struct Volumes<'a, E, T> {
    cpu: &'a Cpu,
    displacement: &'a [T],
    connectivity: &'a [u32],
    rest_shape: &'a [T],
    groups_a_patch: usize,
    volumes: &'a mut [T],
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar> WithElastic<T> for Volumes<'_, E, T> {
    type Output = ();
    fn with<L: Elastic<T>>(self, _: &L) {
        let patch = self.groups_a_patch * LANES;
        let tasks = self.volumes.chunks_mut(2 * patch).enumerate().map(|(index, volumes)| Patch::<E, T, L> {
            displacement: self.displacement,
            connectivity: &self.connectivity[index * patch * E::NODES..],
            rest_shape: &self.rest_shape[index * patch * E::ROWS..],
            volumes,
            types: PhantomData,
        });
        self.cpu.for_each(tasks, |patch| self.cpu.arch().dispatch(patch));
    }
}

struct Patch<'a, E, T, L> {
    displacement: &'a [T],
    connectivity: &'a [u32],
    rest_shape: &'a [T],
    volumes: &'a mut [T],
    types: PhantomData<(E, L)>,
}

impl<E: Element, T: SimdScalar, L: Elastic<T>> WithSimd for Patch<'_, E, T, L> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for group in 0..self.volumes.len() / (2 * LANES) {
            let nodes = &self.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
            let displacements: [[[T; LANES]; 3]; MOST_NODES] = group_vectors::<E, T>(nodes, self.displacement);
            let rest_shape = &self.rest_shape[group * E::ROWS * LANES..(group + 1) * E::ROWS * LANES];
            let mut at = 0;
            while at < LANES {
                let u = E::prepare(&corner_registers::<E, T, S>(simd, &displacements, at));
                let state = E::at_point(
                    &u,
                    0,
                    #[inline(always)]
                    |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
                );
                let k = <L::Of<T::Vector<S>>>::kinematics(&state.gradient);
                let theta = <L::Of<T::Vector<S>>>::volume_measure(&k);
                T::store(state.volume, &mut self.volumes[2 * group * LANES + at..]);
                T::store(state.volume * theta, &mut self.volumes[(2 * group + 1) * LANES + at..]);
                at += T::width::<S>();
            }
        }
    }
}
