// Damping coefficients (kg/s) of the elements that are left.
@group(0) @binding(0) var<storage, read_write> damping_coefficient: array<f32>;

fn damp_node(node: u32, added: f32) {
    damping_coefficient[node] = select(damping_coefficient[node], 0.0, part.first == 1u) + added;
}
