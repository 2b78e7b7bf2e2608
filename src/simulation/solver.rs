//! Solvers: what takes steps, one level above the systems. A solver keeps what it has to remember beside the columns,
//! says how many steps may be taken together before it checks them, and does what has to be done about what it sees.

use super::Simulation;
use super::follow::Follower;
use super::relax::Relaxing;
use crate::error::Error;

/// How the steps of a scene are taken.
pub(super) enum Solver {
    /// Central differences in time. What follows the stable step, where there is one; lent out while it checks.
    Explicit(Option<Follower>),
    /// Pseudo-steps to equilibrium.
    Relaxation(Relaxing),
}

impl Solver {
    /// What follows the stable step.
    pub fn follower(&self) -> Option<&Follower> {
        match self {
            Self::Explicit(follower) => follower.as_ref(),
            Self::Relaxation(_) => None,
        }
    }

    /// The same, to be changed.
    pub fn follower_mut(&mut self) -> Option<&mut Follower> {
        match self {
            Self::Explicit(follower) => follower.as_mut(),
            Self::Relaxation(_) => None,
        }
    }

    /// What looks for equilibrium.
    pub fn relaxing(&self) -> Option<&Relaxing> {
        match self {
            Self::Explicit(_) => None,
            Self::Relaxation(relaxing) => Some(relaxing),
        }
    }

    /// The step before which Δt may become another; a search for equilibrium has one Δt.
    pub fn next_check(&self) -> u64 {
        match self {
            Self::Explicit(follower) => follower.as_ref().map_or(u64::MAX, |follower| follower.found.next),
            Self::Relaxation(_) => u64::MAX,
        }
    }

    /// Whether no step is left after so many of those planned.
    pub fn is_done(&self, step: u64, planned: u64) -> bool {
        match self {
            Self::Explicit(_) => step >= planned,
            Self::Relaxation(relaxing) => relaxing.equilibrium.reached,
        }
    }
}

impl Simulation {
    /// What comes before a step, in an order that does not depend on how the program asks for steps: the state is kept,
    /// inputs and what hands do are taken up, and then the stable step is checked. A second time before the same step
    /// it does nothing.
    fn begin_step(&mut self) -> Result<(), Error> {
        self.before_the_check()?;
        self.follow()
    }

    /// All of it but the check.
    pub(super) fn before_the_check(&mut self) -> Result<(), Error> {
        self.wait_for_life();
        self.keep_history_if_due()?;
        self.take_up_inputs()?;
        self.begin_batches()
    }

    /// Takes steps up to `target`, or to equilibrium.
    pub(super) fn steps_to(&mut self, target: u64) -> Result<(), Error> {
        while self.step_count() < target {
            self.begin_step()?;
            match &self.solver {
                Solver::Explicit(_) => {
                    let check = self.solver.next_check().min(self.next_change());
                    let next = check.min(self.next_kept().max(self.step_count() + 1));
                    let next = next.min(self.ports.next_end()).min(self.next_tick());
                    self.some_steps(target.min(next))?;
                    self.end_batches()?;
                }
                Solver::Relaxation(relaxing) if relaxing.equilibrium.reached => return Ok(()),
                Solver::Relaxation(relaxing) => {
                    let next = relaxing.next_check();
                    // who asks again after it was given up is told again
                    if self.step_count() < next {
                        self.some_steps(target.min(next))?;
                    }
                    if self.step_count() >= next {
                        self.check_equilibrium()?;
                    }
                }
            }
        }
        Ok(())
    }
}
