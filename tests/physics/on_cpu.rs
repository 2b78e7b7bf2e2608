//! Runs that leave a GPU out.

use crate::configurations::{Configuration, configurations};
use sinew::BackendChoice;

/// Those on the CPU: for long tests of what an element or a law comes to. That a GPU's kernels give the same, element
/// by element and law by law, is tests/kernels' to say, and in software a GPU takes ten times as long.
pub fn on_cpu() -> Vec<Configuration> {
    configurations().into_iter().filter(|run| run.options.backend == BackendChoice::Cpu).collect()
}
