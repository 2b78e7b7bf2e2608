//! Forces of all elements of a block, a register full at a time.

mod corners;
mod effects;
mod fetch;
mod patch_local;
mod stress;

use super::{BlockLaw, Cpu, NodeColumns};
use crate::components::{FamilyDirection, Patches};
use crate::elements::{Element, MOST_NODES, PressureFrom};
use crate::materials::{Elastic, ElasticLaw, FLATTEST, NeoHookean};
use crate::math::{LANES, Real, Scratch, SimdScalar};
pub(super) use corners::{corner_registers, group_vectors};
use fetch::{AHEAD, IN_CACHE};
use patch_local::{PatchLocal, part, parts};
use pulp::{Simd, WithSimd};
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};
use stress::{InRegisters, mean_volume_change, volume_ratio};

/// The columns a block's kernel reads and writes; layouts as in [`components`](crate::components).
pub struct BlockColumns<'a, 'n, T> {
    /// The body's displacements (m), from row [`first_row`](Self::first_row) on.
    pub displacement: &'a [T],
    /// The first of these rows: 0, or with [`interior`](Self::interior) the first that is not inside a patch.
    pub first_row: usize,
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
    /// Where they are summed; `None` in the scheme of two passes.
    pub patches: Option<&'a Patches>,
    /// Whether elements with J < 0 exert nothing.
    pub inverted_go: bool,
    /// The nodes inside each patch, where they move as soon as its forces are known.
    pub interior: Option<PatchInterior<'a, 'n, T>>,
}

/// The nodes inside patches, and what follows for them. Where a patch has an element with J < 0 they stay as they are.
pub struct PatchInterior<'a, 'n, T> {
    /// Of each patch, perhaps none.
    pub nodes: &'a mut [InsidePatch<'n, T>],
    /// What is done to them as soon as their internal forces are known.
    pub then: &'a (dyn Fn(&mut NodeColumns<'_, T>, &mut NodeColumns<'_, T>) + Sync),
    /// Whether somebody may look afterwards at forces on nodes that always move with their patch.
    pub observed: bool,
}

/// The nodes inside a patch.
pub struct InsidePatch<'n, T> {
    /// Those that always move with it.
    pub free: NodeColumns<'n, T>,
    /// The others ([`Patches::deferred`]), whose forces stay in their columns.
    pub deferred: NodeColumns<'n, T>,
}

/// Fills in the forces of a block and carries its viscous history on by one step. Returns the patches that have
/// elements with J < 0, ascending.
///
/// One kernel an element type for all laws and effects, which asks for them at each point.
pub fn run_block<E: Element, T: SimdScalar>(
    cpu: &Cpu,
    columns: BlockColumns<'_, '_, T>,
    law: &BlockLaw<T>,
    groups_a_patch: usize,
) -> Vec<usize> {
    BlockRun::<E, T>::new(cpu, columns, law, groups_a_patch).run::<_, GENERIC>(&law.elastic)
}

/// The same in f32, where speed counts, with a kernel of its own for what is asked for most: the neo-Hookean law with
/// each combination of fibres and viscosity, and three laws and users' own with neither; of kinds that are
/// [specialised](Element::SPECIALISED). What a material lacks is not even asked for.
pub fn run_block_fast<E: Element>(
    cpu: &Cpu,
    columns: BlockColumns<'_, '_, f32>,
    law: &BlockLaw<f32>,
    groups_a_patch: usize,
) -> Vec<usize> {
    let effects = kernel_effects::<E>(cpu, law);
    let block = BlockRun::<E, f32>::new(cpu, columns, law, groups_a_patch);
    // a constant, so that no code is made of what follows for the other kinds: of a function's result it would be
    if const { !is_specialised::<E>() } {
        return block.run::<_, GENERIC>(&law.elastic);
    }
    match &law.elastic {
        asked if effects.is_none() => block.run::<_, GENERIC>(asked),
        ElasticLaw::NeoHookean(elastic) => block.run_neo_hookean(elastic),
        ElasticLaw::StableNeoHookean(elastic) => block.run::<_, 0>(elastic),
        ElasticLaw::MooneyRivlin(elastic) => block.run::<_, 0>(elastic),
        ElasticLaw::Ogden(elastic) => block.run::<_, 0>(elastic),
        ElasticLaw::UserLaw(elastic) => block.run::<_, 0>(elastic),
        asked => block.run::<_, GENERIC>(asked),
    }
}

