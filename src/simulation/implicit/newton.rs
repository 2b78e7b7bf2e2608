//! Newton's iterations of a step: inexact solves (Eisenstat & Walker 1996), a line search on the work of the residual
//! along the way (Matthies & Strang 1979).

mod along;
mod search;

pub use along::PathPoint;

use super::axes::Motion;
use super::conjugate_gradients::{Ended, Solved, Stop, Vectors, solve};
use super::device::{self, LinearSystem, OnDevice};
use super::differences::{difference, steps_to};
use super::formula::Formula;
use super::preconditioner::{Operator, Preconditioner};
use super::report::ImplicitSteps;
use super::springs::Springs;
use super::sums::Sums;
use super::trial::{Trial, Tried};
use crate::components::{Displacement, Precision};
use crate::error::Error;

/// Of a linear system the residual that is left, at most and at least.
const FORCING: [f64; 2] = [0.1, 0.01];
/// What the work of the residual along a direction must fall to where all of the direction is gone.
const DESCENT: f64 = 0.9;
/// Newton iterations after which a step may end where rounding keeps it from the tolerance.
const ROUNDING_FROM: u32 = 3;
/// Newton iterations at least in which prescribed motion may arrive, where the line search holds it back.
const MOST_MOVES: u32 = 20;
/// What a solve that looks for a motion without resistance leaves of the residual.
const THOROUGH: f64 = 1e-4;
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
#[derive(Default)]
pub(super) struct Workspace {
    /// D of nodes.
    pub inertia: Vec<f64>,
    /// The equation without D (w − y) and without the forces at the end (N), y = u + h v.
    pub constant: Vec<f64>,
    /// Where axes are at the end (m), and how far held axes still have to go (m); empty where none has.
    pub w: Vec<f64>,
    pub to_go: Vec<f64>,
    /// F − R at w (N).
    pub net: Vec<f64>,
    /// The residual g (N) at w; of a step that is found the acceleration at its end (m/s²).
    pub g: Vec<f64>,
    /// The right-hand side of a linear system (N), where that is not −g.
    right: Vec<f64>,
    /// The way of an iteration (m); of a step that is found h v at its end (m).
    pub p: Vec<f64>,
    /// Where a product looks, and where a line search began (m).
    elsewhere: Vec<f64>,
    /// Where loads look at them, displacements in a step (m).
    pub steps: Vec<f64>,
    vectors: Vectors,
}

impl Workspace {
    /// Bytes of all vectors, those of conjugate gradients with them.
    pub fn bytes(&self) -> usize {
        let Self { inertia, constant, w, to_go, net, g, right, p, elsewhere, steps, vectors } = self;
        let own = [inertia, constant, w, to_go, net, g, right, p, elsewhere, steps];
        own.into_iter().map(|vector| size_of_val(&vector[..])).sum::<usize>() + vectors.bytes()
    }

    pub fn resize(&mut self, length: usize) {
        let Self { inertia, constant, w, net, g, p, elsewhere, vectors, .. } = self;
        inertia.resize(length / 3, 0.0);
        for vector in [constant, w, net, g, p, elsewhere] {
            vector.resize(length, 0.0);
        }
        vectors.resize(length);
    }
}

/// One step's system.
pub(super) struct Newton<'a, 'w> {
    pub trial: Trial<'w>,
    pub settings: Settings,
    pub motion: &'a Motion,
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
}

