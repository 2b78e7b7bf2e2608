//! What is seen of a simulation at one moment.

use crate::assembly::CriticalElement;
use crate::components::Energies;
use crate::mesh::{Cells, Ids};
use crate::observation::{SkinState, ToolReading};
use crate::scene::Placed;
use crate::scene::schema::OutputField;
use crate::{GpuColumn, InputValue, Instability, Pick, SceneFile};
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A simulation at one moment. Positions are rounded to f32, what drawing takes.
#[derive(Clone, Debug, Default)]
pub struct State {
    /// What stays as long as the scene does; none before the first one is loaded.
    pub loaded: Option<Arc<Loaded>>,
    /// The bodies, in the order of [`Loaded::bodies`].
    pub bodies: Vec<BodyState>,
    /// The field whose values bodies have.
    pub field: Option<OutputField>,
    /// The field whose vectors bodies have for arrows.
    pub arrows: Option<OutputField>,
    /// Time (s).
    pub time: f64,
    /// Δt (s).
    pub time_step: f64,
    /// Steps taken.
    pub step: u64,
    /// Whether it goes on.
    pub running: bool,
    /// Whether the scene's end is reached, or the rest that a static analysis looks for.
    pub finished: bool,
    /// Simulated seconds a second on the wall that are wanted.
    pub speed: f64,
    /// The same as they were over about the last second, above 1 where it is faster than life (in a
    /// [`Summary`](crate::Summary) it is the other way round); none while it stands.
    pub real_time_factor: Option<f64>,
    /// Times of the states that can be gone back to (s), the oldest first; the start is one more.
    pub history: Vec<f64>,
    /// When energies and probes were taken last (s), which costs too much for every state.
    pub measured: f64,
    /// The energies then (J).
    pub energies: Energies,
    /// What each probe saw then, in the order of [`Loaded::probes`].
    pub probes: Vec<Vec<f64>>,
    /// All inputs, in the order of the scene.
    pub inputs: Vec<InputValue>,
    /// What hands hold.
    pub held: Vec<HeldState>,
    /// Tools, in the order of their names.
    pub tools: Vec<ToolState>,
    /// What was picked last.
    pub picked: Option<Picked>,
    /// How it broke down, if it did.
    pub breakdown: Option<Box<Instability>>,
    /// The last command that was refused, until another one of its kind is not.
    pub refusal: Option<Refusal>,
    /// Commands that have been done or refused.
    pub commands: u64,
}

/// What stays as long as a scene does.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// How many scenes were loaded before.
    pub number: u64,
    /// The scene.
    pub scene: SceneFile,
    /// Where it runs: "CPU, f32, 2 threads".
    pub backend: String,
    /// Its bodies, in the order of their names.
    pub bodies: Vec<Body>,
    /// Its probes: name, and of each number name and unit, "ux (m)".
    pub probes: Vec<(String, Vec<String>)>,
    /// The elements that set the stable step, the smallest first: at most ten.
    pub critical: Vec<CriticalElement>,
    /// What is not wrong with the scene but should be known.
    pub warnings: Vec<String>,
}

/// What stays of a body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Where nodes are at rest (m), in the author's order.
    pub rest: Vec<[f32; 3]>,
    /// The elements and their nodes, by places in the author's order.
    pub cells: Cells,
    /// The author's numbers of nodes.
    pub nodes: Ids,
    /// The author's numbers of elements.
    pub elements: Ids,
    /// The names of its materials.
    pub materials: Vec<String>,
    /// The place of each element's material among those.
    pub element_materials: Vec<u32>,
    /// Sets of the mesh file by name: their nodes, or those of their faces or elements.
    pub sets: BTreeMap<String, Vec<u32>>,
    /// Where its displacements are on the GPU, if it is there.
    pub on_gpu: Option<GpuColumn>,
    /// Along which axes each node is held or moved as told: bits 0, 1, 2 for x, y, z.
    pub constrained: Vec<u32>,
}

/// A body at one moment.
#[derive(Clone, Debug, Default)]
pub struct BodyState {
    /// Where nodes are (m), in the author's order.
    pub positions: Vec<[f32; 3]>,
    /// 1 while an element is there, in the author's order.
    pub alive: Arc<Vec<u8>>,
    /// Another one whenever elements have gone or come back.
    pub topology: u64,
    /// The field's numbers, one after the other, in the author's order of nodes or elements; empty without a field.
    pub values: Vec<f32>,
    /// How many numbers there are of each.
    pub components: usize,
    /// The vectors for arrows, in the author's order of nodes; empty without.
    pub arrows: Vec<[f32; 3]>,
    /// The skin, if it has one.
    pub skin: Option<SkinState>,
}

/// What a hand holds.
#[derive(Clone, Debug, PartialEq)]
pub struct HeldState {
    /// The hand.
    pub hand: u32,
    /// Where the point is that it holds (m).
    pub point: DVec3,
    /// Where it pulls it to (m).
    pub target: DVec3,
    /// With which force (N).
    pub force: DVec3,
}

/// A tool at one moment.
#[derive(Clone, Debug)]
pub struct ToolState {
    /// Its name.
    pub name: String,
    /// Where its origin is (m).
    pub place: DVec3,
    /// How it is turned from how its shape is described.
    pub rotation: DQuat,
    /// What it felt when energies were taken.
    pub felt: ToolReading,
}

/// What was picked.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    /// Where the ray met the body.
    pub pick: Pick,
    /// The place of the nearest of the triangle's nodes, in the author's order.
    pub node: u32,
    /// The author's number of it.
    pub node_number: u64,
    /// The place of the element, in the author's order.
    pub element: usize,
    /// The element's material.
    pub material: String,
    /// The largest step (s) that would be stable for the element at the start, by the bound that elements have; none
    /// where it is not known: of an element that is gone, of a finished run.
    pub step: Option<f64>,
}

/// A command that was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Which: "load", "set".
    pub command: &'static str,
    /// Why, in words for who sent it; of a scene with places in its text.
    pub reason: String,
    /// What is wrong with a scene, with where it stands; empty for what is no mistake of a scene.
    pub mistakes: Vec<Placed>,
}

impl Refusal {
    /// A command that was refused for another reason than mistakes of a scene.
    pub fn new(command: &'static str, reason: impl Into<String>) -> Self {
        Self { command, reason: reason.into(), mistakes: Vec::new() }
    }
}
