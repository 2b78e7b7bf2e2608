//! Kernels that the tests of the GPU layer run.
#![allow(dead_code, clippy::unwrap_used)]

use sinew::backend::gpu::{BufferKind, Gpu};
use sinew::backend::kernel::{BufferId, Fragment, Kernel};
use sinew::shader;

/// y <- a x + y, a from a uniform found by name.
pub const SAXPY: &str = "struct Scale { a: f32, count: u32 }
@group(0) @binding(0) var<storage, read> x: array<f32>;
@group(0) @binding(1) var<storage, read_write> y: array<f32>;
@group(0) @binding(2) var<uniform> scale: Scale;
@compute @workgroup_size(64)
fn saxpy(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i < scale.count { y[i] += scale.a * x[i]; }
}
";

/// Each row is a recurrence of the step's record: order and completeness of the steps show in every bit.
pub const MARCH: &str = "struct Step { number: u32, push: f32 }
@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(1) var<storage, read_write> state: array<f32>;
@compute @workgroup_size(64)
fn march(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&state) {
        state[id.x] = fma(state[id.x], 0.75, step.push) + f32(step.number % 7u) * f32(id.x + 1u);
    }
}
";

/// The same, all steps of a submission in one dispatch; records are of 16 bytes.
pub const MARCH_ON: &str = "struct Step { number: u32, push: f32, @size(8) reserved: u32 }
struct StepRecords { count: u32, @align(16) steps: array<Step> }
@group(0) @binding(0) var<storage, read> step_records: StepRecords;
@group(0) @binding(1) var<storage, read_write> state: array<f32>;
@compute @workgroup_size(64)
fn march(@builtin(global_invocation_id) id: vec3<u32>) {
    for (var i = 0u; i < step_records.count; i++) {
        let step = step_records.steps[i];
        if id.x < arrayLength(&state) {
            state[id.x] = fma(state[id.x], 0.75, step.push) + f32(step.number % 7u) * f32(id.x + 1u);
        }
    }
}
";

pub fn saxpy(x: BufferId, y: BufferId, scale: BufferId, threads: u32) -> Kernel {
    let kernel = Kernel::new("saxpy", "saxpy").fragment(Fragment::new("saxpy.wgsl", SAXPY)).fragment(shader!("row"));
    kernel.bind("x", x).bind("y", y).bind("scale", scale).threads(threads)
}

pub fn march(state: BufferId, threads: u32) -> Kernel {
    Kernel::new("march", "march").fragment(Fragment::new("march.wgsl", MARCH)).bind("state", state).threads(threads)
}

pub fn march_on(state: BufferId, threads: u32) -> Kernel {
    Kernel::new("march on", "march")
        .fragment(Fragment::new("march.wgsl", MARCH_ON))
        .bind("state", state)
        .threads(threads)
}

pub fn march_records(count: u32) -> Vec<u8> {
    (0..count).flat_map(|n| bytemuck::cast::<_, [u8; 8]>([n, (1.0 / (n + 1) as f32).to_bits()])).collect()
}

pub fn storage(gpu: &mut Gpu, label: &str, rows: &[f32]) -> BufferId {
    gpu.create_with(label, rows, BufferKind::Storage).unwrap()
}
