//! What is patch-local: its nodes' displacements, and the sums of its forces.

use super::PatchForces;
use crate::components::Patches;
use crate::elements::{Element, MOST_NODES, PressureFrom};
use crate::materials::Elastic;
use crate::math::{LANES, Real, Scratch, SimdScalar};
use pulp::Simd;

// corners are written out below: an element that has more needs more there
const _: () = assert!(MOST_NODES == 10);

/// A vector at each corner.
pub(super) type AtNodes<R> = [[R; 3]; MOST_NODES];

/// The element forces (N) of each patch, and its nodes where it sums them: rows of the body, and those of its corners.
pub(super) fn parts<'a, T>(
    mut force: &'a mut [T],
    patches: Option<&'a Patches>,
    forces_a_patch: usize,
    corners_a_patch: usize,
) -> impl Iterator<Item = (&'a mut [T], Option<PatchLocal<'a>>)> {
    let count = patches.map_or(force.len().div_ceil(forces_a_patch), Patches::count);
    (0..count).map(move |index| {
        let patch_local = patches.map(|patches| PatchLocal {
            nodes: &patches.nodes[patches.starts[index] as usize..patches.starts[index + 1] as usize],
            corners: part(&patches.connectivity, index, corners_a_patch).as_chunks().0,
        });
        let forces = patch_local.as_ref().map_or(forces_a_patch, |patch_local| 3 * patch_local.nodes.len());
        let all = std::mem::take(&mut force);
        let (own, others) = all.split_at_mut(forces.min(all.len()));
        force = others;
        (own, patch_local)
    })
}

/// A patch's part of a column, where each patch but the last has as much.
pub(super) fn part<X>(column: &[X], index: usize, length: usize) -> &[X] {
    &column[index * length..column.len().min((index + 1) * length)]
}

/// Rows of a group's corners, of that length so that no bound has to be checked further on.
#[inline(always)]
fn of_group<E: Element, X>(rows: &[X], group: usize) -> &[X] {
    &rows[group * E::NODES..][..E::NODES]
}

