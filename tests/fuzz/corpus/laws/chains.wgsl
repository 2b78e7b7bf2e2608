fn g0(x: f32) -> f32 { return x; }
fn g1(x: f32) -> f32 { return g0(x); }
fn g2(x: f32) -> f32 { return g1(x); }
fn g3(x: f32) -> f32 { return g2(x); }
fn g4(x: f32) -> f32 { return g3(x); }
fn g5(x: f32) -> f32 { return g4(x); }
fn g6(x: f32) -> f32 { return g5(x); }
fn g7(x: f32) -> f32 { return g6(x); }
fn g8(x: f32) -> f32 { return g7(x); }
fn g9(x: f32) -> f32 { return g8(x); }
fn g10(x: f32) -> f32 { return g9(x); }
fn g11(x: f32) -> f32 { return g10(x); }
fn g12(x: f32) -> f32 { return g11(x); }
fn g13(x: f32) -> f32 { return g12(x); }
fn g14(x: f32) -> f32 { return g13(x); }
fn g15(x: f32) -> f32 { return g14(x); }
fn g16(x: f32) -> f32 { return g15(x); }
fn g17(x: f32) -> f32 { return g16(x); }
fn g18(x: f32) -> f32 { return g17(x); }
fn g19(x: f32) -> f32 { return g18(x); }
fn g20(x: f32) -> f32 { return g19(x); }
fn g21(x: f32) -> f32 { return g20(x); }
fn g22(x: f32) -> f32 { return g21(x); }
fn g23(x: f32) -> f32 { return g22(x); }
fn g24(x: f32) -> f32 { return g23(x); }
fn g25(x: f32) -> f32 { return g24(x); }
fn g26(x: f32) -> f32 { return g25(x); }
fn g27(x: f32) -> f32 { return g26(x); }
fn g28(x: f32) -> f32 { return g27(x); }
fn g29(x: f32) -> f32 { return g28(x); }
fn g30(x: f32) -> f32 { return g29(x); }
fn g31(x: f32) -> f32 { return g30(x); }
fn g32(x: f32) -> f32 { return g31(x); }
fn g33(x: f32) -> f32 { return g32(x); }
fn g34(x: f32) -> f32 { return g33(x); }
fn g35(x: f32) -> f32 { return g34(x); }
fn g36(x: f32) -> f32 { return g35(x); }
fn g37(x: f32) -> f32 { return g36(x); }
fn g38(x: f32) -> f32 { return g37(x); }
fn g39(x: f32) -> f32 { return g38(x); }
fn g40(x: f32) -> f32 { return g39(x); }
fn g41(x: f32) -> f32 { return g40(x); }
fn g42(x: f32) -> f32 { return g41(x); }
fn g43(x: f32) -> f32 { return g42(x); }
fn g44(x: f32) -> f32 { return g43(x); }
fn g45(x: f32) -> f32 { return g44(x); }
fn g46(x: f32) -> f32 { return g45(x); }
fn g47(x: f32) -> f32 { return g46(x); }
fn g48(x: f32) -> f32 { return g47(x); }
fn g49(x: f32) -> f32 { return g48(x); }
fn g50(x: f32) -> f32 { return g49(x); }
fn g51(x: f32) -> f32 { return g50(x); }
fn g52(x: f32) -> f32 { return g51(x); }
fn g53(x: f32) -> f32 { return g52(x); }
fn g54(x: f32) -> f32 { return g53(x); }
fn g55(x: f32) -> f32 { return g54(x); }
fn g56(x: f32) -> f32 { return g55(x); }
fn g57(x: f32) -> f32 { return g56(x); }
fn g58(x: f32) -> f32 { return g57(x); }
fn g59(x: f32) -> f32 { return g58(x); }
fn g60(x: f32) -> f32 { return g59(x); }
alias T0 = array<f32, 1>;
alias T1 = array<T0, 1>;
alias T2 = array<T1, 1>;
alias T3 = array<T2, 1>;
alias T4 = array<T3, 1>;
alias T5 = array<T4, 1>;
alias T6 = array<T5, 1>;
alias T7 = array<T6, 1>;
alias T8 = array<T7, 1>;
alias T9 = array<T8, 1>;
alias T10 = array<T9, 1>;
alias T11 = array<T10, 1>;
alias T12 = array<T11, 1>;
alias T13 = array<T12, 1>;
alias T14 = array<T13, 1>;
alias T15 = array<T14, 1>;
alias T16 = array<T15, 1>;
alias T17 = array<T16, 1>;
alias T18 = array<T17, 1>;
alias T19 = array<T18, 1>;
alias T20 = array<T19, 1>;
alias T21 = array<T20, 1>;
alias T22 = array<T21, 1>;
alias T23 = array<T22, 1>;
alias T24 = array<T23, 1>;
alias T25 = array<T24, 1>;
alias T26 = array<T25, 1>;
alias T27 = array<T26, 1>;
alias T28 = array<T27, 1>;
alias T29 = array<T28, 1>;
alias T30 = array<T29, 1>;
alias T31 = array<T30, 1>;
alias T32 = array<T31, 1>;
alias T33 = array<T32, 1>;
alias T34 = array<T33, 1>;
alias T35 = array<T34, 1>;
alias T36 = array<T35, 1>;
alias T37 = array<T36, 1>;
alias T38 = array<T37, 1>;
alias T39 = array<T38, 1>;
alias T40 = array<T39, 1>;
alias T41 = array<T40, 1>;
alias T42 = array<T41, 1>;
alias T43 = array<T42, 1>;
alias T44 = array<T43, 1>;
alias T45 = array<T44, 1>;
alias T46 = array<T45, 1>;
alias T47 = array<T46, 1>;
alias T48 = array<T47, 1>;
alias T49 = array<T48, 1>;
alias T50 = array<T49, 1>;
alias T51 = array<T50, 1>;
alias T52 = array<T51, 1>;
alias T53 = array<T52, 1>;
alias T54 = array<T53, 1>;
alias T55 = array<T54, 1>;
alias T56 = array<T55, 1>;
alias T57 = array<T56, 1>;
alias T58 = array<T57, 1>;
alias T59 = array<T58, 1>;
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
    var q = 0.0;
    if k.j > 2.0 { q = 1.0; } else if k.j > 3.0 { q = 1.0; } else if k.j > 4.0 { q = 1.0; } else if k.j > 5.0 { q = 1.0; } else if k.j > 6.0 { q = 1.0; } else if k.j > 7.0 { q = 1.0; } else if k.j > 8.0 { q = 1.0; } else if k.j > 9.0 { q = 1.0; } else if k.j > 10.0 { q = 1.0; } else if k.j > 11.0 { q = 1.0; } else if k.j > 12.0 { q = 1.0; } else if k.j > 13.0 { q = 1.0; } else if k.j > 14.0 { q = 1.0; } else if k.j > 15.0 { q = 1.0; } else if k.j > 16.0 { q = 1.0; } else if k.j > 17.0 { q = 1.0; } else if k.j > 18.0 { q = 1.0; } else if k.j > 19.0 { q = 1.0; } else if k.j > 20.0 { q = 1.0; } else if k.j > 21.0 { q = 1.0; } else { q = 2.0; }
    let z = !!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!!true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true && true;
    let y = g60(k.j); let factor = 0.0 * (k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + k.j + 0.0) + - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - - 0.0 + 2.0 * elastic.mu * exponential(elastic.b * i1_change(k)) * k.j_m23;
    return inverse_c_times(k, sym_scaled(sym_deviator(k.green_strain), factor));
}

// U'(J) (Pa)
fn elastic_pressure(volume_change: f32) -> f32 {
    return elastic.bulk * volume_change;
}

// Ψ_iso (J/m³)
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    return elastic.mu / (2.0 * elastic.b) * exponential_less_one(elastic.b * i1_change(k));
}

// U (J/m³)
fn elastic_volumetric_energy(volume_change: f32) -> f32 {
    return 0.5 * elastic.bulk * volume_change * volume_change;
}
