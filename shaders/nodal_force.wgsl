// A force on chosen nodes that have mass; twin of systems/nodal_force.rs. factor_of is in
// load_factor.wgsl, or generated where all nodes get the same. signal: slot of the force (N).
fn nodal_force(i: u32, node: u32) {
    if mass[node] > 0.0 {
        add_load(node, factor_of(i) * step.signals[parameters.signal].xyz);
    }
}
