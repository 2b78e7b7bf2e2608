// What resists acceleration (kg) where mass is scaled: the mass of the elements that are left, and what was added to
// them. A part of node_mass.wgsl; element_at is generated, added_to is in added_mass.wgsl.
@group(0) @binding(0) var<storage, read_write> inertial_mass: array<f32>;

fn move_node(node: u32, added: f32) {
    var further = 0.0;
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        if rest_shape[volumes[i]] > 0.0 {
            further += shares[i] * added_to(element_at(volumes[i]));
        }
    }
    inertial_mass[node] = select(inertial_mass[node], 0.0, part.first == 1u) + (added + further);
}
