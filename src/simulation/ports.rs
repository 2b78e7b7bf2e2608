//! Tools that hands move: a batch of steps begins with reading where the device is, and ends with telling what the tool
//! felt.
//!
//! A batch is so many steps, whatever a program asks for, and the tool goes through it in a straight line that is known
//! when it begins. So a run depends on the pose that each batch began with alone: those are recorded and replayed.

mod course;

pub(super) use course::PortState;

use super::Simulation;
use crate::assembly::motion;
use crate::components::{Clock, Key, Signals};
use crate::error::Error;
use crate::observation::feel;
use crate::port::{DevicePose, EngineEnd, ToolPort, Touch, open};
use crate::scene::schema::Scene;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use web_time::Instant;

/// A pose with which a batch of steps began. See [`InputRecording`](super::InputRecording).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseChange {
    /// Steps taken before it.
    pub step: u64,
    /// The port.
    pub port: String,
    /// Where the device was.
    pub pose: DevicePose,
}

/// What came through a port in a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PortUse {
    /// The tool that it moves.
    pub tool: String,
    /// Batches of steps that began with a new pose of the device.
    pub poses: u64,
    /// Batches that ended.
    pub batches: u64,
    /// Poses that no tool could follow: numbers that are not finite, no orientation.
    pub refused: u64,
    /// What is to be known of it; empty where all is well.
    pub warning: String,
}

/// Poses of each port with the steps that they are due with, ascending.
pub(super) type Poses = BTreeMap<String, VecDeque<(u64, DevicePose)>>;

/// The ports of a scene.
#[derive(Debug, Default)]
pub(super) struct Ports {
    all: BTreeMap<String, Port>,
}

/// A port, and the tool that it moves.
#[derive(Debug)]
struct Port {
    used: PortUse,
    word: crate::scene::schema::Port,
    state: PortState,
    /// Where nobody has opened it there is none.
    end: Option<EngineEnd>,
    /// Touches told through the end that is open, and the number of the pose of the present batch; both 0 at first.
    told: u64,
    answers: u64,
    /// When the present batch began.
    began: Option<Instant>,
}

impl Ports {
    /// Those of a scene, with tools where they are at first.
    pub fn of(scene: &Scene) -> Self {
        let port = |(name, tool): (&String, &crate::scene::schema::Tool)| {
            let word = tool.port.clone()?;
            let first = motion(tool).path.first().copied()?;
            let port = Port {
                used: PortUse { tool: name.clone(), ..PortUse::default() },
                state: PortState::at(first),
                end: None,
                told: 0,
                answers: 0,
                began: None,
                word,
            };
            Some((port.word.name.clone(), port))
        };
        Self { all: scene.tools.iter().filter_map(port).collect() }
    }

    /// The step that ends the next batch.
    pub fn next_end(&self) -> u64 {
        self.all.values().map(|port| port.state.ends).min().unwrap_or(u64::MAX)
    }
}

impl Simulation {
    /// Opens a port of the scene for the device that moves its tool, which may be in another thread. One that was
    /// opened before is open no longer: what comes through it is not heard.
    ///
    /// # Errors
    /// A name that the scene does not have, with those that it has.
    pub fn open_port(&mut self, name: &str) -> Result<ToolPort, Error> {
        let names: Vec<&str> = self.ports.all.keys().map(String::as_str).collect();
        let error = match names.is_empty() {
            true => {
                let word = format!("port: (name: {name:?}, speed: 0.1)");
                format!("there is no port named {name:?}: no tool of the scene has one ({word} in a tool makes one)")
            }
            false => format!("there is no port named {name:?}; there is {}", names.join(", ")),
        };
        let port = self.ports.all.get_mut(name).ok_or(Error::Options(error))?;
        let (device, engine) = open();
        port.end = Some(engine);
        (port.told, port.answers) = (0, 0);
        Ok(device)
    }

    /// What came through the ports of the scene so far, by their names.
    pub fn ports(&self) -> BTreeMap<String, PortUse> {
        let used = |(name, port): (&String, &Port)| {
            let warning = match (port.used.poses, port.used.refused) {
                (0, 0) => format!("nobody has fed it: `{}` stays where it starts", port.used.tool),
                (_, 0) => String::new(),
                (_, refused) => format!("{refused} poses had numbers that are not finite, or no orientation"),
            };
            (name.clone(), PortUse { warning, ..port.used.clone() })
        };
        self.ports.all.iter().map(used).collect()
    }

