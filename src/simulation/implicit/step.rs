//! A step from its beginning to the loads at its end.

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::bonds::Bonds;
use super::contact_work::{TouchedBefore, rubs};
use super::device::{bring_state, send_state};
use super::formula::Formula;
use super::grasped::Grasped;
use super::iterations::{Iterations, OfForces};
use super::newton::{Found, Lost, Settings, Workspace};
use super::place::Place;
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::step_control::StepControl;
use super::to_go::ToGo;
use super::trial::Trial;
use super::work::{add_internal_work, add_work, note_formula};
use crate::components::*;
use crate::error::{Criterion, Error};
use crate::observation::Observer;
use crate::scene::schema::{ImplicitScheme, Inversion, Scene, Solver};
use bevy_ecs::prelude::*;

/// What is left of a residual that is warned of.
const WARNED: f64 = 0.5;

/// A load that jumps when the motion begins has jumped after such a share of the first step: of those before, of which
/// generalised-α has a share, it would be late by that share of a step.
const BEGINS: f64 = 1e-6;

/// What takes implicit steps.
pub(in crate::simulation) struct Implicit {
    axes: Axes,
    iterations: Iterations,
    springs: Springs,
    bonds: Bonds,
    /// Whether work is added up.
    works: bool,
    control: Option<StepControl>,
}

/// Whether a step was taken.
pub(in crate::simulation) enum Taken {
    Taken,
    /// All stands as it stood, for a shorter one.
    Back,
}

impl Implicit {
    /// What takes the steps of a scene; `None` where they are explicit.
    pub fn of(scene: &Scene, world: &mut World) -> Option<Self> {
        let Solver::Implicit { scheme, step, adaptive, newton, tolerance, preconditioner, budget } = scene.solver
        else {
            return None;
        };
        if scene.is_static() {
            return None;
        }
        let axes = Axes::of(world);
        let settings = Settings { formula: Formula::of(scheme), newton, tolerance, budget };
        let iterations = Iterations::new(settings, preconditioner, &axes, world);
        let works = scene.output.energies_every.is_some();
        let control = adaptive.map(|asked| StepControl::of(asked, step, &axes, world));
        Some(Self { axes, iterations, springs: Springs::default(), bonds: Bonds::default(), works, control })
    }

    /// What chooses their lengths by their errors.
    pub fn control(&self) -> Option<&StepControl> {
        self.control.as_ref()
    }

    /// The same, to choose one.
    pub fn control_mut(&mut self) -> Option<&mut StepControl> {
        self.control.as_mut()
    }

    /// What they took.
    pub fn report(&self) -> ImplicitSteps {
        self.iterations.report()
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
        let lengths = self.control.as_ref().map_or(String::new(), |control| format!("; {}", control.in_words()));
        self.iterations.in_use(format!("{scheme}: {iterations}{lengths}"), &self.axes, world, passes)
    }

