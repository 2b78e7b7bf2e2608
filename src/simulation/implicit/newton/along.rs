//! Along a path of equilibria, whose load factor is an unknown, too: arc length (Crisfield 1981).
//!
//! With u the free axes, ℓ the factor of all loads and prescribed motions, K the tangent and g(u, ℓ) the residual, an
//! iteration is δu = p_g + δℓ p_ℓ, K p_g = −g, K p_ℓ = −∂g/∂ℓ, and ‖Δu‖ = Δs over the step says how large δℓ is
//! (the cylindrical form: ℓ is no part of the length). Of its two roots it is the one that turns less. Beyond a limit
//! point K is not positive, so that the solves are those of minimal residuals.

use super::super::minimal_residual::{self as minres, Vectors};
use super::super::place::Place;
use super::super::step::held_axes;
use super::super::vectors::{copy, update};
use super::{Lost, MOST_PRODUCTS, Newton, ROUNDING_FROM, Stop, difference, fill_with_signs};
use crate::components::{Reals, Signals};
use crate::error::Error;
use crate::scene::schema::ArcLength;
use bevy_ecs::prelude::World;
use serde::Serialize;

/// Iterations of a step at most; a step that takes `USUAL` stays as long as it is.
const MOST_ITERATIONS: u64 = 12;
const USUAL: f64 = 4.0;
/// How much longer or shorter the next step may be.
const CHANGE: [f64; 2] = [0.5, 2.0];
/// The shortest step, as a share of the first.
const SHORTEST: f64 = 1e-6;
/// By how much the factor is changed to see what it does, in f32 and in f64.
const DIFFERENCE: [f64; 2] = [1e-3, 1e-6];
/// What solves leave of their residuals: of a way, and of the search for a motion without resistance.
const LEFT: f64 = 1e-3;
/// How far the last step, to the factor itself, may lead, in lengths of a step: what leads farther is elsewhere.
const NEAR: f64 = 1.5;

/// A point of a path of equilibria.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct PathPoint {
    /// What all loads and prescribed motions are multiplied with.
    pub load_factor: f64,
    /// How far free axes have gone in the step (m), root mean square over nodes.
    pub length: f64,
    /// Whether bodies give way along some motion: the tangent stiffness has a negative eigenvalue.
    pub unstable: bool,
    /// Newton's iterations that led there.
    pub iterations: u64,
}

/// What keeps a step from going anywhere.
#[derive(Clone, Copy, Debug)]
enum Constraint {
    /// ‖Δu‖ (m).
    Length(f64),
    /// The load factor.
    Factor(f64),
}

/// What a path is followed with.
struct Follower {
    /// The time whose loads are the whole (s).
    end: f64,
    factor: f64,
    /// −∂g/∂ℓ (N), p_ℓ and p_g (m).
    slope: Reals,
    of_factor: Reals,
    of_residual: Reals,
    vectors: Vectors,
}

impl Newton<'_, '_> {
    /// Follows the path from no load to all of it, or as many points of it as are wanted. The columns of forces are
    /// those of a point where `at` is called with it, and of the last one in the end.
    pub fn follow_path(
        &mut self,
        end: f64,
        arc: &ArcLength,
        mut at: impl FnMut(&mut World, usize, &PathPoint) -> Result<(), Error>,
    ) -> Result<Vec<PathPoint>, Lost> {
        let axes = self.trial.axes;
        let zeros = || axes.zeros();
        let (mut points, mut way, mut tangent, mut from) = (Vec::<PathPoint>::new(), zeros(), zeros(), zeros());
        let (slope, of_factor, of_residual) = (zeros(), zeros(), zeros());
        let mut path = Follower { end, factor: 0.0, slope, of_factor, of_residual, vectors: Vectors::of(axes) };
        let nodes = (self.motion.free.iter().filter(|&&free| free).count().max(1) as f64 / 3.0).sqrt();
        let longest = arc.longest.map_or(f64::INFINITY, |longest| longest * nodes);
        copy(&mut from, &self.space.correction);
        self.correct(&mut path, Constraint::Factor(0.0), &from)?;
        let (mut first, mut length) = (0.0, 0.0);
        while points.len() < arc.points as usize && path.factor != 1.0 {
            let factor = path.factor;
            copy(&mut from, &self.space.correction);
            self.find_slope(&mut path)?;
            copy(&mut tangent, &path.of_factor);
            let size = self.sums.norm(&tangent);
            if size == 0.0 {
                return Err(Lost::Because("loads and motions change nothing along the path".into()));
            }
            if points.is_empty() {
                first = arc.first * size;
                length = first.min(longest);
            }
            let ahead = if self.sums.dot(&way, &tangent) < 0.0 { -1.0 } else { 1.0 };
            let iterations = loop {
                match self.advance(&mut path, (&from, &tangent), (length, ahead * length / size)) {
                    Ok(iterations) => break iterations,
                    Err(Lost::Error(error)) => return Err(Lost::Error(error)),
                    Err(Lost::Because(_)) if length > SHORTEST * first => {}
                    Err(Lost::Because(why)) => {
                        let point = points.len();
                        let what =
                            format!("no more of the path beyond load factor {factor:.4}, its point {point}: {why}");
                        return Err(Lost::Because(what));
                    }
                }
                path.factor = factor;
                length *= CHANGE[0];
            };
            update(&mut way, |axis, _| self.went(axis, &from));
            let unstable = self.gives_way_along(&mut path)?;
            self.forces_at_w()?;
            let went = self.sums.norm(&way) / nodes;
            let point = PathPoint { load_factor: path.factor, length: went, unstable, iterations };
            points.push(point);
            at(self.trial.world, points.len(), &point)?;
            length *= (USUAL / iterations.max(1) as f64).sqrt().clamp(CHANGE[0], CHANGE[1]);
            length = length.min(longest);
        }
        Ok(points)
    }

