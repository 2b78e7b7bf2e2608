// Pressure (Pa) of elements with one point: from the volume there.
fn mean_pressure(element: u32, e: Element) -> f32 {
    return 0.0;
}

fn point_pressure(mean: f32, k: Kinematics) -> f32 {
    return elastic_pressure(elastic_volume_measure(k));
}

// J/m³
fn volumetric_energy(element: u32, e: Element) -> f32 {
    return elastic_volumetric_energy(elastic_volume_measure(elastic_kinematics(at_point(e, 0u).gradient)));
}
