//! The step follows what is stable: smaller on the word of the cheap bound, and by the highest frequency itself where that comes
//! close.

use super::Simulation;
use super::follow::{Follower, step_of};
use super::watch::Seen;
use crate::components::*;
use crate::error::{Criterion, Error, Instability};

/// Larger by less is not worth a change.
const WORTH: f64 = 1.1;
/// The highest frequency is found so many times, and once more for so many steps: each costs about a hundred steps. Beyond
/// that the cheap bound is taken at its word.
const FINDINGS: (u64, u64) = (4, 1000);
/// A step that is so many times the stable one by the cheap bound tells of its limits rather than of the step.
const VAGUE: f64 = 2.0;
/// Steps between two findings beyond that, where the cheap bound is as far off or has made the step as much smaller.
const REST: u64 = 100;
/// The highest frequency is found anew for a larger step when the bound of the elements has fallen to this share.
const RELIEF: f64 = 0.6;
/// A step so many times smaller than the first is given up.
const LEAST: f64 = 1e-4;

impl Simulation {
    /// Makes the step smaller where it must be, and larger where that is worth while.
    pub(super) fn adapt(&mut self, follower: &mut Follower, mut seen: Seen) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        let known_now = follower.calls_for_a_finding(&seen, &clock) && self.find(follower, &mut seen)?;
        follower.found.seen.get_or_insert(seen);
        // far off the cheap bound may say anything: until the true limit is found, a quarter of the last has to do
        let bound = step_of(seen.square);
        let limit = if known_now { bound } else { bound.max(step_of(follower.found.known) / (VAGUE * VAGUE)) };
        let wanted = follower.wanted(limit, &seen);
        let smaller = clock.time_step > follower.most() * limit;
        if !(smaller || known_now && wanted > WORTH * clock.time_step) {
            return Ok(());
        }
        if wanted < LEAST * follower.first {
            return Err(self.too_small(follower, wanted));
        }
        let left = follower.duration - clock.time();
        // the scene ends with a whole step
        let (new, last) = match (left / wanted - 1e-6).ceil() {
            steps if steps >= 1.0 => (left / steps, clock.step + steps as u64),
            _ => (wanted, self.planned_steps()),
        };
        follower.found.guessed |= !known_now;
        let history = &mut follower.history;
        history.changes += 1;
        history.smallest = history.smallest.min(new);
        history.largest = history.largest.max(new);
        self.change_step(new, last)
    }

    /// The stable step has gone to nothing.
    fn too_small(&self, follower: &Follower, wanted: f64) -> Error {
        let worst = follower.watched.iter().flat_map(|block| {
            let elements = block.now(&self.world).into_iter();
            elements.map(|(row, square)| (square, block.entity, row))
        });
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
        let named = worst.and_then(|(_, entity, row)| crate::assembly::author_of(&self.world, entity, row));
        let (body, element) = named.unwrap_or_default();
        Error::Unstable(Box::new(Instability {
            time: self.time(),
            step: self.step_count(),
            body,
            what: format!(
                "the stable step has shrunk to {wanted:.3e} s, less than a {:.0}th of {:.3e} s at the start; element \
                 {element} is deformed most",
                1.0 / LEAST,
                follower.first
            ),
            cause:
                "tissue that is squeezed flat or stiffens without end (remove such elements by VolumeRatioBelow, or \
                    when_unstable: Remove)"
                    .into(),
            good_until: self.time(),
            criterion: Criterion {
                value: Some(wanted),
                limit: Some(LEAST * follower.first),
                element: Some(element),
                ..Criterion::of("step")
            },
            last_good: None,
        }))
    }
}

impl Follower {
    /// Whether the highest frequency is to be found now.
    fn calls_for_a_finding(&self, seen: &Seen, clock: &Clock) -> bool {
        let (time_step, found) = (clock.time_step, &self.found);
        let pressing = time_step > self.most() * step_of(seen.square);
        let before = found.seen.unwrap_or(*seen);
        let relieved = seen.of_elements < RELIEF * before.of_elements || seen.alive < before.alive;
        let may_grow = time_step * WORTH < self.wanted(f64::INFINITY, seen);
        let affordable = self.history.sharp_looks < FINDINGS.0 + clock.step / FINDINGS.1;
        let better = affordable && (pressing || found.guessed || relieved && may_grow);
        // far off the cheap bound says nothing, and steps made small on its word cost more than the finding
        let made_small = found.guessed && VAGUE * time_step < step_of(found.known);
        let vague = made_small || time_step > VAGUE * step_of(seen.square);
        better || vague && clock.step >= found.known_at + REST
    }
}
