// Families of fibres that stiffen exponentially; twin of src/materials/exponential_fibres.rs. FAMILIES and
// family_direction are generated.
struct ExponentialFamily {
    k1: f32, // Pa
    k2: f32,
    dispersion: f32,
    tension_only: f32, // 1: it only pulls
    // unit vector, where it is the same in the whole block
    x: f32,
    y: f32,
    z: f32,
    unused: f32,
}
@group(0) @binding(0) var<uniform> exponential_fibres: array<ExponentialFamily, FAMILIES>;

// k₂ Ē², no more than a stress needs to stay a number
fn family_exponent(f: ExponentialFamily, strain: f32) -> f32 {
    return min(f.k2 * strain * strain, 40.0);
}

// Ē, or 0 where the family does not pull, and I₄ − 1
fn exponential_strain(f: ExponentialFamily, k: Kinematics, a: vec3<f32>) -> vec2<f32> {
    let i4_change = 2.0 * sym_quadratic(k.green_strain, a);
    let w = j_m23_change(k);
    let change = i4_change + w + w * i4_change;
    let strain = f.dispersion * i1_change(k) + (1.0 - 3.0 * f.dispersion) * change;
    return vec2<f32>(max(strain, (1.0 - f.tension_only) * strain), i4_change);
}

// 2k₁ Ē exp(k₂ Ē²) ∂Ē/∂C (Pa)
fn exponential_stress(f: ExponentialFamily, k: Kinematics, a: vec3<f32>) -> Sym3 {
    let strain = exponential_strain(f, k, a);
    let factor = 2.0 * f.k1 * strain.x * exponential(family_exponent(f, strain.x)) * k.j_m23;
    let spread = inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), 2.0 * f.dispersion));
    let spherical = sym_scaled(k.adjugate_c, (-1.0 / 3.0) / (k.j * k.j) * (1.0 + strain.y));
    let along = sym_scaled(sym_plus(sym_square_of(a), spherical), 1.0 - 3.0 * f.dispersion);
    return sym_scaled(sym_plus(spread, along), factor);
}

// Sum over the families (Pa)
fn exponential_isochoric(element: u32, k: Kinematics) -> Sym3 {
    var stress = exponential_stress(exponential_fibres[0], k, family_direction(element, 0u));
    for (var family = 1u; family < FAMILIES; family++) {
        let direction = family_direction(element, family);
        stress = sym_plus(stress, exponential_stress(exponential_fibres[family], k, direction));
    }
    return stress;
}

// J/m³
fn exponential_energy(element: u32, k: Kinematics) -> f32 {
    var energy = 0.0;
    for (var family = 0u; family < FAMILIES; family++) {
        let f = exponential_fibres[family];
        let strain = exponential_strain(f, k, family_direction(element, family)).x;
        let square = strain * strain;
        let grown = exponential_less_one(family_exponent(f, strain)) / select(1.0, f.k2, f.k2 > 0.0);
        energy += 0.5 * f.k1 * select(square, grown, f.k2 > 0.0);
    }
    return energy;
}
