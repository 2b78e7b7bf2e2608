//! Which kinds of elements a test runs with, where.

use crate::configurations::{Configuration, ELEMENTS};
use sinew::BackendChoice;
use sinew::backend::gpu::gpu_or_reason;

/// Every configuration with every kind of elements. On a GPU in software, which compiles each kernel for about a
/// second, with two kinds, tests taking turns: what a GPU does is compared with the CPU kind by kind in
/// `tests/kernels`.
pub fn with_elements(runs: &[Configuration], turn: usize) -> Vec<(&Configuration, &'static str)> {
    let software = gpu_or_reason().is_some_and(|gpu| gpu.report().software);
    let pairs = runs.iter().flat_map(|run| ELEMENTS.into_iter().enumerate().map(move |kind| (run, kind)));
    pairs
        .filter(|(run, (place, _))| {
            let everywhere = !software || run.options.backend == BackendChoice::Cpu;
            everywhere || place % (ELEMENTS.len() / 2) == turn % (ELEMENTS.len() / 2)
        })
        .map(|(run, (_, elements))| (run, elements))
        .collect()
}
