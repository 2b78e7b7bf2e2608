// Hooke's law for small strains; twin of src/materials/linear.rs.
struct Linear {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: Linear;

// ε for E, tr ε for the change of volume, C = I; det F tells what is inside out
fn elastic_kinematics(h: mat3x3<f32>) -> Kinematics {
    let trace = h[0][0] + h[1][1] + h[2][2];
    return Kinematics(
        Sym3(
            vec3<f32>(h[0][0], h[1][1], h[2][2]),
            0.5 * vec3<f32>(h[0][1] + h[1][0], h[1][2] + h[2][1], h[0][2] + h[2][0]),
        ),
        Sym3(vec3<f32>(1.0), vec3<f32>(0.0)),
        trace,
        1.0,
        1.0 + volume_change_of(h),
        1.0,
    );
}

// P = S (Pa)
fn elastic_first_stress(gradient: mat3x3<f32>, k: Kinematics, isochoric: Sym3, pressure: f32) -> mat3x3<f32> {
    return sym_rows(sym_plus(isochoric, elastic_volumetric(k, pressure)));
}

// 2μ dev ε (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    return sym_scaled(sym_deviator(k.green_strain), 2.0 * elastic.shear);
}

fn elastic_volume_measure(k: Kinematics) -> f32 {
    return k.volume_change;
}

// p I (Pa)
fn elastic_volumetric(k: Kinematics, pressure: f32) -> Sym3 {
    return Sym3(vec3<f32>(pressure), vec3<f32>(0.0));
}

fn elastic_without_pressure(k: Kinematics, stress: Sym3) -> Sym3 {
    return stress;
}

// κ tr ε (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let deviator = sym_deviator(k.green_strain);
    return elastic.shear * sym_contracted(deviator, deviator);
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
