// What resists acceleration (kg) where mass is scaled: the mass of the elements that are left, and what was added to
// them. A part of node_mass.wgsl; element_at is generated.
@group(0) @binding(0) var<storage, read_write> inertial_mass: array<f32>;
@group(0) @binding(1) var<storage, read> added_mass: array<u32>; // of each element an f64 (kg), its low word first

// An f64 of 0 or above, cut to an f32.
fn from_f64(low: u32, high: u32) -> f32 {
    let exponent = high >> 20u;
    if exponent < 897u {
        return 0.0;
    }
    return bitcast<f32>(((exponent - 896u) << 23u) | ((high & 0xfffffu) << 3u) | (low >> 29u));
}

fn move_node(node: u32, added: f32) {
    var further = 0.0;
    for (var i = starts[node]; i < starts[node + 1u]; i++) {
        if rest_shape[volumes[i]] > 0.0 {
            let element = element_at(volumes[i]);
            further += shares[i] * from_f64(added_mass[2u * element], added_mass[2u * element + 1u]);
        }
    }
    inertial_mass[node] = select(inertial_mass[node], 0.0, part.first == 1u) + (added + further);
}
