// All steps of a submission of a small body, in one dispatch of one workgroup: one of which a step takes no longer than
// starting kernels does. INVOCATIONS is generated, and `var<workgroup> step: Step`.
struct StepRecords {
    count: u32, // steps of the submission
    steps: array<Step>,
}
@group(0) @binding(0) var<storage, read> step_records: StepRecords;

// sum_patch of patches.wgsl, for each block, and the functions of systems of nodes, in their order: linked by
// `Pass::of` in src/backend/node_stage/pass.rs.
fn sum_all(number: u32, local: u32, kept: u32) {}
fn call_all(node: u32) {}
fn finish_all(local: u32, node: u32) {}

// `id` is 0. No 0 is written in its place: Mesa 22.3's software GPU compiles loops anew, while they run, of which only
// a uniform is not known before, and has been seen to crash over it.
@compute @workgroup_size(INVOCATIONS)
fn many_steps(@builtin(workgroup_id) id: vec3<u32>, @builtin(local_invocation_index) local: u32) {
    for (var number = 0u; number < step_records.count; number++) {
        if local == 0u {
            step = step_records.steps[number];
        }
        workgroupBarrier();
        sum_all(id.x, local, 0u);
        storageBarrier();
        for (var first = id.x; first < pass_rows.count; first += INVOCATIONS) {
            let node = first + local;
            if node < pass_rows.count {
                call_all(node);
            }
            finish_all(local, node);
        }
        // the nodes have moved, and nobody reads this step's record any more
        storageBarrier();
        workgroupBarrier();
    }
}
