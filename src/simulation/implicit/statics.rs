//! Equilibrium by Newton's iterations: those of an implicit step without inertia.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::Axes;
use super::device::{bring_state, send_state};
use super::formula::Formula;
use super::free_motions::{FreeMotion, free_motions};
use super::iterations::{Iterations, OfForces};
use super::newton::{Found, Lost, Newton, Settings, Workspace};
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::trial::Trial;
use crate::components::*;
use crate::error::Error;
use crate::scene::schema;
use crate::snapshot::Keeping;
use bevy_ecs::prelude::*;
use web_time::Instant;

/// Newton's iterations at most: slender bodies spend some twenty on the way.
const MOST_ITERATIONS: u32 = 60;
/// A share of loads along a motion that nothing holds, which is more than rounding.
const UNBALANCED: f64 = 1e-5;

/// What seeks equilibrium.
pub(in crate::simulation) struct Statics {
    axes: Axes,
    iterations: Iterations,
    springs: Springs,
}

/// What came of it.
pub(in crate::simulation) enum Attempt {
    /// Bodies are at rest.
    Found(Rest),
    /// All stands as it stood.
    NotFound,
    /// The same, and there is no equilibrium: what loads move and nothing holds, in words.
    NotHeld(Vec<String>),
}

/// An equilibrium.
pub(in crate::simulation) struct Rest {
    /// About how far nodes still have to go (m), a norm over all free axes, and how far they have gone.
    pub remaining: f64,
    pub displaced: f64,
    /// Newton's iterations that led there.
    pub iterations: u64,
    /// Whether bodies give way along some motion.
    pub unstable: bool,
}

impl Statics {
    /// What seeks the equilibrium of bodies to a residual of a tolerance.
    pub fn new(tolerance: f64, world: &mut World) -> Self {
        let axes = Axes::of(world);
        let settings = Settings { formula: Formula::of_rest(), newton: MOST_ITERATIONS, tolerance, budget: None };
        let iterations = Iterations::new(settings, schema::Preconditioner::TwoLevel, &axes, world);
        Self { axes, iterations, springs: Springs::default() }
    }

    /// What they took.
    pub fn report(&self) -> &ImplicitSteps {
        &self.iterations.report
    }

    /// What it is made of.
    pub fn in_use(&mut self, world: &mut World, passes: OfForces<'_>) -> SolverInUse {
        let Settings { newton, tolerance, .. } = self.iterations.settings;
        let first = format!(
            "rest by at most {newton} Newton iterations, to a residual of {tolerance}; pseudo-steps where they do not arrive"
        );
        self.iterations.in_use(first, &self.axes, world, passes)
    }

    /// The residual at which it counts as found.
    pub fn tolerance(&self) -> f64 {
        self.iterations.settings.tolerance
    }

    /// Seeks equilibrium under loads and motions in full, from where bodies are.
    pub fn attempt(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<Attempt, Error> {
        let started = Instant::now();
        bring_state(world)?;
        self.iterations.kept.keep(world);
        world.insert_resource(TrialForces { trying: true, ..TrialForces::default() });
        let before = self.iterations.report.newton_iterations;
        let found = self.find(world, passes, before);
        world.remove_resource::<TrialForces>();
        if !matches!(found, Ok(Attempt::Found(_))) {
            self.iterations.kept.put_back(world, |_| true);
        }
        send_state(world)?;
        self.iterations.end_step(started);
        match found {
            Ok(attempt) => Ok(attempt),
            Err(Lost::Because(_)) => Ok(Attempt::NotFound),
            Err(Lost::Error(error)) => Err(error),
        }
    }

    fn find(&mut self, world: &mut World, passes: &mut [ScheduledPass], before: u64) -> Result<Attempt, Lost> {
        let clock = *world.resource::<Clock>();
        let Some(relaxation) = clock.relaxation else { return Ok(Attempt::NotFound) };
        let Self { axes, iterations, springs } = self;
        let mut trial = Trial { world, passes, axes, springs, step: clock.step, count: 0, elsewhere: false };
        let Iterations { motion, space, .. } = &mut *iterations;
        axes.read(trial.world, motion);
        trial.world.resource_mut::<Signals>().approach(relaxation.end, [1.0, 1.0]);
        trial.boundary()?;
        super::step::held_axes(trial.world, axes, motion, &mut space.to_go);
        space.inertia.fill(0.0);
        space.constant.fill(0.0);
        space.w.copy_from_slice(&motion.u);
        let mut newton = iterations.newton(trial, 1.0);
        let motions = free_motions(newton.trial.world, newton.trial.axes, &newton.motion.free);
        let not_held = not_held(&motions, &mut newton)?;
        if !not_held.is_empty() {
            return Ok(Attempt::NotHeld(not_held));
        }
        let found = newton.solve();
        let rest = match &found {
            // along a motion that nothing holds there is no resistance either
            Ok(Found { solved: true, remaining, .. }) => Some((*remaining, motions.is_empty() && newton.gives_way()?)),
            _ => None,
        };
        let mut trial = newton.trial;
        iterations.count(trial.count);
        found?;
        let Some((remaining, unstable)) = rest else { return Ok(Attempt::NotFound) };
        let Workspace { w, net, step, acceleration, .. } = &mut iterations.space;
        trial.forces(w, None, net)?;
        step.fill(0.0);
        acceleration.fill(0.0);
        axes.arrive(trial.world, w, step, acceleration);
        Ok(Attempt::Found(Rest {
            remaining,
            displaced: iterations.sums.norm(w),
            iterations: iterations.report.newton_iterations - before,
            unstable,
        }))
    }
}

/// What loads move and nothing holds, in words, where all forces on nodes are known beforehand: those of systems of
/// one's own may hold them elsewhere.
fn not_held(motions: &[FreeMotion], newton: &mut Newton<'_, '_>) -> Result<Vec<String>, Error> {
    let are_known = newton.trial.world.get_resource::<Keeping>().is_none_or(|keeping| keeping.written.is_empty());
    if motions.is_empty() || !are_known {
        return Ok(Vec::new());
    }
    newton.forces_at_w()?;
    let loads = &newton.space.net;
    let is_unbalanced = |motion: &&FreeMotion| {
        let (sum, size) = motion.work(loads);
        sum.abs() > UNBALANCED * size
    };
    Ok(motions.iter().filter(is_unbalanced).map(|motion| motion.to_string()).collect())
}
