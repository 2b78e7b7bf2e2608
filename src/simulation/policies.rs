//! What is done when the stable step becomes smaller than the step: the policies of `integration.when_unstable`.

use super::follow::{Follower, VAGUE, square_of, step_of};
use super::stable_step::{ACCURACY, limits};
use super::watch::Seen;
use super::{Simulation, mass_scaling};
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::{Criterion, Error, Instability};

/// Larger by less is not worth a change.
pub(super) const WORTH: f64 = 1.1;
/// Elements go together whose ω² is at least this share of the largest.
const NEARLY: f64 = 0.8;
/// A step so many times smaller than the first is given up.
const LEAST: f64 = 1e-4;

impl Simulation {
    /// Makes the step smaller where it must be, and larger where that is worth while.
    pub(super) fn adapt(&mut self, follower: &mut Follower, seen: &Seen, time_step: f64) -> Result<(), Error> {
        let known_now = follower.known_at == self.step_count();
        // far off the cheap bound may say anything: until the true limit is found, a quarter of the last has to do
        let bound = step_of(seen.square);
        let limit = if known_now { bound } else { bound.max(step_of(follower.known) / (VAGUE * VAGUE)) };
        let wanted = follower.wanted(limit, seen);
        let smaller = time_step > follower.most() * limit;
        if !(smaller || known_now && wanted > WORTH * time_step) {
            return Ok(());
        }
        if wanted < LEAST * follower.first {
            return Err(self.too_small(follower, wanted));
        }
        let clock = *self.world.resource::<Clock>();
        let left = follower.duration - clock.time();
        // the scene ends with a whole step
        let (new, last) = match (left / wanted - 1e-6).ceil() {
            steps if steps >= 1.0 => (left / steps, clock.step + steps as u64),
            _ => (wanted, self.planned_steps()),
        };
        follower.guessed |= !known_now;
        let history = &mut follower.history;
        history.changes += 1;
        history.smallest = history.smallest.min(new);
        history.largest = history.largest.max(new);
        self.change_step(new, last)
    }

    /// Adds mass to all elements whose bound does not allow the step any more.
    pub(super) fn make_heavier(&mut self, follower: &mut Follower, time_step: f64) -> Result<(), Error> {
        let columns = [Mass::NAME, FictitiousMass::NAME];
        let world = &mut self.world;
        bring_to_host(world, |_, name| columns.contains(&name))?;
        for block in &mut follower.watched {
            let bounds: Vec<(usize, f64)> =
                block.now(world).into_iter().map(|(row, square)| (row, step_of(square))).collect();
            mass_scaling::make_heavier(world, block.entity, &bounds, time_step / follower.safety);
            block.weigh(world);
        }
        let added = mass_scaling::weigh(world);
        send_to_device(world, |_, name| name == FictitiousMass::NAME)?;
        if let Some(found) = limits(world, ACCURACY) {
            follower.known = square_of(found.safe);
        }
        let history = &mut follower.history;
        history.added_mass = added.mass;
        history.added_share = added.mass / self.facts.initial_mass;
        history.added_energy += added.energy;
        Ok(())
    }

    /// Removes the elements with the highest frequencies, as many as are nearly as quick as the quickest; others follow if
    /// that is not enough.
    pub(super) fn remove_quickest(&mut self, follower: &mut Follower, seen: &Seen) -> Result<(), Error> {
        let step = self.step_count();
        bring_to_host(&mut self.world, |_, name| [Alive::NAME, RemovalStep::NAME].contains(&name))?;
        for block in &follower.watched {
            let quick = block.now(&self.world).into_iter().filter(|(_, square)| *square >= NEARLY * seen.of_elements);
            let quick: Vec<usize> = quick.map(|(row, _)| row).collect();
            if let Some(mut due) = self.world.get_mut::<RemovalStep>(block.entity) {
                quick.iter().for_each(|&row| due[row] = u32::try_from(step + 1).unwrap_or(u32::MAX));
                follower.history.removed += quick.len() as u64;
            }
        }
        // they go at the end of this step
        follower.next = step + 1;
        send_to_device(&mut self.world, |_, name| name == RemovalStep::NAME)
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
