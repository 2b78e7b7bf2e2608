//! Volumes of all elements of a block, a register full at a time: what nodal means are made of.

use super::element_kernel::{corner_registers, group_vectors};
use super::{BlockLaw, Cpu};
use crate::elements::{Element, MOST_NODES};
use crate::materials::{Elastic, ElasticLaw};
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
    let patch = groups_a_patch * LANES;
    let tasks = volumes.chunks_mut(2 * patch).enumerate().map(|(index, volumes)| PatchVolumes::<E, T> {
        displacement,
        connectivity: &connectivity[index * patch * E::NODES..],
        rest_shape: &rest_shape[index * patch * E::ROWS..],
        elastic: &law.elastic,
        volumes,
        element: PhantomData,
    });
    cpu.for_each(tasks, |patch| cpu.dispatch(patch));
}

struct PatchVolumes<'a, E, T: SimdScalar> {
    displacement: &'a [T],
    connectivity: &'a [u32],
    rest_shape: &'a [T],
    elastic: &'a ElasticLaw<T>,
    volumes: &'a mut [T],
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar> WithSimd for PatchVolumes<'_, E, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // no built-in law measures strain or volume by its parameters: those of the first copy do for all
        let elastic = self.elastic.map(
            #[inline(always)]
            |number: T| T::splat(simd, number),
        );
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
                let k = elastic.kinematics(&state.gradient);
                let theta = elastic.volume_measure(&k);
                T::store(state.volume, &mut self.volumes[2 * group * LANES + at..]);
                T::store(state.volume * theta, &mut self.volumes[(2 * group + 1) * LANES + at..]);
                at += T::width::<S>();
            }
        }
    }
}
