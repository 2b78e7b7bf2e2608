//! Going back: to the first state, and to states that are kept during the run.

use super::Simulation;
use super::grab::AllGrabs;
use crate::components::{Clock, Signals};
use crate::error::Error;
use crate::snapshot::{PackedSnapshot, Snapshot};
use std::collections::VecDeque;

/// What is kept to go back to.
#[derive(Default)]
pub(super) struct History {
    /// The state before the first step.
    start: Option<PackedSnapshot>,
    /// Why that was not kept, where it should have been.
    no_start: Option<String>,
    kept: Option<Kept>,
}

/// States of the run, the oldest first.
struct Kept {
    /// Time between two (s).
    every: f64,
    /// What they may take together.
    bytes: usize,
    states: VecDeque<Snapshot>,
    /// When the next is due (s).
    next: f64,
}

impl Kept {
    fn add(&mut self, state: Snapshot) {
        self.next = state.time() + self.every;
        self.states.push_back(state);
        // states may grow; the newest is kept whatever it takes
        while self.states.len() > 1 && self.states.iter().map(Snapshot::size).sum::<usize>() > self.bytes {
            self.states.pop_front();
        }
    }
}

impl Simulation {
    /// Goes back to the state before the first step, at rest or as the scene and the program made it, with all inputs
    /// at their initial values and nothing held: the same steps from there give the same bits. Outputs go on being
    /// written.
    ///
    /// # Errors
    /// That this state was not kept: the run began with a snapshot from elsewhere, [`Options::forgets_start`] is set,
    /// or it is a static analysis; what the GPU says.
    ///
    /// [`Options::forgets_start`]: super::Options::forgets_start
    pub fn reset(&mut self) -> Result<(), Error> {
        self.settle()?;
        self.keep_start();
        let Some(start) = self.history.start.as_ref().map(PackedSnapshot::unpacked) else {
            let why = self.history.no_start.clone().unwrap_or_else(|| {
                "the run began with a snapshot from elsewhere, `forgets_start` is set, or this is a static analysis"
                    .into()
            });
            let text = format!("the state before the first step was not kept: {why} (make a new simulation)");
            return Err(Error::Options(text));
        };
        let preload = self.preload.take();
        self.restore(&start?)?;
        self.preload = preload;
        self.world.resource_mut::<Signals>().inputs_mut().iter_mut().for_each(|input| input.withdraw());
        self.take_up_grabs(AllGrabs::new())
    }

    /// Keeps the state before the first step, if that has not been taken yet. What cannot be kept, as that of a system
    /// whose resource is not there, does not keep anybody from stepping.
    pub(super) fn keep_start(&mut self) {
        let wanted = !self.facts.forgets_start && !self.scene.is_static() && self.settling.is_none();
        if wanted && self.step_count() == 0 && self.history.start.is_none() {
            match self.snapshot() {
                Ok(state) => self.history.start = Some(state.packed()),
                Err(reason) => self.history.no_start = Some(reason.to_string()),
            }
        }
    }

    /// Keeps a state now and whenever so much simulated time has passed (s), in so many bytes together: where they are
    /// used up, the oldest states go, but never the newest. What was kept before is forgotten. Going back forgets what
    /// came later; a snapshot that is not of this run's own past forgets all.
    ///
    /// # Errors
    /// An `every` that is no positive number; that one state alone takes more; a static analysis; what the GPU says.
    pub fn keep_history(&mut self, every: f64, bytes: usize) -> Result<(), Error> {
        if !(every.is_finite() && every > 0.0) {
            return Err(Error::Options(format!("states cannot be kept every {every} s: it must be above 0")));
        }
        let state = self.snapshot()?;
        if state.size() > bytes {
            return Err(Error::Options(format!("one state has {} bytes; {bytes} are allowed for all", state.size())));
        }
        let mut kept = Kept { every, bytes, states: VecDeque::new(), next: 0.0 };
        kept.add(state);
        self.history.kept = Some(kept);
        Ok(())
    }

    /// Keeps no more states, and forgets those that were kept.
    pub fn forget_history(&mut self) {
        self.history.kept = None;
    }

    /// The times of the states that can be gone back to (s), the oldest first; that before the first step is one more.
    pub fn history(&self) -> Vec<f64> {
        self.history.kept.iter().flat_map(|kept| &kept.states).map(Snapshot::time).collect()
    }

    /// Goes back to the last kept state that is not later than a time (s), or to that before the first step; its time
    /// (s). The same steps and inputs from there give the same bits as before. Later states are forgotten.
    ///
    /// # Errors
    /// That no state so old is kept, with the oldest that is; what the GPU says.
    pub fn rewind(&mut self, to: f64) -> Result<f64, Error> {
        // a time that is a whole number of steps is met in spite of rounding
        let latest = to + 1e-6 * self.time_step();
        let kept = self.history.kept.as_ref();
        let Some(place) = kept.and_then(|kept| kept.states.iter().rposition(|state| state.time() <= latest)) else {
            if latest >= 0.0 && self.history.start.is_some() {
                self.reset()?;
                return Ok(self.time());
            }
            let oldest = self.history().first().map(|time| format!("; the oldest is of t = {time} s"));
            return Err(Error::Options(format!(
                "no state at or before t = {to} s is kept{}",
                oldest.unwrap_or_default()
            )));
        };
        let Some(state) = kept.and_then(|kept| kept.states.get(place)).cloned() else { return Ok(self.time()) };
        self.restore(&state)?;
        Ok(state.time())
    }

    /// The run goes on from a time: what it came to after that is forgotten, and all of it where it has never been
    /// there.
    pub(super) fn forget_later(&mut self, time: f64, ours: bool) {
        if let Some(kept) = &mut self.history.kept {
            kept.states.retain(|state| ours && state.time() <= time);
            kept.next = kept.states.back().map_or(time, |state| state.time() + kept.every);
        }
    }

    /// The next step at whose beginning a state is to be kept.
    pub(super) fn next_kept(&self) -> u64 {
        let Some(kept) = &self.history.kept else { return u64::MAX };
        // no state is kept twice
        let after = kept.states.back().map_or(0, |state| state.step() + 1);
        self.world.resource::<Clock>().step_nearest(kept.next).max(after)
    }

    /// Keeps the present state, if that is due.
    pub(super) fn keep_history_if_due(&mut self) -> Result<(), Error> {
        if self.next_kept() > self.step_count() {
            return Ok(());
        }
        let state = self.snapshot()?;
        if let Some(kept) = &mut self.history.kept {
            kept.add(state);
        }
        Ok(())
    }
}
