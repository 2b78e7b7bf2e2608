//! Dynamic relaxation: pseudo-steps to equilibrium, their damping chosen anew from what the last ones did.
//!
//! Every [`CHECK_STEPS`] steps the residual is taken, the lowest frequency of the motion is estimated by the Rayleigh
//! quotient ω² = Δuᵀ ΔF / Δuᵀ M Δu of what has changed since the last check, and all nodes are damped critically for
//! it, c = 2ω (Underwood 1983). Forces count less where elements are squeezed, which raises the highest frequency.
//! Steps that end in numbers that are not finite or in elements turned inside out are taken back.

mod again;
mod equilibrium;
mod flight;

pub use equilibrium::Equilibrium;

use super::ScheduledPass;
use super::Simulation;
use super::explain::SolverInUse;
use super::frequency::largest_eigenvalue;
use super::implicit::{Attempt, ImplicitSteps, OfForces, Rest, Statics, warn_of_instability};
use super::residual::{Motion, Residual, State};
use super::stretch::least_stretch;
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::{Error, NotConverged};
use crate::observation::Observer;
use crate::scene::schema::{Analysis, EquilibriumSearch, Scene, SearchMethod};
use bevy_ecs::prelude::*;

/// Steps between two checks of the residual.
const CHECK_STEPS: u64 = 40;
/// Elements are checked while loads grow, then in every so many checks.
const CHECKS_BETWEEN_STRETCHES: u64 = 10;
/// How often steps may be taken back.
const MOST_SETBACKS: u32 = 10;
/// Damping a at most: beyond 1 a step would turn round.
const MOST_DAMPING: f64 = 1.0;
/// Motion that tells of frequencies makes forces so many times what rounding makes.
const CLEAR_OF_ROUNDING: f64 = 10.0;
/// What rounding may make of the residual, in units of its estimate: lightly damped, it keeps stiff motion awake (seen:
/// up to 4.3).
const ROUNDING: f64 = 6.0;
/// What the remaining motion may be, in tolerances of the residual: it errs on the side of too much.
const MOTION: f64 = 10.0;
/// From a turning point to the middle of the slowest motion in units of 1/a, and somewhat more: π/2, if a is right.
const TURN: f64 = 3.0;
/// A residual that has not fallen by a tenth in so many times that the slowest motion needs to fall by e will not fall.
const PATIENCE: f64 = 30.0;

/// A static analysis at work.
pub(super) struct Relaxing {
    pub equilibrium: Equilibrium,
    most_steps: u64,
    next_check: u64,
    before: State,
    /// Step and residual when the residual was last seen to fall by a tenth.
    best: (u64, f64),
    largest_scale: f64,
    largest_displaced: f64,
    /// Who is farther (m) from where it began flies away.
    far: f64,
    /// The force scale before anything is squeezed, and the share of it that squeezed elements leave.
    force_scale: f64,
    squeezed: f64,
    checks: u64,
    /// The lowest frequency, as far as it is known (1/s).
    frequency: f64,
    /// The check that first saw loads at rest.
    settled_at: Option<u64>,
    /// The check since which all is as quiet as it must be.
    quiet_since: Option<u64>,
    newton: Option<Box<ByNewton>>,
}

/// Newton's iterations, tried at the start, and again where pseudo-steps have come near enough.
struct ByNewton {
    statics: Statics,
    /// The residual from which on they are tried; infinite before the first time.
    below: f64,
}

/// What is turned farther (rad) is led there by pseudo-steps: the straight way of an iteration winds up less, or the
/// other way round.
const FAR_TURN: f64 = 0.5 * std::f64::consts::PI;
/// The residual from which Newton's iterations begin again, and by what it falls each time that they do not arrive.
const BEGIN_AGAIN: f64 = 1e-2;
const LESS: f64 = 0.1;

/// How well a static analysis knows the largest eigenvalue at rest: some 24 products; its safety is margin enough.
const OF_RELAXATION: f64 = 0.2;

