//! Effects of a material that are not pointwise laws; those are in [`materials`](crate::materials).

use super::Clock;
use crate::materials::PronyTerm;
use crate::scene::schema::ViscousIntegrator;
use bevy_ecs::prelude::*;

/// Density at rest (kg/m³).
#[derive(Component, Clone, Copy, Debug)]
pub struct Density(pub f64);

/// Mass-proportional damping rate c of the force −c M v (1/s).
#[derive(Component, Clone, Copy, Debug)]
pub struct Damping(pub f64);

/// Viscosity of the isochoric stress.
#[derive(Component, Clone, Debug)]
pub struct Prony {
    /// Share α and time τ (s) of each term.
    pub terms: Vec<(f64, f64)>,
    /// How the history is carried on.
    pub integrator: ViscousIntegrator,
}

impl Prony {
    /// Coefficients of the recursion for the clock's step; in a static analysis, of what remains in the long term.
    pub fn coefficients(&self, clock: &Clock) -> Vec<PronyTerm<f64>> {
        let make = match self.integrator {
            _ if clock.relaxation.is_some() => |alpha, _, _| PronyTerm::long_term(alpha),
            ViscousIntegrator::Exact => PronyTerm::exact,
            ViscousIntegrator::BackwardEuler => PronyTerm::backward_euler,
        };
        self.terms.iter().map(|&(alpha, tau)| make(alpha, tau, clock.time_step)).collect()
    }
}
