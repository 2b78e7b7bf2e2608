//! Effects of a material that are not pointwise laws; those are in [`materials`](crate::materials).

use super::Clock;
use crate::materials::{ExponentialFibre, PronyTerm};
use crate::scene::schema::ViscousIntegrator;
use bevy_ecs::prelude::*;

/// Density at rest (kg/m³).
#[derive(Component, Clone, Copy, Debug)]
pub struct Density(pub f64);

/// Mass-proportional damping rate c of the force −c M v (1/s).
#[derive(Component, Clone, Copy, Debug)]
pub struct Damping(pub f64);

/// Stiffness-proportional damping: time β of the stress β Ṡ (s).
#[derive(Component, Clone, Copy, Debug)]
pub struct StiffnessDamping(pub f64);

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

/// The terms of all that a material remembers, for the clock's step: of the isochoric stress and of the pressure, those
/// of viscosity first. A static analysis has no rates.
pub fn memory_terms(world: &World, material: Entity, clock: &Clock) -> [Vec<PronyTerm<f64>>; 2] {
    let prony = world.get::<Prony>(material);
    let mut terms = prony.map_or([vec![], vec![]], |prony| prony.coefficients(clock));
    if let Some(damping) = world.get::<StiffnessDamping>(material).filter(|_| clock.relaxation.is_none()) {
        terms.iter_mut().for_each(|terms| terms.push(PronyTerm::damping(damping.0, clock.time_step)));
    }
    terms
}
