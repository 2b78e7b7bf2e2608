//! Where a tool goes in a batch of steps.

use crate::assembly::steps_of;
use crate::components::{Clock, Key};
use crate::observation::Felt;
use crate::port::DevicePose;
use crate::scene::schema::{Follow, Port};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// How much of what earlier batches say of the stiffness is left after another one.
const FORGET: f64 = 0.9;

/// Speeds below this share of the port's are none.
const SLOW: f64 = 0.01;

/// Ways below this share of the port's longest say nothing of what answers them: forces change by rounding, and by what
/// rings, as well.
const LEAST: f64 = 3e-4;

/// How many times the stiffness with which tissue answers at once holds a proxy back. A mass m gives λ² + gλ − g = 0
/// from batch to batch with g = m/T² over the sum of stiffnesses: with 1 it is ½, and a proxy swings on; with 2 it is
/// ¼, and a swing is .64 times the one before.
const CALM: f64 = 2.0;

/// The present batch of a port, as snapshots have it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PortState {
    /// Steps taken before the batch and at its end: both 0 before the first.
    pub begins: u64,
    pub ends: u64,
    /// Where the tool goes: time (s), place (m), orientation.
    pub path: [Key; 2],
    /// The step at which it was told what the tool felt.
    pub felt_at: u64,
    /// Where the device was last.
    target: Option<(DVec3, DQuat)>,
    /// What the tool felt in the last batch (N).
    force: DVec3,
    /// The middle of the last batch's way (m), where it touched something.
    touched: Option<DVec3>,
    /// Sums of the squares of ways along the force, and of ways times what the force changed by.
    ways: [f64; 2],
    /// The way of the last batch (m), and what it changed by.
    #[serde(default)]
    way: DVec3,
    #[serde(default)]
    change: DVec3,
    /// Sums of the squares of what ways changed by as they turned back, and of that times what the force changed by.
    #[serde(default)]
    changes: [f64; 2],
    /// The fastest it ever went, as a share of what it may.
    fastest: f64,
}

impl PortState {
    /// Before the first batch, with the tool at a place.
    pub fn at(first: Key) -> Self {
        Self {
            begins: 0,
            ends: 0,
            path: [first; 2],
            felt_at: 0,
            target: None,
            force: DVec3::ZERO,
            touched: None,
            ways: [0.0; 2],
            way: DVec3::ZERO,
            change: DVec3::ZERO,
            changes: [0.0; 2],
            fastest: SLOW,
        }
    }

    /// Whether a run can go on from it.
    pub fn is_sound(&self) -> bool {
        let [(from, ..), (until, ..)] = self.path;
        let of = |place: DVec3, turn: DQuat| place.is_finite() && turn.is_finite() && turn.is_normalized();
        let there = self.path.iter().all(|&(time, place, turn)| time.is_finite() && of(place, turn));
        let aims = self.target.is_none_or(|(place, turn)| of(place, turn));
        let vectors = [self.force, self.touched.unwrap_or_default(), self.way, self.change];
        let sums = self.ways.into_iter().chain(self.changes).chain([self.fastest]);
        let numbers = sums.chain(vectors.into_iter().flat_map(|vector| vector.to_array())).all(f64::is_finite);
        there && aims && numbers && from <= until && self.begins <= self.ends && self.felt_at <= self.ends
    }

    /// Takes where the device is.
    pub fn target(&mut self, pose: &DevicePose) {
        self.target = Some((pose.place, pose.orientation.normalize()));
    }

    /// Begins a batch with the next step; whether the tool becomes much quicker than ever before.
    pub fn begin(&mut self, port: &Port, clock: &Clock) -> bool {
        let steps = steps_of(port.every, clock.time_step);
        (self.begins, self.ends) = (clock.step, clock.step.saturating_add(steps));
        let (now, until) = (clock.time(), clock.time_at(self.ends));
        let (place, turn) = self.pose(now);
        let batch = until - now;
        let (aim, turned) = match (self.target, port.follow) {
            (None, _) => (place, turn),
            (Some(target), Follow::Position) => target,
            // both springs as they are at the end of the batch: tissue goes on from the force that it had
            (Some((aim, turned)), Follow::Proxy { stiffness, damping }) => {
                let sum = stiffness + self.stiffness() + CALM * self.dynamic_stiffness() + damping / batch;
                let aim = place + (aim - place) * (stiffness / sum) + self.force / sum;
                (if aim.is_finite() { aim } else { place }, turned)
            }
        };
        let [way, angle] = [aim.distance(place), turn.angle_between(turned)];
        let [farthest, widest] = [port.speed * batch, port.spin.to_radians() * batch];
        let end = if way > farthest { place + (aim - place) * (farthest / way) } else { aim };
        let turned = if angle > widest { turn.slerp(turned, widest / angle) } else { turned };
        self.path = [(now, place, turn), (until, end, turned.normalize())];
        let share = (way / farthest).max(angle / widest).min(1.0);
        let quickens = share > 2.0 * self.fastest;
        self.fastest = self.fastest.max(share);
        quickens
    }

