#![doc = include_str!("README.md")]

pub mod components;
pub mod driver;
mod error;
pub mod materials;
pub mod math;
pub mod port;
pub mod scene;
mod simulation;
pub mod skins;
pub mod snapshot;
#[path = "../systems/mod.rs"]
pub mod systems;

// what the other crates of the workspace and the tests see into: no version keeps its names and types
#[doc(hidden)]
pub mod assembly;
#[doc(hidden)]
pub mod backend;
#[doc(hidden)]
pub mod contact;
#[doc(hidden)]
pub mod elements;
#[doc(hidden)]
pub mod evaluation;
#[doc(hidden)]
pub mod observation;
#[doc(hidden)]
pub mod output;
#[doc(hidden)]
pub mod uniform;

// custom systems are written with these, and must be so in the same versions
pub use bevy_ecs;
pub use glam;
pub use serde;
/// Meshes: generators, files, topology.
#[doc(inline)]
pub use sinew_mesh as mesh;
#[doc(hidden)]
pub use sinew_tools as tools;

pub use backend::gpu::{Host, NoGpu};
pub use error::{Error, GpuFailure, Instability, NotConverged, NotUnloaded};
pub use output::Folder;
pub use scene::SceneFile;
pub use simulation::explain;
pub use simulation::{
    Advanced, BackendChoice, ColumnView, Ended, Equilibrium, FieldName, Frames, GpuColumn, Grab, GrabId, Grip,
    ImplicitSteps, InputChange, InputRecording, InputUse, InputValue, Inversions, Mode, Names, NodeSet, NodeState,
    Options, PathPoint, Pick, PortUse, PoseChange, Preload, RealTime, Simulation, Stability, StepHistory, Summary,
    SurfaceContactUse, SystemTime, Unloaded, Unloading, UnloadingStep, unload,
};
pub use snapshot::Snapshot;

#[doc(hidden)]
pub use backend::gpu::gpu_or_reason;
#[doc(hidden)]
pub use error::shell_word;
#[doc(hidden)]
pub use simulation::TwoLevelParts;

/// What systems of one's own are written with: `use sinew::prelude::*;`.
///
/// The derive macros of bevy_ecs name their crate `bevy_ecs`; it is among these, so that `#[derive(Resource)]` compiles
/// in a crate that depends on sinew alone. Those of serde need `#[serde(crate = "sinew::serde")]` there.
pub mod prelude {
    #[doc(no_inline)]
    pub use crate::components::{Clock, Displacement, DisplacementIncrement, ExternalForce, Mass, RestPosition};
    #[doc(no_inline)]
    pub use crate::systems::{
        Before, Cpu, ForceSlopes, NodeColumns, NodeSystem, NodesAtRest, Phase, Registry, SimdScalar, System,
    };
    #[doc(no_inline)]
    pub use crate::{BackendChoice, Error, NodeSet, Options, SceneFile, Simulation, bevy_ecs, glam, serde};
    #[doc(no_inline)]
    pub use bevy_ecs::prelude::*;
    #[doc(no_inline)]
    pub use glam::DVec3;
}

/// The code in the readme compiles and runs.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
