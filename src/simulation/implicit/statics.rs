//! Equilibrium by Newton's iterations: those of an implicit step without inertia.

mod touching;

use super::super::ScheduledPass;
use super::super::explain::SolverInUse;
use super::axes::{Axes, Motion};
use super::device::{bring_state, send_state};
use super::formula::Formula;
use super::free_motions::{FreeMotion, Unresisted, free_motions};
use super::grasped::Grasped;
use super::iterations::{Iterations, OfForces};
use super::kept::Kept;
use super::newton::{Found, Lost, Newton, PathPoint, Settings, Workspace};
use super::place::Place;
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::trial::Trial;
use crate::components::*;
use crate::error::{Criterion, Error};
use crate::observation::Observer;
use crate::scene::schema::{self, ArcLength};
use crate::snapshot::Keeping;
use bevy_ecs::prelude::*;
use touching::{Growth, Touching};

/// Newton's iterations at most: slender bodies spend some twenty on the way.
const MOST_ITERATIONS: u32 = 60;
/// The residual to which rest is sought on the way to all loads.
const ON_THE_WAY: f64 = 1e-3;
/// A share of loads along a motion that nothing holds, which is more than rounding.
const UNBALANCED: f64 = 1e-5;

/// What seeks equilibrium.
pub(in crate::simulation) struct Statics {
    axes: Axes,
    iterations: Iterations,
    springs: Springs,
    arc: Option<ArcLength>,
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
    /// The path that led there, where one was followed; none else.
    pub path: Vec<PathPoint>,
}

impl Statics {
    /// What seeks the equilibrium of bodies to a residual of a tolerance, along a path or not.
    pub fn new(tolerance: f64, arc: Option<ArcLength>, world: &mut World) -> Self {
        let axes = Axes::of(world);
        let settings = Settings { formula: Formula::of_rest(), newton: MOST_ITERATIONS, tolerance, budget: None };
        let mut iterations = Iterations::new(settings, schema::Preconditioner::TwoLevel, &axes, world);
        iterations.kept = Kept::of_rest(axes.precision());
        Self { axes, iterations, springs: Springs::default(), arc }
    }

    /// What they took.
    pub fn report(&self) -> ImplicitSteps {
        self.iterations.report()
    }

    /// What it is made of.
    pub fn in_use(&mut self, world: &mut World, passes: OfForces<'_>) -> SolverInUse {
        let Settings { newton, tolerance, .. } = self.iterations.settings;
        let first = match &self.arc {
            Some(ArcLength { points, .. }) => format!(
                "a path of at most {points} equilibria by arc length, each to a residual of {tolerance}, with the method of \
                 minimal residuals in place of conjugate gradients"
            ),
            None => format!(
                "rest by at most {newton} Newton iterations, to a residual of {tolerance}; pseudo-steps where they do not \
                 arrive"
            ),
        };
        self.iterations.in_use(first, &self.axes, world, passes)
    }

    /// Whether a path is followed.
    pub fn follows_path(&self) -> bool {
        self.arc.is_some()
    }

    /// The residual at which it counts as found.
    pub fn tolerance(&self) -> f64 {
        self.iterations.settings.tolerance
    }

