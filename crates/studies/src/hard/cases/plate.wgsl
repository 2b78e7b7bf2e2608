// The GPU's part of `Plate` in impact.rs. Its columns and `parameters` are declared by the engine.
fn plate(node: u32) {
    let height = rest_position[3u * node + 2u] + displacement[3u * node + 2u];
    add_load(node, vec3<f32>(0.0, 0.0, -parameters.stiffness * min(height, 0.0)));
}
