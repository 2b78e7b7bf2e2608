//! Steps chosen by an estimate of their error, from what a step shows of the next term of its series.
//!
//! The error of a step of h is that of displacements, e (see `local_error` of its formula). Within a frame of T, the
//! longest step, T/h such steps add up to ‖e‖ T/h, which is held below the tolerance: an error per unit of time, so
//! that the error of a motion falls in proportion to the tolerance, whatever the order. Norms are root mean squares
//! over mass. The next length is that of a proportional and integral controller (Gustafsson 1991), with η = error over
//! tolerance and p the order: h⁺ = .9 h η^(−.7/p) η₋^(.4/p), η₋ of the step before.

use super::super::run::WHOLE;
use super::axes::Axes;
use super::place::Place;
use crate::components::{Clock, RestPosition};
use crate::scene::schema::ErrorControl;
use bevy_ecs::prelude::*;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Steps are shorter than the error alone asks for, so that few of them are taken back.
const SAFETY: f64 = 0.9;
/// The exponents of the controller, over the order: of this error, and of that of the step before.
const GAINS: [f64; 2] = [0.7, 0.4];
/// From one step to the next lengths change so many times at most, down and up.
const CHANGES: [f64; 2] = [0.2, 2.0];
/// Steps grow only by more than that: another length makes preconditioners anew.
const LARGER: f64 = 1.2;
/// What is left of a step that was not found.
const CUT: f64 = 0.25;
/// The share of a frame that is the shortest step, unless the scene says otherwise.
const SHORTEST: f64 = 1e-4;
/// The least scale of errors, as a share of the extent of bodies.
const SCALE: f64 = 0.01;
/// Lengths that differ by less of themselves are one: times are rounded.
const SAME: f64 = 1e-7;

/// What chooses steps.
pub(in crate::simulation) struct StepControl {
    tolerance: f64,
    /// T (s): frames of it end with a step.
    frame: f64,
    /// The shortest step (s).
    smallest: f64,
    /// What displacements count as at least (m), and whether larger ones count.
    scale: f64,
    grows: bool,
    /// The error of the step before the present one is known, or that one has been taken back.
    taken_back: bool,
    state: Controlled,
}

/// What it remembers from step to step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::simulation) struct Controlled {
    /// The step before which a length is chosen next.
    next: u64,
    /// How long the next step may be (s), and any at most.
    wanted: f64,
    longest: f64,
    /// The error of the last step over the tolerance, where that is known.
    before: Option<f64>,
    /// The largest displacement so far (m).
    largest: f64,
}

impl Controlled {
    /// Whether it can be that of a run.
    pub fn is_sound(&self) -> bool {
        let positive = |length: f64| length.is_finite() && length > 0.0;
        let before = self.before.is_none_or(|error| error.is_finite() && error >= 0.0);
        positive(self.wanted) && positive(self.longest) && before && self.largest.is_finite() && self.largest >= 0.0
    }
}

impl StepControl {
    /// Of bodies that have these axes, in frames of a length (s).
    pub(super) fn of(asked: ErrorControl, frame: f64, axes: &Axes, world: &World) -> Self {
        let extent = axes.bodies.iter().map(|&body| extent(world, body)).fold(0.0, f64::max);
        Self {
            tolerance: asked.tolerance,
            frame,
            smallest: asked.smallest.unwrap_or(SHORTEST * frame),
            scale: asked.displacement.unwrap_or(SCALE * extent),
            grows: asked.displacement.is_none(),
            taken_back: false,
            state: Controlled { next: 0, wanted: frame, longest: frame, before: None, largest: 0.0 },
        }
    }

    /// In words.
    pub fn in_words(&self) -> String {
        let Self { tolerance, frame, smallest, scale, grows, .. } = self;
        let least = if *grows { "of the largest displacement, which counts as" } else { "of" };
        let at_least = if *grows { " at least" } else { "" };
        format!(
            "steps are chosen so that the errors within {frame} s add up to {tolerance} {least} {scale:.3e} m{at_least}, \
             from {smallest} s to {frame} s"
        )
    }

    /// What it remembers.
    pub fn state(&self) -> Controlled {
        self.state
    }

    /// Goes on from what it remembered.
    pub fn take_up(&mut self, state: Controlled) {
        self.state = state;
    }

    /// Makes no step longer than that (s), nor shorter than the shortest.
    pub fn limit(&mut self, longest: f64) {
        self.state.longest = longest.clamp(self.smallest.min(self.frame), self.frame);
        self.state.wanted = self.state.wanted.min(self.state.longest);
    }

    /// The step before which a length is chosen next.
    pub fn next(&self) -> u64 {
        self.state.next
    }

    /// Where the step that begins now has to end or any after it: at the end of its frame or of the scene (s), or at a
    /// corner of curves before.
    fn ends(&self, time: f64, corner: Option<f64>, duration: f64) -> f64 {
        let frame = ((time / self.frame + WHOLE).floor() + 1.0) * self.frame;
        let end = if duration > time + self.smallest { frame.min(duration) } else { frame };
        // what a step cannot tell from its own ends is none
        corner.filter(|corner| *corner < end - self.smallest).unwrap_or(end)
    }

