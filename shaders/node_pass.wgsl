// The kernel of systems that work node by node. INVOCATIONS is generated.

// The functions of those systems, in their order: linked by `Pass::of` in src/backend/node_stage/pass.rs
// (`sinew explain SCENE --backend gpu --kernel LABEL` shows what is called).
fn call_all(node: u32) {}
fn finish_all(local: u32, node: u32) {}

@compute @workgroup_size(INVOCATIONS)
fn node_pass(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let node = row(id, groups) + pass_rows.first;
    if node < pass_rows.count {
        call_all(node);
    }
    finish_all(local, node);
}
