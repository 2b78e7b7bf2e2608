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

    /// Whether it is its elastic law and nothing else.
    pub fn is_elastic(&self) -> bool {
        let fibres = self.fibres.is_some() || !self.exponential.is_empty();
        !fibres && self.prony.is_empty() && self.volumetric.is_empty() && !self.reproject
    }

    /// The same law with a memory that its kernel leaves as it is, as long as stresses are finite.
    pub fn with_still_memory(&self) -> Self {
        let mut law = self.clone();
        law.prony.iter_mut().chain(&mut law.volumetric).for_each(|term| term.rate = T::default());
        law
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
