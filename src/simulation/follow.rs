//! The stable step followed during the run: a cheap bound every few steps, the highest frequency itself when that comes
//! close, and what the scene wants done about it.

use super::stable_step::{ACCURACY, Stability, limits};
use super::tangent::Tangent;
use super::watch::{Seen, Watched};
use super::Simulation;
use crate::backend::device::bring_to_host;
use crate::components::*;
use crate::error::{Error, Instability};
use crate::scene::schema::{Scene, StepBound, WhenUnstable};
use bevy_ecs::prelude::*;
use serde::Serialize;
use std::time::Instant;

/// Steps between two looks at all elements: at least, and at most.
const LOOKS: (u64, u64) = (16, 256);
/// Between two looks strains change by so much, at the present speed.
const STRAIN: f64 = 0.05;
/// Steps between two findings of the highest frequency where the step can be made smaller on the cheap bound's word. Each
/// costs about a hundred steps.
const SHARP_LOOKS: u64 = 1000;
/// Larger by less is not worth a change.
const WORTH: f64 = 1.1;
/// The highest frequency is found anew for a larger step when the bound of the elements has fallen to this share.
const RELIEF: f64 = 0.6;
/// A step so many times smaller than the first is given up.
const LEAST: f64 = 1e-4;

/// How the step went during the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StepHistory {
    /// How often it was changed.
    pub changes: u64,
    /// The smallest step taken (s).
    pub smallest: f64,
    /// The largest step taken (s).
    pub largest: f64,
    /// How often all elements were looked at.
    pub looks: u64,
    /// How often the highest frequency was found during the run.
    pub sharp_looks: u64,
    /// What looking took (s).
    pub seconds: f64,
    /// When the step was first seen to be beyond the stable one (s), where it stays all the same.
    pub beyond_since: Option<f64>,
    /// Mass that was added so that the step could stay (kg).
    pub added_mass: f64,
    /// The same as a share of all mass.
    pub added_share: f64,
    /// Elements that were removed because they need a smaller step.
    pub removed: u64,
}

/// Follows the stable step of a run.
pub(super) struct Follower {
    pub policy: WhenUnstable,
    pub safety: f64,
    /// The step takes nothing but the bound of the elements for granted: it never grows beyond that.
    by_elements: bool,
    /// The scene's own step, which it never grows beyond (s).
    own: f64,
    duration: f64,
    first: f64,
    next: u64,
    watched: Vec<Watched>,
    /// The highest ω² when it was found last (1/s²), in which step, and what was seen then.
    known: f64,
    known_at: u64,
    seen: Option<Seen>,
    pub history: StepHistory,
}

impl Follower {
    /// `None` where there is no motion.
    pub fn new(scene: &Scene, stability: &Stability, world: &World) -> Option<Self> {
        let (limit, integration) = (stability.limit?, &scene.integration);
        let step = world.resource::<Clock>().time_step;
        Some(Self {
            policy: scene.when_unstable(),
            safety: integration.safety,
            by_elements: integration.bound == StepBound::Elements,
            own: integration.step.unwrap_or(f64::INFINITY),
            duration: scene.duration,
            first: step,
            next: LOOKS.0,
            watched: Vec::new(),
            known: square_of(limit),
            known_at: 0,
            seen: None,
            history: StepHistory { smallest: step, largest: step, ..StepHistory::default() },
        })
    }

    /// The share of the stable step beyond which a step counts as too large: half of what `safety` leaves is used up.
    fn most(&self) -> f64 {
        0.5 * (1.0 + self.safety)
    }

    /// The largest step that may be taken when so much is stable (s).
    fn wanted(&self, limit: f64, seen: &Seen) -> f64 {
        let elements = if self.by_elements { self.safety * step_of(seen.at_rest) } else { f64::INFINITY };
        (self.safety * limit).min(elements).min(self.own)
    }

}

/// 2/ω.
fn step_of(square: f64) -> f64 {
    2.0 / square.sqrt()
}

