// Hooke's law in the strain E that the law's own kinematics find, Green's or a small one, for `elastic` with `shear`
// and `bulk`; of st_venant_kirchhoff.wgsl, linear.wgsl and corotational_frame.wgsl.
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
