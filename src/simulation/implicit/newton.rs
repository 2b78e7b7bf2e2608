//! Newton's iterations of a step: inexact solves (Eisenstat & Walker 1996), a line search on the work of the residual
//! along the way (Matthies & Strang 1979).

mod along;
mod rounding;
mod search;

pub use along::PathPoint;

use super::axes::{Axes, Motion};
use super::conjugate_gradients::{Ended, Solved, Stop, Vectors, solve};
use super::device::{self, LinearSystem, OnDevice};
use super::differences::difference;
use super::equation::Before;
use super::forces_before::ForcesBefore;
use super::formula::Formula;
use super::free_motions::Unresisted;
use super::place::Place;
use super::preconditioner::{Operator, Preconditioner};
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::sums::Sums;
use super::to_go::ToGo;
use super::trial::{Trial, Tried};
use super::vectors::{clear, update};
use crate::components::{Precision, Reals};
use crate::error::Error;

/// Of a linear system the residual that is left, at most and at least.
const FORCING: [f64; 2] = [0.1, 0.01];
/// What the work of the residual along a direction must fall to where all of the direction is gone.
const DESCENT: f64 = 0.9;
/// Newton iterations after which a step may end where rounding keeps it from the tolerance.
const ROUNDING_FROM: u32 = 3;
/// Newton iterations at least in which prescribed motion may arrive, where the line search holds it back.
const MOST_MOVES: u32 = 20;
/// Passes of an iteration at least: a product and a look where it leads; where something is moved as told one more.
const ITERATION: u64 = 2;
/// What a solve that looks for a motion without resistance leaves of the residual.
const THOROUGH: f64 = 1e-4;
/// How many times the residual that a step begins with it may leave when its iterations are over, if nobody has said
/// that it is to end after so many passes. What is warned of is a twentieth of that; beyond, forces and places have
/// nothing to do with each other.
const DIVERGED: f64 = 10.0;
/// Of all forces the share that may be left where iterations leave more of the residual than there was when they began:
/// what they have found is worse than where nobody had looked for anything. A tenth is a hundred times the usual
/// tolerance, and forces that are off by so much do work that is off by as much as guards let the energy of implicit
/// steps be.
const WORSE: f64 = 0.1;
/// Iterations of a linear solve without a budget.
const MOST_PRODUCTS: u64 = 5000;

/// When a step counts as solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    pub formula: Formula,
    pub newton: u32,
    pub tolerance: f64,
    pub budget: Option<u64>,
}

/// Why a step was not found.
pub(super) enum Lost {
    /// In words.
    Because(String),
    Error(Error),
}

impl From<Error> for Lost {
    fn from(error: Error) -> Self {
        Lost::Error(error)
    }
}

/// The way of a Newton step.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// p·b (J).
    along: f64,
    /// Whether p is no solution but the direction of a first iteration, along which bodies do not resist.
    gives_way: bool,
}

/// How far Newton's iterations came.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    /// What is left of the first residual, as a share of it; 0 within the tolerance.
    pub left: f64,
    /// Whether that is within the tolerance, or what rounding makes.
    pub solved: bool,
    /// About how far axes still have to go (m), a norm.
    pub remaining: f64,
}

/// Vectors over all axes that Newton's iterations work with.
pub(super) struct Workspace {
    /// w − y (m): where axes are at the end, w, from where their velocity leads, y = u + h v.
    pub correction: Reals,
    /// How far held axes still have to go (m).
    pub to_go: ToGo,
    /// F − R at w (N).
    pub net: Reals,
    /// The residual g at w (N). A solve begins with the right-hand side in its place, and leaves what it leaves.
    residual: Reals,
    /// The way of an iteration (m).
    p: Reals,
    vectors: Vectors,
}

impl Workspace {
    /// Of all axes.
    pub fn of(axes: &Axes) -> Self {
        let to_go = ToGo::nowhere(axes.precision());
        let [correction, net, residual, p, direction, image] = [(); 6].map(|()| axes.zeros());
        Self { correction, to_go, net, residual, p, vectors: Vectors { direction, image } }
    }

