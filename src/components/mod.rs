//! The data: what a scene author names is an entity, what is numerous is a column of one of its components.
//!
//! | entity | components |
//! |---|---|
//! | body | node columns ([`nodes`]), [`Corners`], [`ElementForce`], [`Authoring`] |
//! | element block: one element type, one material, one body | [`Block`], [`Connectivity`], [`Patches`], [`RestShape`] and, where called for, [`FibreDirection`], [`ViscousMemory`], [`MemoryBefore`], [`NodalVolumeChange`], [`Alive`], [`RemovalStep`] |
//! | material | [`Density`], an [elastic law](crate::materials::ElasticLaw), [`Fibres`](crate::materials::Fibres), [`ExponentialFibres`], [`Prony`], [`Damping`], [`StiffnessDamping`]: an effect exists when its component does |
//! | constraint, load, removal | [`Fixed`], [`Prescribed`], [`SceneLoad`], [`OwnLoad`], [`RemovalCriterion`] with the rows they act on |
//! | probe | [`Probe`] |

mod block;
mod clock;
mod column;
mod column_bytes;
mod column_layout;
mod constraint;
mod contact;
mod curve;
mod free_tool;
mod glue;
mod grab;
mod grasp;
mod guard;
mod input;
mod load;
mod material;
#[doc(hidden)]
pub mod nodes;
mod observation;
mod own_load;
mod patches;
mod signal;
mod springs;
mod suction;
mod suture;
mod tool;
mod tool_removal;
mod touched;

pub use block::{Alive, Connectivity, FibreDirection, RemovalStep, RestShape, ViscousMemory};
pub use clock::Clock;
pub use column::{Column, Precision, Reals};
pub use material::{Damping, Density};
pub use nodes::{
    Authoring, ConstrainedAxes, DampingCoefficient, Displacement, DisplacementCompensation, DisplacementIncrement,
    ElementForce, ExternalForce, InertialMass, InternalForce, Mass, RestPosition, Work,
};
pub use observation::Energies;
pub use patches::Scheme;
pub use signal::Signals;

// what the engine, the crates on top and tests see beside: no version keeps their names and types
#[doc(hidden)]
pub use block::{
    AddedMass, Block, BlockCorners, ElementSums, ElementVolume, FamilyDirection, FirstInverted, MemoryBefore,
    NodalVolumeChange, OnInversion, RemovalTime, RemovedEnergy, RemovedMomentum, RemovedWork, patch_groups,
    patch_length,
};
#[doc(hidden)]
pub use clock::{Relaxation, TrialForces};
pub(crate) use column::is_anywhere;
#[doc(hidden)]
pub use column::{ColumnAccess, Role, all_columns, column_is, columns_in, place_in_buffer};
#[doc(hidden)]
pub use column_layout::{Increments, Rows, Subject};
#[doc(hidden)]
pub use constraint::{Fixed, Measure, Prescribed, RemovalCriterion};
#[doc(hidden)]
pub use contact::{
    ContactForce, ContactGain, ContactSpring, Did, FacePlaces, FaceTouch, MEETING_NUMBERS, PointState, SurfaceRows,
    SurfaceSleep, SurfaceTouch,
};
pub(crate) use contact::{Meets, Met};
#[doc(hidden)]
pub use free_tool::{FreeMotion, FreeMotions, FreeTool, FreeTools, FreeTouch, MetBody};
#[doc(hidden)]
pub use glue::{Glue, Strength, TIE_NUMBERS, TieState, TiedPoint, frame_of};
#[doc(hidden)]
pub use grab::{Grabs, HeldNode};
#[doc(hidden)]
pub use grasp::{Grasp, Grasps, HOLD_NUMBERS, ToolHold};
#[doc(hidden)]
pub use guard::{BeginsInside, Extreme, GuardMemory, Notice};
#[doc(hidden)]
pub use input::{Change, Input, InputState};
#[doc(hidden)]
pub use load::{FaceCorners, FaceMarks, LoadedNodes, LoadedRows, SceneLoad};
#[doc(hidden)]
pub use material::{
    ElementInertia, ElementMemory, ExponentialFibres, PerCopyInertia, PerCopyMemory, Prony, StiffnessDamping,
};
#[doc(hidden)]
pub use nodes::{
    Acceleration, ChosenBy, Corners, FirstNonFinite, GROUP_ROWS, InternalWork, MiddleDisplacement, NodeSums,
    OwnNumbers, PreviousPrescribedIncrement, SchemeLoss, WORK_NUMBERS,
};
#[doc(hidden)]
pub use observation::{AlsoWritten, Cadence, HeldEnergies, HeldEnergy, Observed, Probe};
#[doc(hidden)]
pub use own_load::{LoadText, NodeAtRest, OfSystem, OwnLoad};
#[doc(hidden)]
pub use patches::{Patches, inside_of};
#[doc(hidden)]
pub use signal::Signal;
#[doc(hidden)]
pub use springs::{Rubbing, SolvedPress, SolvedSprings, SpringForces, TouchingSpring};
pub(crate) use suction::{APART, STEEP};
#[doc(hidden)]
pub use suction::{BodyFaces, FacePresence, NO_FACE, SUCTION_NUMBERS, Suction, SuctionMarks, SuctionPressure, share};
#[doc(hidden)]
pub use suture::{Anchor, SUTURE_NUMBERS, Suture, SutureForce, SutureState, Sutured, Sutures};
pub(crate) use tool::IdleTools;
#[doc(hidden)]
pub use tool::{FELT_NUMBERS, Hand, Key, Pose, TOUCH_NUMBERS, ToolContact, ToolContacts, ToolMotion, ToolTouch};
#[doc(hidden)]
pub use tool_removal::{
    INTAKE_NUMBERS, Island, Islands, Mouth, ToolIntake, ToolLooks, ToolReach, ToolRemoval, ToolRemovals,
};
#[doc(hidden)]
pub use touched::Touched;

use bevy_ecs::prelude::*;

/// What the scene's author calls an entity.
#[derive(Component, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Label(pub String);

/// That an entity is a body, with nodes that move.
#[derive(Component, Clone, Copy, Debug)]
pub struct Body;

/// The body that a block, constraint, load or probe belongs to.
#[derive(Component, Clone, Copy, Debug)]
pub struct OfBody(pub Entity);
