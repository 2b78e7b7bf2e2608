// Takes away the elements whose time has come; twin of systems/element_removal.rs. extinguish is generated from the block's
// element type. criterion.wgsl sets the time of elements that pass a limit.
struct Removal {
    share: f32, // density over nodes of an element (kg/m³)
}
@group(0) @binding(0) var<uniform> removal: Removal;
@group(0) @binding(1) var<storage, read_write> rest_shape: array<f32>;
@group(0) @binding(2) var<storage, read_write> alive: array<u32>;
@group(0) @binding(3) var<storage, read> removal_step: array<u32>;
@group(0) @binding(4) var<storage, read_write> removed_energy: array<f32>;
@group(0) @binding(5) var<storage, read> displacement_step: array<f32>;

// ½ m v² of the element's share of its nodes (J), v in the middle of the last step.
fn kinetic_energy(element: u32, volume: f32) -> f32 {
    var squares = 0.0;
    for (var corner = 0u; corner < NODES; corner++) {
        let at = 3u * connectivity[place(element, NODES, corner)];
        let v = step.rate * vec3<f32>(displacement_step[at], displacement_step[at + 1u], displacement_step[at + 2u]);
        squares += dot(v, v);
    }
    return 0.5 * removal.share * volume * squares;
}

@compute @workgroup_size(64)
fn element_removal(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count || alive[element] == 0u {
        return;
    }
    let due = removal_step[element];
    if due == 0xffffffffu || due > max(step.number, step.number + 1u) {
        return;
    }
    let e = element_of(element);
    let elastic = energy_density(element, e) * e.volume;
    removed_energy[element] = elastic + hourglass_energy(element, e) + kinetic_energy(element, e.volume);
    alive[element] = 0u;
    extinguish(element);
}
