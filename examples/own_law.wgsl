// Demiray's exponential law for soft tissue: it stiffens as it is stretched.
//   Ψ_iso = μ/(2b) (exp(b (Ī₁ − 3)) − 1), Ī₁ = J^(−2/3) tr C      U = κ/2 (J − 1)²
// H. Demiray, A note on the elasticity of soft biological tissues, Journal of Biomechanics 5 (1972) 309-311, with the
// volume change added in the usual way. Without b it is the neo-Hookean law.
struct Demiray {
    mu: f32, // shear modulus at small strains (Pa)
    b: f32, // how fast it stiffens
    bulk: f32, // bulk modulus (Pa)
}
@group(0) @binding(0) var<uniform> elastic: Demiray;

// exp(b (Ī₁ − 3))
fn stiffening(k: Kinematics) -> f32 {
    let i1 = k.j_m23 * (3.0 + 2.0 * sym_trace(k.green_strain));
    return exp(elastic.b * (i1 - 3.0));
}

// Second Piola-Kirchhoff stress (Pa) that is not from the pressure: μ exp(...) J^(−2/3) (I − tr C/3 C⁻¹), written as
// C⁻¹·2 dev E, which keeps the digits of small strains.
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let deviator = Sym3(e.diagonal - sym_trace(e) / 3.0, e.others);
    let factor = 2.0 * elastic.mu * stiffening(k) * k.j_m23 / (k.j * k.j);
    return sym_scaled(sym_times_coaxial(k.adjugate_c, deviator), factor);
}

// U'(J) (Pa)
fn elastic_pressure(volume_change: f32) -> f32 {
    return elastic.bulk * volume_change;
}

// Ψ_iso (J/m³)
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.mu / (2.0 * elastic.b) * (stiffening(k) - 1.0);
}

// U (J/m³)
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    return 0.5 * elastic.bulk * volume_change * volume_change;
}
