//! What a step does several times, one after the other.

use crate::backend::kernel::Kernel;
use std::fmt::{Display, Formatter, Result};

/// A part of a step that is repeated: sweeps of a system, iterations of a solver.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Repeat {
    /// What, in the order in which it is done.
    pub what: Vec<String>,
    /// How often in a step, where `until` does not end it earlier.
    pub times: u64,
    /// What ends it.
    pub until: Option<String>,
}

impl Repeat {
    /// So many times, at least once.
    pub fn times(times: usize, what: &[&str]) -> Self {
        let what = what.iter().map(|&what| what.to_owned()).collect();
        Self { what, times: times.max(1) as u64, until: None }
    }

    /// What stands for kernels, in the order in which a step runs them: those that are repeated are neighbours.
    pub fn spread<T: Clone>(&self, kernels: &[Kernel], all: &[T]) -> Vec<T> {
        let first = kernels.iter().position(|kernel| kernel.repeated).unwrap_or(kernels.len());
        let count = kernels[first..].iter().take_while(|kernel| kernel.repeated).count();
        let (before, others) = all.split_at(first);
        let (repeated, after) = others.split_at(count);
        let repeated = (0..self.times).flat_map(|_| repeated.iter().cloned());
        before.iter().cloned().chain(repeated).chain(after.iter().cloned()).collect()
    }
}

impl Display for Repeat {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (what, times) = (self.what.join(", "), self.times);
        match &self.until {
            Some(until) => write!(f, "repeat until {until}, at most {times} times: {what}"),
            None if times == 1 => write!(f, "once: {what}"),
            None => write!(f, "repeat {times} times: {what}"),
        }
    }
}
