//! Keeping states: snapshots for a program, those that a scene's output asks for, and the last ones before a breakdown.

use super::Simulation;
use crate::components::{Clock, GuardMemory};
use crate::error::{Error, Instability, LastGood};
use crate::observation::{Observer, write_fields};
use crate::output::Series;
use crate::snapshot::Snapshot;
use std::path::{Path, PathBuf};
use std::time::Duration;
use web_time::Instant;

/// The series of the last states before a breakdown, in the output folder.
const LAST_STATES: &str = "last_states";

impl Simulation {
    /// The present state, to go back to it or to keep it in a file.
    ///
    /// # Errors
    /// That it is a static analysis; what the GPU says.
    pub fn snapshot(&mut self) -> Result<Snapshot, Error> {
        self.settle()?;
        let mut snapshot = Snapshot::take(&mut self.world)?;
        self.note_resume_state(&mut snapshot)?;
        Ok(snapshot)
    }

    /// Goes back, or on, to the state of a snapshot. Steps from there give the same bits as they did, or would have
    /// done, when it was taken, on the same backend; a snapshot of the CPU in f32 also fits the GPU, whose bits differ.
    ///
    /// # Errors
    /// That the snapshot is of another simulation, is senseless, or holds a body where nothing can be held
    /// ([`Options::grabs`](super::Options::grabs)): then nothing has changed. A custom system's state that cannot be
    /// taken back; what the GPU says.
    pub fn restore(&mut self, snapshot: &Snapshot) -> Result<(), Error> {
        self.keep_start();
        let state = self.checked_resume_state(snapshot)?;
        self.world.increment_change_tick();
        self.restored += 1;
        let before = self.step_count();
        snapshot.put(&mut self.world)?;
        (self.settling, self.preload) = (None, None);
        let ours = self.take_up_resume_state(state, before)?;
        self.forget_later(snapshot.time(), ours);
        let clock = *self.world.resource::<Clock>();
        self.began = (clock.step, clock.time());
        (self.elapsed, self.metronome, self.frames) = (Duration::ZERO, Default::default(), Default::default());
        self.failure = None;
        let mut observer = self.world.resource_mut::<Observer>();
        observer.checked_at = None;
        observer.window.clear();
        observer.writing = Duration::ZERO;
        Ok(())
    }

    /// How often it has gone over to another state otherwise than by steps: by [`restore`](Self::restore),
    /// [`reset`](Self::reset) or [`rewind`](Self::rewind). Where this is another number, what was read of the state is
    /// old, also at the same step and with as many elements.
    pub fn times_restored(&self) -> u64 {
        self.restored
    }

    /// What the guards have seen so far: the largest imbalance of energy, hourglass energies, the smallest J, the
    /// fastest node, and what they warned of.
    pub fn guards(&self) -> GuardMemory {
        self.world.get_resource::<GuardMemory>().cloned().unwrap_or_default()
    }

    /// How the simulation broke down, if it did.
    pub fn failure(&self) -> Option<&Instability> {
        self.failure.as_ref()
    }

    /// Keeps the state at the end of the last step, in a file or in memory, if that is due: not sooner, for systems
    /// that stand after `observe` belong to the step too.
    pub(super) fn keep_what_is_due(&mut self) -> Result<(), Error> {
        let step = self.step_count();
        let observer = self.world.resource::<Observer>();
        let (folder, window) = (observer.snapshot_folder(step).map(Path::to_path_buf), observer.keeps_state(step));
        if folder.is_none() && !window {
            return Ok(());
        }
        let started = Instant::now();
        let snapshot = self.snapshot()?;
        if let Some(folder) = folder {
            snapshot.write(&folder.join(snapshot.file_name()))?;
            self.world.resource_mut::<Observer>().writing += started.elapsed();
        }
        if window {
            self.world.resource_mut::<Observer>().keep_state(snapshot);
        }
        Ok(())
    }

    /// Writes the last states that passed all guards into the output folder, as fields and as snapshots, and the state
    /// in which the breakdown was noticed, if all of it can be written. The world keeps that state.
    pub(super) fn leave_last_states(&mut self, broken: &mut Instability) -> Result<(), Error> {
        let observer = self.world.resource::<Observer>();
        let Some(folder) = observer.folder().map(Path::to_path_buf) else { return Ok(()) };
        let states: Vec<Snapshot> = observer.window.iter().cloned().collect();
        let Some(good) = states.last() else { return Ok(()) };
        let found = self.snapshot()?;
        let mut series = Series::named(&folder, LAST_STATES)?;
        for state in &states {
            state.put(&mut self.world)?;
            write_fields(&mut self.world, &mut series)?;
            state.write(&folder.join(state.file_name()))?;
        }
        let (time, step, snapshot) = (good.time(), good.step(), good.file_name());
        found.put(&mut self.world)?;
        write_fields(&mut self.world, &mut series)?;
        let series = format!("{LAST_STATES}.pvd");
        broken.last_good = Some(LastGood { time, step, snapshot, series, folder });
        Ok(())
    }

    /// Writes the last state kept in memory into the output folder: what a GPU that failed has left. Its name, if there
    /// is one and it can be written.
    pub(super) fn leave_last_snapshot(&self) -> Option<PathBuf> {
        let observer = self.world.get_resource::<Observer>()?;
        let (folder, state) = (observer.folder()?, observer.window.back()?);
        let name = state.file_name();
        state.write(&folder.join(&name)).ok()?;
        Some(folder.join(&name))
    }
}
