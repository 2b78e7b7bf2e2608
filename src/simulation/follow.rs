//! The stable step followed during the run: a cheap bound every few steps, and what the scene wants done about it.
//! When the highest frequency itself is found is in [`adapt`](super::adapt) and [`policies`](super::policies).

use super::Simulation;
use super::mass_scaling;
use super::rounding::warn_of_rounding;
use super::stable_step::Stability;
use super::watch::{Seen, Watched};
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::{Scene, WhenUnstable};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// Steps between two looks at all elements: at least, and at most; and no more than half of all steps so far, because what
/// begins smoothly becomes faster.
const LOOKS: (u64, u64) = (16, 256);
/// Between two looks strains change by so much, at the present speed: close to the limit, and where the step is half of it
/// or less. The stable step of what is squeezed shrinks twice as fast as it, and a twentieth is left when it counts as close.
const STRAIN: (f64, f64) = (0.01, 0.25);
/// No more than that between two looks, however close they come: what falls flat must not pass through zero unseen.
const MOST_STRAIN: f64 = 0.5;

/// How the step went during the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// Kinetic energy that mass brought which was added during the run (J).
    pub added_energy: f64,
    /// Elements that were removed because they need a smaller step.
    pub removed: u64,
}

/// Follows the stable step of a run.
pub(super) struct Follower {
    pub policy: WhenUnstable,
    pub safety: f64,
    /// The step takes nothing but the bound of the elements for granted: it never grows beyond that.
    by_elements: bool,
    /// The share of the stable step at the start that the scene's own one is; else 0.
    own_share: f64,
    pub duration: f64,
    pub first: f64,
    pub watched: Vec<Watched>,
    pub found: Found,
    pub history: StepHistory,
}

/// What has been found so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Found {
    /// The step before which is looked next.
    pub next: u64,
    /// The step that the scene or the program wants, which it never grows beyond (s).
    pub own: Option<f64>,
    /// The highest ω² when it was found last (1/s²): in which step, and what was seen then.
    pub known: f64,
    pub known_at: u64,
    pub seen: Option<Seen>,
    /// Whether the step was made smaller on the word of the cheap bound.
    pub guessed: bool,
}

/// The same with how it went, for snapshots.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Followed {
    found: Found,
    history: StepHistory,
    /// Of each block, as base64 of f32; none before the first look.
    growths: Vec<String>,
}

impl Follower {
    /// `None` where there is no motion.
    pub fn new(scene: &Scene, stability: &Stability, initial_mass: f64, world: &mut World) -> Option<Self> {
        let (limit, integration) = (stability.limit?, &scene.integration);
        let step = world.resource::<Clock>().time_step;
        let added = if scene.scales_mass() { mass_scaling::weigh(world).mass } else { 0.0 };
        let policy = scene.when_unstable();
        // a scene's own step may need elements to go before they do harm
        let at_once = step > limit && policy == WhenUnstable::Remove;
        Some(Self {
            policy,
            safety: integration.safety,
            by_elements: stability.stays_with_elements,
            own_share: integration.step.map_or(0.0, |step| step / limit),
            duration: scene.duration,
            first: step,
            watched: Vec::new(),
            found: Found {
                next: if at_once { 0 } else { LOOKS.0 },
                own: integration.step,
                known: square_of(limit),
                known_at: 0,
                seen: None,
                guessed: false,
            },
            history: StepHistory {
                smallest: step,
                largest: step,
                added_mass: added,
                added_share: added / initial_mass,
                beyond_since: (step > limit && policy == WhenUnstable::Watch).then_some(0.0),
                ..StepHistory::default()
            },
        })
    }

    /// The share of the stable step beyond which a step counts as too large: half of what was left at the start is used up.
    pub fn most(&self) -> f64 {
        0.5 * (1.0 + self.safety.max(self.own_share).min(1.0))
    }

    /// The largest step that may be taken when so much is stable (s).
    pub fn wanted(&self, limit: f64, seen: &Seen) -> f64 {
        let elements = if self.by_elements { self.safety * step_of(seen.at_rest) } else { f64::INFINITY };
        (self.safety * limit).min(elements).min(self.found.own.unwrap_or(f64::INFINITY))
    }
}

impl Follower {
    /// What has been found so far.
    pub fn followed(&self) -> Followed {
        let growth = |block: &Watched| {
            let bytes: Vec<u8> = block.known_growth().iter().flat_map(|growth| growth.to_le_bytes()).collect();
            BASE64_STANDARD.encode(bytes)
        };
        let growths = self.watched.iter().map(growth).collect();
        // time on a clock on the wall is no part of the state
        let history = StepHistory { seconds: 0.0, ..self.history };
        Followed { found: self.found.clone(), history, growths }
    }