/// Whether an element type has kernels of its own. In the library's unit tests none has: they take most of the time of
/// compiling, and are tested from outside (`tests/kernels`, `tests/physics`).
pub(super) const fn is_specialised<E: Element>() -> bool {
    E::SPECIALISED && !cfg!(test)
}

/// Whether a law's kernel in f32 is one that has fibres, and one that has viscosity, and nothing that it need not have;
/// `None`: it is the one that asks for each effect, as always on machines without vector registers.
pub fn kernel_effects<E: Element>(cpu: &Cpu, law: &BlockLaw<f32>) -> Option<[bool; 2]> {
    let effects = [law.fibres.is_some(), !law.prony.is_empty()];
    let others = !law.exponential.is_empty() || !law.volumetric.is_empty() || law.reproject || law.copies.is_some();
    let is_there = match law.elastic {
        ElasticLaw::NeoHookean(_) => true,
        ElasticLaw::StableNeoHookean(_)
        | ElasticLaw::MooneyRivlin(_)
        | ElasticLaw::Ogden(_)
        | ElasticLaw::UserLaw(_) => effects == [false, false],
        _ => false,
    };
    (is_specialised::<E>() && cpu.has_vectors() && is_there && !others).then_some(effects)
}

/// Effects of a kernel, as bits.
const FIBRES: u8 = 1;
const VISCOSITY: u8 = 2;
/// The kernel asks the block's law which effects it has.
pub(super) const GENERIC: u8 = 4;
/// There is no such kernel for machines without vector registers.
pub(super) const VECTORS: u8 = 8;

/// A block's run through its kernel.
pub(super) struct BlockRun<'a, 'n, E, T: SimdScalar> {
    cpu: &'a Cpu,
    columns: BlockColumns<'a, 'n, T>,
    law: &'a BlockLaw<T>,
    groups_a_patch: usize,
    element: PhantomData<E>,
}

impl<E: Element> BlockRun<'_, '_, E, f32> {
    fn run_neo_hookean(self, elastic: &NeoHookean<f32>) -> Vec<usize> {
        match (self.law.fibres.is_some(), !self.law.prony.is_empty()) {
            (false, false) => self.run::<_, 0>(elastic),
            (true, false) => self.run::<_, FIBRES>(elastic),
            (false, true) => self.run::<_, VISCOSITY>(elastic),
            (true, true) => self.run::<_, { FIBRES | VISCOSITY }>(elastic),
        }
    }
}

impl<'a, 'n, E: Element, T: SimdScalar> BlockRun<'a, 'n, E, T> {
    pub fn new(cpu: &'a Cpu, columns: BlockColumns<'a, 'n, T>, law: &'a BlockLaw<T>, groups_a_patch: usize) -> Self {
        Self { cpu, columns, law, groups_a_patch, element: PhantomData }
    }

