// Forces of deformed elements on their corners; twin of systems/element_forces.rs.
// The element's and the material's fragments say how, note_inverted or remove_inverted what becomes of J < 0; isochoric_stress, viscous_pressure and write_forces are generated.
@group(0) @binding(0) var<storage, read> rest_shape: array<f32>;
@group(0) @binding(1) var<storage, read_write> element_force: array<f32>;

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
    let e = element_of(element);
    let mean = mean_pressure(element, e);
    var forces = Forces();
    var inverted = false;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        let k = elastic_kinematics(at.gradient);
        inverted = inverted || (e.volume > 0.0 && k.true_j < 0.0);
        let pressure = viscous_pressure(element, point, point_pressure(mean, k));
        let stress = elastic_first_stress(at.gradient, k, isochoric_stress(element, point, k), pressure);
        forces = add_stress(forces, point, at, stress);
    }
    if inverted && is_removed_inverted(element) {
        write_forces(element, array<vec3<f32>, NODES>());
        return;
    }
    write_forces(element, corner_forces(element, e, forces));
}
