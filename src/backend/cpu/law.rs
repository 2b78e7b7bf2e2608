//! The material of a block, ready for its kernel.

use crate::materials::{ElasticLaw, Fibres, PronyTerm};
use crate::math::Scalar;
use bevy_ecs::prelude::*;

/// All that a block's kernel needs of its material, in the kernel's precision. What the material does not have is `None`
/// or empty, and then is not in the kernel either: kernels are compiled for each combination.
#[derive(Component, Clone, Debug)]
pub struct BlockLaw<T: Scalar> {
    /// Isotropic elasticity.
    pub elastic: ElasticLaw<T>,
    /// Fibres, and their direction when it is the same for the whole block.
    pub fibres: Option<(Fibres<T>, Option<[T; 3]>)>,
    /// Viscosity, for the run's time step.
    pub prony: Vec<PronyTerm<T>>,
}

impl BlockLaw<f64> {
    /// Rounds to the run's precision.
    pub fn rounded<T: Scalar>(&self) -> BlockLaw<T> {
        let round = |value: f64| T::from_f64(value);
        BlockLaw {
            elastic: self.elastic.rounded(),
            fibres: self.fibres.map(|(f, direction)| {
                let fibres = Fibres { eta: round(f.eta), tension_only: round(f.tension_only) };
                (fibres, direction.map(|a| a.map(round)))
            }),
            prony: self
                .prony
                .iter()
                .map(|t| PronyTerm {
                    stress: round(t.stress),
                    memory: round(t.memory),
                    rate: round(t.rate),
                    aim: round(t.aim),
                })
                .collect(),
        }
    }
}
