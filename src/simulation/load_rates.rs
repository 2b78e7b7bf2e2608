//! What loads of the scene's own make of the stable step, as far as it can be seen at rest.
//!
//! A force f(u, v) on a node is that of a spring and a damper to the first order, K = −∂f/∂u and C = −∂f/∂v. Central
//! differences take v from the middle of the step before, so the recursion M (u⁺ − 2u + u⁻)/Δt² + C (u − u⁻)/Δt + K u =
//! 0 is stable while Δt² xᵀKx/4 + Δt xᵀCx/2 ≤ xᵀMx. With κ and γ the largest |K|/m and |C|/m of all nodes, whose norms
//! are those of Frobenius, and ω² the largest of the bodies, that is so up to
//!
//! Δt = 2/(γ/2 + √(γ²/4 + ω² + κ)).
//!
//! Slopes are differences at nodes at rest, at some times, with the curve at 1. What pushes only later, or harder
//! elsewhere, is not seen: where it may be stiff, the scene's own `step` or `safety` is smaller.

use crate::components::*;
use bevy_ecs::prelude::*;
use glam::DVec3;

/// Nodes of each body at which slopes are taken, evenly from all; the lightest node is one more.
const TRIED: usize = 1000;
/// Times at which they are taken, evenly from the start to the end.
const TIMES: usize = 5;
/// Length of the differences, as a share of the body's size.
const LENGTH: f64 = 1e-6;

/// The largest slopes of all loads of the scene's own.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LoadRates {
    /// κ (1/s²).
    square: f64,
    /// γ (1/s).
    rate: f64,
}

impl LoadRates {
    /// Of the loads of a world at rest, whose scene lasts so long (s).
    pub fn at_rest(duration: f64, world: &mut World) -> Self {
        let mut all = Self::default();
        let loads: Vec<(OwnLoad, Entity, OfSystem)> = world
            .query::<(&OwnLoad, &OfBody, &OfSystem)>()
            .iter(world)
            .map(|(load, body, system)| (load.clone(), body.0, *system))
            .collect();
        let systems = loads.iter().map(|(.., system)| system.0 + 1).max().unwrap_or(0);
        // loads of one system are on different bodies
        for number in 0..systems {
            let mut largest = Self::default();
            for (load, body, _) in loads.iter().filter(|(.., system)| system.0 == number) {
                let found = Self::of_load(load, *body, duration, world);
                largest = Self { square: largest.square.max(found.square), rate: largest.rate.max(found.rate) };
            }
            all = Self { square: all.square + largest.square, rate: all.rate + largest.rate };
        }
        all
    }

    fn of_load(load: &OwnLoad, body: Entity, duration: f64, world: &World) -> Self {
        let entity = world.entity(body);
        let (Some(RestPosition(rest)), Some(mass)) = (entity.get::<RestPosition>(), entity.get::<Mass>()) else {
            return Self::default();
        };
        let axes = entity.get::<ConstrainedAxes>();
        let moves = |row: &usize| mass.get(*row) > 0.0 && axes.is_none_or(|axes| axes[*row] & 7 != 7);
        let rows: Vec<usize> = match &load.rows {
            Some(rows) => rows.iter().map(|&row| row as usize).filter(moves).collect(),
            None => (0..rest.len()).filter(moves).collect(),
        };
        let (low, high) =
            rest.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)));
        let length = LENGTH * (high - low).max_element();
        let lightest = rows.iter().copied().min_by(|&a, &b| mass.get(a).total_cmp(&mass.get(b)));
        let every = rows.len().div_ceil(TRIED).max(1);
        let mut largest = Self::default();
        for row in rows.iter().copied().step_by(every).chain(lightest) {
            for number in 0..TIMES {
                let time = duration * number as f64 / (TIMES - 1) as f64;
                let node = NodeAtRest { rest_position: rest[row], mass: mass.get(row), time };
                let [stiffness, damping] = load.text.growth(&node, length).map(|slope| slope / node.mass);
                // what is no number is the guards' business
                largest = Self { square: largest.square.max(stiffness), rate: largest.rate.max(damping) };
            }
        }
        largest
    }

    /// The stable step (s) under the loads, from that of the bodies alone.
    pub fn with(&self, step: f64) -> f64 {
        if *self == Self::default() {
            return step;
        }
        let half = 0.5 * self.rate;
        2.0 / (half + (half * half + 4.0 / (step * step) + self.square).sqrt())
    }

    /// What they do to the stable step of the bodies (s), where it can be noticed.
    pub fn told(&self, step: f64) -> Option<String> {
        let with = self.with(step);
        (with < 0.999 * step).then(|| {
            format!(
                "loads of the scene's own make {with:.3e} s of {step:.3e} s: at rest they grow by up to {:.3e} N/(m kg) with \
                 displacements and {:.3e} N s/(m kg) with velocities",
                self.square, self.rate
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both roots of z² − (2 − κΔt² − γΔt) z + 1 − γΔt lie within the unit circle just below the step, and not above:
    /// there z = −1.
    #[test]
    fn a_spring_and_a_damper_are_stable_up_to_the_step_and_not_beyond() {
        for (square, rate, own) in
            [(4.0, 0.0, 0.0), (0.0, 3.0, 0.0), (9.0, 3.0, 25.0), (0.0, 0.0, 16.0), (1e-3, 1e3, 1.0)]
        {
            let loads = LoadRates { square, rate };
            let limit = loads.with(2.0 / f64::sqrt(own));
            let at_minus_one = |step: f64| 4.0 - (own + square) * step * step - 2.0 * rate * step;
            assert!(at_minus_one(0.999 * limit) > 0.0 && at_minus_one(1.001 * limit) < 0.0, "{loads:?}, {own}");
        }
        assert_eq!(LoadRates::default().with(0.3), 0.3);
    }
}
