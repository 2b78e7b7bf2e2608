//! Parameters of a law that differ from copy to copy of a body.

use crate::components::{Clock, ElementMemory};
use crate::materials::{Elastic, ElasticLaw, ExponentialFibre, Fibres, PronyTerm};
use crate::math::{LANES, Scalar, SimdScalar, lane_place};
use bevy_ecs::prelude::*;
use pulp::Simd;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::sync::Arc;

/// What the stress of a material depends on, beside directions and what it remembers.
#[derive(Clone, Debug, PartialEq)]
pub struct LawParameters<T: Scalar> {
    /// Isotropic elasticity.
    pub elastic: ElasticLaw<T>,
    /// Fibres.
    pub fibres: Option<Fibres<T>>,
    /// Families of fibres that stiffen exponentially.
    pub exponential: Vec<ExponentialFibre<T>>,
    /// Terms of what is remembered of the isochoric stress, then of the pressure, for the run's time step, where these
    /// differ from copy to copy; empty where all copies have those of the block.
    pub terms: Vec<PronyTerm<T>>,
}

impl<T: Scalar> LawParameters<T> {
    /// All that may differ: numbers of the elastic law, then η of fibres (Pa), then k₁ (Pa) and k₂ of each family, then
    /// the four numbers of each term.
    pub fn numbers(&self) -> Vec<T> {
        let numbers = RefCell::new(Vec::new());
        let _ = self.elastic.map(|number| {
            numbers.borrow_mut().push(number);
            number
        });
        let mut numbers = numbers.into_inner();
        numbers.extend(self.fibres.iter().map(|fibres| fibres.eta));
        numbers.extend(self.exponential.iter().flat_map(|family| [family.k1, family.k2]));
        numbers.extend(self.terms.iter().flat_map(|term| [term.stress, term.memory, term.rate, term.aim]));
        numbers
    }

    /// Rounds to another precision.
    fn rounded<Q: Scalar>(&self) -> LawParameters<Q> {
        let round = |value: T| Q::from_f64(value.to_f64());
        LawParameters {
            elastic: self.elastic.map(round),
            fibres: self.fibres.map(|fibres| fibres.map(round)),
            exponential: self.exponential.iter().map(|family| family.map(round)).collect(),
            terms: self.terms.iter().map(|term| term.map(round)).collect(),
        }
    }
}

/// Numbers of a term.
const TERM_NUMBERS: usize = 4;

/// The parameters of each copy, and how elements have them.
#[derive(Clone, PartialEq)]
pub struct LawCopies<T: Scalar> {
    /// Of each copy.
    pub of_copy: Vec<LawParameters<T>>,
    /// The copy of each element, by its row.
    pub copies: Arc<[u32]>,
    /// [`LawParameters::numbers`] of each element, laid out as columns of [blocks](crate::components::Block) are.
    pub numbers: Vec<T>,
    /// How many numbers an element has.
    pub rows: usize,
    /// How many of them are of the law, the first ones; the others are of terms.
    pub of_law: usize,
}

impl<T: Scalar> LawCopies<T> {
    /// From the parameters of each copy and the copy of each element.
    pub fn new(of_copy: Vec<LawParameters<T>>, copies: Arc<[u32]>) -> Self {
        let of_each: Vec<Vec<T>> = of_copy.iter().map(LawParameters::numbers).collect();
        let rows = of_each.first().map_or(0, Vec::len);
        let padded = copies.len().div_ceil(LANES) * LANES;
        let mut numbers = vec![T::default(); padded * rows];
        for row in 0..padded {
            // elements that fill up the last group have the last element's
            let Some(&copy) = copies.get(row).or(copies.last()) else { break };
            for (k, &number) in of_each[copy as usize].iter().enumerate() {
                numbers[lane_place(row, rows, k)] = number;
            }
        }
        let of_law = rows - of_copy.first().map_or(0, |first| TERM_NUMBERS * first.terms.len());
        Self { of_copy, copies, numbers, rows, of_law }
    }

