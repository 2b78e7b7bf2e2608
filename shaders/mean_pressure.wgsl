// Pressure (Pa) of elements with several points: one, from their mean volume.
fn mean_volume_change(e: Element) -> f32 {
    var change = 0.0;
    var volume = 0.0;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        change += at.volume * elastic_volume_measure(elastic_kinematics(at.gradient));
        volume += at.volume;
    }
    return change / volume;
}

// Pa
fn mean_pressure(element: u32, e: Element) -> f32 {
    return elastic_pressure(mean_volume_change(e));
}

fn point_pressure(mean: f32, k: Kinematics) -> f32 {
    return mean;
}

// J/m³
fn volumetric_energy(element: u32, e: Element) -> f32 {
    return elastic_volumetric_energy(mean_volume_change(e));
}
