//! What a simulation remembers of its pace, beside the clock: for snapshots, so that what goes on from one takes the same steps.

use super::beat::Beat;
use super::follow::Followed;
use super::step_change::relax_as;
use super::{Job, Simulation};
use crate::components::Clock;
use crate::error::Error;
use crate::observation::Observer;
use crate::snapshot::{Snapshot, SnapshotError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The pace at the end of a step.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Pace {
    /// The last step of the scene, in steps as they are now.
    last_step: u64,
    /// When systems on the host run next, by name.
    beats: BTreeMap<String, Beat>,
    /// What is known of the stable step.
    found: Option<Followed>,
}

impl Simulation {
    /// Notes the pace in a snapshot of the world.
    pub(super) fn note_pace(&self, snapshot: &mut Snapshot) {
        let beat = |entry: &super::Entry| match &entry.job {
            Job::Host { beat, .. } => Some((entry.name.clone(), *beat)),
            Job::Kernels(_) => None,
        };
        let pace = Pace {
            last_step: self.facts.steps,
            beats: self.entries.iter().filter_map(beat).collect(),
            found: self.follower.as_ref().map(|follower| follower.followed()),
        };
        // numbers and names are always written
        snapshot.set_pace(serde_json::to_value(pace).unwrap_or_default());
    }

    /// Goes on at the pace of a snapshot that has been put into the world.
    pub(super) fn take_up_pace(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        let senseless = |reason: String| SnapshotError::Senseless(format!("its pace cannot be taken up: {reason}"));
        let pace: Pace =
            serde_json::from_value(snapshot.pace().clone()).map_err(|error| senseless(error.to_string()))?;
        let clock = *self.world.resource::<Clock>();
        relax_as(&mut self.world, &clock)?;
        for entry in &mut self.entries {
            if let (Job::Host { beat, .. }, Some(kept)) = (&mut entry.job, pace.beats.get(&entry.name)) {
                *beat = *kept;
            }
        }
        self.facts.steps = pace.last_step;
        self.world.resource_mut::<Observer>().go_on(&clock, pace.last_step);
        if let (Some(follower), Some(found)) = (&mut self.follower, pace.found)
            && !follower.take_up(found, &mut self.world)
        {
            return Err(senseless("it is that of other elements".into()).into());
        }
        Ok(())
    }
}
