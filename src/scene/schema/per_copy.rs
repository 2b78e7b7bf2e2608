//! Numbers that differ from copy to copy of a body.

use crate::math::noise;
use serde::{Deserialize, Serialize};
use twox_hash::XxHash64;

/// A number for each copy of a body.
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
}

impl PerCopy {
    /// The number of each of so many copies; as many as there are of `Values`. Draws of different names have nothing to
    /// do with each other, whatever their seed.
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
        }
    }
}