    /// Begins the batches that are due with the next step.
    pub(super) fn begin_batches(&mut self) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        // what is on its way to rest does not move in time
        if self.ports.all.is_empty() || clock.relaxation.is_some() {
            return Ok(());
        }
        self.end_batches()?;
        for (name, port) in &mut self.ports.all {
            if port.state.ends > clock.step {
                continue;
            }
            let replayed = self.tape.pose_due(clock.step, name);
            // what comes from a hand counts more than what is replayed
            if let Some(pose) = port.end.as_mut().and_then(EngineEnd::pose).or(replayed) {
                match pose.is_sound() {
                    true => {
                        (port.used.poses, port.answers) = (port.used.poses + 1, pose.sequence);
                        self.lineage.note(clock.step, &format!("{name} {pose:?}"));
                        self.tape.note_pose(PoseChange { step: clock.step, port: name.clone(), pose });
                        port.state.target(&pose);
                    }
                    false => port.used.refused += 1,
                }
            }
            let quickens = port.state.begin(&port.word, &clock);
            self.world.resource_mut::<Signals>().lead(name, &port.state.path);
            if let Some(follower) = self.solver.follower_mut().filter(|_| quickens) {
                follower.note_change(clock.step, true);
            }
            port.began = port.end.as_ref().map(|_| Instant::now());
        }
        Ok(())
    }

    /// Ends the batches whose steps have been taken.
    pub(super) fn end_batches(&mut self) -> Result<(), Error> {
        let clock = *self.world.resource::<Clock>();
        for port in self.ports.all.values_mut() {
            let state = &mut port.state;
            if state.ends != clock.step || state.felt_at == clock.step || clock.relaxation.is_some() {
                continue;
            }
            let felt = feel(&mut self.world, &port.used.tool, state.ends - state.begins)?;
            state.end(&port.word, felt, clock.step);
            port.used.batches += 1;
            let Some(end) = &mut port.end else { continue };
            port.told += 1;
            let [(from, ..), (until, ..)] = state.path;
            let (place, orientation) = state.pose(clock.time());
            let seconds = port.began.map_or(0.0, |began| began.elapsed().as_secs_f64());
            end.tell(&Touch {
                time: clock.time(),
                place,
                orientation,
                velocity: state.velocity(),
                force: felt.force,
                torque: felt.torque,
                normal: felt.force.normalize_or_zero(),
                stiffness: state.stiffness(),
                in_contact: felt.in_contact,
                real_time_factor: seconds / (until - from),
                sequence: port.told,
                step: clock.step,
                answers: port.answers,
            });
        }
        Ok(())
    }

    /// Where batches are, for snapshots.
    pub(super) fn port_states(&self) -> BTreeMap<String, PortState> {
        // nothing of it is kept before the first step
        let begun = self.ports.all.iter().filter(|(_, port)| port.state.ends > 0);
        begun.map(|(name, port)| (name.clone(), port.state.clone())).collect()
    }

    /// Whether batches can be in such states.
    pub(super) fn check_port_states(&self, states: &BTreeMap<String, PortState>) -> Result<(), String> {
        let fits = |(name, state): &(&String, &PortState)| state.is_sound() && self.ports.all.contains_key(*name);
        match states.iter().find(|state| !fits(state)) {
            Some((name, _)) => Err(format!("the port {name:?} cannot be what it says")),
            None => Ok(()),
        }
    }

    /// Goes on from states of batches, which have been checked; where there are none, from the start.
    pub(super) fn take_up_port_states(&mut self, mut states: BTreeMap<String, PortState>) {
        let first = |tool: &str| -> Option<Key> { motion(self.scene.tools.get(tool)?).path.first().copied() };
        for (name, port) in &mut self.ports.all {
            let state = states.remove(name).or_else(|| first(&port.used.tool).map(PortState::at));
            let Some(state) = state else { continue };
            port.state = state;
            // whatever pose it goes to came before
            port.answers = 0;
            let path = &port.state.path;
            // before the first batch there is no way
            let path = if port.state.ends == 0 { &path[..1] } else { &path[..] };
            self.world.resource_mut::<Signals>().lead(name, path);
        }
    }

    /// Poses of a recording by their ports, if they can be replayed on this simulation from the present step on.
    pub(super) fn checked_poses(&self, poses: &[PoseChange]) -> Result<Poses, Error> {
        let (mut last, mut all) = (self.step_count(), Poses::new());
        for PoseChange { step, port, pose } in poses {
            if !self.ports.all.contains_key(port) {
                let names: Vec<&str> = self.ports.all.keys().map(String::as_str).collect();
                let there = if names.is_empty() { "none".into() } else { names.join(", ") };
                return Err(Error::Options(format!(
                    "the recording has a port {port:?}; in the scene there is {there}"
                )));
            }
            if *step < last || !pose.is_sound() {
                return Err(Error::Options(format!("the recording cannot move {port:?} at step {step} to {pose:?}")));
            }
            last = *step;
            all.entry(port.clone()).or_default().push_back((*step, *pose));
        }
        Ok(all)
    }
}
