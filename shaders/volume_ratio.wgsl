// The change of volume by J, for laws with U(J); defaults of src/materials/elastic.rs.
fn elastic_volume_measure(k: Kinematics) -> f32 {
    return k.volume_change;
}

// Second Piola-Kirchhoff stress (Pa) of a pressure (Pa): p J C⁻¹
fn elastic_volumetric(k: Kinematics, pressure: f32) -> Sym3 {
    return sym_scaled(k.adjugate_c, pressure / k.j);
}

// What a stress (Pa) is without its part that acts on J: s − (s:C)/3 C⁻¹
fn elastic_without_pressure(k: Kinematics, stress: Sym3) -> Sym3 {
    let pressing = sym_trace(stress) + 2.0 * sym_contracted(stress, k.green_strain);
    return sym_plus(stress, sym_scaled(k.adjugate_c, pressing * (-1.0 / 3.0) / (k.j * k.j)));
}
