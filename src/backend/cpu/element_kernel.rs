//! Forces of all elements of a block, a register full at a time.

use super::{BlockLaw, Cpu};
use crate::elements::{Element, MOST_NODES};
use crate::materials::{Fibres, Kinematics, NeoHookean, PronyTerm};
use crate::math::{LANES, Real, SimdScalar, Sym3};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;
use std::sync::atomic::{AtomicBool, Ordering};

/// The columns a block's kernel reads and writes; layouts as in [`components`](crate::components).
pub struct BlockColumns<'a, T> {
    /// The body's displacements (m).
    pub displacement: &'a [T],
    /// Nodes of each element.
    pub connectivity: &'a [u32],
    /// Rest shapes.
    pub rest_shape: &'a [T],
    /// Fibre directions, where they differ.
    pub fibre_direction: Option<&'a [T]>,
    /// Viscous history; empty without viscosity.
    pub memory: &'a mut [T],
    /// The block's part of the element forces (N).
    pub force: &'a mut [T],
}

/// Fills in the forces of a block and carries its viscous history on by one step. Says whether an element has J < 0.
pub fn run_block<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    columns: BlockColumns<'_, T>,
    law: &BlockLaw<T>,
    groups_a_patch: usize,
) -> bool {
    match (law.fibres.is_some(), !law.prony.is_empty()) {
        (false, false) => run_kernel::<E, T, false, false>(cpu, columns, law, groups_a_patch),
        (true, false) => run_kernel::<E, T, true, false>(cpu, columns, law, groups_a_patch),
        (false, true) => run_kernel::<E, T, false, true>(cpu, columns, law, groups_a_patch),
        (true, true) => run_kernel::<E, T, true, true>(cpu, columns, law, groups_a_patch),
    }
}

fn run_kernel<E: Element, T: SimdScalar, const FIBRES: bool, const PRONY: bool>(
    cpu: &Cpu,
    columns: BlockColumns<'_, T>,
    law: &BlockLaw<T>,
    groups_a_patch: usize,
) -> bool {
    let inverted = AtomicBool::new(false);
    let patch = groups_a_patch * LANES;
    let memory_a_group = 6 * law.prony.len();
    let patches = columns.force.chunks_mut(patch * 3 * E::NODES).enumerate();
    // without viscosity there is no memory to hand out
    let mut memories = columns.memory.chunks_mut((patch * memory_a_group).max(1));
    let tasks = patches.map(move |(index, force)| Patch::<E, T, FIBRES, PRONY> {
        displacement: columns.displacement,
        connectivity: &columns.connectivity[index * patch * E::NODES..],
        rest_shape: &columns.rest_shape[index * patch * E::ROWS..],
        fibre_direction: columns.fibre_direction.map(|all| &all[index * patch * 3..]),
        memory: memories.next().unwrap_or_default(),
        force,
        law,
        element: PhantomData,
    });
    cpu.for_each(tasks, |patch| {
        if cpu.arch().dispatch(patch) {
            inverted.store(true, Ordering::Relaxed);
        }
    });
    inverted.into_inner()
}

struct Patch<'a, E, T: SimdScalar, const FIBRES: bool, const PRONY: bool> {
    displacement: &'a [T],
    connectivity: &'a [u32],
    rest_shape: &'a [T],
    fibre_direction: Option<&'a [T]>,
    memory: &'a mut [T],
    force: &'a mut [T],
    law: &'a BlockLaw<T>,
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar, const FIBRES: bool, const PRONY: bool> WithSimd for Patch<'_, E, T, FIBRES, PRONY> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> bool {
        let mut worst = T::splat(simd, T::default());
        for group in 0..self.force.len() / (LANES * 3 * E::NODES) {
            let displacements = self.group_displacements(group);
            let mut at = 0;
            while at < LANES {
                worst = worst.max(self.part_of_group(simd, group, at, &displacements));
                at += T::width::<S>();
            }
        }
        let mut lanes = [T::default(); LANES];
        T::store(worst, &mut lanes);
        lanes.iter().any(|&v| v > T::default())
    }
}

