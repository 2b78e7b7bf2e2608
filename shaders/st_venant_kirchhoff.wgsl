// The St. Venant-Kirchhoff law; twin of src/materials/st_venant_kirchhoff.rs.
struct StVenantKirchhoff {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: StVenantKirchhoff;

// 2μ dev E (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    return sym_scaled(sym_deviator(k.green_strain), 2.0 * elastic.shear);
}

// tr E
fn elastic_volume_measure(k: Kinematics) -> f32 {
    return sym_trace(k.green_strain);
}

// p I (Pa)
fn elastic_volumetric(k: Kinematics, pressure: f32) -> Sym3 {
    return Sym3(vec3<f32>(pressure), vec3<f32>(0.0));
}

fn elastic_without_pressure(k: Kinematics, stress: Sym3) -> Sym3 {
    return stress;
}

// κ tr E (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let deviator = sym_deviator(k.green_strain);
    return elastic.shear * sym_contracted(deviator, deviator);
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
