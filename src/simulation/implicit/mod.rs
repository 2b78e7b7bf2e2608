//! Implicit steps: each solves for where forces balance at its end. The systems up to the loads say what the forces
//! are ([`trial`]), Newton's iterations find the place ([`newton`]), and what comes after in a step runs then.

mod axes;
mod conjugate_gradients;
mod device;
mod differences;
mod equation;
mod formula;
mod free_motions;
mod grasped;
mod iterations;
mod kept;
mod minimal_residual;
mod newton;
mod preconditioner;
mod report;
mod springs;
mod statics;
mod step;
mod sums;
mod trial;
mod unsupported;
mod work;

pub(super) use iterations::OfForces;
pub use newton::PathPoint;
pub use report::ImplicitSteps;
pub(super) use statics::{Attempt, Rest, Statics};
pub(super) use step::Implicit;
pub(super) use unsupported::{check, check_moves};

use super::Simulation;
use super::build::after_the_step;
use crate::components::*;
use crate::error::Error;

impl Simulation {
    /// What implicit steps have taken so far, and in a static analysis Newton's iterations to equilibrium; `None` where
    /// there are neither.
    pub fn implicit_steps(&self) -> Option<&ImplicitSteps> {
        let of_steps = self.solver.implicit().map(Implicit::report);
        of_steps.or_else(|| self.solver.relaxing()?.iterations())
    }

    /// Takes one implicit step.
    pub(super) fn implicit_step(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        let Some(implicit) = self.solver.implicit_mut() else { return Ok(()) };
        implicit.step(&mut self.world, &mut self.entries)?;
        self.world.resource_mut::<Clock>().step = step + 1;
        if self.facts.on_gpu {
            return self.after_a_step_on_device(step);
        }
        for entry in self.entries.iter_mut().filter(|entry| after_the_step(entry.phase)) {
            entry.run_on_host(step, &mut self.world)?;
        }
        self.keep_what_is_due()
    }
}
