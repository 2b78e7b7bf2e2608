//! Time.

use super::SolvedSprings;
use super::curve::smooth;
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};

/// The clock counts steps; time is their number times Δt, exact however long the run (a sum of f32 steps reads 1087.7 s
/// after 1e7 steps of 1e-4 s).
#[derive(Resource, Clone, Copy, Debug, Deserialize, Serialize)]
pub struct Clock {
    /// Steps taken.
    pub step: u64,
    /// Δt (s).
    pub time_step: f64,
    /// The step since which Δt is what it is, and the time at its beginning (s).
    pub since: (u64, f64),
    /// Δt before that (s).
    pub before: f64,
    /// How steps lead to rest, in a static analysis.
    pub relaxation: Option<Relaxation>,
    /// Whether velocities are those at the ends of steps, as implicit steps have them; else of their middles.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub velocities_at_ends: bool,
    /// The springs of contact of implicit steps, where bodies may touch something.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub springs: Option<SolvedSprings>,
}

impl Clock {
    /// At the beginning of a motion in steps of Δt (s).
    #[doc(hidden)]
    pub fn with_step(time_step: f64) -> Self {
        Self {
            step: 0,
            time_step,
            since: (0, 0.0),
            before: time_step,
            relaxation: None,
            velocities_at_ends: false,
            springs: None,
        }
    }

    /// Whether it can be the clock of a motion: steps are positive and finite, and Δt is what it is since a step that
    /// was taken.
    #[doc(hidden)]
    pub fn is_sound(&self) -> bool {
        let step = |step: f64| step.is_finite() && step > 0.0;
        let since = self.since.0 <= self.step && self.since.1.is_finite() && self.since.1 >= 0.0;
        let springs = self.springs.is_none_or(|springs| step(springs.step));
        step(self.time_step)
            && step(self.before)
            && springs
            && since
            && self.relaxation.is_none()
            && self.time().is_finite()
    }

    /// The step that is nearest to a time (s), in steps as they are now: the present one at least.
    #[doc(hidden)]
    pub fn step_nearest(&self, time: f64) -> u64 {
        let steps = ((time - self.since.1) / self.time_step).round().max(0.0);
        // a number of steps beyond what can be counted ends at the largest
        self.since.0.saturating_add(steps as u64).max(self.step)
    }

    /// Time at the beginning of a step (s), which must not lie before the last change of Δt: the time of the change and
    /// so many steps, exact however long the run.
    pub fn time_at(&self, step: u64) -> f64 {
        self.since.1 + step.saturating_sub(self.since.0) as f64 * self.time_step
    }

    /// Time from the middle of the last step to the middle of the present one (s), over which forces change velocities:
    /// Δt, in the first step half of it, and after a change of Δt the mean of both.
    #[doc(hidden)]
    pub fn half_step_interval(&self) -> f64 {
        match self.step {
            0 => 0.5 * self.time_step,
            step if step == self.since.0 => 0.5 * (self.before + self.time_step),
            _ => self.time_step,
        }
    }

    /// The times (s) from the middle of the step before to the middle of a step, which must not lie before the last
    /// change of Δt: over them forces at its beginning change velocities. The first such window begins with the motion.
    #[doc(hidden)]
    pub fn window_at(&self, step: u64) -> (f64, f64) {
        let there = Self { step, ..*self };
        let end = self.time_at(step) + 0.5 * self.time_step;
        (end - there.half_step_interval(), end)
    }

    /// What of the last displacement increment leads back to the middle of that step, where velocities are: before the
    /// first step the column holds the initial velocity, at rest there is no middle, and implicit steps have velocities
    /// at their ends.
    pub fn back_to_middle(&self) -> f64 {
        if self.step > 0 && self.relaxation.is_none() && !self.velocities_at_ends { 0.5 } else { 0.0 }
    }

    /// Δt of the last step (s).
    pub(crate) fn last_step(&self) -> f64 {
        if self.step == self.since.0 { self.before } else { self.time_step }
    }

    /// Takes steps of another length from now on (s).
    #[doc(hidden)]
    pub fn change_step(&mut self, time_step: f64) {
        // two changes before a step is taken are one
        if self.step != self.since.0 || self.step == 0 {
            self.before = self.time_step;
        }
        self.since = (self.step, self.time());
        self.time_step = time_step;
    }

    /// The present time (s). In a static analysis it grows with the loads up to the scene's duration and stays there.
    pub fn time(&self) -> f64 {
        match &self.relaxation {
            None => self.time_at(self.step),
            Some(relaxation) => relaxation.end * relaxation.progress(self.step),
        }
    }

    /// What turns a step's displacement into a velocity (1/s): 1/Δt; 0 in a static analysis, whose steps are no motion.
    pub fn rate(&self) -> f64 {
        if self.relaxation.is_some() { 0.0 } else { 1.0 / self.time_step }
    }
}

/// Dynamic relaxation: pseudo-steps that lead to rest. Chosen by the simulation, anew every so many steps.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq)]
pub struct Relaxation {
    /// The time whose loads and motions are wanted (s).
    pub end: f64,
    /// A step, and how far loads had grown in it: from there they grow by `ramp_rate` a step.
    pub since: (u64, f64),
    /// By how much the progress of loads grows in a step.
    pub ramp_rate: f64,
    /// a = cΔt/2 of the damping c, the same for all nodes.
    pub damping: f64,
    /// What forces are multiplied with, over the inertial mass: how much the bound of the stable step is outdone.
    pub force_scale: f64,
}

impl Relaxation {
    /// How far loads and motions have grown at the end of so many steps, from 0 to 1.
    pub fn progress(&self, steps: u64) -> f64 {
        (self.since.1 + self.ramp_rate * steps.saturating_sub(self.since.0) as f64).min(1.0)
    }

    /// What loads and motions are multiplied with then: the progress by the 3-4-5 polynomial, so that nothing begins or
    /// ends suddenly.
    pub fn share(&self, steps: u64) -> f64 {
        smooth(self.progress(steps))
    }
}

/// Whether forces are only tried: those at displacements that a solver may not keep. They leave the memory of viscous
/// materials as it is, and note nothing of elements turned inside out but that there are some. Exists where steps are
/// implicit.
#[derive(Resource, Clone, Copy, Debug, Default)]
pub struct TrialForces {
    /// Whether they are.
    pub trying: bool,
    /// Whether an element that must not be is turned inside out there.
    pub inverted: bool,
}
