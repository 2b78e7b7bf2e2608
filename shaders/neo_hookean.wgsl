// The neo-Hookean law; twin of src/materials/neo_hookean.rs. By way of S; `direct_stress` there is the same at once.
struct NeoHookean {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: NeoHookean;

// μJ^(−2/3) C⁻¹·2 dev E (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let deviator = Sym3(e.diagonal - sym_trace(e) * (1.0 / 3.0), e.others);
    let factor = 2.0 * elastic.shear * k.j_m23 / (k.j * k.j);
    return sym_scaled(sym_times_coaxial(k.adjugate_c, deviator), factor);
}

// κ(J − 1) (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return 0.5 * elastic.shear * i1_change(k);
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
