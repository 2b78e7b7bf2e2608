// The kernel of systems that work node by node. call_all and finish_all are generated: the functions of those systems, in
// their order.
const INVOCATIONS: u32 = 64u;

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