    /// Takes a step of a length (m) from a point along its tangent, the factor ahead by so much at first; gives its
    /// iterations.
    fn advance(
        &mut self,
        path: &mut Follower,
        (from, tangent): (&Reals, &Reals),
        (length, ahead): (f64, f64),
    ) -> Result<u64, Lost> {
        let factor = path.factor;
        let left = 1.0 - factor;
        let goes = |newton: &mut Self, path: &mut Follower, by: f64, constraint: Constraint| {
            update(&mut newton.space.correction, |axis, _| from.get(axis) + by * tangent.get(axis));
            path.factor = factor + by;
            newton.correct(path, constraint, from)
        };
        if left > 0.0 && ahead >= left {
            match goes(self, path, left, Constraint::Factor(1.0)) {
                Ok(iterations) if self.distance(from) <= NEAR * length => return Ok(iterations),
                Err(Lost::Error(error)) => return Err(Lost::Error(error)),
                // what leads farther, or nowhere, has a limit point on its way
                _ => {}
            }
        }
        let iterations = goes(self, path, ahead, Constraint::Length(length))?;
        if left > 0.0 && path.factor > 1.0 {
            // it passes the whole load on its way
            let share = left / (path.factor - factor);
            let beyond = self.distance(from);
            update(&mut self.space.correction, |axis, w| from.get(axis) + share * (w - from.get(axis)));
            path.factor = 1.0;
            let more = self.correct(path, Constraint::Factor(1.0), from)?;
            if self.distance(from) > beyond {
                return Err(Lost::Because("the whole load is elsewhere".into()));
            }
            return Ok(iterations + more);
        }
        Ok(iterations)
    }

    /// How far free axes are from others (m), a norm.
    fn distance(&self, from: &Reals) -> f64 {
        (0..from.len()).map(|axis| self.went(axis, from).powi(2)).sum::<f64>().sqrt()
    }

    /// How far an axis has gone from there (m); 0 where it is not free.
    fn went(&self, axis: usize, from: &Reals) -> f64 {
        if self.motion.free[axis] { self.space.correction.get(axis) - from.get(axis) } else { 0.0 }
    }

    /// Newton's iterations under a constraint, from w and a factor, of a step that began elsewhere.
    fn correct(&mut self, path: &mut Follower, constraint: Constraint, from: &Reals) -> Result<u64, Lost> {
        let mut floor = 0.0;
        for iteration in 0..=MOST_ITERATIONS {
            self.put(path)?;
            let tried = self.forces_at_w()?;
            if !tried.sound || !path.factor.is_finite() {
                break;
            }
            let size = self.residual();
            if iteration == u64::from(ROUNDING_FROM) {
                floor = self.rounding()?;
                self.forces_at_w()?;
            }
            if size <= (self.settings.tolerance * self.scale(&tried)).max(floor) {
                return Ok(iteration);
            }
            if iteration == MOST_ITERATIONS || !size.is_finite() {
                break;
            }
            let mut right = self.space.residual.clone();
            update(&mut right, |_, g| -g);
            self.minimal_residual(&right, &mut path.of_residual, &mut path.vectors)?;
            let by = match constraint {
                Constraint::Factor(factor) => factor - path.factor,
                Constraint::Length(length) => {
                    self.find_slope(path)?;
                    self.least_turn(path, from, length)?
                }
            };
            for axis in (0..from.len()).filter(|&axis| self.motion.free[axis]) {
                let by = path.of_residual.get(axis) + by * path.of_factor.get(axis);
                self.space.correction.set(axis, self.space.correction.get(axis) + by);
            }
            path.factor += by;
            self.report.newton_iterations += 1;
        }
        Err(Lost::Because("a point of the path was not found".into()))
    }

