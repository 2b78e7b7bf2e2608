//! The step follows what is stable: smaller on the word of certain bounds, and by the highest frequency itself once
//! that is worth its cost.
//!
//! Bounds that hold whatever was not looked at are cheap and too small. What is lost by them is counted, in steps,
//! against a step that the last finding would allow were nothing stiffer; when as much is lost as a finding costs, and
//! what is left of the run can gain as much again, the highest frequency is found (as one who rents skis until the
//! rents have come to their price: at most twice the best that foresight could do). It is found from the shape that was
//! quickest last and from where elements are stiffest now: some products show it to a few per cent.

use super::Simulation;
use super::damped_step::square_with_damping;
use super::follow::{Follower, step_of};
use super::frequency::{PRODUCT, bodies, largest_near};
use super::load_rates::LoadRates;
use super::nodal;
use super::stiffness::StabilitySample;
use super::tangent::Tangent;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::{Criterion, Error, Instability};
use crate::scene::schema::WhenUnstable;

/// Larger by less is not worth a change: when the highest frequency has been found, or a hand has let go; and by
/// bounds, which come and go.
const LARGER: (f64, f64) = (1.05, 2.0);
/// A step so many times the wanted one is made smaller.
const SMALLER: f64 = 1.25;
/// Steps become at most so many times longer at once: the balance of energy is that of steps of like length.
const LONGER: f64 = 2.0;
/// Products by which the highest frequency is found anew: the first time, and from a shape that is known.
const PRODUCTS: (usize, usize) = (20, 8);
/// What a finding costs, in products: around them all elements are checked several times, and steps of tetrahedra in
/// f32 are quicker than [`PRODUCT`] says (30 to 60 steps for eight products, measured).
const FINDING_PRODUCTS: f64 = 2.0;
/// ω² may be so many times what they show.
const SHOWN: f64 = 1.1;
/// Lengths change by at most so many times themselves in a step: what follows must see it come, and where the step
/// comes and goes with what is squeezed and let go, each change makes energy of what rings close to the limit. (With 1
/// a thread that slips out of a grasp gained up to 18 % of its energy in some milliseconds, and 8 runs of 12 ended so;
/// with .3 none, with .1 none either, in three times as many steps.)
const FASTEST: f64 = 0.3;
/// Strains make a step at most so many times smaller than it would be.
const SLOWEST: f64 = 20.0;
/// A step so many times smaller than the first is given up.
const LEAST: f64 = 1e-4;

impl Simulation {
    /// Makes the step smaller where it must be, and larger where that is worth while; whether it is to grow further
    /// soon.
    pub(super) fn adapt(&mut self, follower: &mut Follower, seen: &mut StabilitySample) -> Result<bool, Error> {
        let clock = *self.world.resource::<Clock>();
        let found = &mut follower.found;
        found.lost += found.losing * clock.step.saturating_sub(found.checked_at) as f64;
        let gives_up = |follower: &Follower, seen: &StabilitySample| {
            follower.wanted(follower.step_of(seen.square), seen) < LEAST * follower.first
        };
        let finds = follower.is_finding_worth(seen, &clock) || gives_up(follower, seen);
        if finds {
            self.estimate(follower, seen)?;
        }
        follower.found.seen.get_or_insert(*seen);
        let limit = follower.step_of(seen.square);
        let stable = follower.wanted(limit, seen);
        if gives_up(follower, seen) {
            return Err(self.too_small(follower, stable, seen));
        }
        let seen_to_come = follower.seen_to_come(stable, seen, &clock);
        let in_the_end = stable.min(seen_to_come);
        let wanted = in_the_end.min(LONGER * clock.time_step);
        let smaller = clock.time_step > follower.most() * limit || clock.time_step > SMALLER * wanted;
        let lasts = finds || follower.found.eased;
        let change = smaller || wanted >= if lasts { LARGER.0 } else { LARGER.1 } * clock.time_step;
        let taken = if change { wanted } else { clock.time_step };
        follower.found.eased &= smaller || stable >= LARGER.0 * taken;
        let hoped_for = follower.hoped_for(seen, &clock);
        follower.found.losing = if hoped_for < LARGER.0 * taken { 0.0 } else { 1.0 - taken / hoped_for };
        if !change {
            return Ok(false);
        }
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
        self.change_step(new, last)?;
        Ok(wanted < in_the_end)
    }

