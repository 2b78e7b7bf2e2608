//! Rest sought again where springs of contact have become others.

use super::super::solver::Solver;
use super::{CHECK_STEPS, Relaxing, Simulation, State};
use crate::components::Clock;
use bevy_ecs::prelude::*;

impl Simulation {
    /// Seeks rest again from where it was found, with springs of contact of another step (s).
    pub(in crate::simulation) fn rest_again(&mut self, step: f64) {
        if let Solver::Relaxation(relaxing) = &mut self.solver {
            relaxing.go_on(step, &mut self.world);
        }
    }
}

impl Relaxing {
    fn go_on(&mut self, step_of_springs: f64, world: &mut World) {
        let mut clock = world.resource_mut::<Clock>();
        let mut times = 1.0;
        if let Some(springs) = &mut clock.springs {
            times = step_of_springs / springs.step;
            springs.step = step_of_springs;
        }
        // masses are those with which the springs before are stable
        let slower = times.min(1.0).powi(2);
        self.force_scale *= slower;
        if let Some(relaxation) = &mut clock.relaxation {
            relaxation.force_scale *= slower;
        }
        let step = clock.step;
        self.before = State::of(world);
        (self.best, self.quiet_since) = ((step, f64::INFINITY), None);
        self.equilibrium.reached = false;
        self.next_check = step + CHECK_STEPS;
        if let Some(newton) = &mut self.newton {
            newton.below = f64::INFINITY;
            self.next_check = step + 1;
        }
    }
}