    /// With the kernel of a law with these effects.
    pub fn run<L: Elastic<T>, const EFFECTS: u8>(self, elastic: &L) -> Vec<usize> {
        let Self { cpu, columns, law, groups_a_patch, element } = self;
        let inverted = Mutex::new(Vec::new());
        let patch = groups_a_patch * LANES;
        let far = size_of_val(columns.rest_shape) > IN_CACHE;
        let memory_an_element = law.memory_numbers(E::POINTS);
        let varying = law.varying_families();
        let direction = law.fibres.as_ref().map(|(_, direction)| direction);
        let uniform = match direction {
            Some(FamilyDirection::Uniform(a)) => a.map(|number| [number; LANES]),
            _ => Default::default(),
        };
        let uniform = &uniform[..];
        // without viscosity there is no memory to hand out
        let mut memories = columns.memory.chunks_mut((patch * memory_an_element).max(1));
        let tasks = parts(columns.force, columns.patches, patch * 3 * E::NODES, patch * E::NODES);
        let (interior, then) = match columns.interior {
            Some(PatchInterior { nodes, then, observed }) => (nodes, Some((then, observed))),
            None => (&mut [][..], None),
        };
        let mut interior = interior.iter_mut();
        let tasks = tasks.enumerate().map(move |(index, (force, patch_local))| {
            let patch = PatchForces::<E, T, L, EFFECTS> {
                first_group: index * groups_a_patch,
                displacement: columns.displacement,
                first_row: columns.first_row,
                nodal_volume_change: columns.nodal_volume_change,
                connectivity: part(columns.connectivity, index, patch * E::NODES).as_chunks().0,
                rest_shape: part(columns.rest_shape, index, patch * E::ROWS).as_chunks().0,
                fibre_direction: columns.fibre_direction.map(|all| &all[index * patch * 3 * varying..]),
                varying,
                along: match (direction, columns.fibre_direction) {
                    (Some(FamilyDirection::Varying(place)), Some(all)) => {
                        (&all.as_chunks().0[3 * (index * groups_a_patch * varying + place)..], 3 * varying)
                    }
                    _ => (uniform, 0),
                },
                memory: memories.next().unwrap_or_default(),
                memory_rows: memory_an_element,
                force,
                patch_local,
                inverted_go: columns.inverted_go,
                far,
                elastic,
                law,
                element,
            };
            (patch, interior.next())
        });
        cpu.for_each(tasks, |(patch, interior)| {
            let index = patch.first_group / groups_a_patch;
            let run = |patch: PatchForces<'_, E, T, L, EFFECTS>, inside: Inside<'_, T>| {
                T::with_scratch(|scratch| E::run_patch(cpu, OfPatch { patch, inside, scratch }))
            };
            let is_inverted = match (interior, then) {
                (Some(InsidePatch { free, deferred }), Some((then, observed))) => free.with_forces(observed, |free| {
                    let u = [&*free.u, &*deferred.u];
                    let forces = [&mut *free.internal, &mut *deferred.internal];
                    let is_inverted = run(patch, Inside { u, forces });
                    if !is_inverted {
                        then(free, deferred);
                    }
                    is_inverted
                }),
                _ => run(patch, Inside { u: [&[]; 2], forces: [&mut [], &mut []] }),
            };
            if is_inverted {
                inverted.lock().unwrap_or_else(PoisonError::into_inner).push(index);
            }
        });
        let mut inverted = inverted.into_inner().unwrap_or_else(PoisonError::into_inner);
        inverted.sort_unstable();
        inverted
    }
}

struct PatchForces<'a, E, T: SimdScalar, L, const EFFECTS: u8> {
    /// Its first group, among those of the block.
    first_group: usize,
    displacement: &'a [T],
    first_row: usize,
    nodal_volume_change: &'a [T],
    connectivity: &'a [[u32; LANES]],
    rest_shape: &'a [[T; LANES]],
    fibre_direction: Option<&'a [T]>,
    varying: usize,
    /// Unit vectors of the fibres, and how many rows a group has of them: none where all groups have the same.
    along: (&'a [[T; LANES]], usize),
    memory: &'a mut [T],
    /// Rows that a group has of it.
    memory_rows: usize,
    force: &'a mut [T],
    patch_local: Option<PatchLocal<'a>>,
    inverted_go: bool,
    /// Whether what comes next has to be fetched from memory.
    far: bool,
    elastic: &'a L,
    law: &'a BlockLaw<T>,
    element: PhantomData<E>,
}

/// The nodes inside a patch that move with it, one sort after the other: displacements (m), and where forces on them go
/// (N).
struct Inside<'i, T> {
    u: [&'i [T]; 2],
    forces: [&'i mut [T]; 2],
}

/// A patch, the nodes inside it if they move with it, and where to compute it.
struct OfPatch<'a, 'i, 's, E, T: SimdScalar, L, const EFFECTS: u8> {
    patch: PatchForces<'a, E, T, L, EFFECTS>,
    inside: Inside<'i, T>,
    scratch: &'s mut Scratch<T>,
}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> WithSimd for OfPatch<'_, '_, '_, E, T, L, EFFECTS> {
    /// Whether there is an element with J < 0.
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Self { mut patch, inside, scratch } = self;
        patch.bring(inside.u, scratch);
        let mut law = patch.in_registers(simd);
        let mut worst = T::splat(simd, T::default());
        for group in 0..patch.connectivity.len() / E::NODES {
            if patch.far {
                patch.fetch(group + AHEAD);
            }
            if EFFECTS == FIBRES | VISCOSITY && (group == 0 || patch.along.1 > 0) {
                patch.square_along(simd, group, &mut law.along_squared);
            }
            let mut at = 0;
            while at < LANES {
                patch.take_parameters(simd, group, at, &mut law);
                worst = worst.max(patch.part_of_group(simd, &law, group, at, scratch));
                at += T::width::<S>();
            }
        }
        let mut lanes = [T::default(); LANES];
        T::store(worst, &mut lanes);
        let is_inverted = lanes.iter().any(|&v| v > T::default());
        patch.bring_back(if is_inverted { [&mut [], &mut []] } else { inside.forces }, scratch);
        is_inverted
    }
}