    /// Where the tool is at a time (s): at the end of the way, unless steps have become shorter meanwhile.
    pub fn pose(&self, time: f64) -> (DVec3, DQuat) {
        let [(from, before, turn), (until, after, turned)] = self.path;
        match (time - from) / (until - from) {
            share if share < 1.0 => (before.lerp(after, share.max(0.0)), turn.slerp(turned, share.max(0.0))),
            _ => (after, turned),
        }
    }

    /// Ends the batch of a port at its last step. What is no number, of bodies that break down, is not remembered.
    pub fn end(&mut self, port: &Port, felt: Felt, step: u64) {
        let felt = if felt.force.is_finite() { felt } else { Felt { force: DVec3::ZERO, ..felt } };
        let [(from, start, _), (until, end, _)] = self.path;
        let (way, middle) = (end - start, 0.5 * (start + end));
        let (force, least) = (felt.force - self.force, LEAST * port.speed * (until - from));
        // what is touched for the first time was at rest before
        let (change, turns_back) = match self.touched {
            None if felt.in_contact => (way, true),
            _ => (way - self.way, (way - self.way).dot(self.change) < 0.0),
        };
        if felt.in_contact && turns_back && change.length() > least {
            self.changes = with(self.changes, change.length_squared(), -change.dot(force));
        }
        if let Some(before) = self.touched.filter(|_| felt.in_contact) {
            let out = felt.force.normalize_or_zero();
            let moved = (middle - before).dot(out);
            if moved.abs() > least {
                self.ways = with(self.ways, moved * moved, -moved * force.dot(out));
            }
        }
        (self.way, self.change) = (way, change);
        if !felt.in_contact {
            // the slopes stay, but what is touched next may be other tissue
            (self.ways, self.changes) = (faded(self.ways), faded(self.changes));
        }
        self.touched = felt.in_contact.then_some(middle);
        self.force = felt.force;
        self.felt_at = step;
    }

    /// How fast the tool went (m/s).
    pub fn velocity(&self) -> DVec3 {
        let [(from, before, _), (until, after, _)] = self.path;
        if until > from { (after - before) / (until - from) } else { DVec3::ZERO }
    }

    /// By how much the force grows for each metre that the tool goes in (N/m): the line through what the last batches
    /// changed by in which it went anywhere.
    pub fn stiffness(&self) -> f64 {
        if self.touched.is_some() { slope(self.ways) } else { 0.0 }
    }

    /// By how much the force grows for each metre by which the way of a batch becomes longer (N/m), of ways that turn
    /// back from batch to batch: nodes that the tool takes along, and the waves that go out from them, answer these at
    /// once, with 2 m/T² + ρ c A/T of batches T. A proxy without mass that answers a batch later swings if it yields by
    /// more than that.
    fn dynamic_stiffness(&self) -> f64 {
        if self.touched.is_some() { slope(self.changes) } else { 0.0 }
    }
}

/// Sums of which a batch has passed.
fn faded(sums: [f64; 2]) -> [f64; 2] {
    sums.map(|sum| FORGET * sum)
}

/// Sums with another square and another product, of which earlier ones fade; none beyond all numbers.
fn with(sums: [f64; 2], square: f64, product: f64) -> [f64; 2] {
    let [squares, products] = faded(sums);
    let sums = [squares + square, products + product];
    if sums.iter().all(|sum| sum.is_finite()) { sums } else { [0.0; 2] }
}

/// The slope of a line through pairs of which these are the sums, where it rises.
fn slope([squares, products]: [f64; 2]) -> f64 {
    let found = products / squares;
    if found.is_finite() { found.max(0.0) } else { 0.0 }
}

#[cfg(test)]
mod tests;
