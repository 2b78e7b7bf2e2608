// The change of volume by J, for laws with U(J); defaults of src/materials/elastic.rs.
fn elastic_volume_measure(k: Kinematics) -> f32 {
    return k.volume_change;
}

// Second Piola-Kirchhoff stress (Pa) of a pressure (Pa): p J C⁻¹
fn elastic_volumetric(k: Kinematics, pressure: f32) -> Sym3 {
    return sym_scaled(k.adjugate_c, pressure / k.j);
}
