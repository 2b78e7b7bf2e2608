// What the force on each node is multiplied with, for nodal_force.
@group(0) @binding(0) var<storage, read> factors: array<f32>;

fn factor_of(i: u32) -> f32 {
    return factors[i];
}
