//! Implicit steps: each solves for where forces balance at its end. The systems up to the loads say what the forces
//! are ([`trial`]), Newton's iterations find the place ([`newton`]), and what comes after in a step runs then.

mod axes;
mod bonds;
mod by_parts;
mod conjugate_gradients;
mod contact_work;
mod device;
mod differences;
mod equation;
mod forces_before;
mod formula;
mod free_motions;
mod grasped;
mod iterations;
mod kept;
mod minimal_residual;
mod newton;
mod place;
mod preconditioner;
mod report;
mod springs;
mod statics;
mod step;
mod step_control;
mod sums;
mod to_go;
mod trial;
mod unsupported;
mod vectors;
mod work;

#[doc(hidden)]
pub use by_parts::TwoLevelParts;
pub(super) use iterations::OfForces;
pub use newton::PathPoint;
pub use report::ImplicitSteps;
pub(super) use statics::{Attempt, Rest, Statics, warn_of_instability};
pub(super) use step::Implicit;
pub(super) use step_control::{Controlled, StepControl};
pub(super) use unsupported::{check, check_moves};

use super::Simulation;
use super::build::after_the_step;
use crate::components::*;
use crate::error::Error;
use crate::systems::Phase;
use device::{bring_removal, left};
use step::Taken;

impl Simulation {
    /// What implicit steps have taken so far, and in a static analysis Newton's iterations to equilibrium; `None` where
    /// there are neither.
    pub fn implicit_steps(&self) -> Option<ImplicitSteps> {
        let of_steps = self.solver.implicit().map(Implicit::report);
        of_steps.or_else(|| self.solver.relaxing()?.iterations())
    }

    /// Chooses the length of the step that begins now, where that is chosen by errors.
    pub(super) fn choose_step(&mut self) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        let Some(control) = self.solver.step_control() else { return Ok(()) };
        let corner = self.world.resource::<Signals>().corner_after(control.after(&clock));
        match control.choose(&clock, corner, self.scene.duration) {
            Some((length, last)) => self.change_step(length, last.unwrap_or(self.facts.steps)),
            None => Ok(()),
        }
    }

    /// Takes one implicit step.
    pub(super) fn implicit_step(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        while let Some(implicit) = self.solver.implicit_mut() {
            match implicit.step(&mut self.world, &mut self.entries)? {
                Taken::Taken => break,
                Taken::Back => self.choose_step()?,
            }
        }
        self.world.resource_mut::<Clock>().step = step + 1;
        let before = left(&mut self.world);
        if self.facts.on_gpu {
            return self.after_a_step_on_device(step, before);
        }
        self.run_after_the_step(step, |phase| phase < Phase::Observe)?;
        self.renew_forces(step, before)?;
        self.run_after_the_step(step, |phase| phase == Phase::Observe)?;
        self.keep_what_is_due()
    }

    /// Runs what comes after an implicit step, of some phases.
    fn run_after_the_step(&mut self, step: u64, which: impl Fn(Phase) -> bool) -> Result<(), Error> {
        for entry in self.entries.iter_mut().filter(|entry| after_the_step(entry.phase) && which(entry.phase)) {
            entry.run_on_host(step, &mut self.world)?;
        }
        Ok(())
    }

    /// Takes the forces at the end of an implicit step once more where elements have gone since, of so many, and where
    /// a thread or a tie has let go in it, with whose force it was found.
    pub(super) fn renew_forces(&mut self, step: u64, before: usize) -> Result<(), Error> {
        let went = bring_removal(&mut self.world, before)?;
        let Some(implicit) = self.solver.implicit_mut() else { return Ok(()) };
        if !went && !implicit.has_let_go(&self.world) {
            return Ok(());
        }
        implicit.renew_forces(&mut self.world, &mut self.entries, step)
    }
}
