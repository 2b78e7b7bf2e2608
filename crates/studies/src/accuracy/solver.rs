//! What a study needs of whatever solves the scene: an offer of variations, a prediction of time, a solution.

use super::configuration::{Configuration, Digits, Factor, Processor};
use super::method::Method;
use glam::DVec3;
use sinew::mesh::{ElementKind, Mesh};
use sinew::scene::schema::ViscousIntegrator;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Solves a scene in many ways.
pub trait Solver {
    /// What can be varied.
    ///
    /// # Errors
    /// That the scene as it is written cannot be solved at all.
    fn choices(&mut self) -> Result<Choices, Refusal>;

    /// What a configuration will cost, before it is run.
    ///
    /// # Errors
    /// Why it cannot be run.
    fn predict(&mut self, configuration: &Configuration) -> Result<Cost, Refusal>;

    /// Solves the scene.
    ///
    /// # Errors
    /// Why there is no solution.
    fn solve(&mut self, configuration: &Configuration) -> Result<Solution, Refusal>;

    /// From now on nothing may take longer than until then: what is not done is cut off with [`Refusal::TooLong`].
    fn until(&mut self, _: Instant) {}
}

/// What can be varied in a scene.
#[derive(Clone, Debug)]
pub struct Choices {
    /// The scene as it is written.
    pub base: Configuration,
    /// Kinds of elements that its meshes can have, each before those that are more accurate; empty when they cannot
    /// change.
    pub elements: Vec<ElementKind>,
    /// How fine meshes can be, ascending; all of one shape, so that errors follow a power of the cell size.
    pub meshes: Vec<Factor>,
    /// Those of them that have a single layer of cells where the scene's own mesh has more: what they say does not
    /// follow the power of the cell size that the others follow.
    pub single_layers: Vec<Factor>,
    /// Whether tools or surfaces touch: which nodes do changes with the mesh, and so may the order.
    pub touches: bool,
    /// What the step can be divided by; empty where there is no step to choose.
    pub steps: Vec<u32>,
    /// Number types.
    pub digits: Vec<Digits>,
    /// Whether the scene names its step: it does not become smaller with the cells as long as it is stable.
    pub step_is_fixed: bool,
    /// Hourglass stiffness against the scene's; empty where there is none to change.
    pub hourglass: Vec<f64>,
    /// Ways to carry viscous history on; empty without viscosity.
    pub viscous: Vec<ViscousIntegrator>,
    /// Other elastic laws of the same small-strain moduli, by their words.
    pub laws: Vec<String>,
    /// Where it can run.
    pub places: Vec<Processor>,
    /// Ways to step in time, or to seek equilibrium.
    pub methods: Vec<Method>,
    /// Names of the channels that its solutions have, such as `tip.uz`.
    pub quantities: Vec<String>,
    /// Effects that can be switched off, in words.
    pub effects: Vec<String>,
    /// What errors measured on finer meshes do not contain, one sentence each.
    pub unseen: Vec<String>,
    /// What the author should know about the study, one sentence each.
    pub notes: Vec<String>,
}

/// What a configuration costs.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Cost {
    /// All wall time, setting up and looking included (s).
    pub seconds: f64,
    /// Elements.
    pub elements: u64,
    /// Steps.
    pub steps: u64,
}

/// Why there is no solution.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The configuration makes no sense, or the engine refuses it.
    Refused(String),
    /// It began and broke down.
    Broke(String),
    /// It was cut off: it was not done when its time was over.
    TooLong,
    /// Somebody wants the study to end.
    Interrupted,
}

/// What a configuration came to.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// Numbers over time.
    pub channels: Vec<Channel>,
    /// The displacement field at some times.
    pub field: Option<Field>,
    /// Wall time of the steps alone (s).
    pub seconds: f64,
    /// What bringing the bodies to rest before the first step took (s); 0 where they begin as they are.
    pub preload: f64,
    /// How often the steps were timed; `seconds` is the best.
    pub timed: u32,
    /// Simulated time (s); `None` for a search for equilibrium, which has none.
    pub simulated: Option<f64>,
    /// Steps.
    pub steps: u64,
    /// Elements.
    pub elements: u64,
    /// Nodes.
    pub nodes: u64,
    /// Δt (s); 0 where there is none.
    pub time_step: f64,
    /// Where it ran, in words.
    pub backend: String,
    /// Hourglass energy over strain energy at the end.
    pub hourglass_share: f64,
}

/// A number over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name: `tip.uz`, `energy.strain`.
    pub name: String,
    /// Channels of a group are components of one thing and measured against its length.
    pub group: String,
    /// Its unit.
    pub unit: String,
    /// Times (s), ascending.
    pub times: Vec<f64>,
    /// Values at these times.
    pub values: Vec<f64>,
}

/// Displacements of bodies at some times.
#[derive(Clone, Debug, Default)]
pub struct Field {
    /// Times (s), ascending; the last is the end.
    pub times: Vec<f64>,
    /// The bodies, by name.
    pub bodies: BTreeMap<String, BodyField>,
}

/// Displacements of a body at the times of its [`Field`].
#[derive(Clone, Debug)]
pub struct BodyField {
    /// The mesh at rest.
    pub mesh: Arc<Mesh>,
    /// Lumped masses of its nodes at the end (kg); 0 for nodes that nothing holds any more.
    pub masses: Vec<f64>,
    /// Displacements of its nodes (m), one list a time.
    pub displacements: Vec<Vec<DVec3>>,
}

impl Solution {
    /// Wall time per simulated second; where nothing is simulated in time, wall time alone (s).
    pub fn seconds_per_second(&self) -> f64 {
        self.seconds / self.simulated.unwrap_or(1.0)
    }

    /// The channel of a name.
    pub fn channel(&self, name: &str) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.name == name)
    }
}
