//! A step from its beginning to the loads at its end.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::device::{bring_state, send_state};
use super::differences::steps_to;
use super::formula::Formula;
use super::grasped::Grasped;
use super::iterations::{Iterations, OfForces};
use super::kept::Kept;
use super::newton::{Found, Lost, Settings, Workspace};
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::trial::Trial;
use super::work::Works;
use crate::components::*;
use crate::error::{Criterion, Error};
use crate::observation::Observer;
use crate::scene::schema::{ImplicitScheme, Inversion, Scene, Solver};
use bevy_ecs::prelude::*;
use web_time::Instant;

/// What is left of a residual that is warned of.
const WARNED: f64 = 0.5;

/// What takes implicit steps.
pub(in crate::simulation) struct Implicit {
    axes: Axes,
    iterations: Iterations,
    springs: Springs,
    works: Option<Works>,
}

impl Implicit {
    /// What takes the steps of a scene; `None` where they are explicit.
    pub fn of(scene: &Scene, world: &mut World) -> Option<Self> {
        let Solver::Implicit { scheme, newton, tolerance, preconditioner, budget, .. } = scene.solver else {
            return None;
        };
        if scene.is_static() {
            return None;
        }
        let axes = Axes::of(world);
        let settings = Settings { formula: Formula::of(scheme), newton, tolerance, budget };
        let iterations = Iterations::new(settings, preconditioner, &axes, world);
        let works = scene.output.energies_every.map(|_| Works::default());
        Some(Self { axes, iterations, springs: Springs::default(), works })
    }

    /// What they took.
    pub fn report(&self) -> &ImplicitSteps {
        &self.iterations.report
    }

    /// What it is made of.
    pub fn in_use(&mut self, scheme: ImplicitScheme, world: &mut World, passes: OfForces<'_>) -> SolverInUse {
        let Settings { newton, tolerance, .. } = self.iterations.settings;
        let scheme = match scheme {
            ImplicitScheme::Euler => "implicit Euler".into(),
            ImplicitScheme::GeneralizedAlpha { high_frequencies } => {
                format!("generalised-α, which leaves {high_frequencies} of the highest frequencies a step")
            }
        };
        let iterations = match newton {
            1 => format!("one Newton iteration, solved to {tolerance} of its residual"),
            _ => format!("at most {newton} Newton iterations, to a residual of {tolerance} of all forces"),
        };
        self.iterations.in_use(format!("{scheme}: {iterations}"), &self.axes, world, passes)
    }

