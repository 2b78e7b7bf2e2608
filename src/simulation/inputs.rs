//! Inputs of a scene: set by a program between steps, recorded and replayed.
//!
//! What is set is taken up when the next step begins, and nothing of it is known before: a run depends on the last
//! value of each input in each step alone, not on how many calls led there.

use super::Simulation;
use crate::components::{Change, Clock, Input, InputState, Signals};
use crate::error::Error;
use crate::output::{OutputError, replace};
use crate::scene::schema::{Constraint, Curve, Load, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

/// An input of a scene, at the present step.
#[derive(Clone, Debug, PartialEq)]
pub struct InputValue {
    /// Its name.
    pub name: String,
    /// The factor at the present time.
    pub value: f64,
    /// What it goes to: what was set last, or the initial value.
    pub target: f64,
    /// By how much it changes in a second at most (1/s).
    pub rate: Option<f64>,
    /// What it multiplies.
    pub uses: Vec<InputUse>,
}

/// What an input multiplies.
#[derive(Clone, Debug, PartialEq)]
pub struct InputUse {
    /// Where in the scene: `loads[0].curve`.
    pub path: String,
    /// What of it: `force`.
    pub of: &'static str,
    /// Its unit; `None` where only the scene's own law of the load knows.
    pub unit: Option<&'static str>,
}

/// Every change of the inputs of a run, with the step that began with it. Replayed on a simulation that is where this
/// one was, it gives the same bits. Serialised as RON, JSON or anything else that keeps numbers to the last bit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputRecording {
    /// Steps taken before it began.
    pub from: u64,
    /// In the order of steps.
    pub changes: Vec<InputChange>,
}

/// One change of an input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputChange {
    /// Steps taken before it.
    pub step: u64,
    /// The input.
    pub name: String,
    /// What it was set to.
    pub value: f64,
}

impl InputRecording {
    /// As RON.
    ///
    /// # Errors
    /// What RON cannot hold.
    pub fn to_ron(&self) -> Result<String, Error> {
        let pretty = ron::ser::PrettyConfig::new().depth_limit(2);
        ron::ser::to_string_pretty(self, pretty).map_err(|error| Error::Options(format!("the recording: {error}")))
    }

    /// From RON.
    ///
    /// # Errors
    /// What is no recording, with line and column.
    pub fn from_ron(text: &str) -> Result<Self, Error> {
        ron::from_str(text).map_err(|error| Error::Options(format!("this is no recording of inputs: {error}")))
    }

    /// Writes it as RON; the file appears when it is complete.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        let text = self.to_ron()?;
        Ok(replace(path, |file| file.write_all(text.as_bytes()).map_err(OutputError::system("write", path)))?)
    }

    /// Reads one.
    ///
    /// # Errors
    /// As [`InputRecording::from_ron`], and files that cannot be read.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path).map_err(OutputError::system("read", path))?;
        Self::from_ron(&text)
    }
}

/// What is being recorded and replayed.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    recording: Option<InputRecording>,
    replayed: Vec<InputChange>,
}

impl Tape {
    /// The first step after `step` that begins with a change.
    fn next_after(&self, step: u64) -> u64 {
        let next = self.replayed.partition_point(|change| change.step <= step);
        self.replayed.get(next).map_or(u64::MAX, |change| change.step)
    }

    /// The changes with which a step begins.
    fn due(&self, step: u64) -> &[InputChange] {
        let place = |bound: u64| self.replayed.partition_point(|change| change.step < bound);
        &self.replayed[place(step)..place(step + 1)]
    }

    /// The run goes on from another step: what was recorded after it has not been.
    fn go_on_from(&mut self, step: u64, before: u64) {
        let Some(recording) = &mut self.recording else { return };
        if (recording.from..=before).contains(&step) {
            recording.changes.retain(|change| change.step < step);
        } else {
            *recording = InputRecording { from: step, changes: Vec::new() };
        }
    }
}

impl Simulation {
    /// All inputs of the scene, in its order, as they are at the present step.
    pub fn inputs(&self) -> Vec<InputValue> {
        let time = self.time();
        let value = |input: &Input| InputValue {
            name: input.name.clone(),
            value: input.course().value(time),
            target: input.target(),
            rate: input.rate,
            uses: uses(&self.scene, &input.name),
        };
        self.world.resource::<Signals>().inputs().iter().map(value).collect()
    }

    /// Sets an input: from the next step on it goes there, no faster than its rate. Loads act in each step with its mean
    /// over that step, prescribed nodes are where it says at the step's end. Of several values before a step the last
    /// counts.
    ///
    /// # Errors
    /// A name that the scene does not have, with those that it has; a value that is no finite number; a static analysis
    /// that has begun, whose loads are what they were then.
    pub fn set_input(&mut self, name: &str, value: f64) -> Result<(), Error> {
        if !value.is_finite() {
            return Err(Error::Options(format!("an input must be a finite number; {name:?} was set to {value}")));
        }
        if self.scene.is_static() && self.step_count() > 0 {
            let text = "the inputs of a static analysis can be set before its first step only: loads grow to what they are then";
            return Err(Error::Options(text.into()));
        }
        match self.world.resource_mut::<Signals>().inputs_mut().iter_mut().find(|input| input.name == name) {
            Some(input) => input.set(value),
            None => return Err(self.no_input(name)),
        }
        Ok(())
    }

    fn no_input(&self, name: &str) -> Error {
        let all = self.world.resource::<Signals>().inputs();
        let names: Vec<&str> = all.iter().map(|input| input.name.as_str()).collect();
        Error::Options(match names.is_empty() {
            true => {
                format!("there is no input named {name:?}: the scene has none (curve: Input(name: {name:?}) makes one)")
            }
            false => format!("there is no input named {name:?}; there is {}", names.join(", ")),
        })
    }

