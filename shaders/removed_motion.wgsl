// Counts the kinetic energy and the momentum of elements that are about to be taken away, and the part of the energy
// that constraints gave them: in a kernel of its own, so that neither this one nor element_removal has more than eight
// buffers. MASS_SHARES are generated from the block's element type; MOMENTA_AT is where momenta begin among the counts.
// added_to is in added_mass.wgsl, or generated where no mass is scaled.
struct Removal {
    density: f32, // kg/m³
}
@group(0) @binding(0) var<uniform> removal: Removal;
@group(0) @binding(1) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(2) var<storage, read> removal_step: array<u32>;
@group(0) @binding(3) var<storage, read_write> removed_energy: array<f32>;
@group(0) @binding(4) var<storage, read> displacement_increment: array<f32>;
@group(0) @binding(5) var<storage, read> constrained_axes: array<u32>;
@group(0) @binding(6) var<storage, read_write> removed_motion_books: array<f32>;

// ½ m v² of the element's share of its nodes (J), v in the middle of the last step, m with what was added to it; m v
// (kg m/s) without.
@compute @workgroup_size(64)
fn removed_motion(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count || !is_due(element) {
        return;
    }
    let volume = rest_shape[place(element, ROWS, VOLUME_ROW)];
    if volume == 0.0 {
        return; // it has gone before
    }
    var shares = MASS_SHARES;
    var squares = 0.0;
    var constrained = 0.0;
    var mean = vec3<f32>(0.0);
    for (var corner = 0u; corner < NODES; corner++) {
        let node = connectivity[place(element, NODES, corner)];
        let at = 3u * node;
        let v = step.rate * vec3<f32>(displacement_increment[at], displacement_increment[at + 1u], displacement_increment[at + 2u]);
        squares += shares[corner] * dot(v, v);
        mean += shares[corner] * v;
        let along = (vec3<u32>(constrained_axes[node]) & vec3<u32>(1u, 2u, 4u)) != vec3<u32>(0u);
        let held = select(vec3<f32>(0.0), v, along);
        constrained += shares[corner] * dot(held, held);
    }
    let mass = removal.density * volume;
    let moved = mass + added_to(element);
    removed_energy[element] = 0.5 * moved * squares;
    removed_motion_books[element] = 0.5 * moved * constrained;
    for (var i = 0u; i < 3u; i++) {
        removed_motion_books[MOMENTA_AT + place(element, 3u, i)] = mass * mean[i];
    }
}