    /// The same laws with terms made of those that each copy has.
    pub fn with_terms(&self, mut terms: impl FnMut(usize, &[PronyTerm<T>]) -> Vec<PronyTerm<T>>) -> Self {
        let mut of_copy = self.of_copy.clone();
        of_copy.iter_mut().enumerate().for_each(|(copy, law)| law.terms = terms(copy, &law.terms));
        Self::new(of_copy, Arc::clone(&self.copies))
    }

    /// Whether terms differ from copy to copy.
    pub fn have_terms(&self) -> bool {
        self.rows > self.of_law
    }

    /// The parameters of an element.
    pub fn of_row(&self, row: usize) -> &LawParameters<T> {
        &self.of_copy[self.copies[row] as usize]
    }

    /// Rounds to another precision.
    pub fn rounded<Q: Scalar>(&self) -> LawCopies<Q> {
        LawCopies::new(self.of_copy.iter().map(LawParameters::rounded).collect(), Arc::clone(&self.copies))
    }
}

impl LawCopies<f64> {
    /// The same laws with the terms of what each copy remembers, for the clock's step.
    pub fn with_memories(&self, memories: &[ElementMemory], clock: &Clock) -> Self {
        self.with_terms(|copy, _| memories.get(copy).map_or(Vec::new(), |memory| memory.terms(clock).concat()))
    }
}

/// The numbers of elements follow from those of copies.
impl<T: Scalar> fmt::Debug for LawCopies<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LawCopies").field("of_copy", &self.of_copy).finish_non_exhaustive()
    }
}

/// Of a block whose material differs from copy to copy.
#[derive(Component, Clone, Debug)]
pub struct PerCopyLaw(pub Arc<LawCopies<f64>>);

impl<T: SimdScalar> LawCopies<T> {
    /// A number of a register full of elements, from lane `at` of a group on.
    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S, group: usize, at: usize, k: usize) -> T::Vector<S> {
        T::load(simd, &self.numbers[(group * self.rows + k) * LANES + at..])
    }

    /// The elastic law of a register full of elements, of the kind of `kind`.
    #[inline(always)]
    pub(super) fn elastic<S: Simd, L: Elastic<T>>(
        &self,
        simd: S,
        kind: &L,
        group: usize,
        at: usize,
    ) -> L::Of<T::Vector<S>> {
        let place = Cell::new(0);
        kind.map(
            #[inline(always)]
            |_| {
                let k = place.get();
                place.set(k + 1);
                self.load(simd, group, at, k)
            },
        )
    }

    /// η of a register full of elements that have so many families of other fibres.
    #[inline(always)]
    pub(super) fn eta<S: Simd>(&self, simd: S, group: usize, at: usize, families: usize) -> T::Vector<S> {
        self.load(simd, group, at, self.of_law - 2 * families - 1)
    }

    /// Gives the family of that number, of so many, the stiffness of a register full of elements.
    #[inline(always)]
    pub(super) fn stiffen<S: Simd>(
        &self,
        simd: S,
        (group, at): (usize, usize),
        (number, families): (usize, usize),
        family: &mut ExponentialFibre<T::Vector<S>>,
    ) {
        let first = self.of_law - 2 * (families - number);
        family.k1 = self.load(simd, group, at, first);
        family.k2 = self.load(simd, group, at, first + 1);
    }

    /// The term of that number of a register full of elements.
    #[inline(always)]
    pub(super) fn term<S: Simd>(&self, simd: S, group: usize, at: usize, number: usize) -> PronyTerm<T::Vector<S>> {
        let first = self.of_law + TERM_NUMBERS * number;
        PronyTerm {
            stress: self.load(simd, group, at, first),
            memory: self.load(simd, group, at, first + 1),
            rate: self.load(simd, group, at, first + 2),
            aim: self.load(simd, group, at, first + 3),
        }
    }
}
