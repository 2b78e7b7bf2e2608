// Hooke's law for small strains; twin of src/materials/linear.rs. With hooke.wgsl.
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
