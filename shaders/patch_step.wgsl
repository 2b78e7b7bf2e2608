// The kernel of a block's patches where the nodes inside a patch move as soon as its forces are known: the stages of
// the pass over the nodes, which does the rest. sum_patch is in patches.wgsl; LEAST_INTERIOR, INVOCATIONS and
// force_of_patch are generated.
//
// No workgroup sees what another moves: a node is inside a patch if no other patch of the body has it, a patch reads
// the displacements of its own nodes only, and no stage reads those of other nodes than its own. Within a workgroup all
// displacements have been read before the first barrier of sum_patch.

// The functions of those stages, in their order: linked by `Pass::of` in src/backend/node_stage/pass.rs.
fn call_all(node: u32) {}
fn finish_all(local: u32, node: u32) {}

@compute @workgroup_size(INVOCATIONS)
fn patch_step(
    @builtin(workgroup_id) id: vec3<u32>,
    @builtin(num_workgroups) workgroups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let number = patch_row(id, workgroups);
    if number < patches.count {
        let interior = patch_lists[patches.interior + number];
        sum_patch(number, local, interior);
        // they follow one another
        let first = patch_lists[patches.nodes + patch_lists[number]];
        for (var i = local; i < interior; i += INVOCATIONS) {
            force_of_patch = vec3<f32>(patch_force[3u * i], patch_force[3u * i + 1u], patch_force[3u * i + 2u]);
            call_all(first + i);
        }
        // once for all of them: each sixty-four invocations that had any have a place of the patch's own
        let part = local / 64u;
        finish_all(local, select(pass_rows.count, first + LEAST_INTERIOR * part, 64u * part < interior));
    }
}
