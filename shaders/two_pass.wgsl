// Every element writes the forces on its corners, for the gather to sum: the scheme of two passes. write_forces is
// generated.
@group(0) @binding(0) var<storage, read_write> element_force: array<f32>;

fn write_force(element: u32, corner: u32, force: vec3<f32>) {
    let at = block.force_offset + place(element, 3u * NODES, 3u * corner);
    element_force[at] = force.x;
    element_force[at + LANES] = force.y;
    element_force[at + 2u * LANES] = force.z;
}

@compute @workgroup_size(64)
fn element_forces(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let element = row(id, groups);
    if element >= block.count {
        return;
    }
    write_forces(element, forces_of(element));
}
