// A force on chosen nodes that have mass; twin of systems/nodal_force.rs. factor_of is in
// load_factor.wgsl, or generated where all nodes get the same.
struct NodalLoad {
    signal: u32, // slot of the force (N)
}
@group(0) @binding(0) var<uniform> load: NodalLoad;
@group(0) @binding(1) var<storage, read> mass: array<f32>;

fn nodal_force(i: u32, node: u32) {
    if mass[node] > 0.0 {
        add_load(node, factor_of(i) * step.signals[load.signal].xyz);
    }
}
