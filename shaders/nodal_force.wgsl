// A force on chosen nodes that have mass; twin of systems/nodal_force.rs.
struct NodalLoad {
    count: u32, // loaded nodes
    signal: u32, // slot of the force (N)
}
@group(0) @binding(0) var<uniform> load: NodalLoad;
@group(0) @binding(1) var<storage, read> rows: array<u32>;
@group(0) @binding(2) var<storage, read> mass: array<f32>;

@compute @workgroup_size(64)
fn nodal_force(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = row(id, groups);
    if i < load.count && mass[rows[i]] > 0.0 {
        add_load(rows[i], step.signals[load.signal].xyz);
    }
}
