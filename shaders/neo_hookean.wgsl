// The neo-Hookean law; twin of src/materials/neo_hookean.rs.
struct NeoHookean {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> neo_hookean: NeoHookean;

// μJ^(−2/3) C⁻¹·2 dev E (Pa)
fn neo_hookean_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let deviator = Sym3(e.diagonal - sym_trace(e) * (1.0 / 3.0), e.others);
    let factor = 2.0 * neo_hookean.shear * k.j_m23 / (k.j * k.j);
    return sym_scaled(sym_times_coaxial(k.adjugate_c, deviator), factor);
}

// κJ(J − 1) C⁻¹ (Pa)
fn neo_hookean_volumetric(k: Kinematics) -> Sym3 {
    return sym_scaled(k.adjugate_c, neo_hookean.bulk * k.volume_change / k.j);
}

// J/m³
fn neo_hookean_energy(k: Kinematics) -> f32 {
    let trace_c = 3.0 + 2.0 * sym_trace(k.green_strain);
    return 0.5 * neo_hookean.shear * (k.j_m23 * trace_c - 3.0)
        + 0.5 * neo_hookean.bulk * k.volume_change * k.volume_change;
}