impl Newton<'_, '_> {
    /// Solves for the places at the end of the step, from those in the workspace. The columns of forces are those there
    /// then.
    pub fn solve(&mut self) -> Result<Found, Lost> {
        let mut tried = self.forces_at_w()?;
        if !tried.sound {
            // what flies on may turn elements inside out that forces would have kept
            self.space.w.copy_from_slice(&self.motion.u);
            tried = self.forces_at_w()?;
        }
        if !tried.sound {
            return Err(Lost::Because("forces at the beginning of the step are no numbers".into()));
        }
        let mut size = self.residual();
        let first = size;
        let mut before = size;
        let (mut floor, mut iterations, mut remaining) = (0.0, 0, f64::INFINITY);
        loop {
            if iterations > 0 && self.farthest.is_some() && Springs::seek(self.trial.world)? {
                tried = self.forces_at_w()?;
                size = self.residual();
            }
            let enough = self.settings.tolerance * self.scale(&tried);
            if iterations == ROUNDING_FROM {
                floor = self.rounding()?;
            }
            let enough = enough.max(floor);
            let moves = self.moves();
            // the linearised step takes its one solve wherever it begins
            let taken = self.settings.newton > 1 || iterations > 0 || size == 0.0;
            let solved = taken && size <= enough && !moves;
            let ends = iterations >= self.settings.newton && !moves || self.left() == 0;
            if solved || ends {
                return Ok(self.left_of([first, size], solved, remaining));
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
            let way = self.solve_linear(forcing.max(needed).min(0.5), moves)?;
            before = size;
            tried = match self.search(way, &mut size, enough) {
                Err(Lost::Because(_)) if !moves && self.is_rounding(size)? => {
                    return Ok(self.left_of([first, size], true, remaining));
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

    /// Whether held axes have not arrived yet.
    fn moves(&self) -> bool {
        self.space.to_go.iter().any(|&left| left != 0.0)
    }

    /// Passes that the step may still take.
    fn left(&self) -> u64 {
        self.settings.budget.map_or(u64::MAX, |budget| budget.saturating_sub(self.trial.count))
    }

    pub fn forces_at_w(&mut self) -> Result<Tried, Error> {
        let Workspace { w, net, steps, .. } = &mut *self.space;
        let at = steps_to(&self.settings.formula, self.h, self.motion, w, steps, &self.trial);
        let sound = self.trial.forces(w, at, net)?;
        self.trial.elsewhere = false;
        Ok(self.trial.judge(sound, &self.motion.free, &self.motion.held, net))
    }

    /// g at w, from the forces there; its norm (N).
    fn residual(&mut self) -> f64 {
        let Workspace { w, net, g, constant, inertia, .. } = &mut *self.space;
        let stiffness = self.settings.formula.stiffness();
        self.motion.fill_residual((stiffness, self.h), (w, net), (constant, inertia), g);
        self.trial.springs.press(stiffness, &self.motion.free, g);
        self.sums.norm(g)
    }

    /// What the residual is compared with (N): loads, reactions and inertia.
    fn scale(&self, tried: &Tried) -> f64 {
        let Workspace { w, constant, inertia, .. } = &*self.space;
        let inertial = |axis: usize| {
            let y = self.motion.predicted(axis, self.h);
            constant[axis] + inertia[axis / 3] * (w[axis] - y)
        };
        let free = (0..w.len()).filter(|&axis| self.motion.free[axis]);
        let of_inertia: f64 = free.map(|axis| inertial(axis).powi(2)).sum();
        tried.loads.sqrt() + tried.reactions.sqrt() + of_inertia.sqrt()
    }

    /// Notes how a step ends, and gives what is left of its residual.
    fn left_of(&mut self, [first, size]: [f64; 2], solved: bool, remaining: f64) -> Found {
        // a step that begins within the tolerance leaves all of next to nothing
        let left = if first > 0.0 && !solved { size / first } else { 0.0 };
        self.report.unsolved += u64::from(!solved && self.settings.newton > 1);
        self.report.largest_residual_left = self.report.largest_residual_left.max(left);
        Found { left, solved, remaining: if size > 0.0 { remaining } else { 0.0 } }
    }

    /// Whether a residual of such a norm at w is no more than what rounding makes.
    fn is_rounding(&mut self, size: f64) -> Result<bool, Error> {
        self.forces_at_w()?;
        Ok(size <= self.rounding()?)
    }

    /// About what rounding makes of the residual (N): of a displacement the last digit, times the norm of its row of K,
    /// which a product with signs shows, and its inertia. The forces at w must be known.
    fn rounding(&mut self) -> Result<f64, Error> {
        let signs = self.signs();
        let mut rows = vec![0.0; signs.len()];
        self.stiffness_times(&signs, &mut rows)?;
        let digit = if self.is_f64() { f64::EPSILON } else { f64::from(f32::EPSILON) };
        let Workspace { w, inertia, .. } = &*self.space;
        let free = (0..w.len()).filter(|&axis| self.motion.free[axis]);
        let square: f64 = free.map(|axis| ((rows[axis].abs() + inertia[axis / 3]) * w[axis]).powi(2)).sum();
        Ok(digit * square.sqrt())
    }

    /// A vector of ones with signs that no motion knows of, on free axes.
    fn signs(&self) -> Vec<f64> {
        let sign = |axis: usize| if (axis.wrapping_mul(0x9e37_79b9) >> 7) & 1 == 0 { 1.0 } else { -1.0 };
        (0..self.space.w.len()).map(|axis| if self.motion.free[axis] { sign(axis) } else { 0.0 }).collect()
    }

    fn is_f64(&self) -> bool {
        let body = self.trial.axes.bodies.first();
        let u = body.and_then(|&body| self.trial.world.get::<Displacement>(body));
        u.is_some_and(|u| u.precision() == Precision::F64)
    }

    /// Whether bodies at w do not resist some motion: a solve meets it, whose right-hand side has a part of every one.
    /// In f32, where differences of forces are not sharp enough, it is not asked for. The forces at w must be known.
    pub fn gives_way(&mut self) -> Result<bool, Lost> {
        if !self.is_f64() {
            return Ok(false);
        }
        self.space.right = self.signs();
        let Solved { ended, .. } = self.conjugate_gradients(THOROUGH)?;
        self.space.right = Vec::new();
        Ok(ended == Ended::NegativeCurvature)
    }

    /// c K p (N), by a difference of forces. The forces at w must be known.
    fn stiffness_times(&mut self, p: &[f64], image: &mut [f64]) -> Result<(), Error> {
        let Workspace { w, net, elsewhere, steps, .. } = &mut *self.space;
        difference(&mut self.trial, (&self.settings.formula, self.h, self.motion), (w, net), elsewhere, steps, p, image)
    }

    /// b = −g − K_fc p_c, with what held axes still have to go.
    fn set_right(&mut self) -> Result<(), Error> {
        let to_go = std::mem::take(&mut self.space.to_go);
        let mut right = std::mem::take(&mut self.space.right);
        right.resize(to_go.len(), 0.0);
        let done = self.stiffness_times(&to_go, &mut right);
        (self.space.to_go, self.space.right) = (to_go, right);
        let Workspace { right, g, .. } = &mut *self.space;
        for (axis, right) in right.iter_mut().enumerate() {
            *right = if self.motion.free[axis] { -g[axis] - *right } else { 0.0 };
        }
        done
    }

    /// −g in the place of b, or back: it is 0 where axes are not free.
    fn exchange(&mut self) {
        let Workspace { right, g, .. } = &mut *self.space;
        std::mem::swap(right, g);
        right.iter_mut().chain(g).for_each(|force| *force = -*force);
    }

    /// p ≈ A⁻¹ b on free axes; `moves`: where held axes still have to go.
    fn solve_linear(&mut self, tolerance: f64, moves: bool) -> Result<Way, Lost> {
        if moves {
            self.set_right()?
        } else {
            self.exchange()
        }
        let solved = self.conjugate_gradients(tolerance);
        let along = self.sums.dot(&self.space.p, &self.space.right);
        if !moves {
            self.exchange();
        }
        let Solved { ended, iterations } = solved?;
        self.report.newton_iterations += 1;
        self.report.negative_curvatures += u64::from(ended == Ended::NegativeCurvature);
        if ended == Ended::NotFinite || !along.is_finite() {
            return Err(Lost::Because("forces near the present state are no numbers".into()));
        }
        Ok(Way { along, gives_way: ended == Ended::NegativeCurvature && iterations == 1 })
    }

    fn conjugate_gradients(&mut self, tolerance: f64) -> Result<Solved, Error> {
        self.follow();
        let Self { trial, settings, motion, space, preconditioner, report, sums, on_device, h, .. } = self;
        let most = settings.budget.map_or(MOST_PRODUCTS, |budget| budget.saturating_sub(trial.count + 1).max(1));
        let Workspace { inertia, w, net, elsewhere, steps, right, p, vectors, .. } = &mut **space;
        let of_step = (&settings.formula, *h, *motion);
        if trial.is_on_device() {
            let system = LinearSystem {
                steps: steps_to(&settings.formula, *h, motion, w, steps, trial),
                right,
                w,
                net,
                inertia,
                free: &motion.free,
                formula: &settings.formula,
                preconditioner: &**preconditioner,
            };
            let solved = device::solve(on_device, trial, &system, sums, p, Stop { tolerance, most })?;
            report.linear_iterations += solved.iterations;
            return Ok(solved);
        }
        let times = |x: &[f64], image: &mut [f64]| -> Result<(), Error> {
            difference(trial, of_step, (w, net), elsewhere, steps, x, image)?;
            let nodes = image.as_chunks_mut::<3>().0.iter_mut().zip(x.as_chunks::<3>().0);
            for (((image, x), inertia), free) in nodes.zip(&*inertia).zip(motion.free.as_chunks::<3>().0) {
                for axis in 0..3 {
                    image[axis] = if free[axis] { image[axis] + inertia * x[axis] } else { 0.0 };
                }
            }
            Ok(())
        };
        let solved = solve(sums, right, p, vectors, &mut **preconditioner, Stop { tolerance, most }, times)?;
        report.linear_iterations += solved.iterations;
        Ok(solved)
    }

    fn follow(&mut self) {
        // the world is where the residual was taken
        self.trial.axes.displace(self.trial.world, &self.space.w);
        let formula = &self.settings.formula;
        let springs = self.trial.springs.slopes(formula);
        self.preconditioner.follow(&Operator {
            world: self.trial.world,
            bodies: &self.trial.axes.bodies,
            free: &self.motion.free,
            inertia: &self.space.inertia,
            stiffness: formula.stiffness(),
            springs: &springs,
        });
    }
}
