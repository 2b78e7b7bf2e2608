// The eight-chain law of Arruda and Boyce; twin of src/materials/arruda_boyce.rs.
struct ArrudaBoyce {
    shear: f32, // Pa
    locking_stretch: f32,
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: ArrudaBoyce;

// Ψ/μ and its derivative by Ī₁, for Ī₁ = 3 + change
fn chain_series(change: f32) -> vec2<f32> {
    var coefficients = array<f32, 5>(0.5, 0.05, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673750.0);
    let i1 = 3.0 + change;
    let chain = 1.0 / (elastic.locking_stretch * elastic.locking_stretch);
    var quotient = 1.0;
    var power = 1.0;
    var factor = change;
    var three_to = 1.0;
    var energy = 0.0;
    var slope = 0.0;
    for (var i = 0u; i < 5u; i++) {
        let c = coefficients[i];
        energy += c * factor * quotient;
        slope += c * f32(i + 1u) * power;
        three_to *= 3.0;
        quotient = i1 * quotient + three_to;
        power *= i1 * chain;
        factor *= chain;
    }
    return vec2<f32>(energy, slope);
}

// 2 ∂Ψ/∂Ī₁ J^(−2/3) (I − I₁/3 C⁻¹) (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let factor = 4.0 * elastic.shear * chain_series(min(i1_change(k), 100.0)).y * k.j_m23;
    return inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), factor));
}

// κ(J − 1) (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.shear * chain_series(i1_change(k)).x;
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
