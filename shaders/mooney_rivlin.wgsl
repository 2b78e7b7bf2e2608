// The Mooney-Rivlin law; twin of src/materials/mooney_rivlin.rs.
struct MooneyRivlin {
    c10: f32, // Pa
    c01: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: MooneyRivlin;

// C⁻¹ dev(4(c₁₀ J^(−2/3) + c₀₁ J^(−4/3) (1 + 2 tr E)) E − 8c₀₁ J^(−4/3) E²) (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let second = 4.0 * elastic.c01 * k.j_m23 * k.j_m23;
    let first = 4.0 * elastic.c10 * k.j_m23 + second * (2.0 * sym_trace(e) + 1.0);
    let inner = sym_plus(sym_scaled(e, first), sym_scaled(sym_times_coaxial(e, e), -2.0 * second));
    return inverse_c_times(k, sym_deviator(inner));
}

// κ(J − 1) (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let e = k.green_strain;
    let w = j_m23_change(k);
    let v = w * (2.0 + w);
    let trace = sym_trace(e);
    let i2_change = 4.0 * trace + 2.0 * (trace * trace - sym_contracted(e, e));
    return elastic.c10 * i1_change(k) + elastic.c01 * (3.0 * v + i2_change + v * i2_change);
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
