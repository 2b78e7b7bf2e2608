// Forces of deformed elements on their corners; twin of systems/element_forces.rs. two_pass.wgsl or patches.wgsl sums
// them. The element's and the material's fragments say how, note_inverted or remove_inverted what becomes of J <
// LEAST_J; LEAST_J, isochoric_stress and viscous_pressure are generated; take_law is in law_of_all.wgsl.
@group(0) @binding(0) var<storage, read> rest_shape: array<f32>;

// N
fn forces_of(element: u32) -> array<vec3<f32>, NODES> {
    take_law(element);
    let e = element_of(element);
    let mean = mean_pressure(element, e);
    var forces = Forces();
    var inverted = false;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        let k = elastic_kinematics(at.gradient);
        inverted = inverted || (e.volume > 0.0 && k.true_j < LEAST_J);
        let pressure = viscous_pressure(element, point, point_pressure(mean, k));
        let stress = elastic_first_stress(at.gradient, k, isochoric_stress(element, point, k), pressure);
        forces = add_stress(forces, point, at, stress);
    }
    for (var point = POINTS; point < CHECKED_POINTS; point++) {
        inverted = inverted || (e.volume > 0.0 && 1.0 + volume_change_of(at_point(e, point).gradient) < LEAST_J);
    }
    if inverted && is_removed_inverted(element) {
        return array<vec3<f32>, NODES>();
    }
    return corner_forces(element, e, forces);
}