    /// Takes the step that begins at the clock's, up to the loads at its end. Where that is not found, or its error is
    /// too large, all stands as it stood.
    pub fn step(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<Taken, Error> {
        let told = self.iterations.report;
        let clock = *world.resource::<Clock>();
        bring_state(world)?;
        self.bonds.note(world);
        self.iterations.kept.keep(world, &self.axes);
        let found = self.find(world, passes, &clock);
        world.resource_mut::<Clock>().step = clock.step;
        set_trying(world, false);
        let back = match (&found, &mut self.control) {
            (Ok(None), _) => true,
            (Err(Lost::Because(_)), Some(control)) => control.cut_back(clock.time_step),
            _ => false,
        };
        if found.is_err() || back {
            self.iterations.kept.put_back(world, &self.axes);
            self.axes.put_back(world, &self.iterations.motion);
        }
        send_state(world)?;
        if back {
            self.iterations.take_back(&told);
            return Ok(Taken::Back);
        }
        let left = found.map_err(|lost| match lost {
            Lost::Error(error) => error,
            Lost::Because(what) => not_found(world, what),
        })?;
        self.iterations.end_step();
        self.iterations.report.note_length(clock.time_step);
        if let Some(left) = left.filter(|left| *left > WARNED) {
            warn_of_residual(world, left);
        }
        if self.control.as_ref().is_some_and(StepControl::is_beyond) {
            warn_of_error(world);
        }
        Ok(Taken::Taken)
    }

    /// Whether a thread or a tie has let go in the last step.
    pub fn has_let_go(&self, world: &World) -> bool {
        self.bonds.has_let_go(world)
    }

    /// Takes the forces at the end of a step once more, for elements have gone since, or something has let go: the next
    /// one begins with them. So do the accelerations of nodes that have lost mass or are let go, where they are carried
    /// on.
    pub fn renew_forces(&mut self, world: &mut World, passes: &mut [ScheduledPass], step: u64) -> Result<(), Error> {
        bring_state(world)?;
        let Self { axes, iterations, springs, bonds, .. } = self;
        let Iterations { settings, motion, space, kept, report, .. } = &mut *iterations;
        let (clock, masses) = (*world.resource::<Clock>(), motion.mass.clone());
        let times = [clock.time_at(step), clock.time_at(step + 1)];
        world.resource_mut::<Signals>().evaluate((times[1], times[1]), times);
        Springs::seek(world)?;
        axes.read(world, motion);
        // forces at the end go on from memories and slip of the beginning
        kept.exchange_carried_on(world);
        set_trying(world, true);
        let mut trial = Trial { world, passes, axes, springs, step, count: 0, elsewhere: false };
        trial.present_forces(&mut space.net)?;
        trial.springs.press(1.0, &motion.free, &mut space.net);
        if settings.formula.needs_acceleration() {
            let let_go = bonds.let_go(trial.world, axes);
            let has_changed = |node| motion.mass.get(node) != masses.get(node) || let_go.binary_search(&node).is_ok();
            accelerate(&mut trial, motion, &space.net, has_changed);
        }
        kept.forces.read(trial.world, axes);
        trial.springs.load(&mut kept.forces.external);
        kept.forces.put_back(trial.world, axes);
        kept.exchange_carried_on(trial.world);
        set_trying(trial.world, false);
        trial.world.resource_mut::<Clock>().springs = clock.springs;
        report.passes += trial.count;
        send_state(trial.world)
    }

    /// Finds the end of the step, and takes it unless its error is too large. Gives the share of the residual that is
    /// left, if it was taken.
    fn find(&mut self, world: &mut World, passes: &mut [ScheduledPass], clock: &Clock) -> Result<Option<f64>, Lost> {
        let Self { axes, iterations, springs, works, control, .. } = self;
        let (h, formula) = (clock.time_step, iterations.settings.formula);
        let mut trial = Trial { world, passes, axes, springs, step: clock.step, count: 0, elsewhere: false };
        let Iterations { motion, space, kept, .. } = &mut *iterations;
        axes.read(trial.world, motion);
        if clock.step == 0 {
            begin(&mut trial, motion, &mut space.net, &formula, BEGINS * h)?;
            kept.forces.read(trial.world, axes);
            trial.springs.load(&mut kept.forces.external);
        }
        let times = [clock.time_at(clock.step), clock.time_at(clock.step + 1)];
        trial.world.resource_mut::<Signals>().evaluate((times[1], times[1]), times);
        trial.boundary()?;
        Springs::seek(trial.world)?;
        held_axes(trial.world, axes, motion, &mut space.to_go);
        let grasped = Grasped::hold(trial.world, axes, motion, &mut space.to_go);
        space.begin();
        // loads are those of the end
        trial.world.resource_mut::<Clock>().step += 1;
        set_trying(trial.world, true);
        let mut newton = iterations.newton(trial, h);
        let found = newton.solve();
        let mut trial = newton.trial;
        let taken = match &found {
            Ok(found) => iterations.takes(control.as_mut(), h, found, (axes, trial.world)),
            Err(_) => false,
        };
        if taken {
            keep_forces(&mut trial, h, iterations)?;
            let place = iterations.place(h);
            grasped.note(trial.world, &place, &iterations.space.net, Some(&iterations.kept.forces));
            let count = if *works { add_work } else { add_internal_work };
            let spent = count(trial.world, axes, &iterations.kept.forces, &place);
            note_formula(trial.world, &spent);
            place.arrive(axes, trial.world);
        }
        iterations.count(trial.count);
        found.map(|Found { left, .. }| taken.then_some(left))
    }
}

fn set_trying(world: &mut World, trying: bool) {
    if let Some(mut trial) = world.get_resource_mut::<TrialForces>() {
        *trial = TrialForces { trying, inverted: false };
    }
}

/// Forces and accelerations at the beginning of the motion, with the loads just after it (s), and what touches there.
fn begin(trial: &mut Trial<'_>, motion: &Motion, net: &mut Reals, formula: &Formula, after: f64) -> Result<(), Lost> {
    trial.world.resource_mut::<Signals>().evaluate((after, after), [0.0, 0.0]);
    Springs::seek(trial.world)?;
    trial.present_forces(net)?;
    trial.springs.press(1.0, &motion.free, net);
    if formula.needs_acceleration() {
        accelerate(trial, motion, net, |_| true);
    }
    Ok(())
}

/// Gives the free axes of some nodes the accelerations that forces (N) and damping make there.
fn accelerate(trial: &mut Trial<'_>, motion: &Motion, net: &Reals, which: impl Fn(usize) -> bool) {
    for (body, range) in trial.axes.each() {
        let Some(mut accelerations) = trial.world.get_mut::<Acceleration>(body) else { continue };
        for axis in range.clone().filter(|&axis| motion.free[axis] && which(axis / 3)) {
            let forces = net.get(axis) + motion.damping(axis) * motion.velocity(axis);
            accelerations.set(axis - range.start, -forces / motion.mass.get(axis / 3));
        }
    }
}

/// How far held axes go in the step (m), as `boundary` has written it.
pub(super) fn held_axes(world: &World, axes: &Axes, motion: &Motion, to_go: &mut ToGo) {
    to_go.clear();
    for (body, range) in axes.each() {
        let Some(step) = world.get::<DisplacementIncrement>(body) else { continue };
        let goes = |&axis: &usize| motion.is_held(axis) && step.get(axis - range.start) != 0.0;
        range.clone().filter(goes).for_each(|axis| to_go.push(axis, step.get(axis - range.start)));
    }
}

/// Takes the forces at the end once more where something is kept of them: memories, elements that were turned inside
/// out and may be, what touches.
fn keep_forces(trial: &mut Trial<'_>, h: f64, iterations: &mut Iterations) -> Result<(), Error> {
    let world = &mut *trial.world;
    let notes = world.query::<&OnInversion>().iter(world).any(|policy| policy.0 != Inversion::Stop);
    let touches = world.resource::<Clock>().springs.is_some();
    if iterations.kept.has_memories() || notes || touches || trial.elsewhere {
        set_trying(trial.world, false);
        // forces that were no numbers are in them
        iterations.kept.put_memories_back(trial.world);
        let touched = touches.then(|| TouchedBefore::read(trial.world));
        let Iterations { settings, motion, space: Workspace { correction, net, .. }, .. } = iterations;
        let place = Place { formula: &settings.formula, h, motion, correction, beyond: None };
        trial.noted_forces(&place, net)?;
        if let Some(touched) = touched {
            touched.count_work(trial.world, trial.axes, &place);
        }
    }
    Ok(())
}

/// That a step was not found.
fn not_found(world: &mut World, what: String) -> Error {
    let clock = *world.resource::<Clock>();
    let found = format!("the implicit step from t = {} s was not found: {what}", clock.time());
    let found = (found, rubs(world));
    world.resource_scope(|world, observer: Mut<Observer>| {
        observer.unsolved(world, found, Criterion { value: Some(clock.time_step), ..Criterion::of("implicit_step") })
    })
}

/// That much of a residual was left.
fn warn_of_residual(world: &mut World, left: f64) {
    let results = if left <= 1.0 {
        "results are those of a softer body"
    } else {
        "that is more than it began with, and what was found may be far off"
    };
    let message = format!(
        "an implicit step left {:.0} % of its residual ({:.0} % are a warning): {results}; raise `budget` or `newton`, or \
         take smaller steps",
        100.0 * left,
        100.0 * WARNED
    );
    warn(world, "implicit_step", (left, WARNED), message);
}

/// That a step was taken whose error is too large, for there is none shorter.
fn warn_of_error(world: &mut World) {
    let length = world.resource::<Clock>().time_step;
    let message = format!(
        "the error of an implicit step of {length:.3e} s is beyond the tolerance of `adaptive`, and the scene allows \
         none shorter: lower `smallest`, or raise `tolerance`"
    );
    warn(world, "implicit_step_error", (length, length), message);
}

/// Warns, once a run of each kind.
fn warn(world: &mut World, criterion: &str, (value, limit): (f64, f64), message: String) {
    let clock = *world.resource::<Clock>();
    let Some(mut memory) = world.get_resource_mut::<GuardMemory>() else { return };
    if memory.warnings.iter().any(|notice| notice.criterion == criterion) {
        return;
    }
    let (part, step) = (String::new(), clock.step + 1);
    let time = clock.time_at(step);
    memory.warnings.push(Notice { criterion: criterion.into(), part, time, step, value, limit, message });
}