/// ω² of a stable step.
fn square_of(step: f64) -> f64 {
    4.0 / (step * step)
}

impl Simulation {
    /// How the step went so far; `None` in a static analysis.
    pub fn step_history(&self) -> Option<&StepHistory> {
        self.follower.as_ref().map(|follower| &follower.history)
    }

    /// The next step before which the stable step is looked at.
    pub(super) fn next_follow(&self) -> u64 {
        self.follower.as_ref().map_or(u64::MAX, |follower| follower.next)
    }

    /// Looks at the stable step if it is time, and does what the scene wants done.
    pub(super) fn follow(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        let Some(mut follower) = self.follower.take_if(|follower| follower.next <= step) else { return Ok(()) };
        let started = Instant::now();
        let looked = self.look_with(&mut follower);
        follower.history.seconds += started.elapsed().as_secs_f64();
        self.follower = Some(follower);
        looked
    }

    fn look_with(&mut self, follower: &mut Follower) -> Result<(), Error> {
        let moving = [Displacement::NAME, DisplacementStep::NAME, RestShape::NAME];
        bring_to_host(&mut self.world, |_, name| moving.contains(&name))?;
        if follower.watched.is_empty() {
            follower.watched = Watched::all(&mut self.world);
        }
        let step = self.step_count();
        let all = follower.watched.iter().map(|block| block.look(&self.world, follower.known));
        let mut seen = all.fold(Seen::NOTHING, Seen::and);
        follower.history.looks += 1;
        follower.next = step + (STRAIN / seen.speed).clamp(LOOKS.0 as f64, LOOKS.1 as f64) as u64;
        if !seen.speed.is_finite() || seen.alive == 0 {
            // what is no number is the guards' business
            return Ok(());
        }
        let time_step = self.world.resource::<Clock>().time_step;
        let pressing = time_step > follower.most() * step_of(seen.square);
        let before = follower.seen.unwrap_or(seen);
        let relieved = seen.of_elements < RELIEF * before.of_elements || seen.alive < before.alive;
        let may_grow = follower.policy == WhenUnstable::Adapt && time_step * WORTH < follower.wanted(f64::INFINITY, &seen);
        let waited = step >= follower.known_at + SHARP_LOOKS;
        // the cheap bound may say anything of what it was not made for
        let vague = follower.policy != WhenUnstable::Watch && time_step > 2.0 * step_of(seen.square);
        if pressing && (waited || vague) || relieved && may_grow && waited {
            bring_to_host(&mut self.world, |_, name| Tangent::COLUMNS.contains(&name))?;
            if let Some(found) = limits(&mut self.world, ACCURACY) {
                for block in &mut follower.watched {
                    block.remember(&self.world);
                }
                (follower.known, follower.known_at) = (square_of(found.safe), step);
                seen.square = follower.known;
                follower.seen = Some(seen);
                follower.history.sharp_looks += 1;
            }
        }
        follower.seen.get_or_insert(seen);
        match follower.policy {
            WhenUnstable::Adapt => self.adapt(follower, &seen, time_step),
            WhenUnstable::Watch => {
                if time_step > step_of(follower.known) {
                    follower.history.beyond_since = Some(self.time());
                    // told once; the guards see to the rest
                    follower.next = u64::MAX;
                }
                Ok(())
            }
            WhenUnstable::ScaleMass { .. } | WhenUnstable::Remove => Ok(()),
        }
    }

    /// Makes the step smaller where it must be, and larger where that is worth while.
    fn adapt(&mut self, follower: &mut Follower, seen: &Seen, time_step: f64) -> Result<(), Error> {
        let limit = step_of(seen.square);
        let wanted = follower.wanted(limit, seen);
        let known_now = follower.known_at == self.step_count();
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
            cause: "tissue that is squeezed flat or stiffens without end (remove such elements by VolumeRatioBelow, or \
                    when_unstable: Remove)"
                .into(),
            good_until: self.time(),
        }))
    }
}
