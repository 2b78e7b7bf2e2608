// Mass times acceleration on every node; twin of systems/gravity.rs. factor_of is in load_factor.wgsl, or
// generated where all nodes get the same. signal: slot of the acceleration (m/s²).
fn gravity(node: u32) {
    add_load(node, mass[node] * (factor_of(node) * step.signals[parameters.signal].xyz));
}
