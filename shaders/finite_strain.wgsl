// Strain measures and first Piola-Kirchhoff stress of laws for large strains; defaults of src/materials/elastic.rs.
fn elastic_kinematics(gradient: mat3x3<f32>) -> Kinematics {
    return kinematics(gradient);
}

// F S (Pa)
fn elastic_first_stress(gradient: mat3x3<f32>, k: Kinematics, isochoric: Sym3, pressure: f32) -> mat3x3<f32> {
    return plus_identity_times(gradient, sym_plus(isochoric, elastic_volumetric(k, pressure)));
}
