//! What a step costs: cubes of many sizes, elements, effects, backends, threads and schemes, timed by turns, so that
//! ratios within one run hold on a busy machine too.

mod case;
mod compare;
mod cost;
mod gpu;
mod load;
mod machine;
mod plot;
mod ratios;
mod tables;

pub use case::{Case, Effects, Plan, elements_a_cell};
pub use compare::{Change, compare};
pub use cost::{Cost, cost};
pub use load::Load;
pub use machine::{Machine, memory_peak};
pub use plot::drawing;
pub use ratios::{cpu_to_gpu, split_to_fused};
pub use tables::{csv, line, markdown};

use serde::{Deserialize, Serialize};
use sinew::Error;
use std::time::Instant;

/// What was measured of a case.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Row {
    /// What was run.
    #[serde(flatten)]
    pub case: Case,
    /// How many elements.
    #[serde(rename = "element_count")]
    pub elements: u64,
    /// How many nodes.
    pub nodes: u64,
    /// Time of a step over elements (ns), the best of all blocks of steps: other work on the machine only adds.
    pub ns_per_element_step: f64,
    /// The median of the blocks (ns).
    pub median_ns: f64,
    /// What three quarters of the blocks stay below (ns); records of before do not have it.
    #[serde(default)]
    pub third_quartile_ns: Option<f64>,
    /// Elements computed in a second, by the best.
    pub updates_per_s: f64,
    /// How many times as long the plain two-pass scheme takes in the same run; where it was measured beside.
    pub two_pass_ratio: Option<f64>,
    /// How many times as long it takes as under the engine's gravity in the same run; where that was measured beside.
    #[serde(default)]
    pub gravity_ratio: Option<f64>,
    /// Arithmetic of an element and step (floating-point operations), counted by running the kernel on numbers that
    /// count.
    pub flops: f64,
    /// Bytes that a step has to move for each element if every column is moved once, counted from the columns.
    pub bytes: f64,
    /// Share of the measured bandwidth that these bytes come to; CPU only.
    pub bandwidth_share: Option<f64>,
    /// Share of the measured peak of arithmetic; CPU only.
    pub peak_share: Option<f64>,
    /// From the scene to the first step (s).
    pub setup_s: f64,
    /// Largest memory of the process while the case ran (bytes), where the system tells; all cases of a group are in
    /// memory together.
    pub memory_peak: Option<u64>,
    /// The GPU it ran on, if it did.
    #[serde(default)]
    pub adapter: Option<String>,
    /// Time of all kernels of a step on the GPU's own clock, over elements (ns); each in a pass of its own, as clocks
    /// want it.
    #[serde(default)]
    pub gpu_ns: Option<f64>,
}

/// A benchmark as it is kept.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Record {
    /// The machine, by threads.
    pub machine: Vec<Machine>,
    /// One row a case.
    pub rows: Vec<Row>,
}

/// Blocks of steps that are timed by turns.
const LEAST_BLOCKS: usize = 7;

/// Runs the cases of a group (which differ in what is to be compared) by turns, each for about `seconds`.
///
/// # Errors
/// What keeps a case from running.
pub fn measure(group: &[Case], seconds: f64, machine: &[Machine]) -> Result<Vec<Row>, Error> {
    machine::forget_memory_peak();
    let mut made = Vec::new();
    for case in group {
        let started = Instant::now();
        let mut simulation = case.simulation()?;
        gpu::advance(&mut simulation, 1)?;
        made.push((simulation, started.elapsed().as_secs_f64(), Vec::new(), 1_u64));
    }
    // blocks of some milliseconds: short enough to be left alone, long enough to be timed
    for (simulation, _, _, block) in &mut made {
        let started = Instant::now();
        gpu::advance(simulation, 3)?;
        let step = started.elapsed().as_secs_f64() / 3.0;
        *block = (0.005 / step).clamp(1.0, 512.0) as u64;
    }
    let began = Instant::now();
    let budget = seconds * group.len() as f64;
    while began.elapsed().as_secs_f64() < budget || made[0].2.len() < LEAST_BLOCKS {
        for (simulation, _, times, block) in &mut made {
            // the others have had the caches
            gpu::advance(simulation, 1)?;
            let started = Instant::now();
            gpu::advance(simulation, *block)?;
            times.push(started.elapsed().as_secs_f64() / *block as f64);
        }
    }
    let memory_peak = memory_peak();
    let mut rows = Vec::new();
    for (case, (mut simulation, setup_s, mut times, block)) in group.iter().zip(made) {
        times.sort_by(f64::total_cmp);
        let cells = u64::from(case.cells);
        let (elements, nodes) = (cells.pow(3) * elements_a_cell(case.element), (cells + 1).pow(3));
        let nanoseconds = |seconds: f64| seconds * 1e9 / elements as f64;
        let cost = cost(case, elements, nodes);
        let per_element = times[0] / elements as f64;
        let of = machine.iter().find(|machine| machine.threads == case.threads && !case.is_gpu());
        rows.push(Row {
            case: case.clone(),
            elements,
            nodes,
            ns_per_element_step: nanoseconds(times[0]),
            median_ns: nanoseconds(times[times.len() / 2]),
            third_quartile_ns: Some(nanoseconds(times[times.len() * 3 / 4])),
            updates_per_s: 1.0 / per_element,
            two_pass_ratio: None,
            gravity_ratio: None,
            flops: cost.flops,
            bytes: cost.bytes,
            bandwidth_share: of.map(|machine| cost.bytes / per_element / machine.bytes_per_s),
            peak_share: of.map(|machine| cost.flops / per_element / machine.flops_per_s),
            setup_s,
            memory_peak,
            adapter: gpu::adapter(&mut simulation),
            gpu_ns: gpu::kernel_seconds(&mut simulation, block.min(32))?.map(nanoseconds),
        });
    }
    let best = |rows: &[Row], case: &Case| rows.iter().find(|row| row.case == *case).map(|row| row.ns_per_element_step);
    for place in 0..rows.len() {
        let plain = best(&rows, &rows[place].case.two_pass());
        rows[place].two_pass_ratio = plain.map(|plain| plain / rows[place].ns_per_element_step);
        let case = &rows[place].case;
        let gravity = (case.load != Load::Gravity).then(|| best(&rows, &case.under_gravity())).flatten();
        rows[place].gravity_ratio = gravity.map(|gravity| rows[place].ns_per_element_step / gravity);
    }
    Ok(rows)
}