/// Runs [`OfPatch`] on the machine's registers, and is where kernels are compiled: the compiler keeps a method of a
/// trait with the type it is for, and takes what is in different modules to different cores. Else all of them were in
/// one piece, most of the time that compiling takes.
trait OnRegisters: Element {
    #[inline(never)]
    fn run_patch<T: SimdScalar, L: Elastic<T>, const EFFECTS: u8>(
        cpu: &Cpu,
        task: OfPatch<'_, '_, '_, Self, T, L, EFFECTS>,
    ) -> bool {
        // constants, so that no code is made of the other ways; `with_simd` above is what is run
        if const { EFFECTS == GENERIC } {
            return cpu.dispatch(task);
        }
        let is_inverted = if const { EFFECTS & GENERIC == 0 } {
            cpu.dispatch_vectors(task)
        } else {
            cpu.dispatch_narrow_vectors(task)
        };
        debug_assert!(is_inverted.is_some(), "a kernel for vector registers on a machine without");
        is_inverted.unwrap_or(true)
    }
}
impl<E: Element> OnRegisters for E {}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> PatchForces<'_, E, T, L, EFFECTS> {
    /// One register full of elements, from lane `at` on. Returns −J V, positive for inverted elements.
    #[inline(always)]
    fn part_of_group<S: Simd>(
        &mut self,
        simd: S,
        law: &InRegisters<L::Of<T::Vector<S>>, T, S>,
        group: usize,
        at: usize,
        scratch: &mut Scratch<T>,
    ) -> T::Vector<S> {
        let elastic = &law.elastic;
        let zero = T::splat(simd, T::default());
        let (displacements, theta) = self.at_corners(simd, elastic, group, at, scratch);
        let u = E::prepare(&displacements);
        let rest_shape = &self.rest_shape[group * E::ROWS..][..E::ROWS];
        let shared = match E::PRESSURE {
            PressureFrom::Point => zero,
            PressureFrom::MeanOverPoints => {
                elastic.pressure(mean_volume_change::<E, T, L, S>(simd, elastic, &u, rest_shape, at))
            }
            PressureFrom::Nodes => theta,
        };
        let mut forces = E::no_forces(zero);
        let least = zero.constant(if self.inverted_go { FLATTEST } else { 0.0 });
        let mut worst = zero.constant(f64::MIN);
        for point in 0..E::POINTS {
            let state = E::at_point(
                &u,
                point,
                #[inline(always)]
                |row: usize| T::load(simd, &rest_shape[row][at..]),
            );
            // of an elastic law without more `direct_stress` in its file; `generic_stress` where it is asked what there
            // is
            let (stress, j) = self.stress(simd, law, group, at, point, &state.gradient, shared);
            E::add_stress(&mut forces, point, &state, &stress);
            worst = worst.max(least - j);
        }
        for point in E::POINTS..E::CHECKED_POINTS {
            let j = volume_ratio::<E, T, S>(simd, &u, rest_shape, point, at);
            worst = worst.max(least - j);
        }
        let worst = worst * T::load(simd, &rest_shape[E::VOLUME_ROW][at..]);
        let mut out = [[zero; 3]; MOST_NODES];
        E::store_forces(
            &u,
            &forces,
            #[inline(always)]
            |row: usize| {
                let number = T::load(simd, &rest_shape[row][at..]);
                // forces are proportional to these
                let scales = row == E::FORCE_ROW.unwrap_or(E::VOLUME_ROW) || row == E::VOLUME_ROW;
                if scales && self.inverted_go { worst.if_positive(zero, number) } else { number }
            },
            #[inline(always)]
            |corner: usize, i: usize, force| out[corner][i] = force,
        );
        self.give(simd, group, at, scratch, &out);
        worst
    }
}
