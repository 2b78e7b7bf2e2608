// Mass times acceleration on every node; twin of systems/gravity.rs. factor_of is in load_factor.wgsl, or
// generated where all nodes get the same.
struct GravityLoad {
    signal: u32, // slot of the acceleration (m/s²)
}
@group(0) @binding(0) var<uniform> load: GravityLoad;
@group(0) @binding(1) var<storage, read> mass: array<f32>;

fn gravity(node: u32) {
    add_load(node, mass[node] * (factor_of(node) * step.signals[load.signal].xyz));
}
