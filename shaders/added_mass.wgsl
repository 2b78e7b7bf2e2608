// The mass that was added to elements so that the step may be as large as it is. A part of node_inertia.wgsl and
// removed_motion.wgsl.
@group(0) @binding(0) var<storage, read> added_mass: array<u32>; // of each element an f64 (kg), its low word first

// An f64 of 0 or above, cut to an f32.
fn from_f64(low: u32, high: u32) -> f32 {
    let exponent = high >> 20u;
    if exponent < 897u {
        return 0.0;
    }
    return bitcast<f32>(((exponent - 896u) << 23u) | ((high & 0xfffffu) << 3u) | (low >> 29u));
}

// What was added to an element (kg).
fn added_to(element: u32) -> f32 {
    return from_f64(added_mass[2u * element], added_mass[2u * element + 1u]);
}
