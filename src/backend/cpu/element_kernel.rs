//! Forces of all elements of a block, a register full at a time.

mod effects;

use super::{BlockLaw, Cpu};
use crate::elements::{Element, MOST_NODES, PressureFrom};
use crate::materials::{Elastic, ElasticLaw, Kinematics};
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
    /// θ of each node of the body; empty for elements that do not need it.
    pub nodal_volume_change: &'a [T],
    /// Viscous history; empty without viscosity.
    pub memory: &'a mut [T],
    /// The block's part of the element forces (N).
    pub force: &'a mut [T],
}

/// Fills in the forces of a block and carries its viscous history on by one step. Says whether an element has J < 0.
///
/// One kernel an element type for all laws and effects, which asks for them at each point.
pub fn run_block<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    columns: BlockColumns<'_, T>,
    law: &BlockLaw<T>,
    groups_a_patch: usize,
) -> bool {
    Block::<E, T> { cpu, columns, law, groups_a_patch, element: PhantomData }.run::<_, ASK>(&law.elastic)
}

/// The same in f32, where speed counts: the neo-Hookean law has a kernel of its own for each combination of fibres and
/// viscosity, so that what a material lacks is not even asked for.
pub fn run_block_fast<E: Element>(
    cpu: &Cpu,
    columns: BlockColumns<'_, f32>,
    law: &BlockLaw<f32>,
    groups_a_patch: usize,
) -> bool {
    let ElasticLaw::NeoHookean(elastic) = &law.elastic else {
        return run_block::<E, f32>(cpu, columns, law, groups_a_patch);
    };
    let plain = law.exponential.is_empty() && law.volumetric.is_empty() && !law.reproject;
    let block = Block::<E, f32> { cpu, columns, law, groups_a_patch, element: PhantomData };
    match (law.fibres.is_some(), !law.prony.is_empty()) {
        _ if !plain => block.run::<_, ASK>(&law.elastic),
        (false, false) => block.run::<_, 0>(elastic),
        (true, false) => block.run::<_, FIBRES>(elastic),
        (false, true) => block.run::<_, VISCOSITY>(elastic),
        (true, true) => block.run::<_, { FIBRES | VISCOSITY }>(elastic),
    }
}

/// Effects of a kernel, as bits.
const FIBRES: u8 = 1;
const VISCOSITY: u8 = 2;
/// The kernel asks the block's law which effects it has.
const ASK: u8 = 4;

struct Block<'a, E, T: SimdScalar> {
    cpu: &'a Cpu,
    columns: BlockColumns<'a, T>,
    law: &'a BlockLaw<T>,
    groups_a_patch: usize,
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar> Block<'_, E, T> {
    fn run<L: Elastic<T>, const EFFECTS: u8>(self, elastic: &L) -> bool {
        let Self { cpu, columns, law, groups_a_patch, element } = self;
        let inverted = AtomicBool::new(false);
        let patch = groups_a_patch * LANES;
        let memory_an_element = law.memory_numbers(E::POINTS);
        let varying = law.varying_families();
        let patches = columns.force.chunks_mut(patch * 3 * E::NODES).enumerate();
        // without viscosity there is no memory to hand out
        let mut memories = columns.memory.chunks_mut((patch * memory_an_element).max(1));
        let tasks = patches.map(move |(index, force)| Patch::<E, T, L, EFFECTS> {
            displacement: columns.displacement,
            nodal_volume_change: columns.nodal_volume_change,
            connectivity: &columns.connectivity[index * patch * E::NODES..],
            rest_shape: &columns.rest_shape[index * patch * E::ROWS..],
            fibre_direction: columns.fibre_direction.map(|all| &all[index * patch * 3 * varying..]),
            varying,
            memory: memories.next().unwrap_or_default(),
            force,
            elastic,
            law,
            element,
        });
        cpu.for_each(tasks, |patch| {
            if cpu.arch().dispatch(patch) {
                inverted.store(true, Ordering::Relaxed);
            }
        });
        inverted.into_inner()
    }
}

struct Patch<'a, E, T: SimdScalar, L, const EFFECTS: u8> {
    displacement: &'a [T],
    nodal_volume_change: &'a [T],
    connectivity: &'a [u32],
    rest_shape: &'a [T],
    fibre_direction: Option<&'a [T]>,
    varying: usize,
    memory: &'a mut [T],
    force: &'a mut [T],
    elastic: &'a L,
    law: &'a BlockLaw<T>,
    element: PhantomData<E>,
}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> WithSimd for Patch<'_, E, T, L, EFFECTS> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> bool {
        let mut worst = T::splat(simd, T::default());
        for group in 0..self.force.len() / (LANES * 3 * E::NODES) {
            let nodes = &self.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
            let displacements = group_vectors::<E, T>(nodes, self.displacement);
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

/// S_iso of a law in a function of its own: what all laws come to is too much code to stand in every element's kernel.
struct Isochoric<'a, L, R> {
    elastic: &'a L,
    k: &'a Kinematics<R>,
}

impl<R: Real, L: Elastic<R>> WithSimd for Isochoric<'_, L, R> {
    type Output = Sym3<R>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sym3<R> {
        self.elastic.isochoric(self.k)
    }
}

/// Vectors of a group's nodes, brought side by side.
#[inline(always)]
pub(super) fn group_vectors<E: Element, T: SimdScalar>(nodes: &[u32], column: &[T]) -> [[[T; LANES]; 3]; MOST_NODES] {
    let mut vectors = [[[T::default(); LANES]; 3]; MOST_NODES];
    for corner in 0..E::NODES {
        for lane in 0..LANES {
            let row = 3 * nodes[corner * LANES + lane] as usize;
            let vector = &column[row..row + 3];
            for i in 0..3 {
                vectors[corner][i][lane] = vector[i];
            }
        }
    }
    vectors
}

