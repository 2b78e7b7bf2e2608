//! The words of a scene file: one Rust type for each, read by serde. SI units throughout (m, kg, s, Pa).

mod accuracy;
mod action;
mod analysis;
mod attachment;
mod body;
mod load;
mod material;
mod output;
mod part;
mod per_copy;
mod picture;
mod scene;
mod selection;
mod solver;
mod system;
mod tool;

pub use super::load_parts::{Amplitude, LoadParts, LoadPartsMut, On};
pub use crate::materials::Elasticity;
pub use crate::mesh::ElementKind;
pub use crate::tools::Shape;
pub use accuracy::{Accuracy, AccuracyReference};
pub use action::{Axis, Constraint, Curve, Removal, Threshold, When};
pub use analysis::{Analysis, ArcLength, EquilibriumSearch, InitialState, SearchMethod};
pub use attachment::{Attachment, Point};
pub use body::{Body, MeshSource, Region, SkinFile, SkinFormat, Start};
pub(crate) use load::each_load;
pub use load::{LOADS, Load, Share};
pub use material::{
    Direction, ELASTIC_LAWS, ExponentialFibres, Fibres, Inversion, Material, OwnLaw, Prony, PronyTerm,
    ViscousIntegrator, comparable_laws, laws_for_large_strains, laws_that_recover,
};
pub use output::{Output, OutputField};
pub use part::{OF_THE_WHOLE, Part, PartScene};
pub use per_copy::PerCopy;
pub use picture::{Colours, Cut, Field, Opacity, Picture};
pub use scene::{EnergyGuard, Guard, Guards, Integration, Scene, StepBound, WhenUnstable};
pub use selection::{Probe, Quantity, Select};
pub use solver::{ErrorControl, ImplicitScheme, Preconditioner, Solver};
pub use system::OwnSystem;
pub use tool::{Contact, ContactLaw, Follow, Free, Points, Port, Suction, Tool, ToolMesh, ToolMove, ToolPlace};

/// The texts of these files and those of laws: what a field means is told in the words it is documented with.
pub fn texts() -> impl Iterator<Item = &'static str> {
    TEXT.iter().chain(crate::materials::TEXTS).chain(crate::tools::TEXTS).copied()
}

const TEXT: [&str; 16] = [
    include_str!("scene.rs"),
    include_str!("analysis.rs"),
    include_str!("part.rs"),
    include_str!("body.rs"),
    include_str!("per_copy.rs"),
    include_str!("material.rs"),
    include_str!("action.rs"),
    include_str!("load.rs"),
    include_str!("selection.rs"),
    include_str!("solver.rs"),
    include_str!("system.rs"),
    include_str!("tool.rs"),
    include_str!("attachment.rs"),
    include_str!("output.rs"),
    include_str!("picture.rs"),
    include_str!("accuracy.rs"),
];
