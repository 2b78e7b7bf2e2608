//! Effects of a material that are not pointwise laws; those are in [`materials`](crate::materials).

use super::{Block, Clock};
use crate::materials::{ExponentialFibre, PronyTerm};
use crate::scene::schema::ViscousIntegrator;
use bevy_ecs::prelude::*;
use std::sync::Arc;

/// Density at rest (kg/m³).
#[derive(Component, Clone, Copy, Debug)]
pub struct Density(pub f64);

/// Mass-proportional damping rate c of the force −c M v (1/s).
#[derive(Component, Clone, Copy, Debug)]
pub struct Damping(pub f64);

/// Stiffness-proportional damping: time β of the stress β Ṡ (s).
#[derive(Component, Clone, Copy, Debug)]
pub struct StiffnessDamping(pub f64);

/// Density (kg/m³) and mass-proportional damping rate (1/s) of a block of which copies differ in them.
#[derive(Component, Clone, Debug)]
pub struct PerCopyInertia {
    /// The copy of each element, by its row.
    pub copies: Arc<[u32]>,
    /// Density and rate of each copy.
    pub of_copy: Vec<[f64; 2]>,
}

/// What elements of a block weigh by, and are damped by in proportion to it.
#[derive(Clone, Copy, Debug)]
pub struct ElementInertia<'a> {
    of_all: [f64; 2],
    own: Option<&'a PerCopyInertia>,
}

impl<'a> ElementInertia<'a> {
    /// Of a block.
    pub fn of(world: &'a World, block: Entity) -> Self {
        let material = world.get::<Block>(block).map(|block| block.material);
        let number = |number: Option<f64>| number.unwrap_or(0.0);
        let density = number(material.and_then(|material| world.get::<Density>(material)).map(|density| density.0));
        let rate = number(material.and_then(|material| world.get::<Damping>(material)).map(|damping| damping.0));
        Self { of_all: [density, rate], own: world.get(block) }
    }

    /// The same density (kg/m³) and rate (1/s) of all elements.
    pub fn of_all(density: f64, rate: f64) -> Self {
        Self { of_all: [density, rate], own: None }
    }

    /// Density (kg/m³) and damping rate (1/s) of an element.
    pub fn of_row(&self, row: usize) -> [f64; 2] {
        self.own.map_or(self.of_all, |own| own.of_copy[own.copies[row] as usize])
    }

    /// The same of a copy.
    pub fn of_copy(&self, copy: usize) -> [f64; 2] {
        self.own.map_or(self.of_all, |own| own.of_copy[copy])
    }
}

/// What the elements of each copy of a block remember, where copies differ in it.
#[derive(Component, Clone, Debug)]
pub struct PerCopyMemory(pub Vec<ElementMemory>);

/// What elements remember: viscosity, and damping proportional to stiffness, where there is any.
#[derive(Clone, Debug, Default)]
pub struct ElementMemory {
    /// Viscosity.
    pub prony: Option<Prony>,
    /// Damping.
    pub damping: Option<StiffnessDamping>,
}

impl ElementMemory {
    /// Of a material.
    pub fn of(world: &World, material: Entity) -> Self {
        Self { prony: world.get(material).cloned(), damping: world.get(material).copied() }
    }

    /// The terms of all that is remembered, for the clock's step: of the isochoric stress and of the pressure, those of
    /// viscosity first. A static analysis has no rates.
    pub fn terms(&self, clock: &Clock) -> [Vec<PronyTerm<f64>>; 2] {
        let mut terms = self.prony.as_ref().map_or([vec![], vec![]], |prony| prony.coefficients(clock));
        if let Some(damping) = self.damping.filter(|_| clock.relaxation.is_none()) {
            terms.iter_mut().for_each(|terms| terms.push(PronyTerm::damping(damping.0, clock.time_step)));
        }
        terms
    }
}

/// Families of fibres that stiffen exponentially.
#[derive(Component, Clone, Debug)]
pub struct ExponentialFibres(pub Vec<ExponentialFibre<f64>>);

/// Viscosity of the isochoric stress and of the pressure.
#[derive(Component, Clone, Debug)]
pub struct Prony {
    /// Share α and time τ (s) of each term of the isochoric stress.
    pub terms: Vec<(f64, f64)>,
    /// The same of the pressure.
    pub volumetric: Vec<(f64, f64)>,
    /// How the history is carried on.
    pub integrator: ViscousIntegrator,
    /// Whether the relaxed stress is freed of what is a pressure by now.
    pub reproject: bool,
}

impl Prony {
    /// Coefficients of the recursions for the clock's step, of the isochoric stress and of the pressure; in a static
    /// analysis of what remains in the long term.
    pub fn coefficients(&self, clock: &Clock) -> [Vec<PronyTerm<f64>>; 2] {
        let make = match self.integrator {
            _ if clock.relaxation.is_some() => |alpha, _, _| PronyTerm::long_term(alpha),
            ViscousIntegrator::Exact => PronyTerm::exact,
            ViscousIntegrator::BackwardEuler => PronyTerm::backward_euler,
        };
        [&self.terms, &self.volumetric]
            .map(|terms| terms.iter().map(|&(alpha, tau)| make(alpha, tau, clock.time_step)).collect())
    }
}
