//! Inputs of a scene: set by a program between steps, recorded and replayed.
//!
//! What is set is taken up when the next step begins, and nothing of it is known before: a run depends on the last
//! value of each input in each step alone, not on how many calls led there.

use super::ports::Poses;
use super::{InputChange, InputRecording, PoseChange, Simulation};
use crate::components::{Change, Clock, Input, InputState, Signals};
use crate::error::Error;
use crate::port::DevicePose;
use crate::scene::schema::{Constraint, Curve, Scene, When, WhenUnstable};
use std::collections::BTreeMap;

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

/// What is being recorded and replayed.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    recording: Option<InputRecording>,
    replayed: Vec<InputChange>,
    /// Of each port, in the order of steps.
    poses: Poses,
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

    /// The last pose of a port that is due when a batch begins with a step, taken off.
    pub fn pose_due(&mut self, step: u64, port: &str) -> Option<DevicePose> {
        let poses = self.poses.get_mut(port)?;
        std::iter::from_fn(|| poses.pop_front_if(|(due, _)| *due <= step)).last().map(|(_, pose)| pose)
    }

    /// Takes note of a pose that was taken up.
    pub fn note_pose(&mut self, change: PoseChange) {
        if let Some(recording) = &mut self.recording {
            recording.poses.push(change);
        }
    }

    /// The run goes on from another step, of its own past or not: what was recorded after it has not been, and what was
    /// to be replayed is of another run.
    fn go_on_from(&mut self, step: u64, ours: bool) {
        self.replayed.clear();
        self.poses.clear();
        let Some(recording) = &mut self.recording else { return };
        if ours && recording.from <= step {
            recording.changes.retain(|change| change.step < step);
            recording.poses.retain(|change| change.step < step);
        } else {
            *recording = InputRecording { from: step, ..InputRecording::default() };
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

    /// Sets an input: from the next step on it goes there, no faster than its rate. Loads act in each step with its
    /// mean over that step, prescribed nodes are where it says at the step's end. Of several values before a step the
    /// last counts.
    ///
    /// # Errors
    /// A name that the scene does not have, with those that it has; a value that is no finite number, also in f32; one
    /// with which a load of the scene's own is too stiff for a step that stays; a static analysis that has begun, whose
    /// loads are what they were then.
    pub fn set_input(&mut self, name: &str, value: f64) -> Result<(), Error> {
        if !is_possible(value) {
            let text = format!("an input must be a finite number, in f32 as well; {name:?} was set to {value}");
            return Err(Error::Options(text));
        }
        if self.scene.is_static() && self.step_count() > 0 {
            let text = "the inputs of a static analysis can be set before its first step only: loads grow to what they are then";
            return Err(Error::Options(text.into()));
        }
        let Some(place) = self.world.resource::<Signals>().inputs().iter().position(|input| input.name == name) else {
            return Err(self.no_input(name));
        };
        self.may_be_as_large(place, value)?;
        self.world.resource_mut::<Signals>().inputs_mut()[place].set(value);
        Ok(())
    }

    /// Whether loads of the scene's own are stable with a larger input than ever before, where the step stays.
    fn may_be_as_large(&mut self, place: usize, value: f64) -> Result<(), Error> {
        let stays = self.solver.follower().is_some_and(|follower| follower.policy != WhenUnstable::Adapt);
        let before = self.world.resource::<Signals>().inputs()[place].largest();
        if !stays || value.abs() <= before || self.scene.systems.is_empty() {
            return Ok(());
        }
        let replace = |simulation: &mut Self, largest: f64| {
            simulation.world.resource_mut::<Signals>().inputs_mut()[place].replace_largest(largest)
        };
        replace(self, value.abs());
        let loads = self.loads_now();
        replace(self, before);
        self.fits_the_step(&loads?).map_err(|limit| {
            let step = self.time_step();
            Error::Options(format!(
                "with {value} a load of the scene's own is so stiff that the stable step is {limit:.3e} s, and the step is \
                 {step:.3e} s: choose a smaller one, or let the step follow (when_unstable: Adapt)"
            ))
        })
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
    /// snapshot of this run, with the same changes before it, takes back what was recorded since; one from elsewhere
    /// begins the recording anew.
    pub fn record_inputs(&mut self) {
        self.tape.recording = Some(InputRecording { from: self.step_count(), ..InputRecording::default() });
    }

    /// What has been recorded so far; `None` where nothing is.
    pub fn recorded_inputs(&self) -> Option<&InputRecording> {
        self.tape.recording.as_ref()
    }

    /// Ends recording; `None` where nothing was.
    pub fn stop_recording_inputs(&mut self) -> Option<InputRecording> {
        self.tape.recording.take()
    }

    /// Replays a recording: each change is made when its step begins. What was set before and not taken up yet is
    /// forgotten. What is set meanwhile counts until the next recorded change of the same input; of several changes of
    /// an input at one step the last counts. An empty recording ends replaying, and so does going back.
    ///
    /// # Errors
    /// A recording that began at another step than the present one (restore the snapshot of that step first); inputs
    /// that the scene does not have; values that are no finite numbers, also in f32; steps that go back; changes after
    /// the first step of a static analysis.
    pub fn replay_inputs(&mut self, recording: &InputRecording) -> Result<(), Error> {
        let (from, now) = (recording.from, self.step_count());
        if from != now && !(recording.changes.is_empty() && recording.poses.is_empty()) {
            let text = format!("the recording began after {from} steps, and {now} have been taken");
            return Err(Error::Options(format!("{text}: replay it from the state that it began with")));
        }
        let mut last = from;
        for InputChange { step, name, value } in &recording.changes {
            if self.scene.is_static() && *step > 0 {
                let text = format!(
                    "the recording sets {name:?} at step {step}: a static analysis takes inputs before its first"
                );
                return Err(Error::Options(text));
            }
            if *step < last || !is_possible(*value) {
                return Err(Error::Options(format!("the recording cannot set {name:?} to {value} at step {step}")));
            }
            if !self.world.resource::<Signals>().inputs().iter().any(|input| input.name == *name) {
                return Err(self.no_input(name));
            }
            last = *step;
        }
        let mut changes: Vec<InputChange> = Vec::new();
        for change in &recording.changes {
            // of several before a step the last counts
            let mut of_step = changes.iter().rev().take_while(|earlier| earlier.step == change.step);
            if let Some(back) = of_step.position(|earlier| earlier.name == change.name) {
                changes.remove(changes.len() - 1 - back);
            }
            changes.push(change.clone());
        }
        self.tape.poses = self.checked_poses(&recording.poses)?;
        // what the recorded run took up of it is in the recording
        if !(recording.changes.is_empty() && recording.poses.is_empty()) {
            self.world.resource_mut::<Signals>().inputs_mut().iter_mut().for_each(Input::withdraw);
        }
        self.tape.replayed = changes;
        Ok(())
    }

    /// The next step after the present one that begins with a change.
    pub(super) fn next_change(&self) -> u64 {
        self.tape.next_after(self.step_count())
    }

    /// Takes up what is set when a step begins.
    pub(super) fn take_up_inputs(&mut self) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        // nothing is touched where nothing is set
        if self.world.resource::<Signals>().inputs().is_empty() {
            return Ok(());
        }
        let mut signals = self.world.resource_mut::<Signals>();
        for change in self.tape.due(clock.step) {
            let input = signals.inputs_mut().iter_mut().find(|input| input.name == change.name);
            // what the program sets itself comes after
            if let Some(input) = input.filter(|input| input.pending().is_none()) {
                input.set(change.value);
            }
        }
        let mut larger = false;
        for input in signals.inputs_mut() {
            let (value, largest) = (input.target(), input.largest());
            let Some(change) = input.take_up(&clock) else { continue };
            larger |= input.largest() > largest;
            self.lineage.note(clock.step, &format!("{} {value:?}", input.name));
            if let Some(recording) = &mut self.tape.recording {
                recording.changes.push(InputChange { step: clock.step, name: input.name.clone(), value });
            }
            if let Some(follower) = self.solver.follower_mut() {
                follower.note_change(clock.step, change == Change::Quickens);
            }
        }
        // loads of the scene's own may be as much stiffer
        if larger && !self.scene.systems.is_empty() {
            self.count_loads()?;
            if let Some(follower) = self.solver.follower_mut() {
                follower.check_soon();
            }
        }
        Ok(())
    }

    /// The states of all inputs, for snapshots.
    pub(super) fn input_states(&self) -> BTreeMap<String, InputState> {
        let inputs = self.world.resource::<Signals>().inputs().iter();
        inputs.map(|input| (input.name.clone(), input.state.clone())).collect()
    }

    /// Whether the inputs can be in such states.
    pub(super) fn check_input_states(&self, states: &BTreeMap<String, InputState>) -> Result<(), String> {
        let inputs = self.world.resource::<Signals>().inputs();
        let fits = |(name, state): &(&String, &InputState)| {
            state.is_sound() && inputs.iter().any(|input| input.name == **name)
        };
        match states.iter().find(|state| !fits(state)) {
            Some((name, _)) => Err(format!("the input {name:?} cannot be what it says")),
            None => Ok(()),
        }
    }

    /// Goes on from states of inputs, which have been checked, at the present step, where the run has been or not.
    pub(super) fn take_up_input_states(&mut self, states: BTreeMap<String, InputState>, ours: bool) {
        let mut signals = self.world.resource_mut::<Signals>();
        for (name, state) in states {
            if let Some(input) = signals.inputs_mut().iter_mut().find(|input| input.name == name) {
                input.state = state;
            }
        }
        let step = self.step_count();
        self.tape.go_on_from(step, ours);
    }
}

/// Whether an input can be that: a number that is finite in every precision.
fn is_possible(value: f64) -> bool {
    (value as f32).is_finite()
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
        let (of, unit) = load.parts().field;
        add(format!("loads[{i}].curve"), of, Some(unit));
    }
    for (name, tool) in &scene.tools {
        for (i, part) in tool.moves.iter().enumerate().filter(|(_, part)| is(&part.curve)) {
            let path = format!("tools.{name}.moves[{i}].curve");
            let parts = [(part.displacement, "displacement", "m"), (part.rotation, "rotation", "degrees")];
            for (_, of, unit) in parts.into_iter().filter(|(size, ..)| *size != glam::DVec3::ZERO) {
                add(path.clone(), of, Some(unit));
            }
        }
    }
    for (system, _) in scene.systems.iter().filter(|(_, system)| is(&system.curve)) {
        add(format!("systems.{system}.curve"), "node.curve", None);
    }
    for (i, removal) in scene.removal.iter().enumerate() {
        let When::InTool { rate, curve, .. } = &removal.when else { continue };
        if is(curve) {
            let (of, unit) = if rate.is_some() { ("rate", "m³/s") } else { ("threshold", "1") };
            add(format!("removal[{i}].when.curve"), of, Some(unit));
        }
    }
    for (i, _) in scene.suction.iter().enumerate().filter(|(_, suction)| is(&suction.curve)) {
        add(format!("suction[{i}].curve"), "pressure", Some("Pa"));
    }
    for (i, attachment) in scene.attachments.iter().enumerate() {
        let Some((word, _)) = attachment.curve().filter(|(_, curve)| is(curve)) else { continue };
        // a tool is closed while its curve is ½ or more
        let (of, unit) = if word == "closed" { ("closed", "1") } else { ("tighten", "m") };
        add(format!("attachments[{i}].{word}"), of, Some(unit));
    }
    uses
}
