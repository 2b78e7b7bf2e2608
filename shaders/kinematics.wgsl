// Strain measures of a displacement gradient; twin of src/materials/kinematics.rs. J_FLOOR is generated.
struct Kinematics {
    green_strain: Sym3,
    adjugate_c: Sym3,
    volume_change: f32,
    j: f32,
    true_j: f32,
    j_m23: f32,
}

fn kinematics(h: mat3x3<f32>) -> Kinematics {
    let c0 = vec3<f32>(h[0][0], h[1][0], h[2][0]);
    let c1 = vec3<f32>(h[0][1], h[1][1], h[2][1]);
    let c2 = vec3<f32>(h[0][2], h[1][2], h[2][2]);
    let twice = Sym3(
        2.0 * vec3<f32>(h[0][0], h[1][1], h[2][2]) + vec3<f32>(dot(c0, c0), dot(c1, c1), dot(c2, c2)),
        vec3<f32>(h[0][1] + h[1][0], h[1][2] + h[2][1], h[0][2] + h[2][0])
            + vec3<f32>(dot(c0, c1), dot(c1, c2), dot(c0, c2)),
    );
    let change = volume_change_of(h);
    let volume_change = max(change, J_FLOOR - 1.0);
    let j = 1.0 + volume_change;
    let j_m13 = inverse_cbrt(j);
    return Kinematics(
        sym_scaled(twice, 0.5),
        sym_adjugate(Sym3(1.0 + twice.diagonal, twice.others)),
        volume_change,
        j,
        1.0 + change,
        j_m13 * j_m13,
    );
}

// J^(−2/3) − 1: one Newton step on (1+w)³ J² = 1 brings back the digits that the difference has lost
fn j_m23_change(k: Kinematics) -> f32 {
    let w = k.j_m23 - 1.0;
    let cube = w * (3.0 + w * (3.0 + w));
    let square = k.volume_change * (2.0 + k.volume_change);
    return w - (cube + square + cube * square) * k.j_m23 * (1.0 / 3.0);
}

// C⁻¹ m for an m with the eigenvectors of C
fn inverse_c_times(k: Kinematics, m: Sym3) -> Sym3 {
    return sym_scaled(sym_times_coaxial(k.adjugate_c, m), 1.0 / (k.j * k.j));
}

// Ī₁ − 3
fn i1_change(k: Kinematics) -> f32 {
    let w = j_m23_change(k);
    let twice = 2.0 * sym_trace(k.green_strain);
    return 3.0 * w + (twice + w * twice);
}
