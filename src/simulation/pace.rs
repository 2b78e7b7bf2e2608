//! What a simulation remembers of its pace, beside the clock: for snapshots, so that what goes on from one takes the
//! same steps.

use super::beat::Beat;
use super::follow::Followed;
use super::grab::AllGrabs;
use super::step_change::relax_as;
use super::{Job, Simulation};
use crate::components::{Clock, InputState};
use crate::error::Error;
use crate::observation::Observer;
use crate::snapshot::{Snapshot, SnapshotError};
use bevy_ecs::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The pace at the end of a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pace {
    /// When systems on the host run next, by name.
    beats: BTreeMap<String, Beat>,
    /// What is known of the stable step.
    found: Option<Followed>,
    /// What programs set.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    inputs: BTreeMap<String, InputState>,
    /// What they hold.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    grabs: AllGrabs,
}

impl Simulation {
    /// Notes the pace in a snapshot of the world.
    pub(super) fn note_pace(&self, snapshot: &mut Snapshot) -> Result<(), SnapshotError> {
        let beat = |entry: &super::Entry| match &entry.job {
            Job::Host { beat, .. } => Some((entry.name.clone(), *beat)),
            Job::Kernels(_) => None,
        };
        let pace = Pace {
            beats: self.entries.iter().filter_map(beat).collect(),
            found: self.solver.follower().map(|follower| follower.followed()),
            inputs: self.input_states(),
            grabs: self.grabs.clone(),
        };
        let text = ron::to_string(&pace).map_err(|error| SnapshotError::Senseless(error.to_string()))?;
        snapshot.set_pace(text);
        Ok(())
    }

    /// Goes on at the pace of a snapshot that has been put into the world, where the run was at the step `before`.
    pub(super) fn take_up_pace(&mut self, snapshot: &Snapshot, before: u64) -> Result<(), Error> {
        let senseless = |reason: String| SnapshotError::Senseless(format!("its pace cannot be taken up: {reason}"));
        let pace: Pace = ron::from_str(snapshot.pace()).map_err(|error| senseless(error.to_string()))?;
        if let Some((name, _)) = pace.beats.iter().find(|(_, beat)| !beat.is_sound()) {
            return Err(senseless(format!("the system `{name}` can never run")).into());
        }
        self.take_up_input_states(pace.inputs, before).map_err(senseless)?;
        self.take_up_grabs(pace.grabs)?;
        self.surfaces.clear();
        let clock = *self.world.resource::<Clock>();
        relax_as(&mut self.world, &clock)?;
        for entry in &mut self.entries {
            if let (Job::Host { beat, .. }, Some(kept)) = (&mut entry.job, pace.beats.get(&entry.name)) {
                *beat = *kept;
            }
        }
        // the scene may last longer than that of the snapshot
        let last_step = clock.step_nearest(self.scene.duration);
        self.facts.steps = last_step;
        self.world.resource_scope(|world, mut observer: Mut<Observer>| observer.go_on(world, last_step))?;
        if let (Some(follower), Some(found)) = (self.solver.follower_mut(), pace.found)
            && !follower.take_up(found, &mut self.world)
        {
            return Err(senseless("it is that of other elements".into()).into());
        }
        Ok(())
    }
}