    /// Goes on from what had been found; false where it does not fit the world.
    pub fn take_up(&mut self, followed: Followed, world: &mut World) -> bool {
        self.watched = if followed.growths.is_empty() { Vec::new() } else { Watched::all(world) };
        let growth = |text: &String| {
            let bytes = BASE64_STANDARD.decode(text).ok()?;
            Some(bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect::<Vec<f32>>())
        };
        let growths: Option<Vec<Vec<f32>>> = followed.growths.iter().map(growth).collect();
        let Some(growths) = growths.filter(|growths| growths.len() == self.watched.len()) else { return false };
        let fits = self.watched.iter_mut().zip(growths).all(|(block, growth)| block.take_known_growth(growth));
        (self.found, self.history) = (followed.found, followed.history);
        fits && self.found.known.is_finite()
    }

    /// Elements have gone since the highest frequency was found: their mass has gone with them, and what was found holds no more.
    pub fn has_lost(&self, seen: &Seen) -> bool {
        self.found.seen.is_some_and(|before| seen.alive < before.alive)
    }

    /// The step before which is looked next: sooner where strains change fast and where the step is close to the limit.
    fn next_look(&self, step: u64, seen: &Seen, clock: &Clock) -> u64 {
        // far below the limit more may happen unseen
        let room = self.most() * step_of(seen.square) / clock.time_step - 1.0;
        let strain = (STRAIN.1 * room).clamp(STRAIN.0, STRAIN.1);
        let calm = ((strain / seen.speed) as u64).min(step / 2);
        // what is no number, or inside out, has no speed
        let least =
            if seen.speed.is_finite() { ((MOST_STRAIN / seen.speed) as u64).clamp(1, LOOKS.0) } else { LOOKS.0 };
        step + calm.clamp(least, LOOKS.1)
    }
}

/// 2/ω.
pub(super) fn step_of(square: f64) -> f64 {
    2.0 / square.sqrt()
}

/// ω² of a stable step.
pub(super) fn square_of(step: f64) -> f64 {
    4.0 / (step * step)
}

impl Simulation {
    /// How the step went so far; `None` in a static analysis.
    pub fn step_history(&self) -> Option<&StepHistory> {
        self.follower.as_ref().map(|follower| &follower.history)
    }

    /// The next step before which the stable step is looked at.
    pub(super) fn next_follow(&self) -> u64 {
        self.follower.as_ref().map_or(u64::MAX, |follower| follower.found.next)
    }

    /// Looks at the stable step if it is time, and does what the scene wants done.
    pub(super) fn follow(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        let Some(mut follower) = self.follower.take_if(|follower| follower.found.next <= step) else { return Ok(()) };
        let started = Instant::now();
        let looked = self.look_with(&mut follower);
        follower.history.seconds += started.elapsed().as_secs_f64();
        self.follower = Some(follower);
        looked.map_err(|error| self.note(error))
    }

    fn look_with(&mut self, follower: &mut Follower) -> Result<(), Error> {
        let moving = [Displacement::NAME, DisplacementStep::NAME, RestShape::NAME];
        bring_to_host(&mut self.world, |_, name| moving.contains(&name))?;
        if follower.watched.is_empty() {
            follower.watched = Watched::all(&mut self.world);
        }
        let step = self.step_count();
        let all = follower.watched.iter().map(|block| block.look(&self.world, follower.found.known));
        let mut seen = all.fold(Seen::NOTHING, Seen::and);
        follower.history.looks += 1;
        warn_of_rounding(&follower.watched, &mut self.world);
        let clock = *self.world.resource::<Clock>();
        let lost = follower.has_lost(&seen);
        if lost {
            seen.square = seen.of_elements;
        }
        if lost && matches!(follower.policy, WhenUnstable::ScaleMass { .. }) {
            // what was added to removed elements goes with them
            bring_to_host(&mut self.world, |_, name| [Mass::NAME, FictitiousMass::NAME].contains(&name))?;
            mass_scaling::weigh(&mut self.world);
            send_to_device(&mut self.world, |_, name| name == FictitiousMass::NAME)?;
        }
        follower.found.next = follower.next_look(step, &seen, &clock);
        // what is no number is the guards' business
        if seen.speed.is_finite() && seen.alive > 0 {
            match follower.policy {
                WhenUnstable::Adapt => self.adapt(follower, seen)?,
                _ => self.hold(follower, seen)?,
            }
        }
        Ok(())
    }
}