    /// The time after which a corner counts that a step may have to end at (s).
    pub fn after(&self, clock: &Clock) -> f64 {
        clock.time() + self.smallest
    }

    /// Chooses the length of the step that begins now (s): as long as wanted, or so that a whole number of steps ends
    /// where one has to. `None` where that is the clock's. And the step that ends the scene, by this length.
    pub fn choose(&mut self, clock: &Clock, corner: Option<f64>, duration: f64) -> Option<(f64, Option<u64>)> {
        self.state.next = clock.step + 1;
        let time = clock.time();
        let left = self.ends(time, corner, duration) - time;
        let count = (left / self.state.wanted - WHOLE).ceil().max(1.0);
        let length = left / count;
        if (length - clock.time_step).abs() <= SAME * clock.time_step {
            return None;
        }
        Some((length, self.last_step(clock, length, duration)))
    }

    /// The step that ends the scene by such a length (s); `None` where it has ended.
    pub fn last_step(&self, clock: &Clock, length: f64, duration: f64) -> Option<u64> {
        let left = duration - clock.time();
        (left > self.smallest).then(|| clock.step + (left / length - WHOLE).ceil().max(1.0) as u64)
    }

    /// A step of a length (s) was not found. Whether a shorter one may be.
    pub fn cut_back(&mut self, length: f64) -> bool {
        if length <= self.smallest * (1.0 + SAME) {
            return false;
        }
        self.shorten(length * CUT);
        true
    }

    fn shorten(&mut self, wanted: f64) {
        self.state.wanted = wanted.max(self.smallest);
        self.taken_back = true;
    }

    /// Judges a step of a length (s) that leads to w (m), by its error over the tolerance: whether it is taken, and how
    /// long the next one may be.
    pub fn takes(&mut self, length: f64, error: f64, reach: f64, order: i32) -> bool {
        let largest = self.state.largest.max(reach);
        let scale = if self.grows { self.scale.max(largest) } else { self.scale };
        let share = error * self.frame / length / (self.tolerance * scale);
        let per_order = 1.0 / f64::from(order);
        let is_shortest = length <= self.smallest * (1.0 + SAME);
        // what is no number is too large
        if !(share <= 1.0 || is_shortest) {
            let factor = if share.is_finite() { SAFETY * share.powf(-per_order) } else { CHANGES[0] };
            self.shorten(length * factor.clamp(CHANGES[0], SAFETY));
            return false;
        }
        let before = self.state.before.unwrap_or(share);
        let factor = SAFETY * share.powf(-GAINS[0] * per_order) * before.powf(GAINS[1] * per_order);
        // of errors that are 0 or no numbers
        let factor = if factor.is_nan() { CHANGES[1] } else { factor.clamp(CHANGES[0], CHANGES[1]) };
        let factor = if self.taken_back { factor.min(1.0) } else { factor };
        // what ended where it had to was shorter than wanted
        let wanted = match factor >= LARGER {
            true => factor * length,
            false => factor.min(1.0) * length,
        };
        let keeps = factor >= 1.0 && !self.taken_back;
        let wanted = if keeps { wanted.max(self.state.wanted) } else { wanted };
        self.state.wanted = wanted.clamp(self.smallest.min(self.state.longest), self.state.longest);
        self.state.before = share.is_finite().then_some(share);
        self.state.largest = largest;
        self.taken_back = false;
        true
    }

    /// Whether a step was taken in spite of its error: the shortest.
    pub fn is_beyond(&self) -> bool {
        self.state.before.is_none_or(|share| share > 1.0)
    }
}

/// The length of the diagonal of the box around a body at rest (m).
fn extent(world: &World, body: Entity) -> f64 {
    let Some(rest) = world.get::<RestPosition>(body) else { return 0.0 };
    let first = rest.0.first().copied().unwrap_or_default();
    let (low, high) = rest.0.iter().fold((first, first), |(low, high), x| (low.min(*x), high.max(*x)));
    DVec3::length(high - low)
}

/// The error of a step (m) that leads to a place, and how far it leads from rest (m): root mean squares over
/// mass.
pub(super) fn error_and_reach(place: &Place<'_>, axes: &Axes, world: &World) -> [f64; 2] {
    let Place { formula, h, motion, .. } = place;
    let (mut mass, mut error, mut reach) = (0.0, 0.0, 0.0);
    for (axis, before) in axes.accelerations(world).enumerate() {
        let own = motion.mass.get(axis / 3);
        // three axes are one node
        mass += own / 3.0;
        reach += own * place.displacement(axis).powi(2);
        if motion.free[axis] {
            error += own * formula.local_error(*h, [before, place.arrival(axis, before).1]).powi(2);
        }
    }
    let mean = |sum: f64| if mass > 0.0 { (sum / mass).sqrt() } else { 0.0 };
    [mean(error), mean(reach)]
}

#[cfg(test)]
mod tests;
