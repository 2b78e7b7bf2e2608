//! A scene at work: the world, its schedule, its clock.

mod access;
mod adapt;
mod added_mass;
mod asked;
mod block_forces;
mod budget;
mod build;
mod change;
mod choose;
mod column_view;
mod contact_springs;
mod contact_use;
mod costly;
mod damped_step;
mod device_steps;
pub mod explain;
mod follow;
mod frames;
mod frequency;
mod gpu_column;
mod grab;
mod history;
mod implicit;
mod inputs;
mod interval;
mod keep;
mod known;
mod lineage;
mod load_rates;
mod mass_scaling;
mod modes;
mod names;
mod nodal;
mod node_set;
mod observer;
mod options;
mod outputs;
mod parameters;
mod pick;
mod plan;
mod plausible;
mod policies;
mod ports;
mod preload;
mod prepare;
mod real_time;
mod recording;
mod relax;
mod residual;
mod resume_state;
mod rounding;
mod run;
mod schedule;
mod scheme;
mod skins;
mod solver;
mod stable_step;
mod step_change;
mod step_kernels;
mod stiffness;
mod stiffness_ratio;
mod stretch;
mod summary;
mod surface;
mod tangent;
mod unload;

pub use budget::{Advanced, Ended};
pub use column_view::ColumnView;
pub use contact_use::SurfaceContactUse;
pub use follow::StepHistory;
pub use frames::Frames;
pub use gpu_column::GpuColumn;
pub use grab::{Grab, GrabId, Grip};
#[doc(hidden)]
pub use implicit::TwoLevelParts;
pub use implicit::{ImplicitSteps, PathPoint};
pub use inputs::{InputUse, InputValue};
pub use modes::Mode;
pub use names::{FieldName, Names};
pub use node_set::{NodeSet, NodeState};
pub use options::{BackendChoice, Options};
pub use pick::Pick;
pub use ports::{PortUse, PoseChange};
pub use preload::Preload;
pub use real_time::RealTime;
pub use recording::{InputChange, InputRecording};
pub use relax::Equilibrium;
pub use stable_step::Stability;
pub use summary::{Inversions, Summary, SystemTime};
pub use unload::{Unloaded, Unloading, UnloadingStep, unload};

use crate::backend::kernel::KernelId;
use crate::scene::schema::Scene;
use crate::scene::{Diagnostics, SceneFile};
use crate::systems::{HostSystem, Phase};
use bevy_ecs::prelude::*;
use interval::RunInterval;
use std::time::Duration;

/// A simulation: make it from a scene, step it, look at it.
pub struct Simulation {
    world: World,
    plan: plan::Plan,
    /// Its passes on the backend that it runs on.
    entries: Vec<ScheduledPass>,
    /// As it is now.
    scene: Scene,
    /// What it was made of.
    file: SceneFile,
    /// The text of the scene, where it has been changed since.
    changed: Option<String>,
    facts: Facts,
    solver: solver::Solver,
    /// What is to bring the bodies to rest before the first step.
    settling: Option<Box<Simulation>>,
    /// What that took.
    preload: Option<Preload>,
    /// Inputs that are recorded and replayed.
    tape: inputs::Tape,
    /// Devices that move tools.
    ports: ports::Ports,
    /// What keeps up with life.
    metronome: real_time::Metronome,
    /// Surfaces for picking.
    surfaces: pick::Surfaces,
    grabs: grab::AllGrabs,
    /// The number of the next grab: none is given twice.
    next_grab: u64,
    /// What programs have done so far.
    lineage: lineage::Lineage,
    /// States to go back to.
    history: history::History,
    /// How often it has gone over to another state otherwise than by steps.
    restored: u64,
    /// What a step takes on the clock on the wall (s), where that was measured.
    seconds_a_step: Option<f64>,
    elapsed: Duration,
    /// When that began which `elapsed` does not have yet.
    running: Option<web_time::Instant>,
    frames: frames::FrameClock,
    /// Step and time (s) from which `elapsed` counts: of the start, or of a snapshot that was gone on from.
    began: (u64, f64),
    /// How it broke down.
    failure: Option<crate::error::Instability>,
}

/// A pass of the plan that runs.
struct ScheduledPass {
    name: String,
    /// Of the last of its systems.
    phase: Phase,
    /// Whether one of them finds forces.
    finds_forces: bool,
    /// Places of its systems in the plan.
    systems: Vec<usize>,
    job: Job,
    /// Names of the columns that its systems read.
    reads: Vec<&'static str>,
    /// How many passes after it may sleep: see [`plan::Pass::sleepers`].
    sleepers: usize,
    /// What it needs before steps are submitted to a GPU.
    before_steps: Option<crate::systems::BeforeSteps>,
    time: Duration,
    runs: u64,
}

enum Job {
    Host { system: HostSystem, interval: RunInterval, observes: bool, writes: Vec<&'static str> },
    Kernels(Vec<KernelId>),
}

/// What was decided when the simulation was made.
struct Facts {
    on_gpu: bool,
    /// Whether there are systems of the user's own.
    custom: bool,
    backend: String,
    why: String,
    precision: crate::components::Precision,
    stability: Stability,
    steps: u64,
    nodes: usize,
    elements: usize,
    initial_mass: f64,
    setup: Duration,
    forgets_start: bool,
    /// Systems of the step that act on nodes, by name.
    node_systems: Vec<(String, crate::systems::NodeRows)>,
    /// What tells how fast the forces of systems grow: what they do to the stable step is counted anew when it changes.
    slopes: Vec<crate::systems::SlopesOf>,
    warnings: Diagnostics,
}
