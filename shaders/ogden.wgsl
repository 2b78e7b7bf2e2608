// Ogden's law in principal stretches; twin of src/materials/ogden.rs. With eigen.wgsl and elementary.wgsl.
struct Ogden {
    mu: vec4<f32>, // Pa
    alpha: vec4<f32>,
    bulk: f32, // Pa
    terms: u32,
}
@group(0) @binding(0) var<uniform> elastic: Ogden;

// ln λ̄ for the eigenvalues of E
fn isochoric_logarithms(strains: vec3<f32>) -> vec3<f32> {
    let twice = max(2.0 * strains, vec3<f32>(J_FLOOR * J_FLOOR - 1.0));
    let logarithms = 0.5 * vec3<f32>(
        logarithm_of_one_plus(twice.x),
        logarithm_of_one_plus(twice.y),
        logarithm_of_one_plus(twice.z),
    );
    return logarithms - (logarithms.x + logarithms.y + logarithms.z) * (1.0 / 3.0);
}

// λ̄^α_p − 1
fn isochoric_powers(p: u32, logarithms: vec3<f32>) -> vec3<f32> {
    let exponents = elastic.alpha[p] * logarithms;
    return vec3<f32>(
        exponential_less_one(exponents.x),
        exponential_less_one(exponents.y),
        exponential_less_one(exponents.z),
    );
}

// Σ τᵢ/λᵢ² Nᵢ⊗Nᵢ (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let eigen = sym_eigen(k.green_strain);
    let logarithms = isochoric_logarithms(eigen.values);
    var tau = vec3<f32>(0.0);
    for (var p = 0u; p < elastic.terms; p++) {
        let powers = isochoric_powers(p, logarithms);
        tau += elastic.mu[p] * (powers - (powers.x + powers.y + powers.z) * (1.0 / 3.0));
    }
    let along = tau / max(1.0 + 2.0 * eigen.values, vec3<f32>(J_FLOOR * J_FLOOR));
    let stress = sym_plus(
        sym_scaled(sym_square_of(eigen.vectors[0]), along.x),
        sym_scaled(sym_square_of(eigen.vectors[1]), along.y),
    );
    return sym_plus(stress, sym_scaled(sym_square_of(eigen.vectors[2]), along.z));
}

// κ(J − 1) (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let logarithms = isochoric_logarithms(sym_eigen(k.green_strain).values);
    var energy = 0.0;
    for (var p = 0u; p < elastic.terms; p++) {
        let powers = isochoric_powers(p, logarithms);
        energy += elastic.mu[p] / elastic.alpha[p] * (powers.x + powers.y + powers.z);
    }
    return energy;
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