    /// δℓ of the equation of length, ‖Δu + p_g + δℓ p_ℓ‖ = Δs: the root whose way turns less from that so far.
    fn least_turn(&self, path: &Follower, from: &Reals, length: f64) -> Result<f64, Lost> {
        let (p, q) = (&path.of_factor, &path.of_residual);
        let (mut a, mut b, mut c, mut along) = (0.0, 0.0, -length * length, 0.0);
        for axis in (0..from.len()).filter(|&axis| self.motion.free[axis]) {
            let (so_far, p) = (self.went(axis, from), p.get(axis));
            let after = so_far + q.get(axis);
            a += p * p;
            b += p * after;
            c += after * after;
            along += so_far * p;
        }
        let root = (b * b - a * c).sqrt();
        // what is no number is no root
        if root.is_nan() || a == 0.0 {
            return Err(Lost::Because("no point of the path is that far away".into()));
        }
        Ok(if along >= 0.0 { (root - b) / a } else { (-root - b) / a })
    }

    /// Puts held axes where they are at the factor, and loads with them.
    fn put(&mut self, path: &Follower) -> Result<(), Error> {
        let Self { trial, settings, h, motion, space, .. } = self;
        let correction = &space.correction;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        place.displace(trial.axes, trial.world);
        self.trial.world.resource_mut::<Signals>().approach(path.end, [path.factor; 2]);
        self.trial.boundary()?;
        let super::Workspace { correction, to_go, .. } = &mut *self.space;
        held_axes(self.trial.world, self.trial.axes, self.motion, to_go);
        to_go.add(1.0, correction);
        to_go.clear();
        Ok(())
    }

    /// −∂g/∂ℓ, loads and the motion of held axes together, and p_ℓ with it. The forces at w must be known.
    fn find_slope(&mut self, path: &mut Follower) -> Result<(), Lost> {
        let (here, factor) = (self.space.correction.clone(), path.factor);
        let by = DIFFERENCE[usize::from(self.is_f64())];
        path.factor += by;
        self.put(path)?;
        let Self { trial, settings, h, motion, space, .. } = self;
        let super::Workspace { correction, net, .. } = &mut **space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        trial.forces(&place, &mut path.slope)?;
        let free = |axis: usize| motion.free[axis];
        update(&mut path.slope, |axis, there| if free(axis) { (net.get(axis) - there) / by } else { 0.0 });
        copy(&mut space.correction, &here);
        path.factor = factor;
        self.put(path)?;
        let Follower { slope, of_factor, vectors, .. } = path;
        self.minimal_residual(slope, of_factor, vectors).map(|_| ())
    }

    /// Whether bodies do not resist some motion at w. The forces there must be known.
    fn gives_way_along(&mut self, path: &mut Follower) -> Result<bool, Lost> {
        let mut signs = self.trial.axes.zeros();
        fill_with_signs(&mut signs, &self.motion.free);
        Ok(self.minimal_residual(&signs, &mut path.of_residual, &mut path.vectors)?.gives_way)
    }

    /// x ≈ K⁻¹ b on free axes. The forces at w must be known.
    fn minimal_residual(&mut self, b: &Reals, x: &mut Reals, vectors: &mut Vectors) -> Result<minres::Solved, Lost> {
        self.follow();
        let Self { trial, settings, motion, space, preconditioner, report, sums, h, .. } = self;
        let super::Workspace { correction, net, .. } = &**space;
        let place = Place { formula: &settings.formula, h: *h, motion, correction, beyond: None };
        let times = |x: &Reals, image: &mut Reals| -> Result<(), Error> {
            difference(trial, &place, net, x, image)?;
            update(image, |axis, force| if motion.free[axis] { force } else { 0.0 });
            Ok(())
        };
        let stop = Stop { tolerance: LEFT, most: MOST_PRODUCTS };
        let solved = minres::solve(sums, b, x, vectors, &mut **preconditioner, stop, times)?;
        report.linear_iterations += solved.iterations;
        report.negative_curvatures += u64::from(solved.gives_way);
        match (0..x.len()).all(|axis| x.get(axis).is_finite()) {
            true => Ok(solved),
            false => Err(Lost::Because("forces near the present state are no numbers".into())),
        }
    }
}
