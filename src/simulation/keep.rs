//! Keeping states: snapshots for a program, and those that a scene's output asks for.

use super::Simulation;
use crate::components::Clock;
use crate::error::Error;
use crate::observation::Observer;
use crate::snapshot::Snapshot;
use std::time::Duration;

impl Simulation {
    /// The present state, to go back to it or to keep it in a file.
    ///
    /// # Errors
    /// That it is a static analysis; what the GPU says.
    pub fn snapshot(&mut self) -> Result<Snapshot, Error> {
        Snapshot::take(&mut self.world)
    }

    /// Goes back, or on, to the state of a snapshot. Steps from there give the same bits as they did, or would have done,
    /// when it was taken, on the same backend; a snapshot of the CPU in f32 also fits the GPU, whose bits differ.
    ///
    /// # Errors
    /// That the snapshot is of another simulation (then nothing has changed); what the GPU says.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        snapshot.put(&mut self.world)?;
        let clock = *self.world.resource::<Clock>();
        self.began = (clock.step, clock.time());
        self.elapsed = Duration::ZERO;
        self.world.resource_mut::<Observer>().good_until = clock.time();
        Ok(())
    }

    /// Writes a snapshot if one is due at the end of the last step: not sooner, for systems that stand after `observe` belong
    /// to the step too.
    pub(super) fn keep_what_is_due(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        let observer = self.world.resource::<Observer>();
        let Some(folder) = observer.snapshot_folder(step).map(|folder| folder.to_path_buf()) else { return Ok(()) };
        let snapshot = Snapshot::take(&mut self.world)?;
        snapshot.write(&folder.join(snapshot.file_name()))
    }
}
