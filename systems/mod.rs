//! The step: every system a file of its own here, its kernel a file of the same stem in `shaders/`.
//!
//! ```text
//! boundary         Prescribed                   -> DisplacementIncrement of constrained axes   per node
//! suction_mouth    Displacement, Alive, motion  -> SuctionMarks, SuctionPressure          per face
//! suture_tension   Displacement                 -> SutureForce, SutureState                per suture
//! nodal_volume     Displacement, RestShape      -> NodalVolumeChange                      per element, per node
//! element_forces   Displacement, RestShape, law -> ElementForce                           per element, patch by patch
//! gather           ElementForce, Corners        -> InternalForce (ExternalForce: zero)    per node, over its patches, in a fixed order
//! (loads)          Mass or Displacement         -> ExternalForce                          per loaded node: src/scene/schema/load.rs
//! suction          Displacement                 -> ExternalForce                          per sucked node
//! suture           SutureForce                  -> ExternalForce                          per sutured node
//! grab             Displacement                 -> ExternalForce                          per held node
//! surface_contact  forces, Displacement, ToolHold -> ExternalForce, ContactForce, SurfaceTouch per point that may touch
//! glue             forces, Displacement         -> ExternalForce, TieState, SurfaceTouch  per tie
//! free_tool        forces, Displacement, motion -> ExternalForce, SurfaceTouch, motion    per free tool
//! tool_contact     forces, Displacement, motion -> ExternalForce, ToolTouch, SurfaceTouch per node that may touch
//! grasp            forces, Displacement, motion -> ExternalForce, ToolHold                per node that may be held
//! integrate        forces, Mass                 -> DisplacementIncrement, Displacement         per node
//! tool_removal     Displacement, motion         -> RemovalStep, ToolIntake                per element in reach
//! tool_threshold   Displacement, motion         -> RemovalStep                            per element in reach
//! island_removal   Alive, motion                -> RemovalStep, ToolIntake                per island
//! element_removal  criteria, times              -> Alive, RestShape, Mass                 per element, per node
//! observe          all, read only               -> probes, energies, guards, files
//! ```
//!
//! A scene may have loads of its own in WGSL (`own_load`): systems of their own names, among the loads. What works node
//! by node is a [`NodeSystem`], and so may be a user's: neighbours of a step share a pass (`node_pass`), with
//! `element_forces` before them for the nodes inside a patch (`patch_pass`; on a GPU `src/backend/patch_step.rs`).

mod boundary;
mod element_forces;
mod element_removal;
mod free_tool;
mod gather;
mod glue;
mod grab;
mod grasp;
mod gravity;
mod host_forces;
mod integrate;
mod island_removal;
mod nodal_force;
mod nodal_volume;
mod node_pass;
mod node_shares;
mod node_slices;
mod node_slopes;
mod node_stages;
mod node_system;
mod node_views;
mod observe;
mod own_load;
mod patch_pass;
mod pressure;
mod registry;
mod repeat;
mod rows;
mod runs_on;
mod stage;
mod suction;
mod suction_mouth;
mod surface_contact;
mod suture;
mod suture_tension;
mod system;
mod tool_contact;
mod tool_removal;
mod tool_threshold;
mod traction;

pub use crate::backend::cpu::{Cpu, NodeColumns};
pub use crate::math::SimdScalar;
pub(crate) use element_removal::criterion_steps;
pub(crate) use gather::sum_corners;
pub(crate) use glue::find_ties;
pub(crate) use grab::{bytes_of as grab_bytes, uniform_of as grab_uniform};
pub(crate) use grasp::{Given, HeldNode, held_in_step, note_held};
pub(crate) use host_forces::SlopesOf;
pub(crate) use nodal_volume::means_of;
pub(crate) use node_pass::{NodePass, node_pass, shared_pass};
pub(crate) use node_shares::{give_shares, mark};
pub(crate) use node_slopes::NodeSlopes;
#[doc(hidden)]
pub use node_system::NodeRows;
pub use node_system::NodeSystem;
pub use node_views::{Before, ForceSlopes, MiddleOfStep, NodesAtRest};
#[doc(hidden)]
pub use observe::{add_guard_columns, guard_kernels};
pub(crate) use patch_pass::patch_pass;
pub use registry::Registry;
pub use repeat::Repeat;
pub use rows::{RowSet, Rows};
#[doc(hidden)]
pub use runs_on::{DescribeKernels, HostSystem, OnDevice, OnHost};
pub use stage::Stage;
#[doc(hidden)]
pub use surface_contact::{Meeting, SurfaceContacts, SurfaceMemory};
pub(crate) use surface_contact::{count_surface_work, find_surface_springs, find_surfaces, seek_surfaces};
pub(crate) use suture_tension::find_thread_springs;
#[doc(hidden)]
pub use system::Because;
pub(crate) use system::BeforeSteps;
pub use system::{Outcome, Phase, System};
pub(crate) use tool_contact::{count_tool_work, find_tool_springs};

use crate::scene::schema::{OwnSystem, Scene, each_load};

/// Places in `rows`, which ascend, of those among `count` from row `first` on.
fn places_within(rows: &[u32], first: usize, count: usize) -> std::ops::Range<usize> {
    let place = |bound: usize| rows.partition_point(|&row| (row as usize) < bound);
    place(first)..place(first + count)
}

/// The systems that a scene has of its own: loads in WGSL, each a system of its name.
pub(crate) fn of_scene(scene: &Scene) -> Vec<System> {
    let system = |(number, (name, own)): (usize, (&String, &OwnSystem))| {
        let parameters = own.parameters.iter().map(|(parameter, value)| format!("{parameter} {value}"));
        let what: Vec<String> = std::iter::once(own.file.clone()).chain(parameters).collect();
        own_load::system(name, number, what.join(", "))
    };
    scene.systems.iter().enumerate().map(system).collect()
}

macro_rules! loads {
    ($($(#[$about:meta])* $file:ident: $word:ident $parts:tt;)*) => {
        $(#[doc(hidden)] pub use $file::$word;)*

        /// The systems of loads, with the loads' words in scenes.
        pub(crate) fn of_loads() -> Vec<(&'static str, System)> {
            vec![$((stringify!($word), $file::system())),*]
        }
    };
}
each_load!(loads);

/// The built-in systems, in the order of a step.
#[doc(hidden)]
pub fn standard() -> Vec<System> {
    let loads = of_loads().into_iter().map(|(_, system)| system);
    let before = vec![
        boundary::system(),
        suction_mouth::system(),
        suture_tension::system(),
        nodal_volume::system(),
        element_forces::system(),
        gather::system(),
    ];
    let after = vec![
        suction::system(),
        suture::system(),
        grab::system(),
        surface_contact::system(),
        glue::system(),
        free_tool::system(),
        tool_contact::system(),
        grasp::system(),
        integrate::system(),
        tool_removal::system(),
        tool_threshold::system(),
        island_removal::system(),
        element_removal::system(),
        observe::system(),
    ];
    before.into_iter().chain(loads).chain(after).collect()
}
