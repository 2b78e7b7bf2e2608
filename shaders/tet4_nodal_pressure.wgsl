// Pressure (Pa) of tetrahedra with averaged nodal pressure; twin of src/elements/tet4_nodal_pressure.rs.
@group(0) @binding(0) var<storage, read> nodal_volume_change: array<f32>;

fn corner_volume_change(element: u32, corner: u32) -> f32 {
    return nodal_volume_change[connectivity[place(element, NODES, corner)]];
}

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
