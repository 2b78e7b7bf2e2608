// Invariants of the isochoric deformation, and the stress of an energy of them; twin of src/materials/invariants.rs.

// What an energy is a function of; the first three are exact for small strains.
struct Invariants {
    I1bar_minus_3: f32, // Ī₁ − 3, Ī₁ = J^(−2/3) tr C
    I2bar_minus_3: f32,
    J_minus_1: f32,
    I1bar: f32,
    I2bar: f32,
    J: f32,
}

// Ī₂ − 3, Ī₂ = J^(−4/3) ½((tr C)² − tr C²)
fn i2_change(k: Kinematics) -> f32 {
    let e = k.green_strain;
    let w = j_m23_change(k);
    let v = w * (2.0 + w);
    let trace = sym_trace(e);
    let change = 4.0 * trace + 2.0 * (trace * trace - sym_contracted(e, e));
    return 3.0 * v + change + v * change;
}

// 2 ∂Ψ/∂Ī₁ ∂Ī₁/∂C, from ∂Ψ/∂Ī₁: C⁻¹ times the deviator of 4 ∂Ψ/∂Ī₁ J^(−2/3) E (Pa)
fn stress_of_slope(k: Kinematics, first: f32) -> Sym3 {
    return inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), 4.0 * first * k.j_m23));
}

// The same with Ī₂ as well: 4(∂Ψ/∂Ī₁ J^(−2/3) + ∂Ψ/∂Ī₂ J^(−4/3) (1 + 2 tr E)) E − 8 ∂Ψ/∂Ī₂ J^(−4/3) E² (Pa)
fn stress_of_slopes(k: Kinematics, first: f32, second: f32) -> Sym3 {
    let e = k.green_strain;
    let of_second = 4.0 * second * k.j_m23 * k.j_m23;
    let factor = 4.0 * first * k.j_m23 + of_second * (2.0 * sym_trace(e) + 1.0);
    let inner = sym_plus(sym_scaled(e, factor), sym_scaled(sym_times_coaxial(e, e), -2.0 * of_second));
    return inverse_c_times(k, sym_deviator(inner));
}

// What a formula gives outside of its domain: NaN, which cannot be written down.
fn no_number(x: f32) -> f32 {
    return sqrt(min(x, -1.0));
}
