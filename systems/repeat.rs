//! What a step does several times, one after the other.

use crate::backend::kernel::Kernel;
use std::fmt::{Display, Formatter, Result};

/// What of a system a step repeats: its sweeps.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Repeat {
    /// How often, where `until` does not end it earlier.
    pub times: usize,
    /// What ends it.
    pub until: Option<&'static str>,
    /// What is repeated, in its order.
    pub what: Vec<&'static str>,
}

impl Repeat {
    /// So many times; `None` where that is once.
    pub(crate) fn several(times: usize, what: &[&'static str]) -> Option<Self> {
        (times > 1).then(|| Self { times, until: None, what: what.to_vec() })
    }

    /// What stands for the kernels of a system, as often as a step runs them and in that order. The kernels that are
    /// repeated are neighbours.
    pub(crate) fn spread<T: Clone>(&self, kernels: &[Kernel], all: &[T]) -> Vec<T> {
        let first = kernels.iter().position(|kernel| kernel.repeated).unwrap_or(kernels.len());
        let count = kernels[first..].iter().take_while(|kernel| kernel.repeated).count();
        debug_assert!(!kernels[first + count..].iter().any(|kernel| kernel.repeated), "repeated kernels stand apart");
        let (before, repeated, after) = (&all[..first], &all[first..first + count], &all[first + count..]);
        let repeated = (0..self.times).flat_map(|_| repeated);
        before.iter().chain(repeated).chain(after).cloned().collect()
    }
}

impl Display for Repeat {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (what, times) = (self.what.join(", "), self.times);
        match self.until {
            Some(until) => write!(f, "repeat until {until}, at most {times} times: {what}"),
            None => write!(f, "repeat {times} times: {what}"),
        }
    }
}
