//! What a simulation remembers of its adaptive step and its programs, beside the clock: for snapshots, so that what
//! goes on from one takes the same steps.

use super::follow::Followed;
use super::grab::AllGrabs;
use super::implicit::Controlled;
use super::interval::RunInterval;
use super::ports::PortState;
use super::step_change::relax_as;
use super::{Job, Simulation};
use crate::components::{Clock, Grabs, InputState};
use crate::error::Error;
use crate::observation::Observer;
use crate::snapshot::{Snapshot, SnapshotError};
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What a run goes on with after a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ResumeState {
    /// When systems on the host run next, by name.
    intervals: BTreeMap<String, RunInterval>,
    /// What is known of the stable step.
    found: Option<Followed>,
    /// What chooses implicit steps by their errors remembers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    control: Option<Controlled>,
    /// What programs set.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    inputs: BTreeMap<String, InputState>,
    /// What hands do.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    ports: BTreeMap<String, PortState>,
    /// Whether they may hold something.
    #[serde(default, skip_serializing_if = "is_default")]
    can_grab: bool,
    /// What they hold.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    grabs: AllGrabs,
    /// The scene's text, where its parameters have been changed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scene: Option<String>,
    /// The hash of what they had done before this step.
    #[serde(default, skip_serializing_if = "is_default")]
    changes: u64,
    /// Up to when there are outputs: what ends a run says so. Those of older versions lack it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    good_until: Option<f64>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn senseless(reason: impl std::fmt::Display) -> SnapshotError {
    SnapshotError::Senseless(format!("its resume state cannot be taken up: {reason}"))
}

fn resume_state_of(snapshot: &Snapshot) -> Result<ResumeState, SnapshotError> {
    ron::from_str(snapshot.resume_state()).map_err(senseless)
}

impl Simulation {
    /// Whether a snapshot is of a simulation with [`Options::grabs`](super::Options::grabs): one that goes on from it
    /// needs them, too.
    ///
    /// # Errors
    /// A snapshot that is senseless.
    pub fn can_grab_in(snapshot: &Snapshot) -> Result<bool, Error> {
        Ok(resume_state_of(snapshot)?.can_grab)
    }

    /// Notes the resume state in a snapshot of the world.
    pub(super) fn note_resume_state(&mut self, snapshot: &mut Snapshot) -> Result<(), SnapshotError> {
        let interval = |entry: &super::ScheduledPass| match &entry.job {
            Job::Host { interval, .. } => Some((entry.name.clone(), *interval)),
            Job::Kernels(_) => None,
        };
        let state = ResumeState {
            intervals: self.entries.iter().filter_map(interval).collect(),
            found: self.solver.follower().map(|follower| follower.followed()),
            control: self.solver.step_control().map(|control| control.state()),
            inputs: self.input_states(),
            ports: self.port_states(),
            can_grab: self.world.query::<&Grabs>().iter(&self.world).next().is_some(),
            grabs: self.grabs.clone(),
            scene: self.changed_text(),
            changes: self.lineage.before(self.step_count()).unwrap_or_default(),
            good_until: self.world.get_resource::<Observer>().map(|observer| observer.good_until),
        };
        let text = ron::to_string(&state).map_err(|error| SnapshotError::Senseless(error.to_string()))?;
        snapshot.set_resume_state(text);
        Ok(())
    }

    /// The resume state of a snapshot, if all of it fits; nothing has changed then.
    pub(super) fn checked_resume_state(&mut self, snapshot: &Snapshot) -> Result<ResumeState, Error> {
        let state = resume_state_of(snapshot)?;
        self.check_grabs(&state.grabs)?;
        self.check_changed(state.scene.as_deref())?;
        snapshot.fits(&mut self.world)?;
        if let Some((name, _)) = state.intervals.iter().find(|(_, interval)| !interval.is_sound()) {
            return Err(senseless(format!("the system `{name}` can never run")).into());
        }
        if state.control.is_some_and(|control| !control.is_sound()) {
            return Err(senseless("its steps have no length").into());
        }
        if state.good_until.is_some_and(|time| !time.is_finite()) {
            return Err(senseless("its outputs end at no time").into());
        }
        self.check_input_states(&state.inputs).map_err(senseless)?;
        self.check_port_states(&state.ports).map_err(senseless)?;
        let found = state.found.as_ref().filter(|_| self.solver.follower().is_some());
        match found.is_none_or(|found| found.fits(&mut self.world)) {
            true => Ok(state),
            false => Err(senseless("it is that of other elements").into()),
        }
    }

    /// Goes on with the resume state of a snapshot that has been put into the world, where the run was at the step
    /// `before`; whether it has been where it goes on from.
    pub(super) fn take_up_resume_state(&mut self, state: ResumeState, before: u64) -> Result<bool, Error> {
        let ours = self.lineage.go_on_from(self.step_count(), state.changes, before);
        self.take_up_input_states(state.inputs, ours);
        self.take_up_port_states(state.ports);
        self.take_up_grabs(state.grabs)?;
        self.take_up_changed(state.scene)?;
        self.surfaces.clear();
        let clock = *self.world.resource::<Clock>();
        relax_as(&mut self.world, &clock)?;
        for entry in &mut self.entries {
            if let (Job::Host { interval, .. }, Some(kept)) = (&mut entry.job, state.intervals.get(&entry.name)) {
                *interval = *kept;
            }
        }
        // the scene may last longer than that of the snapshot
        let duration = self.scene.duration;
        let chosen =
            self.solver.step_control().and_then(|control| control.last_step(&clock, clock.time_step, duration));
        let last_step = chosen.unwrap_or_else(|| clock.step_nearest(duration));
        self.facts.steps = last_step;
        self.world.resource_scope(|world, mut observer: Mut<Observer>| observer.go_on(world, last_step))?;
        if let (Some(follower), Some(found)) = (self.solver.follower_mut(), state.found) {
            follower.take_up(found, &mut self.world);
        }
        self.world.resource_mut::<Observer>().good_until = state.good_until.unwrap_or_else(|| clock.time());
        if let (Some(control), Some(state)) = (self.solver.step_control(), state.control) {
            control.take_up(state);
        }
        Ok(ours)
    }
}