/// The nodes of a patch, as its kernel reads them.
pub(super) struct PatchLocal<'a> {
    /// Rows of the body.
    pub(super) nodes: &'a [u32],
    /// Which of them each corner is.
    pub(super) corners: &'a [[u16; LANES]],
}

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> PatchForces<'_, E, T, L, EFFECTS> {
    /// Displacements of the patch's nodes, and θ where elements take their pressure from it, to hand; no forces yet.
    /// Those `inside` that move with the patch bring theirs along (m).
    #[inline(always)]
    pub(super) fn bring(&self, inside: [&[T]; 2], scratch: &mut Scratch<T>) {
        let Some(patch_local) = &self.patch_local else { return };
        let theta = |node: u32| match E::PRESSURE {
            PressureFrom::Nodes => self.nodal_volume_change[node as usize],
            _ => T::default(),
        };
        let mut rows = 0;
        for u in inside {
            let own = scratch.read[rows..].iter_mut().zip(&patch_local.nodes[rows..]);
            for ((row, &node), u) in own.zip(u.chunks_exact(3)) {
                *row = [u[0], u[1], u[2], theta(node)];
            }
            rows += u.len() / 3;
        }
        for (row, &node) in scratch.read[rows..].iter_mut().zip(&patch_local.nodes[rows..]) {
            let first = 3 * (node as usize - self.first_row);
            let u = &self.displacement[first..first + 3];
            *row = [u[0], u[1], u[2], theta(node)];
        }
        scratch.sums[..patch_local.nodes.len()].fill([T::default(); 4]);
    }

    /// The patch-local sums of forces: to the nodes `inside` that move with the patch, all others to where patches are
    /// gathered.
    #[inline(always)]
    pub(super) fn bring_back(&mut self, inside: [&mut [T]; 2], scratch: &Scratch<T>) {
        let mut rows = 0;
        for forces in inside {
            for (force, sum) in forces.chunks_exact_mut(3).zip(&scratch.sums[rows..]) {
                force.copy_from_slice(&sum[..3]);
            }
            rows += forces.len() / 3;
        }
        if self.patch_local.is_some() {
            for (force, sum) in self.force[3 * rows..].chunks_exact_mut(3).zip(&scratch.sums[rows..]) {
                force.copy_from_slice(&sum[..3]);
            }
        }
    }

    /// Displacements of the corners (m), and the mean of the pressures (Pa) there for elements that take it.
    #[inline(always)]
    pub(super) fn at_corners<S: Simd>(
        &self,
        simd: S,
        elastic: &L::Of<T::Vector<S>>,
        group: usize,
        at: usize,
        scratch: &Scratch<T>,
    ) -> (AtNodes<T::Vector<S>>, T::Vector<S>) {
        let zero = T::splat(simd, T::default());
        let mut pressure = zero;
        // written out, not a loop: what a loop fills compilers leave in memory
        macro_rules! corner {
            ($corner:literal) => {
                if $corner < E::NODES {
                    let (u, theta) = self.at_corner(simd, group, $corner, at, scratch);
                    if E::PRESSURE == PressureFrom::Nodes {
                        pressure += elastic.pressure(theta);
                    }
                    u
                } else {
                    [zero; 3]
                }
            };
        }
        let u = [
            corner!(0),
            corner!(1),
            corner!(2),
            corner!(3),
            corner!(4),
            corner!(5),
            corner!(6),
            corner!(7),
            corner!(8),
            corner!(9),
        ];
        (u, pressure * zero.constant(1.0 / E::NODES as f64))
    }

    /// Displacements (m) and θ of a corner of a register full of elements.
    #[inline(always)]
    fn at_corner<S: Simd>(
        &self,
        simd: S,
        group: usize,
        corner: usize,
        at: usize,
        scratch: &Scratch<T>,
    ) -> ([T::Vector<S>; 3], T::Vector<S>) {
        match &self.patch_local {
            Some(patch_local) => {
                let [x, y, z, theta] =
                    T::load_rows(simd, &scratch.read, &of_group::<E, _>(patch_local.corners, group)[corner][at..]);
                ([x, y, z], theta)
            }
            None => self.read_columns(simd, &of_group::<E, _>(self.connectivity, group)[corner][at..]),
        }
    }

    /// Displacements (m) and θ of a register full of nodes.
    #[inline(always)]
    fn read_columns<S: Simd>(&self, simd: S, nodes: &[u32]) -> ([T::Vector<S>; 3], T::Vector<S>) {
        let mut lanes = [[T::default(); LANES]; 4];
        for lane in 0..T::width::<S>() {
            let node = nodes[lane] as usize;
            let u = &self.displacement[3 * node..3 * node + 3];
            for i in 0..3 {
                lanes[i][lane] = u[i];
            }
            if E::PRESSURE == PressureFrom::Nodes {
                lanes[3][lane] = self.nodal_volume_change[node];
            }
        }
        let [x, y, z, theta] = &lanes;
        ([T::load(simd, x), T::load(simd, y), T::load(simd, z)], T::load(simd, theta))
    }

    /// Forces on corners (N) to where they are summed.
    #[inline(always)]
    pub(super) fn give<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        at: usize,
        scratch: &mut Scratch<T>,
        forces: &AtNodes<T::Vector<S>>,
    ) {
        macro_rules! give {
            ($($corner:literal)*) => {
                $(if $corner < E::NODES {
                    self.give_corner(simd, group, $corner, at, scratch, forces[$corner]);
                })*
            };
        }
        // node 0 last: its force is what balances the others'
        give!(1 2 3 4 5 6 7 8 9 0);
    }

    /// The force on a corner of a register full of elements.
    #[inline(always)]
    fn give_corner<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        corner: usize,
        at: usize,
        scratch: &mut Scratch<T>,
        force: [T::Vector<S>; 3],
    ) {
        match &self.patch_local {
            Some(patch_local) => {
                let rows = &of_group::<E, _>(patch_local.corners, group)[corner][at..];
                T::add_to_rows(simd, &mut scratch.sums, rows, force);
            }
            None => {
                let first = 3 * (group * E::NODES + corner);
                for i in 0..3 {
                    T::store(force[i], &mut self.force.as_chunks_mut::<LANES>().0[first + i][at..]);
                }
            }
        }
    }
}
