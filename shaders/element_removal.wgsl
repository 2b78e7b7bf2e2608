// Takes elements away; twin of systems/element_removal.rs. watched and passes_a_limit are generated from the block's
// criteria, energy_density from its material, remove_shape from its element type.
@group(0) @binding(0) var<storage, read_write> rest_shape: array<f32>;
@group(0) @binding(1) var<storage, read_write> alive: array<u32>;
@group(0) @binding(2) var<storage, read> removal_step: array<u32>;
@group(0) @binding(3) var<storage, read_write> removed_energy: array<f32>;

const NEVER: u32 = 0xffffffffu;

@compute @workgroup_size(64)
fn element_removal(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count || alive[element] == 0u {
        return;
    }
    // the step that comes next is number + 1
    let due = removal_step[element] != NEVER && removal_step[element] <= max(step.number, step.number + 1u);
    if !due && !watched(element) {
        return;
    }
    let e = element_of(element);
    let gradient = displacement_gradient(e);
    let k = kinematics(gradient);
    let energy = energy_density(element, k);
    if !due && !passes_a_limit(element, k, energy) {
        return;
    }
    alive[element] = 0u;
    removed_energy[element] = energy * e.volume + hourglass_energy(element, e, gradient);
    remove_shape(element);
}
