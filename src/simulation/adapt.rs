//! The step follows what is stable: smaller on the word of the cheap bound, and by the highest frequency itself where finding that
//! is worth it.
//!
//! Nobody knows how long what is found will hold. So the smaller steps are paid for until they have cost as much as a finding would
//! have, and then it is found (a rented ski is bought when the rent has come to its price: never more than twice of what would have been
//! best); not where what is left of the run is too short to bring that back. Who finds that nothing was to be gained waits twice as
//! long the next time.

use super::Simulation;
use super::follow::{FINDING, Follower, step_of};
use super::frequency::largest_worth;
use super::stable_step::ACCURACY;
use super::tangent::Tangent;
use super::watch::Seen;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::{Criterion, Error, Instability};

/// Larger by less is not worth a change, and on the word of the cheap bound.
const WORTH: (f64, f64) = (1.1, 1.25);
/// A step that is so many times the stable one by the cheap bound tells of its limits rather than of the step.
const VAGUE: f64 = 2.0;
/// Steps between two findings where it does.
const REST: u64 = 100;
/// So many findings, and one more for so many steps, come as soon as the cheap bound calls for smaller steps.
const FIRST: (u64, u64) = (4, 1000);
/// Where elements have gone, ω² may have fallen to this share.
const HOPE: f64 = 0.6;
/// How dear a finding may become, in findings.
const DEAREST: f64 = 16.0;
/// A step so many times smaller than the first is given up.
const LEAST: f64 = 1e-4;
/// Strains change by at most so much in a step: more than that, and what resists them is another from one step to the next. Steps
/// become smaller by half of it or more, and for it alone no smaller than a share of what is stable.
const STRAIN_A_STEP: f64 = 0.1;
const SMALLEST_FOR_STRAIN: f64 = 0.02;

impl Simulation {
    /// Makes the step smaller where it must be, and larger where that is worth while.
    pub(super) fn adapt(&mut self, follower: &mut Follower, mut seen: Seen) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        let found = self.find_if_worth(follower, &mut seen, &clock)?;
        follower.found.seen.get_or_insert(seen);
        let limit = if found { step_of(seen.square) } else { follower.cheap_limit(&seen) };
        let wanted = follower.wanted(limit, &seen);
        if wanted < LEAST * follower.first {
            return Err(self.too_small(follower, wanted));
        }
        let calm = (clock.time_step * STRAIN_A_STEP / seen.speed).max(SMALLEST_FOR_STRAIN * wanted);
        let fast = clock.time_step > 2.0 * calm;
        // a jump is over after a step
        let too_fast = fast && follower.found.fast;
        let smaller = clock.time_step > follower.most() * limit || too_fast;
        // on the word of the cheap bound only back to where it was, or where it is certain
        let may = found || follower.found.slowed || follower.has_lost(&seen);
        let larger = may && wanted.min(calm) > if found { WORTH.0 } else { WORTH.1 } * clock.time_step;
        follower.found.fast = fast;
        if !(smaller || larger) {
            return Ok(());
        }
        follower.found.slowed = too_fast || follower.found.slowed && calm < wanted;
        let wanted = if too_fast || follower.found.slowed { wanted.min(calm) } else { wanted };
        let left = follower.duration - clock.time();
        // the scene ends with a whole step
        let (new, last) = match (left / wanted - 1e-6).ceil() {
            steps if steps >= 1.0 => (left / steps, clock.step + steps as u64),
            _ => (wanted, self.planned_steps()),
        };
        let history = &mut follower.history;
        history.changes += 1;
        history.smallest = history.smallest.min(new);
        history.largest = history.largest.max(new);
        self.change_step(new, last)
    }

    /// Finds the highest frequency if that is worth it; whether it did.
    fn find_if_worth(&mut self, follower: &mut Follower, seen: &mut Seen, clock: &Clock) -> Result<bool, Error> {
        let limit = follower.cheap_limit(seen);
        let pressing = clock.time_step > follower.most() * limit;
        let best = follower.wanted(step_of(follower.hope(seen)), seen);
        let taken = if pressing { follower.wanted(limit, seen).min(clock.time_step) } else { clock.time_step };
        let found = &mut follower.found;
        found.overpaid +=
            (clock.step - found.looked_at.min(clock.step)) as f64 * (1.0 - clock.time_step / best).max(0.0);
        if best.is_nan() || best <= WORTH.0 * taken {
            found.overpaid = 0.0;
            return Ok(false);
        }
        // far off the cheap bound says nothing
        let vague = clock.time_step > VAGUE * step_of(seen.square)
            && (clock.step >= found.known_at + REST || follower.history.sharp_looks == 0);
        let left = follower.duration - clock.time();
        // the first are not waited for: the cheap bound knows sizes of strains and not their directions
        let first = pressing && follower.history.sharp_looks < FIRST.0 + clock.step / FIRST.1;
        let due = vague || found.overpaid >= found.price;
        let pays_back = left * (1.0 / taken - 1.0 / best) > found.price;
        if !(first || due && pays_back) {
            return Ok(false);
        }
        let cheap = seen.square;
        let steps = |at_most: f64| left / follower.wanted(step_of(at_most.min(cheap)), seen);
        bring_to_host(&mut self.world, |_, name| Tangent::COLUMNS.contains(&name))?;
        let Some(largest) = largest_worth(&mut self.world, ACCURACY, Some(&steps)) else { return Ok(false) };
        for block in &mut follower.watched {
            block.remember(&self.world);
        }
        seen.square = largest.at_most.min(cheap);
        let pays = follower.wanted(step_of(seen.square), seen) > WORTH.0 * taken;
        let found = &mut follower.found;
        (found.known, found.known_at) = (seen.square, clock.step);
        (found.seen, found.overpaid) = (Some(*seen), 0.0);
        found.price = if pays { FINDING } else { (2.0 * found.price).min(DEAREST * FINDING) };
        follower.history.sharp_looks += 1;
        Ok(true)
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
    /// What is stable by the cheap bound (s); where that is far off it may say anything: until the true limit is found, a quarter of the
    /// last has to do.
    fn cheap_limit(&self, seen: &Seen) -> f64 {
        let bound = step_of(seen.square);
        if self.has_lost(seen) { bound } else { bound.max(step_of(self.found.known) / (VAGUE * VAGUE)) }
    }

    /// ω² at best (1/s²): as it was when it was found, less where elements have become softer or have gone.
    fn hope(&self, seen: &Seen) -> f64 {
        let Some(before) = &self.found.seen else { return self.found.known };
        let softer = (seen.of_elements / before.of_elements).min(1.0);
        let fewer = if self.has_lost(seen) { HOPE } else { 1.0 };
        self.found.known * softer.min(fewer)
    }
}
