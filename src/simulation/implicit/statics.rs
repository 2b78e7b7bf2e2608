//! Equilibrium by Newton's iterations: those of an implicit step without inertia.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::formula::Formula;
use super::free_motions::{FreeMotion, free_motions};
use super::in_use::Parts;
use super::kept::Kept;
use super::newton::{Found, Lost, Newton, Settings, Workspace};
use super::preconditioner::{Preconditioner, of_name};
use super::report::ImplicitSteps;
use super::sums::Sums;
use super::trial::Trial;
use crate::backend::cpu::Cpu;
use crate::components::*;
use crate::error::Error;
use crate::scene::schema;
use crate::snapshot::Keeping;
use crate::systems::Phase;
use bevy_ecs::prelude::*;
use std::time::Instant;

/// Newton's iterations at most: slender bodies spend some twenty on the way.
const MOST_ITERATIONS: u32 = 60;
/// A share of loads along a motion that nothing holds, which is more than rounding.
const UNBALANCED: f64 = 1e-5;

/// What seeks equilibrium.
pub(in crate::simulation) struct Statics {
    settings: Settings,
    preconditioner: Box<dyn Preconditioner>,
    axes: Axes,
    motion: Motion,
    space: Workspace,
    kept: Kept,
    sums: Sums,
    pub report: ImplicitSteps,
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
        let mut space = Workspace::default();
        space.resize(axes.len());
        Self {
            settings: Settings { formula: Formula::of_rest(), newton: MOST_ITERATIONS, tolerance, budget: None },
            preconditioner: of_name(schema::Preconditioner::TwoLevel),
            axes,
            motion: Motion::default(),
            space,
            kept: Kept::default(),
            sums: Sums::on(world.resource::<Cpu>()),
            report: ImplicitSteps::default(),
        }
    }

    /// What it is made of.
    pub fn in_use(&mut self, world: &mut World, passes: &[ScheduledPass]) -> SolverInUse {
        let Settings { newton, tolerance, .. } = self.settings;
        let Self { settings, axes, motion, space, preconditioner, kept, .. } = self;
        let parts = Parts { settings, axes, motion, space, preconditioner: &mut **preconditioner, kept };
        let first = format!(
            "rest by at most {newton} Newton iterations, to a residual of {tolerance}; pseudo-steps where they do not arrive"
        );
        parts.in_use(first, world, passes)
    }

    /// The residual at which it counts as found.
    pub fn tolerance(&self) -> f64 {
        self.settings.tolerance
    }

    /// Seeks equilibrium under loads and motions in full, from where bodies are.
    pub fn attempt(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<Attempt, Error> {
        let started = Instant::now();
        self.kept.keep(world);
        world.insert_resource(TrialForces { trying: true, ..TrialForces::default() });
        let before = self.report.newton_iterations;
        let found = self.find(world, passes, before);
        world.remove_resource::<TrialForces>();
        if !matches!(found, Ok(Attempt::Found(_))) {
            self.kept.put_back(world, |_| true);
        }
        self.report.steps += 1;
        self.report.preconditioner_bytes = self.preconditioner.holds().1.iter().map(|(_, bytes)| bytes).sum();
        self.report.longest_step = self.report.longest_step.max(started.elapsed().as_secs_f64());
        match found {
            Ok(attempt) => Ok(attempt),
            Err(Lost::Because(_)) => Ok(Attempt::NotFound),
            Err(Lost::Error(error)) => Err(error),
        }
    }

    fn find(&mut self, world: &mut World, passes: &mut [ScheduledPass], before: u64) -> Result<Attempt, Lost> {
        let clock = *world.resource::<Clock>();
        let Some(relaxation) = clock.relaxation else { return Ok(Attempt::NotFound) };
        let mut trial = Trial { world, passes, axes: &self.axes, step: clock.step, count: 0, elsewhere: false };
        self.axes.read(trial.world, &mut self.motion);
        trial.world.resource_mut::<Signals>().approach(relaxation.end, [1.0, 1.0]);
        trial.run(|phase| phase == Phase::Boundary)?;
        super::step::held_axes(trial.world, &self.axes, &self.motion, &mut self.space.to_go);
        let space = &mut self.space;
        space.inertia.fill(0.0);
        space.constant.fill(0.0);
        space.w.copy_from_slice(&self.motion.u);
        let mut newton = Newton {
            trial,
            settings: self.settings,
            motion: &self.motion,
            space,
            preconditioner: &mut *self.preconditioner,
            report: &mut self.report,
            sums: &self.sums,
            h: 1.0,
        };
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
        self.report.passes += trial.count;
        self.report.most_passes = self.report.most_passes.max(trial.count);
        found?;
        let Some((remaining, unstable)) = rest else { return Ok(Attempt::NotFound) };
        let Workspace { w, net, step, acceleration, .. } = &mut self.space;
        trial.forces(w, None, net)?;
        step.fill(0.0);
        acceleration.fill(0.0);
        self.axes.arrive(trial.world, w, step, acceleration);
        Ok(Attempt::Found(Rest {
            remaining,
            displaced: self.sums.norm(w),
            iterations: self.report.newton_iterations - before,
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