/// A register full of nodal vectors, from lane `at` on.
#[inline(always)]
pub(super) fn corner_registers<E: Element, T: SimdScalar, S: Simd>(
    simd: S,
    vectors: &[[[T; LANES]; 3]; MOST_NODES],
    at: usize,
) -> [[T::Vector<S>; 3]; MOST_NODES] {
    let mut u = [[T::splat(simd, T::default()); 3]; MOST_NODES];
    for corner in 0..E::NODES {
        for i in 0..3 {
            u[corner][i] = T::load(simd, &vectors[corner][i][at..]);
        }
    }
    u
}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> Patch<'_, E, T, L, EFFECTS> {
    #[inline(always)]
    fn has_fibres(&self) -> bool {
        if EFFECTS == ASK { self.law.fibres.is_some() } else { EFFECTS & FIBRES != 0 }
    }

    #[inline(always)]
    fn has_viscosity(&self) -> bool {
        if EFFECTS == ASK { !self.law.prony.is_empty() } else { EFFECTS & VISCOSITY != 0 }
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
        let elastic = self.elastic.map(
            #[inline(always)]
            |number: T| T::splat(simd, number),
        );
        let zero = T::splat(simd, T::default());
        let u = E::prepare(&corner_registers::<E, T, S>(simd, displacements, at));
        let rest_shape = &self.rest_shape[group * E::ROWS * LANES..(group + 1) * E::ROWS * LANES];
        let shared = match E::PRESSURE {
            PressureFrom::Point => zero,
            PressureFrom::MeanOverPoints => {
                elastic.pressure(mean_volume_change::<E, T, L, S>(simd, &elastic, &u, rest_shape, at))
            }
            PressureFrom::Nodes => self.mean_of_nodes(simd, &elastic, group, at),
        };
        let mut forces = E::no_forces(zero);
        let mut worst = zero.constant(f64::MIN);
        for point in 0..E::POINTS {
            let state = E::at_point(
                &u,
                point,
                #[inline(always)]
                |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
            );
            let k = elastic.kinematics(&state.gradient);
            let mut pressure = match E::PRESSURE {
                PressureFrom::Point => elastic.pressure(elastic.volume_measure(&k)),
                _ => shared,
            };
            if EFFECTS == ASK && !self.law.volumetric.is_empty() {
                pressure = self.relax_pressure(simd, group, at, point, pressure);
            }
            let mut isochoric = match EFFECTS {
                ASK => simd.vectorize(Isochoric { elastic: &elastic, k: &k }),
                _ => elastic.isochoric(&k),
            };
            if self.has_fibres() {
                isochoric = isochoric.plus(&self.fibre_stress(simd, group, at, &k));
            }
            if EFFECTS == ASK && !self.law.exponential.is_empty() {
                isochoric = isochoric.plus(&self.exponential_stress(simd, group, at, &k));
            }
            if self.has_viscosity() {
                isochoric = self.relax(simd, group, at, point, isochoric);
            }
            if EFFECTS == ASK && self.law.reproject {
                isochoric = elastic.without_pressure(&k, isochoric);
            }
            let stress = elastic.first_stress(&state.gradient, &k, &isochoric, pressure);
            E::add_stress(&mut forces, point, &state, &stress);
            worst = worst.max(-k.true_j);
        }
        let out = &mut self.force[group * 3 * E::NODES * LANES..(group + 1) * 3 * E::NODES * LANES];
        E::store_forces(
            &u,
            &forces,
            #[inline(always)]
            |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
            #[inline(always)]
            |corner: usize, i: usize, force| T::store(force, &mut out[(3 * corner + i) * LANES + at..]),
        );
        worst * T::load(simd, &rest_shape[E::VOLUME_ROW * LANES + at..])
    }

    /// Mean of the pressures (Pa) at the nodes.
    #[inline(always)]
    fn mean_of_nodes<S: Simd>(&self, simd: S, elastic: &L::Of<T::Vector<S>>, group: usize, at: usize) -> T::Vector<S> {
        let nodes = &self.connectivity[group * E::NODES * LANES..(group + 1) * E::NODES * LANES];
        let mut sum = T::splat(simd, T::default());
        for corner in 0..E::NODES {
            let mut lanes = [T::default(); LANES];
            for lane in 0..T::width::<S>() {
                lanes[lane] = self.nodal_volume_change[nodes[corner * LANES + at + lane] as usize];
            }
            sum += elastic.pressure(T::load(simd, &lanes));
        }
        sum * sum.constant(1.0 / E::NODES as f64)
    }
}

/// θ̄ = Σ V_q θ_q / V of elements with several points.
#[inline(always)]
fn mean_volume_change<E: Element, T: SimdScalar, L: Elastic<T>, S: Simd>(
    simd: S,
    elastic: &L::Of<T::Vector<S>>,
    u: &E::Prepared<T::Vector<S>>,
    rest_shape: &[T],
    at: usize,
) -> T::Vector<S> {
    let mut change = T::splat(simd, T::default());
    let mut volume = change;
    for point in 0..E::POINTS {
        let state = E::at_point(
            u,
            point,
            #[inline(always)]
            |row: usize| T::load(simd, &rest_shape[row * LANES + at..]),
        );
        let k = elastic.kinematics(&state.gradient);
        change = state.volume.mul_add(elastic.volume_measure(&k), change);
        volume += state.volume;
    }
    change / volume
}