    /// Bytes of all vectors.
    pub fn bytes(&self) -> usize {
        let Self { correction, to_go, net, residual, p, vectors: Vectors { direction, image } } = self;
        let all = [correction, net, residual, p, direction, image];
        to_go.bytes() + all.into_iter().map(|vector| vector.bytes().len()).sum::<usize>()
    }

    /// Begins at y.
    pub fn begin(&mut self) {
        clear(&mut self.correction);
    }
}

/// Ones with signs that no motion knows of, on free axes.
fn fill_with_signs(vector: &mut Reals, free: &[bool]) {
    let sign = |axis: usize| if (axis.wrapping_mul(0x9e37_79b9) >> 7) & 1 == 0 { 1.0 } else { -1.0 };
    update(vector, |axis, _| if free[axis] { sign(axis) } else { 0.0 });
}

/// One step's system.
pub(super) struct Newton<'a, 'w> {
    pub trial: Trial<'w>,
    pub settings: Settings,
    pub motion: &'a Motion,
    /// Forces at the beginning of the step.
    pub before: &'a ForcesBefore,
    pub space: &'a mut Workspace,
    pub preconditioner: &'a mut dyn Preconditioner,
    pub report: &'a mut ImplicitSteps,
    pub sums: &'a Sums,
    pub on_device: &'a mut Option<OnDevice>,
    /// The length of the step (s); 1 in statics, where nothing has a velocity.
    pub h: f64,
    /// Whether forces on the way were no numbers, or elements turned inside out.
    pub beyond: bool,
    /// How far axes may go in an iteration (m), where who meets whom is looked for in each of them; at rest.
    pub farthest: Option<f64>,
    /// Motions that may have no resistance, along which no iteration goes then; at rest.
    pub unresisted: Unresisted,
}

impl Newton<'_, '_> {
    /// Solves for the places at the end of the step, from those in the workspace. The columns of forces are those there
    /// then.
    pub fn solve(&mut self) -> Result<Found, Lost> {
        let mut tried = self.forces_at_w()?;
        if !tried.sound {
            // what flies on may turn elements inside out that forces would have kept
            let (h, motion) = (self.h, self.motion);
            let back = |axis: usize| if motion.free[axis] { -h * motion.velocity(axis) } else { 0.0 };
            update(&mut self.space.correction, |axis, _| back(axis));
            tried = self.forces_at_w()?;
        }
        if !tried.sound {
            return Err(Lost::Because("forces at the beginning of the step are no numbers".into()));
        }
        let mut size = self.residual();
        let mut first = size;
        let mut before = size;
        let (mut floor, mut iterations, mut remaining) = (0.0, 0, f64::INFINITY);
        loop {
            if iterations > 0 && self.farthest.is_some() && Springs::seek(self.trial.world)? {
                tried = self.forces_at_w()?;
                size = self.residual();
            }
            let scale = self.scale(&tried);
            let enough = self.settings.tolerance * scale;
            if iterations == ROUNDING_FROM && self.left() > 0 {
                floor = self.rounding()?;
            }
            let enough = enough.max(floor);
            // a step that begins within the tolerance, as at rest, leaves all of next to nothing
            let begun = if first > enough { first } else { first.max(scale) };
            let moves = self.space.to_go.moves();
            // the linearised step takes its one solve wherever it begins
            let taken = self.settings.newton > 1 || iterations > 0 || size == 0.0;
            let solved = taken && size <= enough && !moves;
            let ends = iterations >= self.settings.newton && !moves || self.left() < ITERATION + u64::from(moves);
            let worse = self.settings.newton > 1 && size > first && size > WORSE * scale;
            let diverged = !solved && ends && (worse || size > DIVERGED * first);
            if diverged && self.settings.budget.is_none() && !self.settings.formula.is_of_rest() {
                return Err(Lost::Because(format!(
                    "after {iterations} Newton iterations {:.1} times the residual of their beginning is left, {size:.3e} N{}",
                    size / first,
                    self.what_is_beyond()
                )));
            }
            if solved || ends {
                return Ok(self.left_of((size, begun), solved, remaining));
            }
            if iterations >= self.settings.newton.max(MOST_MOVES) {
                return Err(Lost::Because(format!(
                    "what is moved as told is not where it should be after {iterations} Newton iterations{}",
                    self.what_is_beyond()
                )));
            }
            let forcing = match (self.settings.newton, iterations) {
                (1, _) => self.settings.tolerance,
                (_, 0) => FORCING[0],
                _ => (DESCENT * (size / before).powi(2)).clamp(FORCING[1], FORCING[0]),
            };
            let needed = if self.settings.newton > 1 { 0.5 * enough / size } else { 0.0 };
            self.set_right(moves)?;
            if iterations == 0 && moves {
                // what is moved as told may begin at rest: the residual of its way counts with that of where it was
                first = first.max(self.sums.norm(&self.space.residual));
            }
            let way = self.solve_linear(forcing.max(needed).min(0.5))?;
            before = size;
            tried = match self.search(way, &mut size, enough) {
                Err(Lost::Because(_)) if !moves && self.is_rounding(size)? => {
                    return Ok(self.left_of((size, begun), true, remaining));
                }
                found => found?,
            };
            remaining = self.sums.norm(&self.space.p) * size / before;
            iterations += 1;
        }
    }

