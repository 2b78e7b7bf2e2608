// The stable neo-Hookean law, defined for every deformation; twin of src/materials/stable_neo_hookean.rs.
// With elementary.wgsl.
struct StableNeoHookean {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: StableNeoHookean;

// J − 1 without a floor
fn elastic_kinematics(gradient: mat3x3<f32>) -> Kinematics {
    var k = kinematics(gradient);
    k.volume_change = volume_change_of(gradient);
    return k;
}

// m = 4/3 μ (Pa)
fn stable_m() -> f32 {
    return elastic.shear * (4.0 / 3.0);
}

// m I₁/(I₁ + 1) less 3m/4 (Pa)
fn stable_growth(k: Kinematics) -> f32 {
    let growth = 2.0 * sym_trace(k.green_strain);
    return stable_m() * growth / (4.0 * (4.0 + growth));
}

// growth I + 3m/4 (I − J C⁻¹) + m/8 (J − 1) J C⁻¹ (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    let e = k.green_strain;
    let quarters = 0.75 * stable_m() / k.j;
    let squares = sym_adjugate(e);
    let diagonal = k.volume_change - 2.0 * sym_trace(e);
    let change = sym_plus(sym_scaled(e, 2.0), sym_scaled(squares, -4.0));
    let sheared = Sym3(quarters * (change.diagonal + diagonal) + stable_growth(k), quarters * change.others);
    return sym_plus(sheared, sym_scaled(k.adjugate_c, 0.125 * stable_m() * k.volume_change / k.j));
}

// With A = I + ∇u: growth A + 3m/4 (A − cof A) + (p + m/8 (J − 1)) cof A, and what effects have made of S_iso (Pa)
fn elastic_first_stress(h: mat3x3<f32>, k: Kinematics, isochoric: Sym3, pressure: f32) -> mat3x3<f32> {
    let growth = Sym3(vec3<f32>(stable_growth(k)), vec3<f32>(0.0));
    let effects = sym_plus(sym_plus(isochoric, sym_scaled(elastic_isochoric(k), -1.0)), growth);
    let trace = h[0][0] + h[1][1] + h[2][2];
    let turned = transpose(h);
    // cof A − I
    let change = mat3x3<f32>(
        vec3<f32>(trace, 0.0, 0.0) - turned[0] + cross(h[1], h[2]),
        vec3<f32>(0.0, trace, 0.0) - turned[1] + cross(h[2], h[0]),
        vec3<f32>(0.0, 0.0, trace) - turned[2] + cross(h[0], h[1]),
    );
    let shear = 0.75 * stable_m();
    let pressing = pressure + 0.125 * stable_m() * k.volume_change;
    let cofactor = mat3x3<f32>(
        vec3<f32>(1.0, 0.0, 0.0) + change[0],
        vec3<f32>(0.0, 1.0, 0.0) + change[1],
        vec3<f32>(0.0, 0.0, 1.0) + change[2],
    );
    return plus_identity_times(h, effects) + shear * (h - change) + pressing * cofactor;
}

fn elastic_volume_measure(k: Kinematics) -> f32 {
    return k.volume_change;
}

fn elastic_without_pressure(k: Kinematics, stress: Sym3) -> Sym3 {
    return stress;
}

// κ(J − 1) (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let growth = 2.0 * sym_trace(k.green_strain);
    let of_growth = 0.5 * (growth - logarithm_of_one_plus(0.25 * growth));
    return stable_m() * (of_growth + k.volume_change * (0.0625 * k.volume_change - 0.75));
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
