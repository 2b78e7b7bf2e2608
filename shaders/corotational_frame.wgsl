// Hooke's law in a frame of two edges of each element; twin of src/materials/corotational_frame.rs. With
// hooke.wgsl. take_law, which is generated, gives an invocation the law of its element.
struct CorotationalFrame {
    shear: f32, // Pa
    bulk: f32, // Pa
    along: vec3<f32>, // the first edge at rest, a unit vector
    across: vec3<f32>, // what of the second is across it
}
var<private> elastic: CorotationalFrame;

// (n + m)/|n + m| − n of a unit vector n
fn more_of_unit(n: vec3<f32>, m: vec3<f32>) -> vec3<f32> {
    let square = dot(m, m) + 2.0 * dot(n, m);
    let length = sqrt(max(1.0 + square, 1.1754944e-38));
    return (m - square / (1.0 + length) * n) / length;
}

// R − I, by what deformed unit vectors are more than those at rest
fn frame_turn(gradient: mat3x3<f32>) -> mat3x3<f32> {
    let a = elastic.along;
    let b = elastic.across;
    let first = more_of_unit(a, times_vector(gradient, a));
    let moved = times_vector(gradient, b);
    let second = more_of_unit(b, moved - (dot(moved, a + first) + dot(b, first)) * (a + first));
    let third = cross(first, b + second) + cross(a, second);
    let larger = mat3x3<f32>(first.x * a, first.y * a, first.z * a);
    return plus_outer(plus_outer(larger, second, b), third, cross(a, b));
}

// of ε = sym(RᵀF − I); det F tells what is inside out
fn elastic_kinematics(gradient: mat3x3<f32>) -> Kinematics {
    let turn = frame_turn(gradient);
    // rows times columns: (RᵀF − I)ᵢⱼ
    var rest = mat3x3<f32>();
    for (var i = 0u; i < 3u; i++) {
        let column = vec3<f32>(turn[0][i], turn[1][i], turn[2][i]);
        rest[i] = gradient[i] + column.x * gradient[0] + column.y * gradient[1] + column.z * gradient[2] + column;
    }
    let diagonal = vec3<f32>(rest[0][0], rest[1][1], rest[2][2]);
    let others = vec3<f32>(rest[0][1] + rest[1][0], rest[1][2] + rest[2][1], rest[0][2] + rest[2][0]);
    return Kinematics(
        Sym3(diagonal, 0.5 * others),
        Sym3(vec3<f32>(1.0), vec3<f32>(0.0)),
        diagonal.x + diagonal.y + diagonal.z,
        1.0,
        1.0 + volume_change_of(gradient),
        1.0,
    );
}

// R (S_iso + p I) (Pa)
fn elastic_first_stress(gradient: mat3x3<f32>, k: Kinematics, isochoric: Sym3, pressure: f32) -> mat3x3<f32> {
    return plus_identity_times(frame_turn(gradient), sym_plus(isochoric, elastic_volumetric(k, pressure)));
}