    /// Seeks equilibrium under loads and motions in full, from where bodies are.
    pub fn attempt(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<Attempt, Error> {
        let before = self.iterations.report.newton_iterations;
        let seek = |statics: &mut Self, world: &mut World| match statics.arc {
            Some(arc) => statics.follow(world, passes, &arc),
            None => statics.find(world, passes),
        };
        match self.trying(world, seek, |attempt| matches!(attempt, Attempt::Found(_)))? {
            Ok(Attempt::Found(mut rest)) => {
                rest.iterations -= before;
                Ok(Attempt::Found(rest))
            }
            Ok(attempt) => Ok(attempt),
            Err(Lost::Because(what)) if self.follows_path() => Err(not_followed(world, what)),
            Err(Lost::Because(_)) => Ok(Attempt::NotFound),
            Err(Lost::Error(error)) => Err(error),
        }
    }

    /// Whether bodies that are at rest where they are, under loads and motions in full, give way along some motion.
    pub fn gives_way(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<bool, Error> {
        let ask = |statics: &mut Self, world: &mut World| {
            let clock = *world.resource::<Clock>();
            let end = clock.relaxation.map_or(0.0, |relaxation| relaxation.end);
            let Self { axes, iterations, springs, .. } = statics;
            let trial = Trial { world, passes, axes, springs, step: clock.step, count: 0, elsewhere: false };
            let (mut newton, _) = prepared(iterations, trial, (end, [1.0, 1.0]))?;
            let motions = free_motions(newton.trial.world, newton.trial.axes, &newton.motion.free);
            let gives_way = motions.is_empty() && newton.forces_at_w()?.sound && newton.gives_way()?;
            let count = newton.trial.count;
            statics.iterations.count(count);
            Ok(gives_way)
        };
        match self.trying(world, ask, |_| false)? {
            Ok(gives_way) => Ok(gives_way),
            Err(Lost::Error(error)) => Err(error),
            Err(Lost::Because(_)) => Ok(false),
        }
    }

    /// Tries something out; all is as it was afterwards, unless what came of it stays.
    fn trying<T>(
        &mut self,
        world: &mut World,
        seek: impl FnOnce(&mut Self, &mut World) -> Result<T, Lost>,
        stays: impl FnOnce(&T) -> bool,
    ) -> Result<Result<T, Lost>, Error> {
        bring_state(world)?;
        self.iterations.kept.keep(world, &self.axes);
        world.insert_resource(TrialForces { trying: true, ..TrialForces::default() });
        let found = seek(self, world);
        world.remove_resource::<TrialForces>();
        if let Some(springs) = &mut world.resource_mut::<Clock>().springs {
            springs.forces = SpringForces::Stepped;
        }
        if !found.as_ref().is_ok_and(stays) {
            self.iterations.kept.put_back(world, &self.axes);
        }
        send_state(world)?;
        self.iterations.end_step();
        Ok(found)
    }

    fn find(&mut self, world: &mut World, passes: &mut [ScheduledPass]) -> Result<Attempt, Lost> {
        let clock = *world.resource::<Clock>();
        let Some(relaxation) = clock.relaxation else { return Ok(Attempt::NotFound) };
        let touching = clock.springs.map(|_| Touching::of(world, &relaxation, clock.step));
        let Some(mut growth) = touching.map_or(Some(Growth::at_once()), |touching| touching.growth) else {
            return Ok(Attempt::NotFound);
        };
        let farthest = touching.map(|touching| touching.farthest);
        loop {
            let shares = growth.next();
            match self.balance(world, passes, (relaxation.end, shares, farthest)) {
                Ok(Balance::Found { .. }) if shares[1] < 1.0 => growth.succeeded(),
                Ok(Balance::Found { remaining, unstable }) => {
                    return Ok(Attempt::Found(self.rest(remaining, unstable, Vec::new())));
                }
                Ok(Balance::Loose) => return Ok(Attempt::NotFound),
                Ok(Balance::NotHeld(motions)) => return Ok(Attempt::NotHeld(motions)),
                Err(Lost::Error(error)) => return Err(Lost::Error(error)),
                Ok(Balance::NotFound) | Err(Lost::Because(_)) => {
                    if !growth.failed() {
                        return Ok(Attempt::NotFound);
                    }
                    self.axes.put_back(world, &self.iterations.motion);
                }
            }
        }
    }

    /// Rest where bodies are.
    fn rest(&self, remaining: f64, unstable: bool, path: Vec<PathPoint>) -> Rest {
        let place = self.iterations.place(1.0);
        let displaced = (0..self.axes.len()).map(|axis| place.displacement(axis).powi(2)).sum::<f64>().sqrt();
        Rest { remaining, displaced, iterations: self.iterations.report.newton_iterations, unstable, path }
    }

    /// Follows the path of equilibria from no load to all of it, or as far as it is wanted.
    fn follow(&mut self, world: &mut World, passes: &mut [ScheduledPass], arc: &ArcLength) -> Result<Attempt, Lost> {
        let clock = *world.resource::<Clock>();
        let end = clock.relaxation.map_or(0.0, |relaxation| relaxation.end);
        let Self { axes, iterations, springs, .. } = self;
        let trial = Trial { world, passes, axes, springs, step: clock.step, count: 0, elsewhere: false };
        let Iterations { motion, space, .. } = &mut *iterations;
        axes.read(trial.world, motion);
        trial.world.resource_mut::<Signals>().approach(end, [1.0, 1.0]);
        begin(space, motion);
        let mut newton = iterations.newton(trial, 1.0);
        let motions = free_motions(newton.trial.world, newton.trial.axes, &newton.motion.free);
        if let Holds::Nothing(motions) = holds(&motions, &mut newton)? {
            return Ok(Attempt::NotHeld(motions));
        }
        let path = newton.follow_path(end, arc, |world, number, point| {
            let PathPoint { load_factor, length, unstable, iterations } = *point;
            let row = [number as f64, load_factor, length, iterations as f64, f64::from(u8::from(unstable))];
            world.resource_scope(|world, mut observer: Mut<Observer>| observer.note_path(world, row))
        });
        let count = newton.trial.count;
        self.iterations.count(count);
        let path = path?;
        self.iterations.place(1.0).arrive(&self.axes, world);
        let unstable = path.last().is_some_and(|point| point.unstable);
        Ok(Attempt::Found(self.rest(0.0, unstable, path)))
    }

    /// Seeks where bodies are at rest while loads and motions go from one share of what they are at a time (s) to
    /// another.
    fn balance(
        &mut self,
        world: &mut World,
        passes: &mut [ScheduledPass],
        (end, shares, farthest): (f64, [f64; 2], Option<f64>),
    ) -> Result<Balance, Lost> {
        let step = world.resource::<Clock>().step;
        let Self { axes, iterations, springs, .. } = self;
        let trial = Trial { world, passes, axes, springs, step, count: 0, elsewhere: false };
        let (mut newton, grasped) = prepared(iterations, trial, (end, shares))?;
        newton.farthest = farthest;
        if shares[1] < 1.0 {
            newton.settings.tolerance = newton.settings.tolerance.max(ON_THE_WAY);
        }
        let motions = free_motions(newton.trial.world, newton.trial.axes, &newton.motion.free);
        match holds(&motions, &mut newton)? {
            Holds::Enough => {}
            Holds::Perhaps => return Ok(Balance::Loose),
            Holds::Nothing(motions) => return Ok(Balance::NotHeld(motions)),
        }
        if are_all_forces_known(newton.trial.world) {
            newton.unresisted = Unresisted::of(&motions);
        }
        let found = newton.solve();
        let rest = match &found {
            // along a motion that nothing holds there is no resistance either
            Ok(Found { solved: true, remaining, .. }) => {
                let unstable = shares[1] == 1.0 && motions.is_empty() && newton.gives_way()?;
                Some(Balance::Found { remaining: *remaining, unstable })
            }
            _ => None,
        };
        let mut trial = newton.trial;
        iterations.count(trial.count);
        found?;
        let Some(rest) = rest else { return Ok(Balance::NotFound) };
        let Iterations { settings, motion, space: Workspace { correction, net, .. }, .. } = &mut *iterations;
        let place = Place { formula: &settings.formula, h: 1.0, motion, correction, beyond: None };
        match trial.looks_at_steps() {
            true => trial.noted_forces(&place, net)?,
            false => trial.forces(&place, net)?,
        };
        grasped.note(trial.world, &place, net, None);
        grasped.load(trial.world);
        place.arrive(axes, trial.world);
        Ok(rest)
    }
}

/// What Newton's iterations begin with, where bodies stand, while loads and motions go from one share of what they are
/// at a time (s) to another: with what holds nodes, and what touches.
fn prepared<'a, 'w>(
    iterations: &'a mut Iterations,
    mut trial: Trial<'w>,
    (end, shares): (f64, [f64; 2]),
) -> Result<(Newton<'a, 'w>, Grasped), Lost> {
    let Iterations { motion, space, .. } = &mut *iterations;
    trial.axes.read(trial.world, motion);
    trial.world.resource_mut::<Signals>().approach(end, shares);
    trial.boundary()?;
    Springs::seek(trial.world)?;
    super::step::held_axes(trial.world, trial.axes, motion, &mut space.to_go);
    let grasped = Grasped::hold(trial.world, trial.axes, motion, &mut space.to_go);
    begin(space, motion);
    Ok((iterations.newton(trial, 1.0), grasped))
}

/// Begins where bodies stand, without inertia.
fn begin(space: &mut Workspace, motion: &mut Motion) {
    motion.rate = 0.0;
    space.begin();
}

/// That a path was not followed to its end.
fn not_followed(world: &mut World, what: String) -> Error {
    world.resource_scope(|world, observer: Mut<Observer>| {
        // there is no step that could be shorter
        observer.unsolved(world, (what, false), Criterion { value: None, ..Criterion::of("equilibrium") })
    })
}

/// That what was found does not last.
pub(in crate::simulation) fn warn_of_instability(world: &mut World) {
    let clock = *world.resource::<Clock>();
    let Some(mut memory) = world.get_resource_mut::<GuardMemory>() else { return };
    memory.warnings.push(Notice {
        criterion: "equilibrium".into(),
        part: String::new(),
        time: clock.time(),
        step: clock.step,
        value: 0.0,
        limit: 0.0,
        message:
            "the equilibrium does not last: there is a motion that bodies do not resist but give way to, as a column \
                  that is about to buckle. What is small and breaks the symmetry, a load across or a motion in time, \
                  leads to the one that lasts"
                .into(),
    });
}

/// What came of a search for rest at a share of all loads.
enum Balance {
    Found {
        remaining: f64,
        unstable: bool,
    },
    NotFound,
    /// What may hold bodies does not touch them yet.
    Loose,
    NotHeld(Vec<String>),
}

/// What there is against rigid motions that loads do work along.
enum Holds {
    /// No load does, or springs resist.
    Enough,
    /// Something that does not touch yet may.
    Perhaps,
    /// Nothing: the motions, in words.
    Nothing(Vec<String>),
}

/// Whether all forces on nodes are known beforehand: those of systems of one's own may hold nodes elsewhere.
fn are_all_forces_known(world: &World) -> bool {
    world.get_resource::<Keeping>().is_none_or(|keeping| keeping.written.is_empty())
}

/// What holds rigid motions that no constraint does, where all forces on nodes are known beforehand.
fn holds(motions: &[FreeMotion], newton: &mut Newton<'_, '_>) -> Result<Holds, Error> {
    if motions.is_empty() || !are_all_forces_known(newton.trial.world) {
        return Ok(Holds::Enough);
    }
    newton.forces_at_w()?;
    let (loads, springs) = (&newton.space.net, &*newton.trial.springs);
    let is_unbalanced = |motion: &&FreeMotion| {
        let (sum, size) = motion.work(loads);
        sum.abs() > UNBALANCED * size
    };
    let is_loose = |motion: &&FreeMotion| !motion.is_tied && !springs.resist(&motion.axes(loads.len()));
    let loose: Vec<&FreeMotion> = motions.iter().filter(is_unbalanced).filter(is_loose).collect();
    if loose.is_empty() {
        return Ok(Holds::Enough);
    }
    if loose.iter().any(|motion| motion.may_touch) {
        return Ok(Holds::Perhaps);
    }
    Ok(Holds::Nothing(loose.iter().map(|motion| motion.to_string()).collect()))
}