impl Relaxing {
    /// What drives a static analysis, on columns of the host; `None` for a scene of motion.
    pub fn of(scene: &Scene, precision: Precision, world: &mut World) -> Option<Self> {
        let Analysis::Static(search) = scene.analysis else { return None };
        // in units of the bound of the elements, which the inertial masses make the same for all
        let half = 0.5 * world.resource::<Clock>().time_step;
        let springs = world.resource::<Clock>().springs.is_some();
        // springs of contact are as stiff as the bound that their masses make, and no part of that eigenvalue
        let found = if springs { None } else { largest_eigenvalue(world, OF_RELAXATION) };
        let highest = found.map_or(1.0, |found| found.at_least * half * half);
        let highest = if highest > 0.0 && highest < 1.0 { highest } else { 1.0 };
        let load_steps = world.resource_mut::<Clock>().relaxation.as_mut().map_or(0, |relaxation| {
            relaxation.force_scale = scene.integration.safety.powi(2) / highest;
            (1.0 / relaxation.ramp_rate).round() as u64
        });
        // what rounding leaves of the residual in f32 is some 1e-6
        let reachable = if precision == Precision::F64 { 1e-6 } else { 1e-5 };
        let mut new = Self::new(&search, reachable, load_steps, world);
        new.far = flight::far(scene, world);
        if search.method == SearchMethod::Newton {
            let reachable = if precision == Precision::F64 { 1e-10 } else { 1e-5 };
            let statics = Statics::new(search.tolerance.unwrap_or(reachable), search.arc, world);
            new.newton = Some(Box::new(ByNewton { statics, below: f64::INFINITY }));
            // loads and motions have begun then, and are nothing yet
            new.next_check = 1;
        }
        Some(new)
    }

    fn new(search: &EquilibriumSearch, reachable: f64, load_steps: u64, world: &mut World) -> Self {
        let (tolerance, most_steps) = (search.tolerance.unwrap_or(reachable), search.max_steps);
        Self {
            equilibrium: Equilibrium { residual: f64::INFINITY, tolerance, load_steps, ..Equilibrium::default() },
            most_steps,
            next_check: CHECK_STEPS.min(most_steps),
            before: State::of(world),
            best: (0, f64::INFINITY),
            largest_scale: 0.0,
            largest_displaced: 0.0,
            far: f64::INFINITY,
            force_scale: world.resource::<Clock>().relaxation.map_or(1.0, |relaxation| relaxation.force_scale),
            squeezed: 1.0,
            checks: 0,
            frequency: 0.0,
            settled_at: None,
            quiet_since: None,
            newton: None,
        }
    }

    /// What Newton's iterations have taken, where they are tried.
    pub fn iterations(&self) -> Option<ImplicitSteps> {
        self.newton.as_ref().map(|newton| newton.statics.report())
    }

    /// What Newton's iterations are made of, where they are tried.
    pub fn in_use(&mut self, world: &mut World, passes: OfForces<'_>) -> Option<SolverInUse> {
        self.newton.as_mut().map(|newton| newton.statics.in_use(world, passes))
    }

    /// The next step at whose end the residual is checked.
    pub fn next_check(&self) -> u64 {
        self.next_check
    }
}

impl Simulation {
    /// The equilibrium of a static analysis, or how far it has come; `None` for one of motion.
    pub fn equilibrium(&self) -> Option<&Equilibrium> {
        self.solver.relaxing().map(|relaxing| &relaxing.equilibrium)
    }

    /// Whether all is done: the scene's duration has passed, or equilibrium is reached.
    pub fn is_finished(&self) -> bool {
        self.solver.is_done(self.step_count(), self.planned_steps())
    }

    /// Takes all steps that are left, to the end of the scene's duration or to equilibrium.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn finish(&mut self) -> Result<(), Error> {
        self.advance_towards_end(u64::MAX)
    }
}

