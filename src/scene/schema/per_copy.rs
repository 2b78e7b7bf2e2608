//! Numbers and vectors that differ from copy to copy of a body.

use crate::math::noise;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use twox_hash::XxHash64;

/// A number or a vector for each copy of a body.
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub enum PerCopy {
    /// From the first copy's number to the last one's, evenly.
    Linear(f64, f64),
    /// Anywhere between two numbers, each as likely as any other; the same in every run.
    Uniform {
        /// The least.
        from: f64,
        /// The largest.
        to: f64,
        /// Another number, other draws.
        #[serde(default)]
        seed: u64,
    },
    /// Anywhere between two numbers above 0, each factor as likely as any other; the same in every run.
    LogUniform {
        /// The least.
        from: f64,
        /// The largest.
        to: f64,
        /// Another number, other draws.
        #[serde(default)]
        seed: u64,
    },
    /// One number a copy.
    Values(Vec<f64>),
    /// A vector for each copy: its components along the axes of the scene, none of which is a vector itself.
    Axes {
        /// Along x.
        x: Box<PerCopy>,
        /// Along y.
        y: Box<PerCopy>,
        /// Along z.
        z: Box<PerCopy>,
    },
    /// Unit vectors, each direction as likely as any other; the same in every run.
    Directions {
        /// Another number, other draws.
        #[serde(default)]
        seed: u64,
    },
}

impl PerCopy {
    /// Whether it is a vector for each copy.
    pub fn is_vector(&self) -> bool {
        matches!(self, Self::Axes { .. } | Self::Directions { .. })
    }

    /// The number of each of so many copies; as many as there are of `Values`, of vectors that along x. Draws of
    /// different names have nothing to do with each other, whatever their seed.
    pub fn values(&self, name: &str, copies: usize) -> Vec<f64> {
        let steps = (copies.max(2) - 1) as f64;
        let between = |from: f64, to: f64, seed: u64| {
            let first = XxHash64::oneshot(seed, name.as_bytes());
            (0..copies as u64).map(move |copy| from + (to - from) * noise(first.wrapping_add(copy))).collect()
        };
        match self {
            Self::Linear(from, to) => (0..copies).map(|copy| from + (to - from) * copy as f64 / steps).collect(),
            Self::Uniform { from, to, seed } => between(*from, *to, *seed),
            Self::LogUniform { from, to, seed } => {
                let logarithms: Vec<f64> = between(from.ln(), to.ln(), *seed);
                logarithms.into_iter().map(|logarithm| logarithm.exp().clamp(*from, *to)).collect()
            }
            Self::Values(values) => values.clone(),
            Self::Axes { .. } | Self::Directions { .. } => {
                self.vectors(name, copies).into_iter().map(|vector| vector.x).collect()
            }
        }
    }

    /// The vector of each of so many copies; of what is a number for each, that along all three axes. Components of
    /// different axes are drawn as those of different names are.
    pub fn vectors(&self, name: &str, copies: usize) -> Vec<DVec3> {
        match self {
            Self::Axes { x, y, z } => {
                let [x, y, z] = [(x, "x"), (y, "y"), (z, "z")]
                    .map(|(axis, letter)| axis.values(&format!("{name}.{letter}"), copies));
                x.into_iter().zip(y).zip(z).map(|((x, y), z)| DVec3::new(x, y, z)).collect()
            }
            // a sphere between two heights has the area of the cylinder around it
            Self::Directions { seed } => {
                let drawn = |from, to, part: &str| {
                    Self::Uniform { from, to, seed: *seed }.values(&format!("{name}.{part}"), copies)
                };
                let heights = drawn(-1.0, 1.0, "height");
                let angles = drawn(0.0, std::f64::consts::TAU, "angle");
                let direction = |(z, angle): (f64, f64)| {
                    let radius = (1.0 - z * z).max(0.0).sqrt();
                    DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
                };
                heights.into_iter().zip(angles).map(direction).collect()
            }
            of_one_number => of_one_number.values(name, copies).into_iter().map(DVec3::splat).collect(),
        }
    }
}