    /// Finds the highest frequency from what was known of it; whether there is one.
    pub(super) fn estimate(&mut self, follower: &mut Follower, seen: &mut StabilitySample) -> Result<bool, Error> {
        bring_to_host(&mut self.world, |_, name| column_is(name, Tangent::reads))?;
        let world = &mut self.world;
        let bodies = bodies(world);
        let weights = nodal::weights_now(world, &mut follower.trackers, &bodies);
        let products = follower.products();
        let Some((shown, shape)) = largest_near(world, follower.shape.as_deref(), &weights, products) else {
            return Ok(false);
        };
        for block in &mut follower.trackers {
            block.remember(world);
        }
        // bounds hold as well
        seen.square = seen.square.min(square_with_damping(SHOWN * shown, world));
        follower.shape = Some(shape);
        follower.found.take(seen);
        follower.history.eigenvalue_estimates += 1;
        Ok(true)
    }

    /// The stable step has gone to nothing.
    fn too_small(&self, follower: &mut Follower, wanted: f64, seen: &StabilitySample) -> Error {
        let worst = follower.trackers.iter_mut().flat_map(|block| {
            let elements = block.now(&self.world).into_iter();
            elements.map(|(row, square, _)| (square, block.entity, row))
        });
        let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
        let named = worst.and_then(|(_, entity, row)| crate::assembly::author_of(&self.world, entity, row));
        let (body, element) = named.unwrap_or_default();
        let bodies = follower.safety * step_of(seen.square);
        let by_loads = bodies >= LEAST * follower.first;
        let worst = match by_loads {
            true => format!("forces on nodes are so stiff, a grip's or a load's: without them it is {bodies:.3e} s"),
            false => format!("element {element} is deformed most"),
        };
        let cause = match self.world.resource::<Signals>().have_jumped(self.time()) {
            _ if by_loads => {
                "a grip or a load that is too stiff for the mass of its nodes (hold more softly, or scale it down)"
            }
            true => "a prescribed motion that jumps (use a ramp: `curve: Smooth(end: ...)` or `Ramp(end: ...)`)",
            false => {
                "tissue that is squeezed flat or stiffens without end (remove such elements by VolumeRatioBelow, or \
                 when_unstable: Remove)"
            }
        };
        Error::Unstable(Box::new(Instability {
            time: self.time(),
            step: self.step_count(),
            body: if by_loads { String::new() } else { body },
            what: format!(
                "the stable step has shrunk to {wanted:.3e} s, less than a {:.0}th of {:.3e} s at the start; {worst}",
                1.0 / LEAST,
                follower.first
            ),
            cause: cause.into(),
            good_until: self.time(),
            criterion: Criterion {
                value: Some(wanted),
                limit: Some(LEAST * follower.first),
                element: (!by_loads).then_some(element),
                ..Criterion::of("step")
            },
            last_good: None,
        }))
    }
}

impl Follower {
    /// The stable step with such forces on nodes (s), where a run would end for it.
    pub(super) fn gives_up_with(&self, loads: &LoadRates) -> Option<f64> {
        let limit = loads.with(step_of(self.found.known.max(self.found.latest)));
        (self.policy == WhenUnstable::Adapt && self.safety * limit < LEAST * self.first).then_some(limit)
    }

    /// The step that could be taken were the highest frequency found anew, as far as that can be guessed: were nothing
    /// stiffer than when it was found, and less so what has become less stiff (s).
    fn hoped_for(&self, seen: &StabilitySample, clock: &Clock) -> f64 {
        let relief = self.found.seen.map_or(1.0, |before| (seen.of_elements / before.of_elements).min(1.0));
        let stable = self.wanted(self.step_of(self.found.known * relief), seen);
        stable.min(self.seen_to_come(stable, seen, clock))
    }

    /// With how many products the highest frequency is found.
    fn products(&self) -> usize {
        if self.shape.is_some() { PRODUCTS.1 } else { PRODUCTS.0 }
    }

    /// Whether the highest frequency is to be found now.
    fn is_finding_worth(&self, seen: &StabilitySample, clock: &Clock) -> bool {
        let cost = FINDING_PRODUCTS * PRODUCT * self.products() as f64;
        let (now, then) = (self.wanted(self.step_of(seen.square), seen), self.hoped_for(seen, clock));
        let left = (self.duration - clock.time()) / now;
        self.found.lost >= cost && left * (1.0 - now / then) >= cost
    }

    /// The step with which strains that change quickly are seen to come (s), where `stable` would be; none smaller
    /// where the step is the author's.
    fn seen_to_come(&self, stable: f64, seen: &StabilitySample, clock: &Clock) -> f64 {
        match self.found.own {
            Some(_) => f64::INFINITY,
            None => (clock.time_step * FASTEST / seen.speed).max(stable / SLOWEST),
        }
    }
}
