// The GPU's part of `Weight` in load.rs. Its columns and `parameters` are declared by the engine.
fn weight(node: u32) {
    add_load(node, vec3<f32>(0.0, 0.0, mass[node] * parameters.acceleration));
}
