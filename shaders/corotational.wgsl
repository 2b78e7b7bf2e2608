// Hooke's law in the frame that turns with the material; twin of src/materials/corotational.rs. With eigen.wgsl.
struct Corotational {
    shear: f32, // Pa
    bulk: f32, // Pa
}
@group(0) @binding(0) var<uniform> elastic: Corotational;

// Stretches less 1, stretches and their right-handed directions at rest (rows); the least, last, has the sign of J
struct PrincipalStretches {
    biot: vec3<f32>,
    stretches: vec3<f32>,
    axes: mat3x3<f32>,
}

fn principal_stretches(k: Kinematics) -> PrincipalStretches {
    let eigen = sym_eigen(k.green_strain);
    let e = eigen.values;
    let n = eigen.vectors;
    let first_is_less = e.z > e.x;
    let less = min(e.x, e.z);
    let x = select(n[0], n[2], first_is_less);
    let last = select(n[2], n[0], first_is_less);
    let second_is_less = less > e.y;
    let y = select(n[1], last, second_is_less);
    let strains = vec3<f32>(max(e.x, e.z), max(e.y, less), min(e.y, less));
    let roots = sqrt(max(1.0 + 2.0 * strains.xy, vec2<f32>(0.0)));
    // C does not know the sign, and where it is nearly singular not even the size
    let least = min(roots.x, roots.y);
    let signed = clamp(k.true_j / max(roots.x * roots.y, 1.1754944e-38), -least, least);
    let stretches = vec3<f32>(roots, signed);
    // s − 1 = 2E/(1 + s)
    let exact = 2.0 * strains / max(1.0 + stretches, vec3<f32>(1.0));
    let biot = vec3<f32>(exact.xy, select(signed - 1.0, exact.z, signed > 0.5));
    return PrincipalStretches(biot, stretches, mat3x3<f32>(x, y, cross(x, y)));
}

// a vector of length 1; nothing of nothing
fn unit_of(a: vec3<f32>) -> vec3<f32> {
    return a / max(sqrt(dot(a, a)), 1.1754944e-38);
}

// 1/s, bounded
fn inverse_stretches(s: vec3<f32>) -> vec3<f32> {
    return 1.0 / vec3<f32>(max(s.xy, vec2<f32>(J_FLOOR)), select(min(s.z, -J_FLOOR), max(s.z, J_FLOOR), s.z > 0.0));
}

// Σ aᵢ Nᵢ⊗Nᵢ
fn along_axes(axes: mat3x3<f32>, values: vec3<f32>) -> Sym3 {
    let larger = sym_plus(sym_scaled(sym_square_of(axes[0]), values.x), sym_scaled(sym_square_of(axes[1]), values.y));
    return sym_plus(larger, sym_scaled(sym_square_of(axes[2]), values.z));
}

fn trace_of_biot(biot: vec3<f32>) -> f32 {
    return biot.x + biot.y + biot.z;
}

// of 2μ dev B + p I (Pa)
fn biot_stresses(biot: vec3<f32>, pressure: f32) -> vec3<f32> {
    return 2.0 * elastic.shear * (biot - trace_of_biot(biot) * (1.0 / 3.0)) + pressure;
}

fn isochoric_of(principal: PrincipalStretches) -> Sym3 {
    let values = biot_stresses(principal.biot, 0.0) * inverse_stretches(principal.stretches);
    return along_axes(principal.axes, values);
}

fn elastic_kinematics(gradient: mat3x3<f32>) -> Kinematics {
    return kinematics(gradient);
}

// R (2μ dev B + p I), and what effects have made of S_iso (Pa)
fn elastic_first_stress(gradient: mat3x3<f32>, k: Kinematics, isochoric: Sym3, pressure: f32) -> mat3x3<f32> {
    let principal = principal_stretches(k);
    let n = principal.axes;
    let effects = sym_plus(isochoric, sym_scaled(isochoric_of(principal), -1.0));
    let first = unit_of(n[0] + times_vector(gradient, n[0]));
    let deformed = n[1] + times_vector(gradient, n[1]);
    let second = unit_of(deformed - dot(first, deformed) * first);
    let values = biot_stresses(principal.biot, pressure);
    let larger = plus_outer(plus_identity_times(gradient, effects), values.x * first, n[0]);
    return plus_outer(plus_outer(larger, values.y * second, n[1]), values.z * cross(first, second), n[2]);
}

// 2μ U⁻¹ dev B (Pa)
fn elastic_isochoric(k: Kinematics) -> Sym3 {
    return isochoric_of(principal_stretches(k));
}

// tr B
fn elastic_volume_measure(k: Kinematics) -> f32 {
    return trace_of_biot(principal_stretches(k).biot);
}

// p U⁻¹ (Pa)
fn elastic_volumetric(k: Kinematics, pressure: f32) -> Sym3 {
    let principal = principal_stretches(k);
    return along_axes(principal.axes, pressure * inverse_stretches(principal.stretches));
}

// s − (s:U)/3 U⁻¹ (Pa)
fn elastic_without_pressure(k: Kinematics, stress: Sym3) -> Sym3 {
    let principal = principal_stretches(k);
    let pressing = sym_contracted(stress, along_axes(principal.axes, principal.stretches)) * (-1.0 / 3.0);
    let inverse = along_axes(principal.axes, inverse_stretches(principal.stretches));
    return sym_plus(stress, sym_scaled(inverse, pressing));
}

// κ tr B (Pa)
fn elastic_pressure(theta: f32) -> f32 {
    return elastic.bulk * theta;
}

// J/m³
fn elastic_isochoric_energy(k: Kinematics) -> f32 {
    let biot = principal_stretches(k).biot;
    let deviator = biot - trace_of_biot(biot) * (1.0 / 3.0);
    return elastic.shear * dot(deviator, deviator);
}

// J/m³
fn elastic_volumetric_energy(theta: f32) -> f32 {
    return 0.5 * elastic.bulk * theta * theta;
}
