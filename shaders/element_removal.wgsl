// Takes away the elements whose time has come; twin of systems/element_removal.rs. deactivate is generated from the
// block's element type. criterion.wgsl sets the time of elements that pass a limit, removed_motion.wgsl counts their
// motion.
@group(0) @binding(0) var<storage, read_write> rest_shape: array<f32>;
@group(0) @binding(1) var<storage, read_write> alive: array<u32>;
@group(0) @binding(2) var<storage, read> removal_step: array<u32>;
@group(0) @binding(3) var<storage, read_write> removed_energy: array<f32>;

@compute @workgroup_size(64)
fn element_removal(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count || alive[element] == 0u || !is_due(element) {
        return;
    }
    let e = element_of(element);
    removed_energy[element] += energy_density(element, e) * e.volume + hourglass_energy(element, e);
    alive[element] = 0u;
    deactivate(element);
}