impl<E: Element, T: SimdScalar, const FIBRES: bool, const PRONY: bool> Patch<'_, E, T, FIBRES, PRONY> {
    /// Displacements of a group's nodes, brought side by side.
    #[inline(always)]
    fn group_displacements(&self, group: usize) -> [[[T; LANES]; 3]; MOST_NODES] {
        let mut displacements = [[[T::default(); LANES]; 3]; MOST_NODES];
        let nodes = &self.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
        for corner in 0..E::NODES {
            for lane in 0..LANES {
                let row = 3 * nodes[corner * LANES + lane] as usize;
                let u = &self.displacement[row..row + 3];
                for i in 0..3 {
                    displacements[corner][i][lane] = u[i];
                }
            }
        }
        displacements
    }

    /// One register full of elements, from lane `at` on. Returns −J V, positive for inverted elements.
    #[inline(always)]
    fn part_of_group<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        at: usize,
        displacements: &[[[T; LANES]; 3]; MOST_NODES],
    ) -> T::Vector<S> {
        let law = self.law;
        let zero = T::splat(simd, T::default());
        let mut u = [[zero; 3]; MOST_NODES];
        for corner in 0..E::NODES {
            for i in 0..3 {
                u[corner][i] = T::load(simd, &displacements[corner][i][at..]);
            }
        }
        let rest_shape = &self.rest_shape[group * E::ROWS * LANES..(group + 1) * E::ROWS * LANES];
        let gradient = E::gradient(
            &u,
            #[inline(always)]
            |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
        );
        let k = Kinematics::new(&gradient);
        let neo_hookean =
            NeoHookean { shear: T::splat(simd, law.neo_hookean.shear), bulk: T::splat(simd, law.neo_hookean.bulk) };
        let mut isochoric = neo_hookean.isochoric(&k);
        if FIBRES {
            isochoric = isochoric.plus(&self.fibre_stress(simd, group, at, &k));
        }
        if PRONY {
            isochoric = self.relax(simd, group, at, isochoric);
        }
        let stress = gradient.plus_identity_times(&isochoric.plus(&neo_hookean.volumetric(&k)));
        let out = &mut self.force[group * 3 * E::NODES * LANES..(group + 1) * 3 * E::NODES * LANES];
        E::forces(
            &u,
            &gradient,
            &stress,
            #[inline(always)]
            |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
            #[inline(always)]
            |corner: usize, i: usize, force| T::store(force, &mut out[(3 * corner + i) * LANES + at..]),
        );
        -(k.true_j * T::load(simd, &rest_shape[E::VOLUME_ROW * LANES + at..]))
    }

    #[inline(always)]
    fn fibre_stress<S: Simd>(
        &self,
        simd: S,
        group: usize,
        at: usize,
        k: &Kinematics<T::Vector<S>>,
    ) -> Sym3<T::Vector<S>> {
        let zero = T::splat(simd, T::default());
        let Some((fibres, uniform)) = &self.law.fibres else {
            return Sym3([zero; 6]);
        };
        let fibres = Fibres { eta: T::splat(simd, fibres.eta), tension_only: T::splat(simd, fibres.tension_only) };
        let mut direction = [zero; 3];
        for i in 0..3 {
            direction[i] = match (uniform, self.fibre_direction) {
                (Some(a), _) => T::splat(simd, a[i]),
                (None, Some(all)) => T::load(simd, &all[(group * 3 + i) * LANES + at..]),
                (None, None) => zero,
            };
        }
        fibres.isochoric(k, direction)
    }

    /// S_iso − Υ; the memory is carried on.
    #[inline(always)]
    fn relax<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        at: usize,
        isochoric: Sym3<T::Vector<S>>,
    ) -> Sym3<T::Vector<S>> {
        let terms = self.law.prony.len();
        let mut stress = isochoric;
        for (number, term) in self.law.prony.iter().enumerate() {
            let term = PronyTerm {
                stress: T::splat(simd, term.stress),
                memory: T::splat(simd, term.memory),
                rate: T::splat(simd, term.rate),
                aim: T::splat(simd, term.aim),
            };
            let first = (group * 6 * terms + 6 * number) * LANES + at;
            let mut memory = isochoric;
            for i in 0..6 {
                memory.0[i] = T::load(simd, &self.memory[first + i * LANES..]);
            }
            let relaxed = term.relaxed(&isochoric, &memory);
            for i in 0..6 {
                stress.0[i] -= relaxed.0[i];
            }
            let memory = term.carried_on(&isochoric, &memory);
            for i in 0..6 {
                T::store(memory.0[i], &mut self.memory[first + i * LANES..]);
            }
        }
        stress
    }
}
