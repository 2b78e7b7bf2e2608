// Elastic energy per rest volume (J/m³) of an element; fibres_energy_at is generated. Twin of BlockView::energy in
// src/evaluation/block.rs.
fn energy_density(element: u32, e: Element) -> f32 {
    take_law(element);
    var sum = 0.0;
    var volume = 0.0;
    for (var point = 0u; point < POINTS; point++) {
        let at = at_point(e, point);
        let k = elastic_kinematics(at.gradient);
        sum += at.volume * (elastic_isochoric_energy(k) + fibres_energy_at(element, k));
        volume += at.volume;
    }
    return sum / volume + volumetric_energy(element, e);
}
