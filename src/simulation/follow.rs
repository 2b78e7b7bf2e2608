//! The stable step followed during the run: a cheap bound every few steps, and what the scene wants done about it.
//! When the highest frequency itself is found is in [`adapt`](super::adapt) and [`policies`](super::policies).

use super::Simulation;
use super::load_rates::LoadRates;
use super::mass_scaling;
use super::rounding::warn_of_rounding;
use super::stable_step::Stability;
use super::stiffness::{StabilitySample, StiffnessTracker};
use crate::backend::device::{bring_to_host, send_to_device};
use crate::components::*;
use crate::error::Error;
use crate::scene::schema::{Scene, WhenUnstable};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use web_time::Instant;

/// Steps between two checks of all elements: where strains change slowly at least, and at most; and no more than have
/// been taken since the beginning or since loads and motions last became quicker, because what begins smoothly becomes
/// faster.
const CHECK_STEPS: (u64, u64) = (16, 256);
/// Between two checks strains change by so much, at the present speed: close to the limit, and where the step is half
/// of it or less. The stable step of what is squeezed shrinks twice as fast as it, and a twentieth is left when it
/// counts as close.
const STRAIN: (f64, f64) = (0.01, 0.25);
/// No more than that between two checks, however close they come: with .2 a cube crushed to a twentieth within .8 s
/// breaks down in some ways of 54, with .1 in none, nor where it is crushed within .4 s or .1 s.
const MOST_STRAIN: f64 = 0.1;
/// A change of strain in a step, relative to the mean of present lengths over the axes, from which on motion counts as
/// violent: the room between what the elements alone allow and the true limit is then needed, for what a check cannot
/// foresee and for the balance of energy. (Without this rule H08 breaks down in 18 of 48 ways.)
const VIOLENT: f64 = 0.02;

/// How the step went during the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepHistory {
    /// How often it was changed.
    pub changes: u64,
    /// The smallest step taken (s).
    pub smallest: f64,
    /// The largest step taken (s).
    pub largest: f64,
    /// How often all elements were checked.
    pub checks: u64,
    /// How often the highest frequency was found during the run.
    pub eigenvalue_estimates: u64,
    /// What checking took (s).
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
    /// Whether the step takes nothing but the bound of the elements for granted from the start: it never grows beyond
    /// that.
    by_elements: bool,
    /// The share of the stable step at the start that the scene's own one is; else 0.
    own_share: f64,
    /// What forces on nodes make of a stable step at the start: all frequencies here are of the bodies alone.
    loads_at_start: LoadRates,
    pub duration: f64,
    pub first: f64,
    pub trackers: Vec<StiffnessTracker>,
    pub found: Found,
    /// The shape of what is quickest, when it was found last: see [`largest_near`](super::frequency::largest_near).
    pub shape: Option<Vec<f32>>,
    pub history: StepHistory,
}

/// What has been found so far.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Found {
    /// The step before which is checked next.
    pub next: u64,
    /// The step of the last check.
    pub checked_at: u64,
    /// The step in which loads and motions became quicker last, of those that were checked.
    pub quickened: u64,
    /// The step from which on they become quicker, where it is checked next for that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quickens_at: Option<u64>,
    /// What forces on nodes make of the step, where that has been counted anew since the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loads: Option<LoadRates>,
    /// Whether forces on nodes have become less stiff since the step last grew to what is stable.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub eased: bool,
    /// ω² of all bodies at most when it was checked last (1/s²); 0: not yet.
    #[serde(default)]
    pub latest: f64,
    /// The step in which an input last changed.
    #[serde(default)]
    pub changed: Option<u64>,
    /// The step that the scene or the program wants, which it never grows beyond (s).
    pub own: Option<f64>,
    /// The highest ω² when it was found last (1/s²), and what was seen then.
    pub known: f64,
    pub seen: Option<StabilitySample>,
    /// The share of each step that is lost because the highest ω² is not found anew, as far as that can be guessed; and
    /// steps that have been lost so since it was found.
    pub losing: f64,
    pub lost: f64,
    /// Whether strains have changed so fast that the step stays with what the elements alone allow: see [`VIOLENT`].
    pub violent: bool,
}

impl Found {
    /// Takes what was seen as known.
    pub fn take(&mut self, seen: &StabilitySample) {
        (self.known, self.seen) = (seen.square, Some(*seen));
        (self.lost, self.losing) = (0.0, 0.0);
    }
}

/// The same with how it went, for snapshots.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Followed {
    found: Found,
    history: StepHistory,
    /// Of each block, as base64 of f32; none before the first check.
    ratios: Vec<String>,
    /// The shape of what is quickest, in the same way.
    shape: Option<String>,
}

