//! Solvers: what takes steps, one level above the systems. A solver keeps what it has to remember beside the columns,
//! says how many steps may be taken together before it checks them, and does what has to be done about what it sees.
//! What a simulation does with its solver is the same for all (`steps_to` in `run.rs`) but for the step itself:
//! explicit and pseudo-steps are those of the plan, implicit ones solve for their end.

use super::ScheduledPass;
use super::explain::SolverInUse;
use super::follow::Follower;
use super::implicit::{Implicit, OfForces, StepControl};
use super::relax::Relaxing;
use super::stable_step::Stability;
use super::step_change::add_memories_before;
use crate::components::{Clock, Precision};
use crate::error::Error;
use crate::scene::schema::{self, Scene};
use bevy_ecs::prelude::*;

/// How the steps of a scene are taken.
pub(super) enum Solver {
    /// Central differences in time. What follows the stable step, where there is one; lent out while it checks.
    Explicit(Option<Follower>),
    /// Pseudo-steps to equilibrium.
    Relaxation(Relaxing),
    /// Steps that solve for their end.
    Implicit(Box<Implicit>),
}

impl Solver {
    /// What the scene asks for, before anything is on a device.
    pub fn of(scene: &Scene, precision: Precision, world: &mut World) -> Self {
        if let Some(implicit) = Implicit::of(scene, world) {
            add_memories_before(world);
            return Self::Implicit(Box::new(implicit));
        }
        Relaxing::of(scene, precision, world).map_or(Self::Explicit(None), Self::Relaxation)
    }

    /// Begins with the first step, which is known now.
    pub fn begin(&mut self, scene: &Scene, stability: &Stability, initial_mass: f64, world: &mut World) {
        match self {
            Self::Explicit(follower) => *follower = Follower::new(scene, stability, initial_mass, world),
            Self::Relaxation(_) | Self::Implicit(_) => {}
        }
    }

    /// Lends what follows the stable step to who works with the whole simulation, and is to [give it
    /// back](Self::take_back).
    pub fn lend_follower(&mut self) -> Option<Follower> {
        match self {
            Self::Explicit(follower) => follower.take(),
            Self::Relaxation(_) | Self::Implicit(_) => None,
        }
    }

    /// Takes back what was lent.
    pub fn take_back(&mut self, lent: Follower) {
        match self {
            Self::Explicit(follower) => *follower = Some(lent),
            Self::Relaxation(_) | Self::Implicit(_) => debug_assert!(false, "a search for equilibrium lends nothing"),
        }
    }

    /// Whether the last states are left behind where the run breaks down: a search for equilibrium has none that tell.
    pub fn leaves_states(&self) -> bool {
        match self {
            Self::Explicit(_) | Self::Implicit(_) => true,
            Self::Relaxation(_) => false,
        }
    }

    /// What follows the stable step.
    pub fn follower(&self) -> Option<&Follower> {
        match self {
            Self::Explicit(follower) => follower.as_ref(),
            Self::Relaxation(_) | Self::Implicit(_) => None,
        }
    }

    /// The same, to be changed.
    pub fn follower_mut(&mut self) -> Option<&mut Follower> {
        match self {
            Self::Explicit(follower) => follower.as_mut(),
            Self::Relaxation(_) | Self::Implicit(_) => None,
        }
    }

    /// What takes implicit steps.
    pub fn implicit(&self) -> Option<&Implicit> {
        match self {
            Self::Implicit(implicit) => Some(implicit),
            Self::Explicit(_) | Self::Relaxation(_) => None,
        }
    }

    /// The same, to take them.
    pub fn implicit_mut(&mut self) -> Option<&mut Implicit> {
        match self {
            Self::Implicit(implicit) => Some(implicit),
            Self::Explicit(_) | Self::Relaxation(_) => None,
        }
    }

    /// What chooses the lengths of implicit steps by their errors.
    pub fn step_control(&mut self) -> Option<&mut StepControl> {
        self.implicit_mut()?.control_mut()
    }

    /// What it is made of, where it solves equations.
    pub fn in_use(&mut self, scene: &Scene, world: &mut World, passes: OfForces<'_>) -> Option<SolverInUse> {
        match (self, &scene.solver) {
            (Self::Implicit(implicit), schema::Solver::Implicit { scheme, .. }) => {
                Some(implicit.in_use(*scheme, world, passes))
            }
            (Self::Relaxation(relaxing), _) => relaxing.in_use(world, passes),
            _ => None,
        }
    }

    /// What looks for equilibrium.
    pub fn relaxing(&self) -> Option<&Relaxing> {
        match self {
            Self::Explicit(_) | Self::Implicit(_) => None,
            Self::Relaxation(relaxing) => Some(relaxing),
        }
    }

    /// The step before which Δt may become another; a search for equilibrium has one Δt.
    pub fn next_check(&self) -> u64 {
        match self {
            Self::Explicit(follower) => follower.as_ref().map_or(u64::MAX, |follower| follower.found.next),
            Self::Implicit(implicit) => implicit.control().map_or(u64::MAX, StepControl::next),
            Self::Relaxation(_) => u64::MAX,
        }
    }

    /// The step up to which steps may be taken together from `step` on, where others have something to do before that
    /// of `others`; that of `step` where there is only to check, `None` where nothing is left to do.
    pub fn until(&self, step: u64, others: impl FnOnce() -> u64) -> Option<u64> {
        match self {
            Self::Explicit(_) | Self::Implicit(_) => Some(self.next_check().min(others())),
            Self::Relaxation(relaxing) if relaxing.equilibrium.reached => None,
            // who asks again after it was given up is told again
            Self::Relaxation(relaxing) => Some(relaxing.next_check().max(step)),
        }
    }

    /// Looks at what steps have come to, where it is time; whether that was the last.
    pub fn check(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<bool, Error> {
        match self {
            Self::Relaxation(relaxing) if world.resource::<Clock>().step >= relaxing.next_check() => {
                relaxing.check(world, passes)?;
                Ok(relaxing.equilibrium.reached)
            }
            Self::Explicit(_) | Self::Relaxation(_) | Self::Implicit(_) => Ok(false),
        }
    }

    /// Whether no step is left after so many of those planned.
    pub fn is_done(&self, step: u64, planned: u64) -> bool {
        match self {
            Self::Explicit(_) | Self::Implicit(_) => step >= planned,
            Self::Relaxation(relaxing) => relaxing.equilibrium.reached,
        }
    }
}
