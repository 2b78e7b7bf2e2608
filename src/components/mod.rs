//! The data: what a scene author names is an entity, what is numerous is a column of one of its components.
//!
//! | entity | components |
//! |---|---|
//! | body | node columns ([`nodes`]), [`Corners`], [`ElementForce`], [`Authoring`] |
//! | element block: one element type, one material, one body | [`Block`], [`Connectivity`], [`Patches`], [`RestShape`] and, where called for, [`FibreDirection`], [`ViscousMemory`], [`NodalVolumeChange`], [`Alive`], [`RemovalStep`] |
//! | material | [`Density`], an [elastic law](crate::materials::ElasticLaw), [`Fibres`](crate::materials::Fibres), [`ExponentialFibres`], [`Prony`], [`Damping`], [`StiffnessDamping`]: an effect exists when its component does |
//! | constraint, load, removal | [`Fixed`], [`Prescribed`], [`SceneLoad`], [`OwnLoad`], [`RemovalCriterion`] with the
//! rows they act on |
//! | probe | [`Probe`] |

mod block;
mod clock;
mod column;
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
pub mod nodes;
mod observation;
mod own_load;
mod patches;
mod signal;
mod suction;
mod suture;
mod tool;
mod tool_removal;
mod touched;

pub use block::{
    AddedMass, Alive, Block, BlockCorners, Connectivity, ElementSums, ElementVolume, FamilyDirection, FibreDirection,
    FirstInverted, NodalVolumeChange, OnInversion, RemovalStep, RemovalTime, RemovedEnergy, RemovedMomentum,
    RemovedWork, RestShape, ViscousMemory, patch_groups, patch_length,
};
pub use clock::{Clock, Relaxation, TrialForces};
pub use column::{Column, ColumnAccess, Precision, Reals, Role, all_columns, columns_in, place_in_buffer};
pub use column_layout::{Increments, Rows};
pub use constraint::{Fixed, Measure, Prescribed, RemovalCriterion};
pub use contact::{ContactForce, ContactSpring, FaceTouch, MEETING_NUMBERS, SurfaceRows, SurfaceTouch};
pub use free_tool::{FreeMotion, FreeMotions, FreeTool, FreeTools, FreeTouch, MetBody};
pub use glue::{Glue, Strength, TIE_NUMBERS, TieState, TiedPoint, frame_of};
pub use grab::{Grabs, HeldNode};
pub use grasp::{Grasp, Grasps, HOLD_NUMBERS, ToolHold};
pub use guard::{Extreme, GuardMemory, Notice};
pub use input::{Change, Input, InputState};
pub use load::{FaceCorners, FaceMarks, LoadedNodes, LoadedRows, SceneLoad};
pub use material::{Damping, Density, ExponentialFibres, Prony, StiffnessDamping, memory_terms};
pub use nodes::{
    Acceleration, Authoring, ChosenBy, ConstrainedAxes, Corners, DampingCoefficient, Displacement,
    DisplacementCompensation, DisplacementIncrement, ElementForce, ExternalForce, FictitiousMass, FirstNonFinite,
    GROUP_ROWS, InternalForce, InternalWork, Mass, MiddleDisplacement, NodeSums, OwnNumbers,
    PreviousPrescribedIncrement, RestPosition, SchemeLoss, WORK_NUMBERS, Work,
};
pub use observation::{Cadence, Energies, HeldEnergies, HeldEnergy, Observed, Probe};
pub use own_load::{LoadText, NodeAtRest, OfSystem, OwnLoad};
pub use patches::{Patches, Scheme};
pub use signal::{Signal, Signals};
pub use suction::{BodyFaces, FacePresence, NO_FACE, SUCTION_NUMBERS, Suction, SuctionMarks, SuctionPressure, share};
pub use suture::{Anchor, SUTURE_NUMBERS, Suture, SutureForce, SutureState, Sutured, Sutures};
pub use tool::{FELT_NUMBERS, Hand, Key, Pose, TOUCH_NUMBERS, ToolContact, ToolContacts, ToolMotion, ToolTouch};
pub use tool_removal::{INTAKE_NUMBERS, Island, Islands, Mouth, ToolIntake, ToolReach, ToolRemoval, ToolRemovals};
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
