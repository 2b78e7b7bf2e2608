// Damping of nodes (kg/s), for who wants to know where they will go.
@group(0) @binding(0) var<storage, read> damping_coefficient: array<f32>;
