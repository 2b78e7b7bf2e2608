//! What is done when the stable step becomes smaller than a step that stays: the policies of
//! `integration.when_unstable`.

use super::Simulation;
use super::follow::{Follower, square_of, step_of};
use super::mass_scaling::{self, Additions};
use super::stable_step::{ACCURACY, limit_now};
use super::stiffness::StabilitySample;
use super::tangent::Tangent;
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::WhenUnstable;

/// Elements go together whose ω² is at least this share of the largest.
const NEARLY: f64 = 0.8;
/// Who only watches finds the highest frequency so many times, and once more for so many steps: each takes some tens.
const FINDINGS: (u64, u64) = (8, 200);
/// How often mass is added in one step of the run by what counts; then by the elements' own bounds, which are certain.
const ROUNDS: usize = 4;

impl Simulation {
    /// Does what the scene wants done where the step stays. The step before which is checked next, where that is
    /// known.
    pub(super) fn hold(&mut self, follower: &mut Follower, seen: &mut StabilitySample) -> Result<Option<u64>, Error> {
        let (step, time_step) = (self.step_count(), self.world.resource::<Clock>().time_step);
        // mass is not added and elements are not removed on the word of the cheap bound, nor for what a load or a hand
        // does
        let only_reports = follower.policy == WhenUnstable::Watch;
        let presses = |follower: &Follower, square: f64| {
            time_step > follower.most() * if only_reports { follower.step_of(square) } else { step_of(square) }
        };
        let pressing = presses(follower, seen.square);
        let affordable = follower.history.eigenvalue_estimates < FINDINGS.0 + step / FINDINGS.1;
        let found = match only_reports {
            true => pressing && affordable && self.estimate(follower, seen)?,
            false => pressing && self.find(follower, seen)?,
        };
        follower.found.seen.get_or_insert(*seen);
        if !only_reports && time_step > follower.step_of(seen.square) && !presses(follower, seen.square) {
            // with what acts on nodes: told, as where one only watches, and the guards see to the rest
            follower.history.beyond_since.get_or_insert(self.time());
        }
        match follower.policy {
            WhenUnstable::Watch if time_step > follower.step_of(follower.found.known) => {
                let now = self.time();
                follower.history.beyond_since.get_or_insert(now);
                // told once; the guards see to the rest
                Ok(Some(u64::MAX))
            }
            _ if !found || !presses(follower, seen.square) => Ok(None),
            WhenUnstable::ScaleMass { most } => self.scale_mass(follower, time_step, most).map(|()| None),
            WhenUnstable::Remove => self.remove_quickest(follower).map(Some),
            WhenUnstable::Watch | WhenUnstable::Adapt => Ok(None),
        }
    }

    /// Finds the highest frequency; whether there is one.
    pub(super) fn find(&mut self, follower: &mut Follower, seen: &mut StabilitySample) -> Result<bool, Error> {
        bring_to_host(&mut self.world, |_, name| column_is(name, Tangent::reads))?;
        let Some(limit) = limit_now(&mut self.world, ACCURACY) else { return Ok(false) };
        for block in &mut follower.trackers {
            block.remember(&self.world);
        }
        seen.square = square_of(limit);
        follower.found.take(seen);
        follower.history.eigenvalue_estimates += 1;
        Ok(true)
    }

    /// Adds mass to elements that do not allow the step any more, as long as the highest frequency does not.
    fn scale_mass(&mut self, follower: &mut Follower, time_step: f64, most: f64) -> Result<(), Error> {
        let columns = [Mass::NAME, InertialMass::NAME];
        bring_to_host(&mut self.world, |_, name| columns.contains(&name))?;
        let wanted = time_step / follower.safety;
        for round in 0..=ROUNDS {
            // what is known of all is worth more than the bound of an element, until it leads nowhere
            let known = if round < ROUNDS { follower.found.known } else { f64::INFINITY };
            let mut additions = Additions::default();
            for block in &mut follower.trackers {
                let squares = block.now(&self.world).into_iter();
                let bounds: Vec<(usize, f64)> =
                    squares.map(|(row, square, ratio)| (row, step_of(square.min(known * ratio)))).collect();
                additions.and(&self.world, block.entity, &bounds, wanted);
            }
            self.may_add(&additions, follower, most)?;
            additions.make(&mut self.world);
            let added = mass_scaling::scale_masses(&mut self.world);
            for block in &mut follower.trackers {
                block.update_bounds(&self.world);
            }
            let history = &mut follower.history;
            history.added_mass = added.mass;
            history.added_share = added.mass / self.facts.initial_mass;
            history.added_energy += added.energy;
            if let Some(limit) = limit_now(&mut self.world, ACCURACY) {
                follower.found.known = square_of(limit);
            }
            if time_step <= follower.most() * step_of(follower.found.known) {
                break;
            }
        }
        self.warn_of_added_mass(follower.history.added_share);
        send_to_device(&mut self.world, |_, name| name == InertialMass::NAME)
    }

    /// Removes the elements with the highest frequencies, as many as are nearly as quick as the quickest; others follow
    /// if that is not enough. The step before which is checked next.
    fn remove_quickest(&mut self, follower: &mut Follower) -> Result<u64, Error> {
        let step = self.step_count();
        bring_to_host(&mut self.world, |_, name| [Alive::NAME, RemovalStep::NAME].contains(&name))?;
        let mut all = Vec::new();
        for block in &mut follower.trackers {
            all.push((block.entity, block.now(&self.world)));
        }
        let quickest = all.iter().flat_map(|(_, rows)| rows).fold(0.0_f64, |most, (_, square, _)| most.max(*square));
        for (entity, rows) in all {
            let quick = rows.into_iter().filter(|(_, square, _)| *square >= NEARLY * quickest);
            let quick: Vec<usize> = quick.map(|(row, ..)| row).collect();
            if let Some(mut due) = self.world.get_mut::<RemovalStep>(entity) {
                quick.iter().for_each(|&row| due[row] = u32::try_from(step + 1).unwrap_or(u32::MAX));
                follower.history.removed += quick.len() as u64;
            }
        }
        send_to_device(&mut self.world, |_, name| name == RemovalStep::NAME)?;
        // they go at the end of this step
        Ok(step + 1)
    }
}
