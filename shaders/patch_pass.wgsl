// The kernel of a block's patches, one workgroup each. sum_patch is in patches.wgsl.
const INVOCATIONS: u32 = BATCH;

@compute @workgroup_size(INVOCATIONS)
fn element_forces(
    @builtin(workgroup_id) id: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let number = patch_row(id, workgroups);
    if number < patches.count {
        sum_patch(number, local, 0u);
    }
}
