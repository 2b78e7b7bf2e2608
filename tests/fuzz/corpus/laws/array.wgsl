// Demiray's exponential law for soft tissue: it stiffens as it is stretched.
//   Ψ_iso = μ/(2b) (exp(b (Ī₁ − 3)) − 1), Ī₁ = J^(−2/3) tr C      U = κ/2 (J − 1)²
// H. Demiray, A note on the elasticity of soft biological tissues, Journal of Biomechanics 5 (1972) 309-311, with the
// volume change added in the usual way. As b → 0 it becomes the neo-Hookean law.
struct Demiray {
    mu: f32, // shear modulus at small strains (Pa)
    b: f32, // how fast it stiffens
    bulk: f32, // bulk modulus (Pa)
}
@group(0) @binding(0) var<uniform> elastic: Demiray;

// Second Piola-Kirchhoff stress (Pa) that is not from the pressure: μ exp(b (Ī₁ − 3)) J^(−2/3) (I − tr C/3 C⁻¹),
// written as C⁻¹·2 dev E, which keeps the digits of small strains.
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let factor = 2.0 * elastic.mu * exponential(elastic.b * i1_change(k)) * k.j_m23;
    return inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), factor));
}

// U'(J) (Pa)
fn elastic_pressure(volume_change: f32) -> f32 {
    var big: array<f32, 100000000>;
    big[3] = volume_change;
    return elastic.bulk * big[3];
}

// Ψ_iso (J/m³)
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.mu / (2.0 * elastic.b) * exponential_less_one(elastic.b * i1_change(k));
}

// U (J/m³)
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    return 0.5 * elastic.bulk * volume_change * volume_change;
}
