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
    return elastic.bulk * f0(volume_change);
}

// Ψ_iso (J/m³)
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.mu / (2.0 * elastic.b) * exponential_less_one(elastic.b * i1_change(k));
}

// U (J/m³)
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    return 0.5 * elastic.bulk * volume_change * volume_change;
}
fn f0(x: f32) -> f32 { return 0.5 * (f1(x) + f1(x)); }
fn f1(x: f32) -> f32 { return 0.5 * (f2(x) + f2(x)); }
fn f2(x: f32) -> f32 { return 0.5 * (f3(x) + f3(x)); }
fn f3(x: f32) -> f32 { return 0.5 * (f4(x) + f4(x)); }
fn f4(x: f32) -> f32 { return 0.5 * (f5(x) + f5(x)); }
fn f5(x: f32) -> f32 { return 0.5 * (f6(x) + f6(x)); }
fn f6(x: f32) -> f32 { return 0.5 * (f7(x) + f7(x)); }
fn f7(x: f32) -> f32 { return 0.5 * (f8(x) + f8(x)); }
fn f8(x: f32) -> f32 { return 0.5 * (f9(x) + f9(x)); }
fn f9(x: f32) -> f32 { return 0.5 * (f10(x) + f10(x)); }
fn f10(x: f32) -> f32 { return 0.5 * (f11(x) + f11(x)); }
fn f11(x: f32) -> f32 { return 0.5 * (f12(x) + f12(x)); }
fn f12(x: f32) -> f32 { return 0.5 * (f13(x) + f13(x)); }
fn f13(x: f32) -> f32 { return 0.5 * (f14(x) + f14(x)); }
fn f14(x: f32) -> f32 { return 0.5 * (f15(x) + f15(x)); }
fn f15(x: f32) -> f32 { return 0.5 * (f16(x) + f16(x)); }
fn f16(x: f32) -> f32 { return 0.5 * (f17(x) + f17(x)); }
fn f17(x: f32) -> f32 { return 0.5 * (f18(x) + f18(x)); }
fn f18(x: f32) -> f32 { return 0.5 * (f19(x) + f19(x)); }
fn f19(x: f32) -> f32 { return 0.5 * (f20(x) + f20(x)); }
fn f20(x: f32) -> f32 { return 0.5 * (f21(x) + f21(x)); }
fn f21(x: f32) -> f32 { return 0.5 * (f22(x) + f22(x)); }
fn f22(x: f32) -> f32 { return 0.5 * (f23(x) + f23(x)); }
fn f23(x: f32) -> f32 { return 0.5 * (f24(x) + f24(x)); }
fn f24(x: f32) -> f32 { return 0.5 * (f25(x) + f25(x)); }
fn f25(x: f32) -> f32 { return 0.5 * (f26(x) + f26(x)); }
fn f26(x: f32) -> f32 { return 0.5 * (f27(x) + f27(x)); }
fn f27(x: f32) -> f32 { return 0.5 * (f28(x) + f28(x)); }
fn f28(x: f32) -> f32 { return 0.5 * (f29(x) + f29(x)); }
fn f29(x: f32) -> f32 { return 0.5 * (f30(x) + f30(x)); }
fn f30(x: f32) -> f32 { return 0.5 * (f31(x) + f31(x)); }
fn f31(x: f32) -> f32 { return 0.5 * (f32(x) + f32(x)); }
fn f32(x: f32) -> f32 { return 0.5 * (f33(x) + f33(x)); }
fn f33(x: f32) -> f32 { return 0.5 * (f34(x) + f34(x)); }
fn f34(x: f32) -> f32 { return 0.5 * (f35(x) + f35(x)); }
fn f35(x: f32) -> f32 { return 0.5 * (f36(x) + f36(x)); }
fn f36(x: f32) -> f32 { return 0.5 * (f37(x) + f37(x)); }
fn f37(x: f32) -> f32 { return 0.5 * (f38(x) + f38(x)); }
fn f38(x: f32) -> f32 { return 0.5 * (f39(x) + f39(x)); }
fn f39(x: f32) -> f32 { return 0.5 * (f40(x) + f40(x)); }
fn f40(x: f32) -> f32 { return x; }