impl Relaxing {
    /// Checks the residual, and chooses how to go on.
    pub fn check(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<(), Error> {
        let clock = *world.resource::<Clock>();
        let Some(mut relaxation) = clock.relaxation else { return Ok(()) };
        if let Some(newton) = self.newton.as_mut().filter(|newton| newton.below.is_infinite()) {
            self.next_check = CHECK_STEPS.max(clock.step + 1).min(self.most_steps);
            let turns = world.resource::<Signals>().largest_turn(relaxation.end);
            if turns > FAR_TURN && !newton.statics.follows_path() {
                newton.below = BEGIN_AGAIN;
                return Ok(());
            }
            return self.try_newton(world, passes);
        }
        bring_to_host(world, |_, name| column_is(name, State::has))?;
        let now = State::of(world);
        let residual = Residual::of(&now, world);
        let trouble = world.resource_scope(|world, observer: Mut<Observer>| observer.trouble(world))?;
        let blown = !residual.square.is_finite() || !residual.scale_square.is_finite();
        if trouble.is_some() || blown {
            if self.equilibrium.setbacks >= MOST_SETBACKS || clock.step >= self.most_steps {
                return Err(trouble.map_or_else(|| self.given_up(clock.step), |found| Error::Unstable(Box::new(found))));
            }
            return self.take_back(world, relaxation, clock.step);
        }
        let share = relaxation.share(clock.step);
        if share < 1.0 || self.checks.is_multiple_of(CHECKS_BETWEEN_STRETCHES) {
            self.squeezed = least_stretch(world).powi(2);
        }
        self.checks += 1;
        relaxation.force_scale = self.force_scale * self.squeezed;
        let motion = now.motion_since(&self.before, world);
        // forces of a motion are to loads about as the motion is to displacements; they must stand out from rounding
        let noise = residual.digit.max((residual.rounding_square / residual.scale_square).sqrt());
        let tiny = CLEAR_OF_ROUNDING * noise * motion.displaced;
        if let Some(frequency) = motion.frequency.filter(|_| motion.moved > tiny) {
            // the quotient is never below the lowest frequency: with loads at rest the least is the best
            let settled = self.settled_at.is_some_and(|step| clock.step > step + 2 * CHECK_STEPS);
            self.frequency = if settled { frequency.min(self.frequency) } else { frequency };
        }
        relaxation.damping = (relaxation.force_scale.sqrt() * self.frequency * clock.time_step).min(MOST_DAMPING);
        if share >= 1.0 {
            self.settled_at.get_or_insert(clock.step);
        }
        self.judge(&motion, &residual, clock.step - self.before.step, relaxation.damping, world);
        world.resource_mut::<Clock>().relaxation = Some(relaxation);
        let found = &self.equilibrium;
        let row = [clock.step as f64, share, found.residual, found.remaining_motion, relaxation.damping];
        world.resource_scope(|world, mut observer: Mut<Observer>| {
            observer.note_convergence(row)?;
            if share < 1.0 { observer.observe_on_the_way(world) } else { Ok(()) }
        })?;
        self.stay_near(&now, world)?;
        self.before = now;
        let (found, tolerance) = (&self.equilibrium, self.equilibrium.tolerance);
        let quiet = share >= 1.0
            && found.residual <= tolerance + ROUNDING * found.rounding
            && found.remaining_motion <= MOTION * tolerance;
        self.quiet_since = self.quiet_since.filter(|_| quiet).or(quiet.then_some(clock.step));
        // where rounding hides soft motion, a check must not have met it at its turning point
        let long = (clock.step - self.quiet_since.unwrap_or(clock.step)) as f64 >= TURN / relaxation.damping.max(1e-9);
        let arrived = quiet && (long || found.residual <= tolerance);
        let is_near = self.newton.as_ref().is_some_and(|newton| found.residual <= newton.below);
        if share >= 1.0 && (arrived || is_near) {
            self.try_newton(world, passes)?;
        }
        if self.equilibrium.reached {
            return Ok(());
        }
        if arrived {
            self.equilibrium.reached = true;
            return self.ask_whether_it_lasts(world, passes);
        }
        let found = &self.equilibrium;
        // a body that collapses is on its way to another rest: forces grow before they fall
        let collapses = motion.work < -CLEAR_OF_ROUNDING * residual.rounding_square.sqrt() * motion.moved;
        if share < 1.0 || collapses || found.residual < 0.9 * self.best.1 {
            self.best = (clock.step, found.residual);
        }
        let patience = PATIENCE / relaxation.damping.max(1e-9);
        let stalled = (clock.step - self.best.0) as f64 > patience.max(50.0 * CHECK_STEPS as f64);
        if stalled || clock.step >= self.most_steps {
            return Err(self.given_up(clock.step));
        }
        self.next_check = (clock.step + CHECK_STEPS).min(self.most_steps);
        Ok(())
    }

    /// Tries Newton's iterations from the present state, where they are wanted.
    fn try_newton(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<(), Error> {
        let Some(newton) = &mut self.newton else { return Ok(()) };
        newton.below = if newton.below.is_finite() { newton.below * LESS } else { BEGIN_AGAIN };
        match newton.statics.attempt(world, passes)? {
            Attempt::Found(rest) => self.arrive(&rest, world),
            Attempt::NotFound => Ok(()),
            Attempt::NotHeld(motions) => {
                self.equilibrium.not_held = motions;
                Err(self.given_up(world.resource::<Clock>().step))
            }
        }
    }

    /// Asks where pseudo-steps have arrived, and Newton's iterations have not, whether bodies give way there: what is
    /// symmetric is at rest beyond the load at which it buckles, too.
    fn ask_whether_it_lasts(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<(), Error> {
        let Some(newton) = &mut self.newton else { return Ok(()) };
        self.equilibrium.unstable = newton.statics.gives_way(world, passes)?;
        if self.equilibrium.unstable {
            warn_of_instability(world);
        }
        Ok(())
    }

    /// Takes over what Newton's iterations have found.
    fn arrive(&mut self, rest: &Rest, world: &mut World) -> Result<(), Error> {
        let mut clock = world.resource_mut::<Clock>();
        clock.step += rest.iterations;
        let step = clock.step;
        if let Some(relaxation) = &mut clock.relaxation {
            let factor = rest.path.last().map_or(1.0, |point| point.load_factor);
            relaxation.since = (step, factor.clamp(0.0, 1.0));
            relaxation.ramp_rate = 0.0;
        }
        let residual = Residual::of(&State::of(world), world);
        let motion = Motion { moved: rest.remaining, displaced: rest.displaced, ..Motion::default() };
        self.judge(&motion, &residual, 1, 1.0, world);
        let found = &mut self.equilibrium;
        (found.reached, found.newton_iterations, found.unstable) = (true, rest.iterations, rest.unstable);
        found.path.clone_from(&rest.path);
        if let Some(newton) = &self.newton {
            found.tolerance = newton.statics.tolerance();
        }
        if rest.unstable {
            warn_of_instability(world);
        }
        let row = [step as f64, 1.0, found.residual, found.remaining_motion, 0.0];
        world.resource_mut::<Observer>().note_convergence(row)
    }

    /// How far the present state is from equilibrium.
    fn judge(&mut self, motion: &Motion, residual: &Residual, steps: u64, damping: f64, world: &World) {
        let scale = residual.scale_square.sqrt();
        self.largest_scale = self.largest_scale.max(scale);
        // forces that balance to nothing in the end are small beside what they were on the way
        let scale = scale.max(1e-3 * self.largest_scale);
        let share = |part: f64, whole: f64| if part > 0.0 { part / whole } else { 0.0 };
        let found = &mut self.equilibrium;
        found.scale = scale;
        found.residual = share(residual.square.sqrt(), scale);
        let moved = if motion.moved > residual.of_places { motion.moved } else { 0.0 };
        // critically damped motion falls by e in 1/a steps
        let still = moved / (steps.max(1) as f64 * damping.max(1e-9));
        // what goes back to rest is displaced by nothing in the end
        self.largest_displaced = self.largest_displaced.max(motion.displaced);
        found.remaining_motion = share(still, motion.displaced.max(1e-3 * self.largest_displaced));
        // where nothing is loaded and nothing is strained there is nothing to be a share of
        let rounding = (residual.rounding_square + residual.places_square).sqrt();
        found.rounding = if scale > 0.0 { share(rounding, scale) } else { 0.0 };
        found.worst = residual.worst_in_words(world);
    }

    /// Goes back to the last check, from where forces count half. While loads still grow, it goes back to the start,
    /// where they grow at a quarter of the pace: what has been pushed too suddenly may have taken a way that leads
    /// elsewhere.
    fn take_back(&mut self, world: &mut World, mut relaxation: Relaxation, step: u64) -> Result<(), Error> {
        if self.settled_at.is_none() {
            self.before.forget();
            relaxation.ramp_rate *= 0.25;
            relaxation.since = (step, 0.0);
            self.squeezed = 1.0;
        }
        self.force_scale *= 0.5;
        relaxation.force_scale = self.force_scale * self.squeezed;
        self.before.restore(world);
        self.before.step = step;
        send_to_device(world, |_, name| column_is(name, State::has))?;
        world.resource_mut::<Clock>().relaxation = Some(relaxation);
        self.equilibrium.setbacks += 1;
        self.next_check = (step + CHECK_STEPS).min(self.most_steps);
        Ok(())
    }

    fn given_up(&self, steps: u64) -> Error {
        Error::NotConverged(Box::new(NotConverged {
            steps,
            stalled_at: (steps < self.most_steps).then_some(self.best.0),
            equilibrium: self.equilibrium.clone(),
            at_start: false,
        }))
    }
}
