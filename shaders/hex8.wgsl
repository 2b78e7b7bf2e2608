// The eight-node hexahedron with one integration point and hourglass control; twin of src/elements/hex8.rs.
struct Element {
    // displacements of nodes 1 to 7 less that of node 0 (m)
    u1: vec3<f32>,
    u2: vec3<f32>,
    u3: vec3<f32>,
    u4: vec3<f32>,
    u5: vec3<f32>,
    u6: vec3<f32>,
    u7: vec3<f32>,
    // mean gradients of nodes 1 to 7 (1/m)
    b1: vec3<f32>,
    b2: vec3<f32>,
    b3: vec3<f32>,
    b4: vec3<f32>,
    b5: vec3<f32>,
    b6: vec3<f32>,
    b7: vec3<f32>,
    volume: f32, // m³
}

const HOURGLASS_STIFFNESS: u32 = 22u;
const HOURGLASS_ARMS: u32 = 23u;

fn element_of(row: u32) -> Element {
    let u0 = corner_displacement(row, 0u);
    return Element(
        corner_displacement(row, 1u) - u0,
        corner_displacement(row, 2u) - u0,
        corner_displacement(row, 3u) - u0,
        corner_displacement(row, 4u) - u0,
        corner_displacement(row, 5u) - u0,
        corner_displacement(row, 6u) - u0,
        corner_displacement(row, 7u) - u0,
        shape_vector(row, 0u),
        shape_vector(row, 3u),
        shape_vector(row, 6u),
        shape_vector(row, 9u),
        shape_vector(row, 12u),
        shape_vector(row, 15u),
        shape_vector(row, 18u),
        rest_shape[place(row, ROWS, VOLUME_ROW)],
    );
}

struct Forces {
    gradient: mat3x3<f32>, // ∇u
    stress: mat3x3<f32>, // first Piola-Kirchhoff stress (Pa)
}

fn at_point(e: Element, point: u32) -> PointState {
    var h = mat3x3<f32>(e.u1.x * e.b1, e.u1.y * e.b1, e.u1.z * e.b1);
    h = plus_outer(h, e.u2, e.b2);
    h = plus_outer(h, e.u3, e.b3);
    h = plus_outer(h, e.u4, e.b4);
    h = plus_outer(h, e.u5, e.b5);
    h = plus_outer(h, e.u6, e.b6);
    h = plus_outer(h, e.u7, e.b7);
    return PointState(h, h, e.volume);
}

fn add_stress(forces: Forces, point: u32, at: PointState, stress: mat3x3<f32>) -> Forces {
    return Forces(at.gradient, stress);
}

// XᵀΓ_m (m)
fn hourglass_arm(row: u32, m: u32) -> vec3<f32> {
    return shape_vector(row, HOURGLASS_ARMS + 3u * m);
}

// The four hourglass displacements q_m = Γ_m·u − ∇u h_m (m). The signs are those of ηζ, ζξ, ξη, ξηζ at nodes 1 to 7.
fn hourglass_displacements(row: u32, e: Element, h: mat3x3<f32>) -> array<vec3<f32>, 4> {
    return array<vec3<f32>, 4>(
        e.u1 - e.u2 - e.u3 - e.u4 - e.u5 + e.u6 + e.u7 - times_vector(h, hourglass_arm(row, 0u)),
        -e.u1 - e.u2 + e.u3 - e.u4 + e.u5 + e.u6 - e.u7 - times_vector(h, hourglass_arm(row, 1u)),
        -e.u1 + e.u2 - e.u3 + e.u4 - e.u5 + e.u6 - e.u7 - times_vector(h, hourglass_arm(row, 2u)),
        e.u1 - e.u2 + e.u3 + e.u4 - e.u5 + e.u6 - e.u7 - times_vector(h, hourglass_arm(row, 3u)),
    );
}

// Nodal forces (N).
fn corner_forces(row: u32, e: Element, forces: Forces) -> array<vec3<f32>, NODES> {
    let displacements = hourglass_displacements(row, e, forces.gradient);
    let stiffness = rest_shape[place(row, ROWS, HOURGLASS_STIFFNESS)];
    let p = stiffness * displacements[0];
    let q = stiffness * displacements[1];
    let r = stiffness * displacements[2];
    let s = stiffness * displacements[3];
    var folded = e.volume * forces.stress;
    folded = plus_outer(folded, -p, hourglass_arm(row, 0u));
    folded = plus_outer(folded, -q, hourglass_arm(row, 1u));
    folded = plus_outer(folded, -r, hourglass_arm(row, 2u));
    folded = plus_outer(folded, -s, hourglass_arm(row, 3u));
    let f1 = p - q - r + s + times_vector(folded, e.b1);
    let f2 = -p - q + r - s + times_vector(folded, e.b2);
    let f3 = -p + q - r + s + times_vector(folded, e.b3);
    let f4 = -p - q + r + s + times_vector(folded, e.b4);
    let f5 = -p + q - r - s + times_vector(folded, e.b5);
    let f6 = p + q + r + s + times_vector(folded, e.b6);
    let f7 = p - q - r - s + times_vector(folded, e.b7);
    return array<vec3<f32>, NODES>(-f1 - f2 - f3 - f4 - f5 - f6 - f7, f1, f2, f3, f4, f5, f6, f7);
}

// J
fn hourglass_energy(row: u32, e: Element) -> f32 {
    let q = hourglass_displacements(row, e, at_point(e, 0u).gradient);
    let squares = dot(q[0], q[0]) + dot(q[1], q[1]) + dot(q[2], q[2]) + dot(q[3], q[3]);
    return 0.5 * rest_shape[place(row, ROWS, HOURGLASS_STIFFNESS)] * squares;
}
