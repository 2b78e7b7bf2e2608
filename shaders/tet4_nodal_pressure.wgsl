// Pressure (Pa) of tetrahedra with averaged nodal pressure; twin of src/elements/tet4_nodal_pressure.rs.
// corner_volume_change is in corner_volume.wgsl or patch_volume.wgsl.

fn mean_pressure(element: u32, e: Element) -> f32 {
    var sum = 0.0;
    for (var corner = 0u; corner < NODES; corner++) {
        sum += elastic_pressure(corner_volume_change(element, corner));
    }
    return sum / f32(NODES);
}

fn point_pressure(mean: f32, k: Kinematics) -> f32 {
    return mean;
}

// J/m³
fn volumetric_energy(element: u32, e: Element) -> f32 {
    var sum = 0.0;
    for (var corner = 0u; corner < NODES; corner++) {
        sum += elastic_volumetric_energy(corner_volume_change(element, corner));
    }
    return sum / f32(NODES);
}
