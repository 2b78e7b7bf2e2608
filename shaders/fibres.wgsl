// One family of fibres; twin of src/materials/fibres.rs.
struct Fibres {
    eta: f32, // Pa
    tension_only: f32, // 1: they only pull
}
@group(0) @binding(0) var<uniform> fibres: Fibres;

// Ī₄ − 1 and I₄ for the unit direction a
fn fibres_stretch(k: Kinematics, a: vec3<f32>) -> vec2<f32> {
    let i4_change = 2.0 * sym_quadratic(k.green_strain, a);
    let w = j_m23_change(k);
    return vec2<f32>(i4_change + w + w * i4_change, 1.0 + i4_change);
}

fn fibres_pulling(change: f32) -> f32 {
    return max(change, (1.0 - fibres.tension_only) * change);
}

// 2η(Ī₄ − 1) J^(−2/3) (a⊗a − I₄/3 C⁻¹) (Pa)
fn fibres_isochoric(k: Kinematics, a: vec3<f32>) -> Sym3 {
    let stretch = fibres_stretch(k, a);
    let factor = 2.0 * fibres.eta * fibres_pulling(stretch.x) * k.j_m23;
    let spherical = (-1.0 / 3.0) * stretch.y / (k.j * k.j);
    return sym_scaled(sym_plus(sym_square_of(a), sym_scaled(k.adjugate_c, spherical)), factor);
}

// J/m³
fn fibres_energy(k: Kinematics, a: vec3<f32>) -> f32 {
    let pulling = fibres_pulling(fibres_stretch(k, a).x);
    return 0.5 * fibres.eta * pulling * pulling;
}