    fn what_is_beyond(&self) -> &'static str {
        if self.beyond { ": farther on forces are no numbers, or elements are turned inside out" } else { "" }
    }

    /// w.
    fn place(&self) -> Place<'_> {
        let Self { settings, h, motion, space, .. } = self;
        Place { formula: &settings.formula, h: *h, motion, correction: &space.correction, beyond: None }
    }

    /// Passes that the step may still take.
    fn left(&self) -> u64 {
        self.settings.budget.map_or(u64::MAX, |budget| budget.saturating_sub(self.trial.count))
    }

    pub fn forces_at_w(&mut self) -> Result<Tried, Error> {
        let Self { trial, settings, h, motion, space, .. } = self;
        let Workspace { correction, net, .. } = &mut **space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        let sound = trial.forces(&place, net)?;
        trial.elsewhere = false;
        Ok(trial.judge(sound, motion, net))
    }

    /// g at w, from the forces there; its norm (N).
    fn residual(&mut self) -> f64 {
        let Self { trial, settings, h, motion, before: forces, space, sums, .. } = self;
        let Workspace { correction, net, residual, .. } = &mut **space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        place.fill_residual(net, &Before { axes: trial.axes, world: trial.world, forces }, residual);
        trial.springs.press(settings.formula.stiffness(), &motion.free, residual);
        sums.norm(residual)
    }

    /// What the residual is compared with (N): loads, reactions and inertia.
    fn scale(&self, tried: &Tried) -> f64 {
        let before = Before { axes: self.trial.axes, world: self.trial.world, forces: self.before };
        tried.loads.sqrt() + tried.reactions.sqrt() + self.place().inertial_forces(&before)
    }

    /// Notes how a step ends, and gives what is left of the residual that it began with (N).
    fn left_of(&mut self, (size, begun): (f64, f64), solved: bool, remaining: f64) -> Found {
        let left = if begun > 0.0 && !solved { size / begun } else { 0.0 };
        self.report.unsolved += u64::from(!solved && self.settings.newton > 1);
        self.report.largest_residual_left = self.report.largest_residual_left.max(left);
        Found { left, solved, remaining: if size > 0.0 { remaining } else { 0.0 } }
    }

    fn is_f64(&self) -> bool {
        self.trial.axes.precision() == Precision::F64
    }

    /// Whether bodies at w do not resist some motion: a solve meets it, whose right-hand side has a part of every one.
    /// In f32, where differences of forces are not sharp enough, it is not asked for, and where no axis is free there
    /// is none. The forces at w must be known.
    pub fn gives_way(&mut self) -> Result<bool, Lost> {
        if !self.is_f64() || !self.motion.free.contains(&true) {
            return Ok(false);
        }
        fill_with_signs(&mut self.space.residual, &self.motion.free);
        let Solved { ended, .. } = self.conjugate_gradients(THOROUGH)?;
        Ok(ended == Ended::NegativeCurvature)
    }

    /// Puts b = −g − K_fc p_c in the place of g, with what held axes still have to go if they move.
    fn set_right(&mut self, moves: bool) -> Result<(), Error> {
        let Self { trial, settings, h, motion, space, .. } = self;
        let Workspace { correction, net, to_go, residual, p, vectors: Vectors { image, .. } } = &mut **space;
        // it is 0 where axes are not free
        update(residual, |_, g| -g);
        if moves {
            let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
            to_go.put(p);
            difference(trial, &place, net, p, image)?;
            update(residual, |axis, b| if motion.free[axis] { b - image.get(axis) } else { 0.0 });
        }
        Ok(())
    }

    /// p ≈ A⁻¹ b on free axes.
    fn solve_linear(&mut self, tolerance: f64) -> Result<Way, Lost> {
        let Self { trial, motion, space, unresisted, .. } = self;
        let fields = unresisted.fields(&space.correction, (&space.net, &motion.free), trial.springs);
        fields.iter().for_each(|field| field.take_out_of_forces(&mut space.residual, &motion.free));
        let Solved { ended, iterations, along } = self.conjugate_gradients(tolerance)?;
        // what goes with held axes is no motion that nothing resists
        let Workspace { to_go, p, .. } = &mut *self.space;
        to_go.add(1.0, p);
        fields.iter().for_each(|field| field.take_out_of_way(p));
        to_go.add(-1.0, p);
        self.report.newton_iterations += 1;
        self.report.negative_curvatures += u64::from(ended == Ended::NegativeCurvature);
        if ended == Ended::NotFinite || !along.is_finite() {
            return Err(Lost::Because("forces near the present state are no numbers".into()));
        }
        Ok(Way { along, gives_way: ended == Ended::NegativeCurvature && iterations == 1 })
    }

    /// Of the right-hand side that is in the place of the residual.
    fn conjugate_gradients(&mut self, tolerance: f64) -> Result<Solved, Error> {
        self.follow();
        let Self { trial, settings, motion, space, preconditioner, report, sums, on_device, h, .. } = self;
        let most = settings.budget.map_or(MOST_PRODUCTS, |budget| budget.saturating_sub(trial.count + 1).max(1));
        let Workspace { correction, net, residual: right, p, vectors, .. } = &mut **space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        if trial.is_on_device() {
            let system = LinearSystem { place, right, net, preconditioner: &**preconditioner };
            let solved = device::solve(on_device, trial, &system, sums, p, Stop { tolerance, most })?;
            report.linear_iterations += solved.iterations;
            return Ok(solved);
        }
        let inertia = motion.inertia(&settings.formula, *h);
        let times = |x: &Reals, image: &mut Reals| -> Result<(), Error> {
            difference(trial, &place, net, x, image)?;
            inertia.add_product(x, &motion.free, image);
            Ok(())
        };
        let solved = solve(sums, right, p, vectors, &mut **preconditioner, Stop { tolerance, most }, times)?;
        report.linear_iterations += solved.iterations;
        Ok(solved)
    }

    fn follow(&mut self) {
        // the world is where the residual was taken
        let Self { trial, settings, motion, space, preconditioner, h, .. } = self;
        let formula = &settings.formula;
        let place = Place { formula, h: *h, motion, correction: &space.correction, beyond: None };
        place.displace(trial.axes, trial.world);
        let springs = trial.springs.slopes(formula);
        preconditioner.follow(&Operator {
            world: trial.world,
            bodies: &trial.axes.bodies,
            free: &motion.free,
            inertia: motion.inertia(formula, *h),
            stiffness: formula.stiffness(),
            springs: &springs,
        });
    }
}