impl Follower {
    /// `None` where there is no motion.
    pub fn new(scene: &Scene, stability: &Stability, initial_mass: f64, world: &mut World) -> Option<Self> {
        let (limit, integration) = (stability.limit?, &scene.integration);
        let step = world.resource::<Clock>().time_step;
        let added = if scene.scales_mass() { mass_scaling::scale_masses(world).mass } else { 0.0 };
        let policy = scene.when_unstable();
        Some(Self {
            policy,
            safety: integration.safety,
            by_elements: stability.stays_with_elements,
            own_share: integration.step.map_or(0.0, |step| step / limit),
            loads_at_start: stability.loads,
            duration: scene.duration,
            first: step,
            trackers: Vec::new(),
            found: Found {
                next: 0,
                checked_at: 0,
                quickened: 0,
                quickens_at: None,
                loads: None,
                eased: false,
                latest: 0.0,
                changed: None,
                own: integration.step,
                known: square_of(stability.limit_of_bodies),
                seen: None,
                losing: 0.0,
                lost: 0.0,
                violent: false,
            },
            shape: None,
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

    /// The share of the stable step beyond which a step counts as too large: half of what was left at the start is used
    /// up.
    pub fn most(&self) -> f64 {
        0.5 * (1.0 + self.safety.max(self.own_share).min(1.0))
    }

    /// What forces on nodes make of a stable step now.
    pub fn loads(&self) -> LoadRates {
        self.found.loads.unwrap_or(self.loads_at_start)
    }

    /// The stable step when ω² of the bodies is so large (s).
    pub fn step_of(&self, square: f64) -> f64 {
        self.loads().with(step_of(square))
    }

    /// The largest step that may be taken when so much is stable (s).
    pub fn wanted(&self, limit: f64, seen: &StabilitySample) -> f64 {
        let by_elements = self.by_elements || self.found.violent;
        let elements = if by_elements { self.safety * self.step_of(seen.at_rest) } else { f64::INFINITY };
        (self.safety * limit).min(elements).min(self.found.own.unwrap_or(f64::INFINITY))
    }
}

impl Follower {
    /// What has been found so far.
    pub fn followed(&self) -> Followed {
        let ratios = self.trackers.iter().map(|block| text_of(block.known_ratio())).collect();
        // time on a clock on the wall is no part of the state
        let history = StepHistory { seconds: 0.0, ..self.history };
        Followed { found: self.found.clone(), history, ratios, shape: self.shape.as_deref().map(text_of) }
    }

    /// Goes on from what had been found, which [fits](Followed::fits).
    pub fn take_up(&mut self, followed: Followed, world: &mut World) {
        self.trackers = if followed.ratios.is_empty() { Vec::new() } else { StiffnessTracker::all(world) };
        for (block, ratio) in self.trackers.iter_mut().zip(&followed.ratios) {
            let taken = numbers_of(ratio).is_some_and(|ratio| block.take_known_ratio(ratio, world));
            debug_assert!(taken, "the ratios of other elements");
        }
        self.shape = followed.shape.as_deref().and_then(numbers_of);
        (self.found, self.history) = (followed.found, followed.history);
    }

    /// Elements have gone since the highest frequency was found: their mass has gone with them, and what was found
    /// holds no more.
    pub fn has_lost(&self, seen: &StabilitySample) -> bool {
        self.found.seen.is_some_and(|before| seen.alive < before.alive)
    }

    /// An input changes in a step, perhaps so that loads and motions become quicker than ever before. Whether it was
    /// checked before that or is after makes no difference.
    pub fn note_change(&mut self, step: u64, quickens: bool) {
        // where nothing would be done about it nobody checks
        if self.found.next == u64::MAX {
            return;
        }
        self.found.changed = Some(step);
        let within = if quickens { 1 } else { CHECK_STEPS.0 };
        self.found.next = self.found.next.min(step + within);
        // what comes after that check is sought at it
        self.found.quickens_at = self.found.quickens_at.filter(|at| *at < step + within);
        if quickens {
            self.found.quickened = step;
        }
    }

    /// Forces on nodes are less stiff from here on: the step may grow.
    pub fn ease(&mut self) {
        self.found.eased = true;
        self.check_soon();
    }

    /// Checks before the next step.
    pub fn check_soon(&mut self) {
        // where nothing would be done about it nobody checks
        if self.found.next != u64::MAX {
            self.found.next = self.found.next.min(self.found.checked_at);
        }
    }

    /// The step before which is checked next: sooner where strains change fast, where the step is close to the limit,
    /// and before loads and motions become quicker, `quicker` (s).
    fn next_check(&mut self, step: u64, seen: &StabilitySample, clock: &Clock, quicker: Option<f64>) -> u64 {
        // far below the limit more may happen unseen
        let room = self.most() * self.step_of(seen.square) / clock.time_step - 1.0;
        let strain = (STRAIN.1 * room).clamp(STRAIN.0, STRAIN.1);
        // what is no number, or inside out, has no speed
        let speed = if seen.speed.is_finite() { seen.speed } else { MOST_STRAIN };
        let least = ((MOST_STRAIN / speed) as u64).clamp(1, CHECK_STEPS.0);
        let calm =
            ((strain / speed) as u64).clamp(least, CHECK_STEPS.1).min(step.saturating_sub(self.found.quickened).max(1));
        // what begins to change may be anything
        let calm = if self.found.changed == Some(step) { calm.min(CHECK_STEPS.0) } else { calm };
        let until = |time: f64| ((time - clock.time()) / clock.time_step).ceil();
        let sooner = quicker.map(until).filter(|steps| *steps < calm as f64);
        self.found.quickens_at = sooner.map(|steps| step + steps as u64);
        self.found.quickens_at.map_or(step + calm, |at| at.max(step + 1))
    }
}

impl Followed {
    /// Whether it can be that of a world.
    pub fn fits(&self, world: &mut World) -> bool {
        let mut blocks: Vec<(Entity, usize)> =
            world.query::<(Entity, &Block)>().iter(world).map(|(entity, block)| (entity, block.count)).collect();
        blocks.sort();
        let ratios: Option<Vec<usize>> =
            self.ratios.iter().map(|text| numbers_of(text).map(|numbers| numbers.len())).collect();
        let counts = || blocks.iter().map(|block| block.1);
        let fits = ratios.is_some_and(|ratios| ratios.is_empty() || ratios.into_iter().eq(counts()));
        let shape = self.shape.as_ref().is_none_or(|text| numbers_of(text).is_some());
        let loads = self.found.loads.is_none_or(|loads| loads.are_sound());
        let numbers = [self.found.known, self.found.lost, self.found.losing, self.found.latest];
        fits && shape && loads && numbers.iter().all(|number| number.is_finite())
    }
}

/// Numbers as base64, for snapshots.
fn text_of(numbers: &[f32]) -> String {
    BASE64_STANDARD.encode(numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>())
}

fn numbers_of(text: impl AsRef<str>) -> Option<Vec<f32>> {
    let bytes = BASE64_STANDARD.decode(text.as_ref()).ok()?;
    Some(bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect())
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
        self.solver.follower().map(|follower| &follower.history)
    }

    /// Checks the stable step if it is time, and does what the scene wants done.
    pub(super) fn follow(&mut self) -> Result<(), Error> {
        if self.solver.next_check() > self.step_count() {
            return Ok(());
        }
        let Some(mut follower) = self.solver.lend_follower() else {
            return self.choose_step().map_err(|error| self.note(error));
        };
        let started = Instant::now();
        let checked = self.check_with(&mut follower);
        follower.history.seconds += started.elapsed().as_secs_f64();
        self.solver.take_back(follower);
        checked.map_err(|error| self.note(error))
    }

    fn check_with(&mut self, follower: &mut Follower) -> Result<(), Error> {
        let moving = [Displacement::NAME, DisplacementIncrement::NAME, RestShape::NAME];
        bring_to_host(&mut self.world, |_, name| moving.contains(&name))?;
        if follower.trackers.is_empty() {
            follower.trackers = StiffnessTracker::all(&mut self.world);
        }
        let step = self.step_count();
        let mut seen = StabilitySample::NOTHING;
        for block in &mut follower.trackers {
            seen = seen.and(block.sample(&self.world));
        }
        follower.history.checks += 1;
        if let Some(at) = follower.found.quickens_at.take_if(|at| *at <= step) {
            follower.found.quickened = at;
        }
        warn_of_rounding(&follower.trackers, &mut self.world);
        let lost = follower.has_lost(&seen);
        // what was found of more elements says nothing
        seen.square = if lost { seen.of_elements } else { seen.of_elements.min(follower.found.known * seen.ratio) };
        follower.found.latest = if seen.square.is_finite() { seen.square } else { follower.found.latest };
        if lost && matches!(follower.policy, WhenUnstable::ScaleMass { .. }) {
            // what was added to removed elements goes with them
            bring_to_host(&mut self.world, |_, name| [Mass::NAME, InertialMass::NAME].contains(&name))?;
            mass_scaling::scale_masses(&mut self.world);
            send_to_device(&mut self.world, |_, name| name == InertialMass::NAME)?;
        }
        // what is no number is the guards' business
        let sound = seen.speed.is_finite() && seen.of_elements > 0.0;
        follower.found.violent |= seen.mean_speed >= VIOLENT;
        let mut grows = false;
        let known = match follower.policy {
            _ if !sound => None,
            WhenUnstable::Adapt => {
                grows = self.adapt(follower, &mut seen)?;
                None
            }
            _ => self.hold(follower, &mut seen)?,
        };
        if matches!(follower.policy, WhenUnstable::ScaleMass { .. }) {
            // what removal sums on a device
            send_to_device(&mut self.world, |_, name| name == AddedMass::NAME)?;
        }
        // by the step that is taken from here on, unless it is known already
        follower.found.next = known.unwrap_or_else(|| {
            let clock = *self.world.resource::<Clock>();
            let quicker = self.world.resource::<Signals>().quickens_after(clock.time());
            let next = follower.next_check(step, &seen, &clock, quicker);
            if grows { next.min(step + CHECK_STEPS.0) } else { next }
        });
        follower.found.checked_at = step;
        Ok(())
    }
}
