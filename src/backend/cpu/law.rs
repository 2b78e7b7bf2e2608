//! The material of a block, ready for its kernel.

use super::{LawCopies, OwnKernels};
use crate::components::FamilyDirection;
use crate::materials::{Elastic, ElasticLaw, ExponentialFibre, Fibres, PronyTerm};
use crate::math::Scalar;
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// All that a block's kernel needs of its material, in the kernel's precision. What the material does not have is
/// `None` or empty, and costs nothing.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct BlockLaw<T: Scalar> {
    /// Isotropic elasticity.
    pub elastic: ElasticLaw<T>,
    /// Fibres.
    pub fibres: Option<(Fibres<T>, FamilyDirection<T>)>,
    /// Families of fibres that stiffen exponentially.
    pub exponential: Vec<(ExponentialFibre<T>, FamilyDirection<T>)>,
    /// Viscosity of the isochoric stress, for the run's time step.
    pub prony: Vec<PronyTerm<T>>,
    /// Viscosity of the pressure, for the run's time step.
    pub volumetric: Vec<PronyTerm<T>>,
    /// Whether the relaxed isochoric stress is freed of what is a pressure by now.
    pub reproject: bool,
    /// Parameters that differ from copy to copy of the body, in place of those above: the first copy's.
    pub copies: Option<Arc<LawCopies<T>>>,
    /// Kernels in f32 that know the elastic law since they were compiled.
    pub own_kernels: Option<OwnKernels>,
}

impl<T: Scalar> BlockLaw<T> {
    /// Families of fibres whose direction differs from element to element.
    pub fn varying_families(&self) -> usize {
        let directions = self.fibres.iter().map(|(_, direction)| direction);
        let directions = directions.chain(self.exponential.iter().map(|(_, direction)| direction));
        directions.filter(|direction| matches!(direction, FamilyDirection::Varying(_))).count()
    }

    /// Numbers of viscous history that an element with so many integration points has.
    pub fn memory_numbers(&self, points: usize) -> usize {
        6 * self.prony.len() * points + self.volumetric.len()
    }

    /// The elastic law of an element.
    pub fn elastic_of(&self, row: usize) -> &ElasticLaw<T> {
        self.copies.as_ref().map_or(&self.elastic, |copies| &copies.of_row(row).elastic)
    }

    /// The fibres of an element.
    pub fn fibres_of(&self, row: usize) -> Option<(Fibres<T>, &FamilyDirection<T>)> {
        let (fibres, from) = self.fibres.as_ref()?;
        let of_copy = self.copies.as_ref().and_then(|copies| copies.of_row(row).fibres);
        Some((of_copy.unwrap_or(*fibres), from))
    }

    /// The families of fibres of an element that stiffen exponentially.
    pub fn families_of(&self, row: usize) -> impl Iterator<Item = (ExponentialFibre<T>, &FamilyDirection<T>)> {
        self.exponential.iter().enumerate().map(move |(number, (family, from))| {
            let of_copy = self.copies.as_ref().and_then(|copies| copies.of_row(row).exponential.get(number));
            (*of_copy.unwrap_or(family), from)
        })
    }

    /// The terms of an element: of the isochoric stress, and of the pressure.
    pub fn terms_of(&self, row: usize) -> [&[PronyTerm<T>]; 2] {
        match self.copies.as_ref().filter(|copies| copies.have_terms()) {
            Some(copies) => copies.of_row(row).terms.split_at(self.prony.len()).into(),
            None => [&self.prony, &self.volumetric],
        }
    }

    /// The same law with other terms, of the block and of each copy that has its own: each made of the number of its
    /// copy, none for the block's, its place among all terms and the term there.
    pub fn with_terms(&self, term: impl Fn(Option<usize>, usize, &PronyTerm<T>) -> PronyTerm<T>) -> Self {
        let mut law = self.clone();
        let own = law.prony.iter_mut().chain(&mut law.volumetric).enumerate();
        own.for_each(|(place, own)| *own = term(None, place, own));
        if let Some(copies) = law.copies.as_ref().filter(|copies| copies.have_terms()) {
            let of_copy = |copy: usize, terms: &[PronyTerm<T>]| {
                terms.iter().enumerate().map(|(place, own)| term(Some(copy), place, own)).collect()
            };
            law.copies = Some(Arc::new(copies.with_terms(of_copy)));
        }
        law
    }

    /// Whether it is its elastic law and nothing else.
    pub fn is_elastic(&self) -> bool {
        let fibres = self.fibres.is_some() || !self.exponential.is_empty();
        !fibres && self.prony.is_empty() && self.volumetric.is_empty() && !self.reproject
    }

    /// The same law with a memory that its kernel leaves as it is, as long as stresses are finite.
    pub fn with_still_memory(&self) -> Self {
        self.with_terms(|_, _, term| PronyTerm { rate: T::default(), ..*term })
    }

    /// Rounds to another precision.
    pub fn rounded<Q: Scalar>(&self) -> BlockLaw<Q> {
        let round = |value: T| Q::from_f64(value.to_f64());
        let direction = |from: &FamilyDirection<T>| match *from {
            FamilyDirection::Uniform(a) => FamilyDirection::Uniform(a.map(round)),
            FamilyDirection::Varying(place) => FamilyDirection::Varying(place),
        };
        let terms = |terms: &[PronyTerm<T>]| terms.iter().map(|term| term.map(round)).collect();
        BlockLaw {
            elastic: self.elastic.map(round),
            fibres: self.fibres.as_ref().map(|(fibres, from)| (fibres.map(round), direction(from))),
            exponential: self.exponential.iter().map(|(family, from)| (family.map(round), direction(from))).collect(),
            prony: terms(&self.prony),
            volumetric: terms(&self.volumetric),
            reproject: self.reproject,
            copies: self.copies.as_ref().map(|copies| Arc::new(copies.rounded())),
            own_kernels: self.own_kernels.clone(),
        }
    }
}