    /// Records the inputs from here on, until [`stop_recording_inputs`](Self::stop_recording_inputs). Going back to a
    /// snapshot of this run takes back what was recorded since; one from elsewhere begins the recording anew.
    pub fn record_inputs(&mut self) {
        self.tape.recording = Some(InputRecording { from: self.step_count(), changes: Vec::new() });
    }

    /// What has been recorded so far; `None` where nothing is.
    pub fn recorded_inputs(&self) -> Option<&InputRecording> {
        self.tape.recording.as_ref()
    }

    /// Ends recording; `None` where nothing was.
    pub fn stop_recording_inputs(&mut self) -> Option<InputRecording> {
        self.tape.recording.take()
    }

    /// Replays a recording: each change is made when its step begins. What is set meanwhile counts until the next
    /// recorded change of the same input. An empty recording ends replaying.
    ///
    /// # Errors
    /// A recording that began at another step than the present one (restore the snapshot of that step first); inputs
    /// that the scene does not have; values that are no finite numbers; steps that go back.
    pub fn replay_inputs(&mut self, recording: &InputRecording) -> Result<(), Error> {
        let (from, now) = (recording.from, self.step_count());
        if from != now && !recording.changes.is_empty() {
            let text = format!("the recording began after {from} steps, and {now} have been taken");
            return Err(Error::Options(format!("{text}: replay it from the state that it began with")));
        }
        let mut last = from;
        for InputChange { step, name, value } in &recording.changes {
            if *step < last || !value.is_finite() {
                return Err(Error::Options(format!("the recording cannot set {name:?} to {value} at step {step}")));
            }
            if !self.world.resource::<Signals>().inputs().iter().any(|input| input.name == *name) {
                return Err(self.no_input(name));
            }
            last = *step;
        }
        self.tape.replayed = recording.changes.clone();
        Ok(())
    }

    /// The next step after the present one that begins with a change.
    pub(super) fn next_change(&self) -> u64 {
        self.tape.next_after(self.step_count())
    }

    /// Takes up what is set when a step begins.
    pub(super) fn take_up_inputs(&mut self) {
        let clock = *self.world.resource::<Clock>();
        // nothing is touched where nothing is set
        if self.world.resource::<Signals>().inputs().is_empty() {
            return;
        }
        let mut signals = self.world.resource_mut::<Signals>();
        for change in self.tape.due(clock.step) {
            let input = signals.inputs_mut().iter_mut().find(|input| input.name == change.name);
            // what the program sets itself comes after
            if let Some(input) = input.filter(|input| input.pending().is_none()) {
                input.set(change.value);
            }
        }
        for input in signals.inputs_mut() {
            let value = input.target();
            let Some(change) = input.take_up(&clock) else { continue };
            if let Some(recording) = &mut self.tape.recording {
                recording.changes.push(InputChange { step: clock.step, name: input.name.clone(), value });
            }
            if let Some(follower) = self.solver.follower_mut() {
                follower.note_change(clock.step, change == Change::Quickens);
            }
        }
    }

    /// The states of all inputs, for snapshots.
    pub(super) fn input_states(&self) -> BTreeMap<String, InputState> {
        let inputs = self.world.resource::<Signals>().inputs().iter();
        inputs.map(|input| (input.name.clone(), input.state.clone())).collect()
    }

    /// Goes on from states of inputs, at the present step; `before`: the step that the run was at.
    pub(super) fn take_up_input_states(
        &mut self,
        states: BTreeMap<String, InputState>,
        before: u64,
    ) -> Result<(), String> {
        let mut signals = self.world.resource_mut::<Signals>();
        for (name, state) in states {
            let input = signals.inputs_mut().iter_mut().find(|input| input.name == name);
            match input.filter(|_| state.is_sound()) {
                Some(input) => input.state = state,
                None => return Err(format!("the input {name:?} cannot be what it says")),
            }
        }
        let step = self.step_count();
        self.tape.go_on_from(step, before);
        Ok(())
    }
}

/// What the input of a name multiplies.
fn uses(scene: &Scene, name: &str) -> Vec<InputUse> {
    let is = |curve: &Curve| matches!(curve, Curve::Input { name: found, .. } if found == name);
    let mut uses = Vec::new();
    let mut add = |path: String, of: &'static str, unit: Option<&'static str>| uses.push(InputUse { path, of, unit });
    for (i, constraint) in scene.constraints.iter().enumerate() {
        let Constraint::Prescribed { curve, displacement, gradient, rotation, .. } = constraint else { continue };
        let path = format!("constraints[{i}].curve");
        let zero = glam::DVec3::ZERO;
        let parts = [
            (*displacement != zero, "displacement", "m"),
            (gradient.iter().any(|row| *row != zero), "gradient", "1"),
            (*rotation != zero, "rotation", "degrees"),
        ];
        for (_, of, unit) in parts.into_iter().filter(|(there, ..)| *there && is(curve)) {
            add(path.clone(), of, Some(unit));
        }
    }
    for (i, load) in scene.loads.iter().enumerate().filter(|(_, load)| is(load.curve())) {
        let (of, unit) = match load {
            Load::Gravity { .. } => ("acceleration", "m/s²"),
            Load::NodalForce { .. } => ("force", "N"),
            Load::Pressure { .. } => ("pressure", "Pa"),
            Load::Traction { .. } => ("traction", "Pa"),
        };
        add(format!("loads[{i}].curve"), of, Some(unit));
    }
    for (system, _) in scene.systems.iter().filter(|(_, system)| is(&system.curve)) {
        add(format!("systems.{system}.curve"), "node.curve", None);
    }
    uses
}