    /// Takes the step that begins at the clock's, up to the loads at its end. Where that is not found, all stands as
    /// it stood.
    pub fn step(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<(), Error> {
        let started = Instant::now();
        let clock = *world.resource::<Clock>();
        bring_state(world)?;
        self.iterations.kept.keep(world);
        let found = self.find(world, passes, &clock);
        world.resource_mut::<Clock>().step = clock.step;
        set_trying(world, false);
        if found.is_err() {
            self.iterations.kept.put_back(world, |_| true);
        }
        send_state(world)?;
        let left = found.map_err(|lost| match lost {
            Lost::Error(error) => error,
            Lost::Because(what) => not_found(world, what),
        })?;
        self.iterations.end_step(started);
        if left > WARNED {
            warn_of_residual(world, left);
        }
        Ok(())
    }

    /// Finds the end of the step, and takes it. Gives the share of the residual that is left.
    fn find(&mut self, world: &mut World, passes: &mut [ScheduledPass], clock: &Clock) -> Result<f64, Lost> {
        let Self { axes, iterations, springs, works } = self;
        let (h, formula) = (clock.time_step, iterations.settings.formula);
        let mut trial = Trial { world, passes, axes, springs, step: clock.step, count: 0, elsewhere: false };
        let Iterations { motion, space, .. } = &mut *iterations;
        axes.read(trial.world, motion);
        if clock.step == 0 {
            begin(&mut trial, motion, &mut space.net, &formula)?;
        }
        let times = [clock.time_at(clock.step), clock.time_at(clock.step + 1)];
        trial.world.resource_mut::<Signals>().evaluate((times[1], times[1]), times);
        trial.boundary()?;
        Springs::seek(trial.world)?;
        if let Some(works) = works {
            works.begin(trial.world, axes);
        }
        trial.net(&mut space.net);
        held_axes(trial.world, axes, motion, &mut space.to_go);
        let grasped = Grasped::hold(trial.world, axes, motion, &mut space.to_go);
        for axis in 0..space.w.len() {
            (space.inertia[axis], space.constant[axis]) = motion.equation(&formula, h, axis, space.net[axis]);
            space.w[axis] = motion.predicted(axis, h);
        }
        // loads are those of the end
        trial.world.resource_mut::<Clock>().step += 1;
        set_trying(trial.world, true);
        let mut newton = iterations.newton(trial, h);
        let left = newton.solve();
        let mut trial = newton.trial;
        if left.is_ok() {
            let Iterations { motion, space, kept, .. } = &mut *iterations;
            keep_forces(&mut trial, (&formula, h, motion), kept, space)?;
            grasped.note(trial.world, (&formula, h, motion), space);
            let Workspace { w, step, acceleration, .. } = space;
            for axis in 0..w.len() {
                let (velocity, of_axis) = motion.arrival(&formula, axis, h, w[axis]);
                (step[axis], acceleration[axis]) = (h * velocity, of_axis);
            }
            axes.arrive(trial.world, w, step, acceleration);
            if let Some(works) = works {
                works.end(trial.world, axes, motion, w, step, h);
            }
        }
        iterations.count(trial.count);
        left.map(|Found { left, .. }| left)
    }
}

fn set_trying(world: &mut World, trying: bool) {
    if let Some(mut trial) = world.get_resource_mut::<TrialForces>() {
        *trial = TrialForces { trying, inverted: false };
    }
}

/// Forces and accelerations at the beginning of the motion.
fn begin(trial: &mut Trial<'_>, motion: &mut Motion, net: &mut [f64], formula: &Formula) -> Result<(), Lost> {
    trial.world.resource_mut::<Signals>().evaluate((0.0, 0.0), [0.0, 0.0]);
    trial.forces(&motion.u, None, net)?;
    if formula.needs_acceleration() {
        for axis in (0..net.len()).filter(|&axis| motion.free[axis]) {
            motion.a[axis] = -(net[axis] + motion.damping[axis] * motion.v[axis]) / motion.mass[axis];
        }
    }
    Ok(())
}

/// How far held axes go in the step (m), as `boundary` has written it.
pub(super) fn held_axes(world: &World, axes: &Axes, motion: &Motion, to_go: &mut [f64]) {
    for (body, range) in axes.each() {
        let Some(step) = world.get::<DisplacementIncrement>(body) else { continue };
        for i in 0..range.len() {
            let axis = range.start + i;
            to_go[axis] = if motion.held[axis] { step.get(i) } else { 0.0 };
        }
    }
}

/// Takes the forces at the end once more where something is kept of them: memories, elements that were turned inside
/// out and may be, what touches.
fn keep_forces(
    trial: &mut Trial<'_>,
    (formula, h, motion): (&Formula, f64, &Motion),
    kept: &Kept,
    space: &mut Workspace,
) -> Result<(), Error> {
    let world = &mut *trial.world;
    let notes = world.query::<&OnInversion>().iter(world).any(|policy| policy.0 != Inversion::Stop);
    let touches = world.resource::<Clock>().springs.is_some();
    if kept.has_memories() || notes || touches || trial.elsewhere {
        set_trying(trial.world, false);
        // forces that were no numbers are in them
        kept.put_back(trial.world, |column| column.subject == Subject::Memory);
        let Workspace { w, steps, net, .. } = space;
        let at = steps_to(formula, h, motion, w, steps, trial);
        trial.noted_forces(w, at, net)?;
    }
    Ok(())
}

/// That a step was not found.
fn not_found(world: &mut World, what: String) -> Error {
    let clock = *world.resource::<Clock>();
    let found = format!("the implicit step from t = {} s was not found: {what}", clock.time());
    world.resource_scope(|world, observer: Mut<Observer>| {
        observer.unsolved(world, found, Criterion { value: Some(clock.time_step), ..Criterion::of("implicit_step") })
    })
}

/// That much of a residual was left.
fn warn_of_residual(world: &mut World, left: f64) {
    let clock = *world.resource::<Clock>();
    let Some(mut memory) = world.get_resource_mut::<GuardMemory>() else { return };
    if memory.warnings.iter().any(|notice| notice.criterion == "implicit_step") {
        return;
    }
    let message = format!(
        "an implicit step left {:.0} % of its residual ({:.0} % are a warning): results are those of a softer body; raise \
         `budget` or `newton`, or take smaller steps",
        100.0 * left,
        100.0 * WARNED
    );
    memory.warnings.push(Notice {
        criterion: "implicit_step".into(),
        part: String::new(),
        time: clock.time_at(clock.step + 1),
        step: clock.step + 1,
        value: left,
        limit: WARNED,
        message,
    });
}
