//! What a material has on top of its elastic law: fibres and viscosity.

use super::{GENERIC, PatchForces};
use crate::backend::cpu::BlockLaw;
use crate::components::FamilyDirection;
use crate::elements::Element;
use crate::materials::{Elastic, ExponentialFibre, Kinematics, PronyTerm};
use crate::math::{LANES, Real, SimdScalar, Sym3};
use pulp::{Simd, WithSimd};

impl<E: Element, T: SimdScalar, L: Elastic<T>, const EFFECTS: u8> PatchForces<'_, E, T, L, EFFECTS> {
    /// Unit vectors of the fibres.
    #[inline(always)]
    pub(super) fn along<S: Simd>(&self, simd: S, group: usize, at: usize) -> [T::Vector<S>; 3] {
        let (vectors, rows_a_group) = self.along;
        let Some([x, y, z]) = vectors[group * rows_a_group..].first_chunk() else {
            return [T::splat(simd, T::default()); 3];
        };
        [T::load(simd, &x[at..]), T::load(simd, &y[at..]), T::load(simd, &z[at..])]
    }

    /// a⊗a of a group's fibres.
    #[inline(always)]
    pub(super) fn square_along<S: Simd>(&self, simd: S, group: usize, rows: &mut [[T; LANES]; 6]) {
        let mut at = 0;
        while at < LANES {
            let square = Sym3::square_of(self.along(simd, group, at));
            for i in 0..6 {
                T::store(square.0[i], &mut rows[i][at..]);
            }
            at += T::width::<S>();
        }
    }

    /// Of all families that stiffen exponentially.
    #[inline(always)]
    pub(super) fn exponential_stress<S: Simd>(
        &self,
        simd: S,
        group: usize,
        at: usize,
        k: &Kinematics<T::Vector<S>>,
    ) -> Sym3<T::Vector<S>> {
        let mut stress = Sym3([T::splat(simd, T::default()); 6]);
        let families = self.law.exponential.len();
        for (number, (family, direction)) in self.law.exponential.iter().enumerate() {
            let mut family = family.map(
                #[inline(always)]
                |number: T| T::splat(simd, number),
            );
            if let Some(copies) = &self.law.copies {
                copies.stiffen(simd, (self.first_group + group, at), (number, families), &mut family);
            }
            let direction = self.direction(simd, group, at, direction);
            stress = stress.plus(&simd.vectorize(Exponential { family: &family, k, direction }));
        }
        stress
    }

    /// Unit vectors of a family.
    #[inline(always)]
    fn direction<S: Simd>(
        &self,
        simd: S,
        group: usize,
        at: usize,
        direction: &FamilyDirection<T>,
    ) -> [T::Vector<S>; 3] {
        let mut unit = [T::splat(simd, T::default()); 3];
        for i in 0..3 {
            unit[i] = match (direction, self.fibre_direction) {
                (FamilyDirection::Uniform(a), _) => T::splat(simd, a[i]),
                (FamilyDirection::Varying(place), Some(all)) => {
                    T::load(simd, &all[((group * self.varying + place) * 3 + i) * LANES + at..])
                }
                (FamilyDirection::Varying(_), None) => unit[i],
            };
        }
        unit
    }

    /// p − Υ; the memory is carried on, at the last of the points, which all have the same pressure.
    #[inline(always)]
    pub(super) fn relax_pressure<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        at: usize,
        point: usize,
        pressure: T::Vector<S>,
    ) -> T::Vector<S> {
        let mut rest = pressure;
        for (number, term) in self.law.volumetric.iter().enumerate() {
            let place = (self.first_group + group, at, self.law.prony.len() + number);
            let term = term_of::<T, S, EFFECTS>(simd, self.law, place, term);
            let first = group * self.law.memory_numbers(E::POINTS) + 6 * self.law.prony.len() * E::POINTS;
            let place = (first + number) * LANES + at;
            let memory = T::load(simd, &self.memory[place..]);
            rest -= term.relaxed_component(pressure, memory);
            if point + 1 == E::POINTS {
                T::store(term.component_carried_on(pressure, memory), &mut self.memory[place..]);
            }
        }
        rest
    }

    /// `other` + S_iso − Υ; the memory is carried on.
    #[inline(always)]
    pub(super) fn relax<S: Simd>(
        &mut self,
        simd: S,
        group: usize,
        at: usize,
        point: usize,
        isochoric: &Sym3<T::Vector<S>>,
        other: Sym3<T::Vector<S>>,
    ) -> Sym3<T::Vector<S>> {
        let (law, of_block) = (self.law, self.first_group + group);
        let terms = &law.prony[..];
        let first = group * self.memory_rows + 6 * point * terms.len();
        let rows = &mut self.memory.as_chunks_mut::<LANES>().0[first..];
        let mut rest = other;
        let mut share = T::splat(simd, T::default()).constant(1.0);
        match terms {
            // most have one: no loop, more stays in registers
            [term] => {
                let term = term_of::<T, S, EFFECTS>(simd, law, (of_block, at, 0), term);
                relax_by(simd, &term, at, isochoric, &mut rest, &mut share, rows);
            }
            _ => {
                for (number, (term, rows)) in terms.iter().zip(rows.chunks_exact_mut(6)).enumerate() {
                    let term = term_of::<T, S, EFFECTS>(simd, law, (of_block, at, number), term);
                    relax_by(simd, &term, at, isochoric, &mut rest, &mut share, rows);
                }
            }
        }
        rest.plus_scaled(share, isochoric)
    }
}

/// A term of a register full of elements, by the group in the block, the lane, and the place among all terms: the
/// block's, or that of each element's copy.
#[inline(always)]
fn term_of<T: SimdScalar, S: Simd, const EFFECTS: u8>(
    simd: S,
    law: &BlockLaw<T>,
    (group, at, number): (usize, usize, usize),
    of_all: &PronyTerm<T>,
) -> PronyTerm<T::Vector<S>> {
    // a constant, so that only the kernel that asks for everything asks for this
    if const { EFFECTS & GENERIC != 0 }
        && let Some(copies) = &law.copies
        && copies.have_terms()
    {
        return copies.term(simd, group, at, number);
    }
    of_all.map(
        #[inline(always)]
        |number: T| T::splat(simd, number),
    )
}

/// Takes Υ of a term away, its part of the present stress from the `share` that is left of it, and carries its memory
/// on.
#[inline(always)]
fn relax_by<T: SimdScalar, S: Simd>(
    simd: S,
    term: &PronyTerm<T::Vector<S>>,
    at: usize,
    isochoric: &Sym3<T::Vector<S>>,
    rest: &mut Sym3<T::Vector<S>>,
    share: &mut T::Vector<S>,
    rows: &mut [[T; LANES]],
) {
    *share -= term.stress;
    let Some(rows) = rows.first_chunk_mut::<6>() else { return };
    for i in 0..6 {
        let row = &mut rows[i][at..];
        let memory = T::load(simd, row);
        rest.0[i] = (-term.memory).mul_add(memory, rest.0[i]);
        T::store(term.component_carried_on(isochoric.0[i], memory), row);
    }
}

/// S of a family in a function of its own, for the same reason as `Isochoric` in `stress`.
struct Exponential<'a, R> {
    family: &'a ExponentialFibre<R>,
    k: &'a Kinematics<R>,
    direction: [R; 3],
}

impl<R: Real> WithSimd for Exponential<'_, R> {
    type Output = Sym3<R>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Sym3<R> {
        self.family.isochoric(self.k, self.direction)
    }
}
