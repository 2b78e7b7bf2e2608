//! What an elastic law is in scenes and to a GPU, beside its stress: its descriptor.

use super::{Complaints, Elastic};
use crate::uniform::Uniform;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Debug;

/// An elastic law as scenes name it: all that has to be said of one beside [`Elastic`] and its WGSL twin. The twin has
/// the law's word for its stem, and a struct with the members of [`Uniform`].
pub trait Law: Elastic<f64> + Elastic<f64, Of<f32>: Uniform> {
    /// What stands in a scene after the law's word.
    type Parameters: Clone + Debug + PartialEq + Serialize + DeserializeOwned;
    /// What its twin calls beside `Kinematics`, and what it leaves to the functions that most laws have in common.
    const PREREQUISITES: &'static [Prerequisite] = &[Prerequisite::FiniteStrain, Prerequisite::VolumeRatio];
    /// Whether it is one for large strains.
    const LARGE_STRAINS: bool = true;
    /// Whether its stress is one inside out (J < 0), too, and pushes back.
    const RECOVERS: bool = false;
    /// Whether it is one of those that studies of a scene compare.
    const IS_COMPARED: bool = true;

    /// The law that parameters make; they have been checked.
    fn of(parameters: &Self::Parameters) -> Self;

    /// Tells what is wrong with parameters.
    fn check(parameters: &Self::Parameters, complaints: &mut Complaints);

    /// Parameters of a law with these shear and bulk moduli (Pa) at small strains.
    fn with_moduli(shear: f64, bulk: f64) -> Self::Parameters;
}

/// An elastic law of one's own in Rust, written once over any kind of number: `impl<R: Real> Elastic<R> for Law<R>`
/// and, for scenes to name it, this.
///
/// The CPU runs it in kernels that are compiled for it, as for a built-in law. To run it on a GPU, on machines without
/// vector registers and where single elements are looked at it is recorded: run once over numbers that note what is
/// done to them. So it needs no WGSL.
pub trait RustLaw: Elastic<f64, Of<f32>: 'static> + 'static {
    /// What stands under `parameters` in a scene: a struct of `f64`, each with its unit.
    type Parameters: DeserializeOwned;

    /// The law with these parameters.
    ///
    /// # Errors
    /// What is wrong with them, in one sentence without a full stop.
    fn of(parameters: Self::Parameters) -> Result<Self, String>;
}

/// Files in `shaders/` that a law's twin can stand on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prerequisite {
    /// Kinematics, stresses and pressures of large strains: for laws that have none of their own.
    FiniteStrain,
    /// θ = J − 1: for laws that have none of their own.
    VolumeRatio,
    /// Stresses, pressures and energies of Hooke's law in the strain that `elastic_kinematics` finds.
    Hooke,
    /// Eigenvalues and axes.
    Eigen,
    /// Exponentials, logarithms and roots with the same digits on every device.
    Elementary,
    /// Invariants and stresses of their slopes.
    Invariants,
}
